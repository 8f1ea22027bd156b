#include "app/supersample.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <cstring>

#include "app/picture.hpp"

namespace burnish::app {
namespace {

template <class T>
T channel_at(const Framebuffer& frame, int x, int y, int channel) {
    T value;
    std::memcpy(&value, frame.row(y) + (4 * x + channel) * static_cast<int>(sizeof(T)), sizeof(T));
    return value;
}

template <class T>
void put_channel(Framebuffer& frame, int x, int y, int channel, T value) {
    std::memcpy(frame.row(y) + (4 * x + channel) * static_cast<int>(sizeof(T)), &value, sizeof(T));
}

float mean_float(const Framebuffer& large, int side, int x, int y, int channel) {
    double sum = 0.0;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i)
            sum +=
                static_cast<double>(channel_at<float>(large, x * side + i, y * side + j, channel));
    }
    return static_cast<float>(sum / (side * side));
}

/// Sum of 16-bit samples, at most 16 * 65535.
std::uint32_t sum_u16(const Framebuffer& large, int side, int x, int y, int channel) {
    std::uint32_t sum = 0;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i)
            sum += channel_at<std::uint16_t>(large, x * side + i, y * side + j, channel);
    }
    return sum;
}

}  // namespace

int enlargement(int side, const Scene& scene) {
    if (scene.machine.double_precision) return 1;
    if (side > 4)
        throw Error(ErrorCode::bad_option,
                    fmt::format("--samples {}, expected 1, 4, 9 or 16 with machine {}", side * side,
                                scene.machine.name));
    return side;
}

Scene enlarged(const Scene& scene, int side) {
    Scene large = scene;
    if (side == 1) return large;
    if (scene.width * side > Framebuffer::kMaxSize || scene.height * side > Framebuffer::kMaxSize)
        throw Error(
            ErrorCode::limit,
            fmt::format("{} x {} pixels with {} samples each, expected at most {} a side with "
                        "that many",
                        scene.width, scene.height, side * side, Framebuffer::kMaxSize / side));
    large.width *= side;
    large.height *= side;
    large.format =
        scene.format == PixelFormat::rgba32f ? PixelFormat::rgba32f : PixelFormat::rgba16;
    for (Object& object : large.objects) {
        auto* raw = std::get_if<RawVertices>(&object.geometry);
        if (raw == nullptr || raw->space != Space::window) continue;
        for (RawVertex& vertex : raw->vertices) {
            vertex.position.x *= static_cast<float>(side);
            vertex.position.y *= static_cast<float>(side);
        }
    }
    return large;
}

void shrink(const Framebuffer& large, int side, Framebuffer& target) {
    const auto count = static_cast<std::uint32_t>(side * side);
    for (int y = 0; y < target.height(); ++y) {
        for (int x = 0; x < target.width(); ++x) {
            for (int channel = 0; channel < 4; ++channel) {
                if (target.format() == PixelFormat::rgba32f) {
                    put_channel(target, x, y, channel, mean_float(large, side, x, y, channel));
                    continue;
                }
                const std::uint32_t sum = sum_u16(large, side, x, y, channel);
                if (target.format() == PixelFormat::rgba16)
                    put_channel(target, x, y, channel,
                                static_cast<std::uint16_t>((sum + count / 2) / count));
                else  // 65535 = 255 * 257
                    put_channel(target, x, y, channel,
                                static_cast<std::uint8_t>((sum + 257 * count / 2) / (257 * count)));
            }
        }
    }
}

FrameStats draw_supersampled(Renderer& renderer, const Scene& scene, int side, Framebuffer& target,
                             const std::optional<Shown>& shown) {
    if (side == 1) return draw(renderer, scene, target, shown);
    if (shown && std::holds_alternative<Aov>(*shown) && std::get<Aov>(*shown) == Aov::triangle)
        throw Error(ErrorCode::bad_option,
                    "--samples with --aov triangle, expected one: numbers have no mean");
    Scene wanted = scene;
    wanted.width = target.width();
    wanted.height = target.height();
    wanted.format = target.format();
    wanted = enlarged(wanted, side);
    Framebuffer large(wanted.width, wanted.height, wanted.format);
    const FrameStats stats = draw(renderer, wanted, large, shown);
    shrink(large, side, target);
    return stats;
}

}  // namespace burnish::app
