#include <malloc.h>

#include <random>

#include "tests/view_hands.hpp"
#include "view/frame_times.hpp"
#include "view/keys.hpp"

#ifdef BURNISH_SANITIZED
/// Of clang's <sanitizer/allocator_interface.h>, which g++ does not bring along.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace burnish::view {
namespace {

/// The window never gets larger.
constexpr glm::ivec2 kLargest{563, 463};

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
                if (below(10) == 0)
                    hands.resize(64 + below(kLargest.x - 63), 64 + below(kLargest.y - 63));
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

/// Memory in bytes.
struct MemoryUse {
    std::size_t allocated;  ///< asked for and not given back; what allocators keep is not in it
    std::size_t resident;
};

MemoryUse memory_use() {
#ifdef BURNISH_SANITIZED
    return {__sanitizer_get_current_allocated_bytes(), resident_bytes()};
#else
    malloc_trim(0);
    const struct mallinfo2 info = mallinfo2();
    return {info.uordblks + info.hblkhd, resident_bytes()};
#endif
}

/// Opens `file`, which takes back all that was changed, at a fixed size, and waits until nothing
/// is drawn: memory is then that of the same window, whatever was before.
MemoryUse memory_at_rest(Hands& hands, const std::filesystem::path& file) {
    SDL_Event up{};
    up.type = SDL_MOUSEBUTTONUP;
    SDL_PushEvent(&up);
    hands.resize(kLargest.x, kLargest.y);
    hands.drop(file);
    hands.move(5, 5);  // keys go where the mouse is
    const Shot shot = hands.shot();
    EXPECT_EQ(shot.state.input, file);
    EXPECT_EQ(shot.image.width, kLargest.x);
    return memory_use();
}

using ViewFuzz = ViewWindow;

/// Nothing ends it, and memory stays level: after all of the run less than one picture more is in
/// use than after half of it. BURNISH_VIEW_SECONDS makes it longer (`./run soak`).
TEST_F(ViewFuzz, SurvivesRandomInput) {
    const char* const chosen = std::getenv("BURNISH_VIEW_SECONDS");
    const std::chrono::duration<double> seconds(chosen == nullptr ? 2 : std::atoi(chosen));
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
        const auto act_for = [&](double share) {
            const auto start = std::chrono::steady_clock::now();
            int events = 0;
            for (; std::chrono::steady_clock::now() - start < share * seconds; ++events) {
                random.act(hands);
                Hands::pause(2);
            }
            const MemoryUse use = memory_at_rest(hands, first);
            fmt::print("{} events: {:.2f} MB allocated, {:.1f} MB resident\n", events,
                       0x1p-20 * static_cast<double>(use.allocated),
                       0x1p-20 * static_cast<double>(use.resident));
            std::fflush(stdout);
            return use;
        };
        act_for(0.1);  // what is made once is made
        const MemoryUse half = act_for(0.4);
        const MemoryUse whole = act_for(0.5);
        constexpr std::size_t kPicture = std::size_t{4} * kLargest.x * kLargest.y;
        EXPECT_LT(whole.allocated, half.allocated + kPicture);
    });
}

}  // namespace
}  // namespace burnish::view
