#pragma once

#include <burnish/combiner.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/scene.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// One instruction set that the kernels were built for.
struct IsaInfo {
    std::string_view name;  ///< "avx512", "avx2", "sse42", "neon64" or "reference"
    bool available;         ///< this CPU and operating system can run it
};

/// Best first; the scalar reference is always last.
std::vector<IsaInfo> instruction_sets();

struct RendererOptions {
    int threads = 0;       ///< workers, exactly that many; 0 = one per core; at most 1024
    std::string isa = {};  ///< empty: the environment variable BURNISH_ISA, else the best available
    std::size_t memory_cap = std::size_t{256} << 20;  ///< bytes for binned triangles, then a flush
    /// Samples per pixel where Machine::double_precision is set: a square up to 1024. One lies at
    /// the pixel's centre, several in the cells of a grid, moved about by a fixed hash. Machines
    /// take one.
    int double_samples = 1;
    /// Fill FrameStats::stages, kernels and tile_costs. Frames then take a few per cent longer.
    bool accounting = false;
    /// Called after every tile of a frame: how many are done, of how many. Where memory_cap makes
    /// several rounds of them, each counts as the part of the triangles that it draws. Any worker
    /// calls, several at a time.
    std::function<void(std::size_t done, std::size_t total)> progress = {};
    /// Asked before every tile and every longer step before them, down to each row of texels where
    /// mip levels and the maps of a model's program are made: true gives the frame up, render
    /// throws Error{stopped} as soon as the tiles that were begun are done. Any worker asks,
    /// several at a time; it must not throw.
    std::function<bool()> stop = {};
};

/// A register of the combiners as the picture, instead of what the final combiner delivers.
///
/// Frames of floats get its signed value, others value/2 + 1/2, clamped to 0 .. 1, alpha included.
/// `color_sum` and `final_product` exist in the final combiner only and are not negative: every
/// frame gets their value up to 1, and alpha 0.
struct ShownRegister {
    static constexpr std::size_t kAllStages = 16;
    Register reg = Register::spare0;
    /// General stages that run before: 0 shows what the program starts from. A program with fewer
    /// stages shows what its last one left.
    std::size_t stages = kAllStages;
};

/// Geometry as the picture, of the fragments that the picture would show last; nothing is blended.
/// Alpha is 1. Where there is no fragment all four channels are 0, or 1 with `depth`.
///
/// Frames of floats get numbers as they are. Others get them to the nearest code, clamped to 0 .. 1
/// unless it says otherwise.
enum class Aov {
    depth,      ///< window depth, 0 .. 1, in r, g and b
    normal,     ///< interpolated and normalised, world space; others x/2 + 1/2. Raw vertices: 0
    tangent,    ///< as the machine's tangent_frames have it at the pixel
    bitangent,  ///< likewise
    /// Strokes along the tangent as it is seen, brighter towards where it points, in cells of 16 x
    /// 16 pixels: white, or orange where the frame is mirrored. Grey where it points at the eye.
    stripes,
    uv,        ///< r, g: what textures are sampled at, v downward; others u - floor(u). Of raw
               ///< vertices the first coordinates, divided by q
    triangle,  ///< r: number of the triangle, g: of the object; others a colour made of both
};

/// A part of the work on a frame, added up over all workers.
struct StageCost {
    std::string_view name;  ///< prepare, transform, setup, bin, coverage, packets, interpolate,
                            ///< texture, combine, resolve; waiting: for the other workers
    std::string_view unit;  ///< of `items`
    double ms = 0.0;
    std::uint64_t calls = 0;
    std::uint64_t items = 0;
};

/// One kernel's part of its stage.
struct KernelCost {
    std::string_view name;
    std::string_view stage;
    double ms = 0.0;
    std::uint64_t calls = 0;
    std::uint64_t items = 0;  ///< elements; of kernels on packets fragments, times maps or
                              ///< attributes where they do several at once
};

/// A tile's time on its worker, the fragments that were shaded in it, and what it was expected to
/// cost when tiles were put in order: some 100 ns each.
struct TileCost {
    double ms = 0.0;
    std::uint64_t fragments = 0;
    std::uint32_t weight = 0;
};

/// What a frame did. Counts do not depend on ISA or thread count; times do.
struct FrameStats {
    std::uint64_t triangles = 0;             ///< submitted; of draws that are not left out
    std::uint64_t nonfinite_triangles = 0;   ///< dropped for a NaN or infinite clip position
    std::uint64_t degenerate_triangles = 0;  ///< zero area after snapping
    std::uint64_t clipped_triangles = 0;     ///< cut by the near, far or guard band planes
    std::uint64_t binned_triangles = 0;      ///< left of them, or of their parts, for the tiles
    std::uint64_t flushes = 0;               ///< times the memory cap was met
    std::uint64_t shaded_pixels = 0;
    double geometry_ms = 0.0;  ///< vertices, setup, bins
    double tiles_ms = 0.0;     ///< coverage, shading, resolve
    std::vector<std::uint64_t> tiles_per_worker;
    std::vector<StageCost> stages;     ///< with RendererOptions::accounting, as the next two
    std::vector<KernelCost> kernels;   ///< that were called
    std::vector<TileCost> tile_costs;  ///< row by row
};

/// Draws scenes. Bits of the frame depend on the scene and the machine profile only: not on the
/// instruction set, the thread count or earlier frames. One call at a time per object.
class Renderer {
  public:
    /// Throws Error{bad_option} for an unknown or unavailable ISA, or a thread count out of range,
    /// Error{limit} if there is no memory or no thread to be had.
    explicit Renderer(const RendererOptions& options = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    [[nodiscard]] std::string_view isa() const noexcept;
    [[nodiscard]] int threads() const noexcept;

    /// Renders `scene` into all of `target`, whose size (not the scene's) sets the resolution.
    /// A frame of depths (PixelFormat::depth32f) gets the depth buffer as the draws leave it, the
    /// window depth 0 .. 1 of the last fragment that wrote one. Draws that write no depth are left
    /// out; only fragments are shaded of which shading decides whether they live or how deep they
    /// lie.
    /// With Machine::double_precision: by the formulas of the models, in double precision; opaque
    /// meshes with a model only. Frames of floats are then not clamped to 1.
    /// Throws Error{bad_program} or Error{bad_option} for a material, machine or camera that cannot
    /// be drawn, Error{bad_option} for a frame of depths with Machine::double_precision,
    /// Error{limit} if memory runs out, Error{stopped} when RendererOptions::stop says so; the
    /// contents of `target` are then unspecified. The next frame is drawn as if nothing had been.
    FrameStats render(const Scene& scene, Framebuffer& target);

    /// The same picture with a register in place of its colours; the background stays.
    /// Throws Error{bad_option}, too, for a register that the machine does not have; with
    /// Machine::double_precision that is every one. So it does for a frame of depths.
    FrameStats render(const Scene& scene, Framebuffer& target, const ShownRegister& shown);

    /// The same fragments with what is known of their geometry in place of colours. Throws
    /// Error{bad_option}, too, with Machine::double_precision and for a frame of depths.
    FrameStats render(const Scene& scene, Framebuffer& target, Aov shown);

    /// What draws the object of that number in the scene's first light: its material's program, or
    /// the model's, compiled for the scene's machine unless this renderer's last frame had it.
    /// Object::edited is not looked at. Throws what render throws of the material, and
    /// Error{bad_option} with Machine::double_precision, which has formulas.
    ProgramMaterial program(const Scene& scene, std::size_t object);

    /// Draws nothing and throws what render throws on account of the object of that number alone: a
    /// ProgramFault where it is known which part of its program is to blame. What it compiled the
    /// next frame need not. Throws Error{bad_option} as program does.
    void check(const Scene& scene, std::size_t object);

  private:
    FrameStats render_shown(const Scene& scene, Framebuffer& target,
                            const std::optional<ShownRegister>& shown, std::optional<Aov> aov);
    struct State;
    std::unique_ptr<State> m_state;
};

}  // namespace burnish
