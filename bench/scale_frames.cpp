// Times frames of one size of problem for ./run scale: frame times, and memory as the system sees
// it.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <burnish/renderer.hpp>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <string>

#include "bench/frame_scenes.hpp"

namespace burnish {
namespace {

struct Options {
    std::string scene = "ellipsoid";
    int width = 1920, height = 1080, triangles = 20000, texture = 512, layers = 1, threads = 1;
    std::size_t memory_cap_mb = 256;
    double seconds = 0.3;
    int frames = 5;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Gives back what is free, so that what frames take shows.
void trim_memory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

/// A line of /proc/self/status in bytes; 0 where there is none.
std::size_t memory(const std::string& key) {
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key + ":")) return std::stoul(line.substr(key.size() + 1)) * 1024;
    return 0;
}

Scene scene_of(const Options& options) {
    if (options.scene == "ellipsoid") {
        // Twice as many columns as rows.
        const int rows =
            std::max(2, static_cast<int>(std::lround(std::sqrt(options.triangles / 4.0) + 0.5)));
        return ellipsoid_scene(2 * rows, rows, options.width, options.height);
    }
    Layers layers{.count = options.layers, .texture = options.texture, .degrees = 30.0F};
    if (options.scene == "blended") layers.blend = Blend::alpha();
    return layers_scene(layers, options.width, options.height);
}

void run(const Options& options) {
    const Scene scene = scene_of(options);
    Framebuffer frame(options.width, options.height);
    Renderer renderer({.threads = options.threads, .memory_cap = options.memory_cap_mb << 20});
    trim_memory();
    const std::size_t before = memory("VmRSS");
    FrameStats stats;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 2 || seconds_since(start) < 0.2 * options.seconds; ++i)
        stats = renderer.render(scene, frame);
    const auto first = std::chrono::steady_clock::now();
    for (int i = 0; i < options.frames || seconds_since(first) < options.seconds; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        stats = renderer.render(scene, frame);
        fmt::print("ms {:.5f}\n", 1e3 * seconds_since(begin));
    }
    fmt::print("triangles {}\nbinned {}\nshaded {}\nflushes {}\nscene_bytes {}\nrender_bytes {}\n",
               stats.triangles, stats.binned_triangles, stats.shaded_pixels, stats.flushes, before,
               memory("VmRSS") - std::min(before, memory("VmRSS")));
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    burnish::Options options;
    CLI::App app("Times frames of one size of problem.");
    app.add_option("scene", options.scene)
        ->check(CLI::IsMember({"ellipsoid", "layers", "blended"}));
    app.add_option("--width", options.width)->check(CLI::Range(1, 16384));
    app.add_option("--height", options.height)->check(CLI::Range(1, 16384));
    app.add_option("--triangles", options.triangles, "of the ellipsoid, nearly")
        ->check(CLI::Range(8, 100000000));
    app.add_option("--texture", options.texture, "texels of the layers, both ways")
        ->check(CLI::Range(1, 16384));
    app.add_option("--layers", options.layers)->check(CLI::Range(1, 1024));
    app.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
    app.add_option("--memory-cap", options.memory_cap_mb, "MB for binned triangles");
    app.add_option("--seconds", options.seconds, "to time, at least");
    app.add_option("--frames", options.frames, "to time, at least");
    CLI11_PARSE(app, argc, argv);
    try {
        burnish::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "scale_frames: {}\n", error.what());
        return 1;
    }
}
