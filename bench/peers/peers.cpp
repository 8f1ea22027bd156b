// Burnish beside another software renderer, scene by scene: the two take turns, every round is a
// new process of its own. Writes JSON and a table; docs/performance.md says what is compared. Exit
// code 3 means that pictures differ.
#include <fmt/format.h>
#include <stdlib.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/cpu_name.hpp"
#include "bench/peers/agreement.hpp"
#include "bench/peers/cores.hpp"
#include "bench/peers/measurement.hpp"
#include "bench/peers/process.hpp"
#include "core/parallel.hpp"
#include "lab/document_section.hpp"
#include "metrics/frame_errors.hpp"
#include "reference/render_double.hpp"

namespace burnish::peers {
namespace {

namespace fs = std::filesystem;

constexpr double kPeak = 0.9;

/// Pictures agree up to this RMSE. Nine-bit registers and a half vector of eight bits are up to
/// 0.016 from the formula on these scenes, bytes of llvmpipe's bilinear filter up to 0.015. Without
/// lobe nothing amplifies an error.
double largest_rmse(Shading shading) {
    switch (shading) {
        case Shading::textured:
        case Shading::layer:
            return 0.006;
        case Shading::flat:
        case Shading::depth:
            return 0.0005;
        default:
            return 0.02;
    }
}

struct Size {
    int width = 0, height = 0;
};

struct Options {
    std::string peer = "llvmpipe";
    std::vector<std::string> scenes;
    std::vector<Size> sizes;  ///< empty: those of each scene
    std::vector<std::string> isas{""};
    std::vector<int> threads{1, 2};
    int rounds = 3;
    double seconds = 0.5;
    fs::path output = "out/peers";
    fs::path document;  ///< whose section the table replaces; empty: none
    bool realtime = true;
};

/// The sizes that a scene is drawn at.
std::vector<Size> sizes_of(const std::string& scene) {
    if (scene == "S1c") return {{640, 480}, {1280, 720}, {1920, 1080}, {3840, 2160}};
    if (scene == "S5a") return {{800, 600}};
    return {{1920, 1080}};
}

/// A scene whose light makes the double-precision picture's peak 0.9, and that picture.
struct Exposed {
    PeerScene scene;
    float intensity = 1.0F;
    std::optional<Framebuffer> truth;
};

Exposed expose(const std::string& name, Size size) {
    Exposed exposed{peer_scene(name, size.width, size.height, 1.0F), 1.0F, {}};
    if (!exposed.scene.has_double) return exposed;
    WorkerPool pool(0);
    const auto draw = [&] {
        Framebuffer frame(size.width, size.height, PixelFormat::rgba32f);
        DoubleOptions options;
        options.layer_machine = exposed.scene.scene.machine;
        render_double(exposed.scene.scene, frame, pool, options);
        return frame;
    };
    exposed.intensity = static_cast<float>(kPeak / metrics::interior_peak(draw()));
    exposed.scene = peer_scene(name, size.width, size.height, exposed.intensity);
    exposed.truth.emplace(draw());
    return exposed;
}

/// Runs `peer_frames` beside this program.
class Runner {
  public:
    Runner(const fs::path& program, const Options& options)
        : m_program(program), m_options(options) {
        if (options.realtime && succeeds({"chrt", "-f", "5", "true"}))
            m_prefix = {"chrt", "-f", "5"};
    }

    [[nodiscard]] bool realtime() const { return !m_prefix.empty(); }

    /// One process: its median frame, ms. `picture`: where its last frame goes.
    double run(const std::string& contender, const Measurement& m, const fs::path& picture,
               std::string& renderer) const {
        std::vector<std::string> command = m_prefix;
        // One thread means one core: llvmpipe's main thread works, too.
        if (m.threads == 1) command.insert(command.end(), {"taskset", "-c", "0"});
        command.insert(command.end(),
                       {m_program, contender, m.scene, "--width", std::to_string(m.width),
                        "--height", std::to_string(m.height), "--threads",
                        std::to_string(m.threads), "--intensity", fmt::format("{}", m.intensity),
                        "--seconds", fmt::format("{}", m_options.seconds), "--picture", picture});
        std::vector<double> frames;
        for (const std::string& line : output_of(command)) {
            if (line.rfind("ms ", 0) == 0) frames.push_back(std::stod(line.substr(3)));
            if (line.rfind("renderer ", 0) == 0) renderer = line.substr(9);
        }
        if (frames.empty()) throw std::runtime_error(contender + ": no frame was timed");
        return median(frames);
    }

  private:
    fs::path m_program;
    const Options& m_options;
    std::vector<std::string> m_prefix;
};

Framebuffer load_picture(const PeerScene& scene, const fs::path& path) {
    FrameBytes bytes(4 * static_cast<std::size_t>(scene.scene.width) *
                     static_cast<std::size_t>(scene.scene.height));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) throw std::runtime_error(path.string() + ": cannot be read");
    return picture_of(scene, bytes);
}

/// The two frames that a round leaves.
struct Pictures {
    Pictures(const fs::path& folder, const std::string& peer_name)
        : burnish(folder / "burnish.raw"), peer(folder / (peer_name + ".raw")) {}
    fs::path burnish, peer;
};

/// Whether cores are as far apart as they were at another time.
bool same_distance(double transfer, double another) {
    return (transfer > kFarApart) == (another > kFarApart);
}

/// One process of each; both again, twice at most, if their cores changed places meanwhile.
void take_turns(Measurement& m, const std::string& peer, const Runner& runner,
                const Pictures& pictures) {
    if (m.isa.empty()) {
        unsetenv("BURNISH_ISA");
    } else {
        setenv("BURNISH_ISA", m.isa.c_str(), 1);
    }
    constexpr int kAttempts = 3;
    double transfer = 0.0, burnish = 0.0, other = 0.0;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        transfer = line_transfer();
        burnish = runner.run("burnish", m, pictures.burnish, m.burnish.renderer);
        other = runner.run(peer, m, pictures.peer, m.peer.renderer);
        if (m.threads == 1 || same_distance(transfer, line_transfer())) break;
    }
    m.burnish.rounds.push_back(burnish);
    m.peer.rounds.push_back(other);
    if (m.threads > 1) m.transfers.push_back(transfer);
    fmt::print(stderr, "{} {} x {} {}, threads {}, {:.0f} ns apart: {:.2f} and {:.2f} ms\n",
               m.scene, m.width, m.height, m.isa, m.threads, transfer, burnish, other);
}

/// The first round of everything, and what the pictures are like.
std::vector<Measurement> first_round(const Options& options, const Runner& runner,
                                     const Pictures& pictures) {
    std::vector<Measurement> all;
    for (const std::string& name : options.scenes) {
        for (const Size size : options.sizes.empty() ? sizes_of(name) : options.sizes) {
            const Exposed exposed = expose(name, size);
            for (const std::string& isa : options.isas) {
                for (const int threads : options.threads) {
                    Measurement m{name, size.width, size.height, threads, isa, exposed.intensity};
                    take_turns(m, options.peer, runner, pictures);
                    m.agreement = compare(load_picture(exposed.scene, pictures.burnish),
                                          load_picture(exposed.scene, pictures.peer),
                                          exposed.truth ? &*exposed.truth : nullptr);
                    m.agree = m.agreement.holds(largest_rmse(exposed.scene.shading));
                    all.push_back(std::move(m));
                }
            }
        }
    }
    return all;
}

void write(const fs::path& path, const std::string& text) {
    std::ofstream file(path);
    file << text;
    if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// "1920x1080"
Size size_from(const std::string& word) {
    Size size;
    char end = 0;
    const int read = std::sscanf(word.c_str(), "%dx%d%c", &size.width, &size.height, &end);
    if (read == 2 && std::min(size.width, size.height) >= 1 &&
        std::max(size.width, size.height) <= Framebuffer::kMaxSize)
        return size;
    throw std::runtime_error(
        fmt::format("size '{}', expected WIDTHxHEIGHT, 1 .. {}", word, Framebuffer::kMaxSize));
}

/// Returns whether all pictures agree. A machine may be slow for minutes, so a round is everything
/// once, and rounds of one scene lie far apart.
bool run(const Options& options, const fs::path& program) {
    fs::create_directories(options.output);
    const Pictures pictures(options.output, options.peer);
    const Runner runner(program.parent_path() / "peer_frames", options);
    std::vector<Measurement> all = first_round(options, runner, pictures);
    for (int round = 1; round < options.rounds; ++round)
        for (Measurement& m : all) take_turns(m, options.peer, runner, pictures);
    const Surroundings surroundings{cpu_name(), options.peer, runner.realtime(), options.rounds};
    const std::string text = report(all, surroundings);
    fmt::print("{}", text);
    write(options.output / "peers.json", json(all, surroundings));
    write(options.output / "peers.md", text);
    if (!options.document.empty()) {
        const bool usual = options.peer == Options{}.peer;
        lab::replace_section(options.document, usual ? "peers" : options.peer, text);
    }
    return std::ranges::all_of(all, &Measurement::agree);
}

}  // namespace
}  // namespace burnish::peers

int main(int argc, char** argv) {
    namespace peers = burnish::peers;
    peers::Options options;
    for (const std::string_view name : peers::scene_names()) options.scenes.emplace_back(name);
    CLI::App app("Compares burnish with another software renderer: times, pictures, ratios.");
    app.add_option("--peer", options.peer, "llvmpipe (OpenGL), lavapipe or swiftshader (Vulkan)")
        ->check(CLI::IsMember({"llvmpipe", "lavapipe", "swiftshader"}));
    app.add_option("--scenes", options.scenes, "of docs/performance.md; default: all")
        ->delimiter(',');
    app.add_option("--threads", options.threads)->delimiter(',')->check(CLI::Range(1, 1024));
    app.add_option("--isa", options.isas, "instruction sets of burnish; default: the best")
        ->delimiter(',');
    std::vector<std::string> sizes;
    app.add_option("--size", sizes, "of the frame, e.g. 1280x720; default: of each scene")
        ->delimiter(',');
    app.add_option("--rounds", options.rounds, "processes of each")->check(CLI::Range(1, 1000));
    app.add_option("--seconds", options.seconds, "of frames in a process, at least");
    app.add_option("-o,--output", options.output, "folder for peers.json and peers.md");
    app.add_option("--document", options.document,
                   "file whose section \"peers\", or that of --peer's name, to replace");
    app.add_flag("!--ordinary-priority", options.realtime, "never ask for real-time priority");
    CLI11_PARSE(app, argc, argv);
    try {
        for (const std::string& size : sizes) options.sizes.push_back(peers::size_from(size));
        if (!peers::run(options, std::filesystem::canonical("/proc/self/exe"))) return 3;
    } catch (const std::exception& error) {
        fmt::print(stderr, "peers: {}\n", error.what());
        return 1;
    }
}
