// The one file that sees OpenImageIO. No fmt here: OpenImageIO's headers bring a copy of it that is
// configured otherwise.
#include "io/image_io.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/near_file.hpp"
#include "core/within_memory.hpp"
#include "io/atomic_file.hpp"
#include "io/png_check.hpp"

namespace burnish {
namespace {

/// First line of what OpenImageIO says; its texts may hold several.
std::string one_line(std::string text) {
    text.erase(std::min(text.find('\n'), text.size()));
    return text.empty() ? "no reason given" : text;
}

void require_readable_file(const std::filesystem::path& path) {
    std::error_code failure;
    if (std::filesystem::is_directory(path, failure))
        throw Error(ErrorCode::io, path.string() + ": is a directory, expected an image");
    if (access(path.c_str(), R_OK) != 0)
        throw Error(ErrorCode::io, path.string() + ": " + std::strerror(errno) + near_file(path));
    if (std::filesystem::file_size(path, failure) == 0 && !failure)
        throw Error(ErrorCode::bad_input, path.string() + ": empty file, expected an image");
}

/// Data maps hold more than colour: alpha must come back as it was stored.
OIIO::ImageSpec keep_alpha_apart() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

void check_size(const OIIO::ImageSpec& spec, const std::string& name) {
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.depth > 1)
        throw Error(ErrorCode::bad_input, name + ": no two-dimensional picture in it");
    if (spec.width > Texture::kMaxSize || spec.height > Texture::kMaxSize)
        throw Error(ErrorCode::limit, name + ": " + std::to_string(spec.width) + " x " +
                                          std::to_string(spec.height) +
                                          " pixels, expected at most " +
                                          std::to_string(Texture::kMaxSize) + " a side");
}

/// Widens 1 or 2 channels to grey, or 3 to `opaque`, in place; texels lie `channels` values apart.
template <class Value>
void spread_channels(std::span<Value> values, int channels, Value opaque) {
    if (channels == 4) return;
    const auto from = static_cast<std::size_t>(channels);
    // From the end, so that nothing is overwritten before it is read.
    for (std::size_t i = values.size() / 4; i-- > 0;) {
        const Value* source = values.data() + i * from;
        const Value red = source[0];
        const Value green = channels == 3 ? source[1] : red;
        const Value blue = channels == 3 ? source[2] : red;
        const Value alpha = channels == 2 ? source[1] : opaque;
        Value* target = values.data() + i * 4;
        target[0] = red;
        target[1] = green;
        target[2] = blue;
        target[3] = alpha;
    }
}

/// Values of an image file as r, g, b, a. `make_room` takes width and height and returns where they
/// go: width * height * 4 values. Returns the type of the file's own values.
template <class Value, class MakeRoom>
OIIO::TypeDesc read_pixels(const std::filesystem::path& path, Value opaque,
                           const MakeRoom& make_room) {
    require_readable_file(path);
    require_sound_png(path);
    const std::string name = path.string();
    const OIIO::ImageSpec config = keep_alpha_apart();
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(name, &config);
    if (!input)
        throw Error(ErrorCode::bad_input,
                    name + ": not an image that can be read: " + one_line(OIIO::geterror()));
    check_size(input->spec(), name);
    const int channels = std::min(input->spec().nchannels, 4);
    const auto shortage = [&] { return name + ": too large for the memory"; };
    return within_memory(shortage, [&] {
        const std::span<Value> values = make_room(input->spec().width, input->spec().height);
        const bool ok = input->read_image(0, 0, 0, channels, OIIO::TypeDescFromC<Value>::value(),
                                          values.data());
        // A truncated JPEG or TIFF counts as read; only the pending error tells.
        if (!ok || input->has_error())
            throw Error(ErrorCode::bad_input,
                        name + ": damaged image: " + one_line(input->geterror()));
        spread_channels(values, channels, opaque);
        return input->spec().format;
    });
}

/// An Image8 or Image16.
template <class Image>
Image read_integers(const std::filesystem::path& path) {
    using Value = typename decltype(Image::rgba)::value_type;
    Image image;
    read_pixels(path, std::numeric_limits<Value>::max(), [&image](int width, int height) {
        image = Image(width, height);
        return std::span(image.rgba);
    });
    return image;
}

/// OpenImageIO multiplies by a rounded reciprocal, which makes another float of 126 bytes in 256.
void divide_exactly(std::span<float> values, float largest) {
    for (float& value : values) value = std::round(value * largest) / largest;
}

/// Pixels to be written, described the way OpenImageIO asks for them.
struct Source {
    const void* pixels;
    std::ptrdiff_t pitch;
    OIIO::ImageSpec spec;
};

Source describe(const Framebuffer& frame) {
    const OIIO::TypeDesc type = frame.format() == PixelFormat::rgba8    ? OIIO::TypeUInt8
                                : frame.format() == PixelFormat::rgba16 ? OIIO::TypeUInt16
                                                                        : OIIO::TypeFloat;
    const int channels = frame.format() == PixelFormat::depth32f ? 1 : 4;
    return {frame.pixels(), frame.pitch(), {frame.width(), frame.height(), channels, type}};
}

Source describe(const Image8& image) {
    const auto row = 4 * static_cast<std::size_t>(std::max(image.width, 0));
    if (image.width < 1 || image.height < 1 ||
        image.rgba.size() != row * static_cast<std::size_t>(image.height))
        throw Error(ErrorCode::bad_option, "an image whose bytes do not fit its size");
    return {image.rgba.data(),
            static_cast<std::ptrdiff_t>(row),
            {image.width, image.height, 4, OIIO::TypeUInt8}};
}

[[noreturn]] void fail_write(const std::string& name, const std::string& reason) {
    throw Error(ErrorCode::io, name + ": cannot be written: " + one_line(reason));
}

/// A writer for the format that the extension of `path` names.
std::unique_ptr<OIIO::ImageOutput> make_output(const std::filesystem::path& path) {
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
    if (output) return output;
    OIIO::geterror();
    throw Error(ErrorCode::io, path.string() + ": no image format has this extension, expected " +
                                   "one like .png or .exr");
}

/// `file_name` is where the writer writes unless it was given memory; `shown_name` is for errors.
void encode(OIIO::ImageOutput& output, const Source& source, const std::string& file_name,
            const std::string& shown_name) {
    OIIO::ImageSpec spec = source.spec;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 1);  // 3 times as fast as the default, files 10 % larger
    // EXR and TIFF would carry the time of writing, and equal pictures differ as files.
    if (std::strcmp(output.format_name(), "png") != 0)
        spec.attribute("DateTime", "1970:01:01 00:00:00");
    if (!output.open(file_name, spec)) fail_write(shown_name, output.geterror());
    const auto texel_size = static_cast<OIIO::stride_t>(spec.pixel_bytes());
    const bool written = output.write_image(spec.format, source.pixels, texel_size, source.pitch);
    const std::string reason = written ? std::string() : output.geterror();
    const bool closed = output.close();
    if (!written) fail_write(shown_name, reason);
    if (!closed) fail_write(shown_name, output.geterror());
}

/// The bytes of the file; empty if the format can only be written by its own library.
std::vector<unsigned char> encode_in_memory(OIIO::ImageOutput& output, const Source& source,
                                            const std::string& file_name,
                                            const std::string& shown_name) {
    std::vector<unsigned char> bytes;
    if (output.supports("ioproxy") == 0) return bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (!output.set_ioproxy(&memory)) return bytes;
    encode(output, source, file_name, shown_name);
    return bytes;
}

void write_png_to_stdout(const Source& source) {
    const std::string name = "standard output";
    const std::vector<unsigned char> bytes =
        encode_in_memory(*make_output("stdout.png"), source, "stdout.png", name);
    write_all(STDOUT_FILENO, std::as_bytes(std::span(bytes)), name);
}

void write_source(const Source& source, const std::filesystem::path& path) {
    if (path == "-") return write_png_to_stdout(source);
    AtomicFile file(path);
    const std::string file_name = file.temporary().string();
    const std::unique_ptr<OIIO::ImageOutput> output = make_output(path);
    // Through memory where possible: on a full disk the PNG and TGA writers report success, and
    // the JPEG one ends the process.
    const std::vector<unsigned char> bytes =
        encode_in_memory(*output, source, file_name, path.string());
    if (bytes.empty())
        encode(*output, source, file_name, path.string());
    else
        file.write(std::as_bytes(std::span(bytes)));
    file.commit();
}

}  // namespace

Image8 read_image_file(const std::filesystem::path& path) {
    return read_integers<Image8>(path);
}

Image16 read_image16_file(const std::filesystem::path& path) {
    return read_integers<Image16>(path);
}

Framebuffer read_frame_file(const std::filesystem::path& path) {
    std::optional<Framebuffer> frame;
    std::span<float> values;
    const OIIO::TypeDesc type = read_pixels(path, 1.0F, [&](int width, int height) {
        frame.emplace(width, height, PixelFormat::rgba32f);
        values = std::span(reinterpret_cast<float*>(frame->pixels()),
                           4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        return values;
    });
    if (type == OIIO::TypeUInt8) divide_exactly(values, 255.0F);
    if (type == OIIO::TypeUInt16) divide_exactly(values, 65535.0F);
    return std::move(*frame);
}

std::string read_description(const std::filesystem::path& path) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
    if (!input) {
        OIIO::geterror();
        return {};
    }
    return input->spec().get_string_attribute("ImageDescription");
}

void write_frame_file(const Framebuffer& frame, const std::filesystem::path& path,
                      std::string_view description) {
    Source source = describe(frame);
    if (!description.empty()) source.spec.attribute("ImageDescription", std::string(description));
    write_source(source, path);
}

void write_image_file(const Image8& image, const std::filesystem::path& path) {
    write_source(describe(image), path);
}

void draw_text_into(Framebuffer& frame, int x, int y, std::string_view text, int size,
                    const glm::vec4& color) {
    if (frame.format() != PixelFormat::rgba32f || size < 1)
        throw Error(ErrorCode::bad_option, "text into a frame without floats, or of no size");
    const Source source = describe(frame);
    OIIO::ImageBuf buffer(source.spec, frame.pixels(), OIIO::AutoStride, source.pitch);
    if (!OIIO::ImageBufAlgo::render_text(buffer, x, y, std::string(text), size, "DejaVuSans",
                                         OIIO::cspan<float>(&color.x, 4)))
        throw Error(ErrorCode::io, "the font DejaVu Sans: " + one_line(buffer.geterror()));
}

}  // namespace burnish
