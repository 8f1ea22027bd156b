#include <random>

#include "tests/view_hands.hpp"
#include "view/frame_times.hpp"
#include "view/keys.hpp"

namespace burnish::view {
namespace {

/// Random input that never asks to quit, at most a few hundred events a second.
class RandomHands {
  public:
    RandomHands(std::uint32_t seed, std::vector<std::filesystem::path> files)
        : m_random(seed), m_files(std::move(files)) {}

    void act(Hands& hands) {
        switch (below(40)) {
            case 0:
                return key();
            case 1:
                return text();
            case 2:
                return hands.drop(
                    m_files[static_cast<std::size_t>(below(static_cast<int>(m_files.size())))]);
            case 3:
                return wheel();
            case 4:  // real ones, which panels see, too
                return hands.drag(below(500), below(400), below(300) - 150, below(300) - 150,
                                  1 + below(3));
            case 5:
                return hands.click(below(500), below(400));
            case 6:
                if (below(10) == 0) hands.resize(64 + below(500), 64 + below(400));
                return;
            default:
                return motion();
        }
    }

  private:
    int below(int end) { return std::uniform_int_distribution(0, end - 1)(m_random); }

    void push(SDL_Event event) { SDL_PushEvent(&event); }

    void key() {
        const std::span<const KeyBinding> bindings = key_bindings();
        const KeyBinding& binding =
            bindings[static_cast<std::size_t>(below(static_cast<int>(bindings.size())))];
        // Screenshots would fill the disk.
        if (binding.action == Action::quit || binding.key == SDLK_F12) return;
        SDL_Event event{};
        event.type = SDL_KEYDOWN;
        event.key.keysym.sym = binding.key;
        event.key.keysym.scancode = SDL_GetScancodeFromKey(binding.key);
        push(event);
        event.type = SDL_KEYUP;
        push(event);
    }

    void text() {
        SDL_Event event{};
        event.type = SDL_TEXTINPUT;
        for (int i = 0; i < 1 + below(4); ++i)
            event.text.text[i] = static_cast<char>(' ' + below('~' - ' '));
        push(event);
    }

    void wheel() {
        SDL_Event event{};
        event.type = SDL_MOUSEWHEEL;
        event.wheel.y = below(41) - 20;
        push(event);
    }

    void motion() {
        SDL_Event event{};
        event.type = SDL_MOUSEMOTION;
        event.motion.x = below(2000) - 700;
        event.motion.y = below(2000) - 700;
        event.motion.xrel = below(801) - 400;
        event.motion.yrel = below(801) - 400;
        event.motion.state = static_cast<Uint32>(below(8));
        push(event);
    }

    std::mt19937 m_random;
    std::vector<std::filesystem::path> m_files;
};

using ViewFuzz = ViewWindow;

/// Nothing ends it, and memory stays level. BURNISH_VIEW_SECONDS makes it longer (`./run soak`).
TEST_F(ViewFuzz, SurvivesRandomInput) {
    const char* const chosen = std::getenv("BURNISH_VIEW_SECONDS");
    const int seconds = chosen == nullptr ? 4 : std::atoi(chosen);
    const std::filesystem::path first = sphere();
    write(path("bad.toml"), "schema = 1\n[[objects]]\nshape = \"sphere\"\nmaterial = 7\n");
    write(path("bad.obj"), "f 1 2 3\n");
    write(path("flat.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write(path("point.obj"), "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    write(path("program.toml"), R"(schema = 1
[machine]
profile = "nv2a"
[[materials]]
name = "flat"
combiners_text = '''!!RC1.0
{ rgb { spare0 = col0; } }
out.rgb = spare0;
'''
[[objects]]
shape = "cube"
material = "flat"
)");
    show(first, [&](Hands& hands) {
        RandomHands random(
            4711, {first, path("bad.toml"), path("bad.obj"), path("flat.obj"), path("point.obj"),
                   path("program.toml"), path("nowhere.obj"), directory()});
        const auto now = [] { return std::chrono::steady_clock::now(); };
        const auto start = now();
        std::size_t early = 0;
        for (int events = 0; now() - start < std::chrono::seconds(seconds); ++events) {
            random.act(hands);
            Hands::pause(2);
            if (early == 0 && now() - start > std::chrono::seconds(seconds) / 3)
                early = resident_bytes();
            if (seconds > 30 && events % 1000 == 0)
                fmt::print("{} events, {} MB\n", events, resident_bytes() >> 20);
        }
        EXPECT_LT(resident_bytes(), early + (std::size_t{192} << 20));
    });
}

}  // namespace
}  // namespace burnish::view
