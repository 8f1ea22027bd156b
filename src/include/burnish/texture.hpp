#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace burnish {

/// Pixels as they come from a file or a generator: RGBA, 8 bits each, row 0 on top, rows packed.
struct Image8 {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 * width * height bytes

    Image8() = default;
    Image8(int w, int h)
        : width(w),
          height(h),
          rgba(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    [[nodiscard]] std::uint8_t* at(int x, int y) {
        return rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
    }
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return const_cast<Image8*>(this)->at(x, y);
    }
};

/// Pixels of 16 bits each, otherwise like Image8. Signed formats take them as two's complement.
struct Image16 {
    int width = 0;
    int height = 0;
    std::vector<std::uint16_t> rgba;  ///< 4 * width * height words

    Image16() = default;
    Image16(int w, int h)
        : width(w),
          height(h),
          rgba(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    [[nodiscard]] std::uint16_t* at(int x, int y) {
        return rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
    }
    [[nodiscard]] const std::uint16_t* at(int x, int y) const {
        return const_cast<Image16*>(this)->at(x, y);
    }
};

/// How texels are taken within a mip level, and between levels, in this order.
enum class Filter {
    nearest,
    linear,
    nearest_mipmap_nearest,
    linear_mipmap_nearest,
    nearest_mipmap_linear,
    linear_mipmap_linear,
};

/// Whether a filter weights the texels of one level, instead of taking the nearest.
[[nodiscard]] constexpr bool is_linear_within(Filter f) noexcept {
    return f == Filter::linear || f == Filter::linear_mipmap_nearest ||
           f == Filter::linear_mipmap_linear;
}

enum class Wrap { repeat, clamp_to_edge, clamp_to_border, mirrored_repeat };

/// What the ends of a table's coordinate stand for. Other than `edges` is for fetches between
/// stages alone, which look functions up: there the ends of the domain are the centres of the first
/// and the last texel, so that a linear filter never leaves the function.
enum class TexelSpan {
    edges,           ///< 0 and 1 are the outer edges of the texels, as everywhere
    centers,         ///< 0 and 1 are their centres
    signed_centers,  ///< -1 and 1 are
};

/// How coordinates reach texels. Texel row 0 lies at t = 0; linear filtering samples at u*W - 1/2.
struct Sampler {
    Filter filter = Filter::linear;  ///< where a pixel is larger than a texel
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    Wrap wrap_r = Wrap::repeat;
    /// Where it is not: nearest or linear; nothing: as `filter` is within a level.
    std::optional<Filter> mag_filter{};
    float lod_bias = 0.0F;  ///< levels, [-16, 16), kept in 1/256
    /// r, g, b, a of clamp_to_border, clamped to the range of the format.
    std::array<float, 4> border{};
    TexelSpan span_s = TexelSpan::edges, span_t = TexelSpan::edges;
    /// Most probes along the longer axis of what a pixel covers, 1 .. kMostProbes, where `filter`
    /// looks at levels; two_d only.
    int max_anisotropy = 1;

    static constexpr int kMostProbes = 16;

    [[nodiscard]] constexpr bool mag_is_linear() const noexcept {
        return is_linear_within(mag_filter.value_or(filter));
    }
};

/// What the numbers of an image mean. An unsigned byte n is n / 255, a signed one, in two's
/// complement, n / 128, filtered as a signed number; words n / 65535 and n / 32768.
enum class TexelFormat {
    rgba8,
    rgb8,               ///< (r, g, b, 1)
    luminance8,         ///< (r, r, r, 1)
    luminance8_alpha8,  ///< (r, r, r, a)
    intensity8,         ///< (r, r, r, r)
    alpha8,             ///< (0, 0, 0, a)
    r8,                 ///< (r, 0, 0, 1)
    signed_rgba8,
    signed_rgb8,  ///< 1 is 255 / 255
    signed_rgb8_unsigned_alpha8,
    signed_luminance8,
    signed_luminance8_alpha8,
    signed_intensity8,
    signed_alpha8,
    hilo16,                 ///< hi from r, lo from g, two words
    signed_hilo16,          ///< the same, signed
    hilo8,                  ///< two bytes, filtered as words n * 257
    signed_hilo8,           ///< two signed bytes, filtered as words n * 256
    dsdt8,                  ///< ds from r, dt from g, signed
    dsdt8_mag8,             ///< and mag from b, unsigned
    dsdt8_mag8_intensity8,  ///< and intensity from a, unsigned
    rgba16,                 ///< words; wide machines only
};

/// Kinds of texels that texture-shader operations tell apart.
enum class TexelClass {
    unsigned_rgba,
    signed_rgba,
    mixed,  ///< signed colour, unsigned alpha
    hilo,
    signed_hilo,
    dsdt,
    dsdt_mag,
    dsdt_mag_intensity,
};
[[nodiscard]] TexelClass format_class(TexelFormat format) noexcept;

/// Formats whose channels are words: hilo, also of stored bytes, and rgba16.
[[nodiscard]] bool has_words(TexelFormat format) noexcept;
/// hilo16 and its three relatives: two channels instead of four.
[[nodiscard]] bool is_hilo(TexelFormat format) noexcept;

enum class TextureTarget {
    one_d,  ///< height 1; t plays no part
    two_d,
    rectangle,  ///< coordinates in texels; clamps only, one level
    cube,       ///< six square faces +x -x +y -y +z -z; wraps play no part: clamp_to_edge
    three_d,
};

/// What a texture is made of besides its images.
struct TextureDescription {
    TextureTarget target = TextureTarget::two_d;
    TexelFormat format = TexelFormat::rgba8;
    Sampler sampler{};
    int depth = 1;             ///< slices of level 0; three_d only
    bool box_mipmaps = false;  ///< make all levels from level 0
};

/// A mip level: sides in texels, and where the texel (0, 0) of its first face or slice is.
struct TextureLevel {
    int width, height, depth;
    std::int32_t offset;  ///< bytes from Texture::texels()
};

/// Coordinates that the argument of a table never goes beyond, within -8 .. 8.
struct CoordinateRange {
    float least = -8.0F, most = 8.0F;
};

/// A texture in the layout that the fetch kernels read. Immutable.
///
/// All levels, faces and slices lie in one storage with one row pitch: level 0, below it levels 1,
/// 2, ... side by side, and so again for every face or slice, a fixed distance on. Each row is
/// followed by the texels that the wrap mode puts beside its last one, so that a horizontal pair is
/// one load, and the last row by a row likewise, so that the lower pair is one pitch further; with
/// clamp_to_border border texels lie on all sides. The row pitch is an odd number of cache lines,
/// so that the rows of a block spread over the sets.
///
/// A texel is four signed bytes r, g, b, a, of unsigned ones 127 - value, of signed ones -1 -
/// value: what makes the filter short. Of hilo formats it is two words, of rgba16 four. Words are
/// signed: unsigned ones minus 32768.
class Texture {
  public:
    /// Largest width, height and depth, and the levels that they can have.
    static constexpr int kMaxSize = 16384;
    static constexpr int kMaxLevels = 15;

    /// Throws Error{bad_input} if the image is empty or its byte count does not fit its size,
    /// Error{limit} if a side exceeds kMaxSize.
    Texture(const Image8& image, const Sampler& sampler, TexelFormat format = TexelFormat::rgba8);
    /// `images`: the faces or slices of level 0, then those of level 1 and so on, each level half
    /// as large as the one before, rounded down, at least 1; or only level 0 for box_mipmaps, which
    /// averages what each texel covers of the level before, exactly, rounded half up once.
    /// Formats with words take n * 257, or n * 256 if signed, from bytes n.
    /// Throws Error{bad_input} for images, sides or wraps that do not fit target and format, also
    /// Error{limit} for more than 2 GiB.
    Texture(std::span<const Image8> images, const TextureDescription& description);
    /// Formats with words only.
    Texture(std::span<const Image16> images, const TextureDescription& description);
    Texture(Texture&&) noexcept = default;
    Texture& operator=(Texture&&) noexcept = default;
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    ~Texture() = default;

    [[nodiscard]] int width() const noexcept { return m_levels[0].width; }
    [[nodiscard]] int height() const noexcept { return m_levels[0].height; }
    [[nodiscard]] const Sampler& sampler() const noexcept { return m_sampler; }
    [[nodiscard]] TexelFormat format() const noexcept { return m_format; }
    [[nodiscard]] TextureTarget target() const noexcept { return m_target; }
    [[nodiscard]] std::span<const TextureLevel> levels() const noexcept { return m_levels; }
    /// Bytes from one row to the next.
    [[nodiscard]] std::int32_t pitch() const noexcept { return m_pitch; }
    /// Bytes from one face or slice to the next.
    [[nodiscard]] std::int32_t layer_bytes() const noexcept { return m_layer_bytes; }
    /// Bytes from one texel to the next: 4 or 8, in a quartet 32, of a table 4, a summed one 8.
    [[nodiscard]] int texel_bytes() const noexcept { return m_texel_bytes; }
    /// Which of the textures of a quartet this is, 0 .. 3; -1 outside of one.
    [[nodiscard]] int place() const noexcept { return m_place; }
    [[nodiscard]] bool is_table() const noexcept { return m_is_table; }
    /// Of a table of one dimension that is not summed: what every code of a wide register finds in
    /// it, at code & 65535; else null.
    [[nodiscard]] const std::int16_t* codes() const noexcept {
        return m_codes ? m_codes->data() : nullptr;
    }
    /// Of a summed table, which is one, too.
    [[nodiscard]] const std::optional<CoordinateRange>& summed() const noexcept { return m_summed; }
    /// Texel (0, 0) of level 0, first face or slice.
    [[nodiscard]] const std::uint8_t* texels() const noexcept { return m_texels; }
    /// Channel c of a stored texel as the number of the format: -128 .. 255, of words -32768 ..
    /// 65535. x and y may be one beyond the sides, where neighbours lie.
    [[nodiscard]] int texel(std::size_t level, int layer, int x, int y, int c) const noexcept;
    /// Whether channel c is signed.
    [[nodiscard]] bool is_signed(int c) const noexcept;

    /// One to four rgba16 textures of the same target, sides, levels and sampler, none of them in a
    /// quartet yet, once more as a quartet: their texels lie between each other in one storage, 8
    /// bytes of each in turn and 32 for all, so that one row of two texels serves all four.
    /// Throws Error{limit} for more than 2 GiB.
    [[nodiscard]] static std::vector<std::shared_ptr<const Texture>> quartet(
        std::span<const std::shared_ptr<const Texture>> textures);

    /// An rgba16 texture of one or two dimensions without levels, whose channels are all the same,
    /// clamped to its edges and linear, once more for fetches between general stages alone: a texel
    /// is its word and that of the texel below, so that 8 bytes are all that a fragment needs.
    [[nodiscard]] static std::shared_ptr<const Texture> table(const Texture& texture);
    /// The same for means over what the first coordinate goes through from pixel to pixel, as
    /// TableFilter::exact asks for: a texel is its word, the next one, and the sum of the row up to
    /// it (AverageTableCtx). Intervals are 2^lod_bias times as long as the steps between pixels.
    [[nodiscard]] static std::shared_ptr<const Texture> summed_table(const Texture& texture,
                                                                     const CoordinateRange& range);

  private:
    struct Storage;
    /// One that still lacks its texels.
    Texture(const Texture& other, int texel_bytes);
    static std::shared_ptr<Texture> empty_table(const Texture& texture, int texel_bytes);
    /// A place of a quartet that still lacks its texels.
    Texture(const Texture& single, int place, std::shared_ptr<Storage> storage);
    template <class Image>
    void build(std::span<const Image> images, const TextureDescription& description);

    TextureTarget m_target;
    TexelFormat m_format;
    Sampler m_sampler;
    std::vector<TextureLevel> m_levels;
    std::int32_t m_pitch = 0;
    std::int32_t m_layer_bytes = 0;
    int m_texel_bytes = 4;
    int m_place = -1;
    bool m_is_table = false;
    std::optional<CoordinateRange> m_summed;
    std::shared_ptr<Storage> m_storage;
    std::shared_ptr<const std::vector<std::int16_t>> m_codes;
    const std::uint8_t* m_texels = nullptr;
};

using TexturePtr = std::shared_ptr<const Texture>;

}  // namespace burnish
