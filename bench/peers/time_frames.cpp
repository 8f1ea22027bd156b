// One contender, one scene, one process: peer_frames CONTENDER SCENE --width W ... prints the
// milliseconds of every frame, and what rendered them where. `peers` runs it again and again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "bench/cpu_name.hpp"
#include "bench/peers/contender.hpp"
#include "bench/peers/cores.hpp"

namespace burnish::peers {
namespace {

struct Options {
    std::string contender, scene, picture;
    int width = 1920, height = 1080, threads = 1;
    float intensity = 1.0F;
    double seconds = 0.5;
    int frames = 7;
    bool turns = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Draws frames for so long, and at least so many, and prints the milliseconds of each.
void time_frames(Contender& contender, double seconds, int frames) {
    const auto first = std::chrono::steady_clock::now();
    for (int i = 0; i < frames || seconds_since(first) < seconds; ++i) {
        const auto frame = std::chrono::steady_clock::now();
        contender.draw();
        fmt::print("ms {:.5f}\n", 1e3 * seconds_since(frame));
    }
}

/// A turn for every line on standard input, of as many seconds as it says; others had the caches
/// since the last one, so two frames come before. "turn" ends it.
void take_turns(Contender& contender) {
    double seconds = 0.0;
    std::fflush(stdout);
    while (std::scanf("%lf", &seconds) == 1) {
        for (int i = 0; i < 2; ++i) contender.draw();
        time_frames(contender, seconds, 1);
        fmt::print("turn\n");
        std::fflush(stdout);
    }
}

void run(const Options& options) {
    const PeerScene scene =
        peer_scene(options.scene, options.width, options.height, options.intensity);
    const std::unique_ptr<Contender> contender =
        make_contender(options.contender, scene, options.threads);
    contender->draw();
    // Left to itself the kernel keeps both of our workers on one core now and then, as long as the
    // process lives. Workers of others sleep between frames and are found a core; their callers
    // work beside them and are better off free (S4c of llvmpipe 61 ms, pinned 68).
    if (options.contender == "burnish") spread_threads(options.threads);
    // Programs are compiled, memory is there and caches are warm after some frames.
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 3 || seconds_since(start) < 0.2 * options.seconds; ++i) contender->draw();
    fmt::print("renderer {}\ncpu {}\n", contender->description(), cpu_name());
    if (options.turns)
        take_turns(*contender);
    else
        time_frames(*contender, options.seconds, options.frames);
    if (options.picture.empty()) return;
    const FrameBytes bytes = contender->frame();
    std::ofstream file(options.picture, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    if (!file) throw std::runtime_error(options.picture + ": cannot be written");
}

}  // namespace
}  // namespace burnish::peers

int main(int argc, char** argv) {
    burnish::peers::Options options;
    CLI::App app("Times the frames of one renderer.");
    app.add_option("contender", options.contender, "burnish, llvmpipe, lavapipe or swiftshader")
        ->required();
    app.add_option("scene", options.scene)->required();
    app.add_option("--width", options.width)->check(CLI::Range(1, 16384));
    app.add_option("--height", options.height)->check(CLI::Range(1, 16384));
    app.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
    app.add_option("--intensity", options.intensity, "of the light");
    app.add_option("--seconds", options.seconds, "to time, at least");
    app.add_option("--frames", options.frames, "to time, at least");
    app.add_flag("--turns", options.turns, "for every line on standard input: its seconds");
    app.add_option("--picture", options.picture, "file for the last frame's bytes");
    CLI11_PARSE(app, argc, argv);
    try {
        burnish::peers::run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "peer_frames: {}\n", error.what());
        return 1;
    }
}
