#pragma once

#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <thread>

#include "tests/display.hpp"
#include "tests/scratch_directory.hpp"
#include "tests/steel_scene.hpp"
#include "view/view.hpp"

namespace burnish::view {

/// A screenshot as a file: what it shows, and the state that it carries.
struct Shot {
    std::filesystem::path file;
    Image8 image;
    ViewState state;
};

/// Mouse and keys for a window of `burnish view`, through the X server as a person's would come.
class Hands {
  public:
    explicit Hands(std::filesystem::path directory) : m_directory(std::move(directory)) {
        for (int tries = 0; m_window.empty() && tries < 200; ++tries) {
            m_window = output_of("xdotool search --name burnish | head -n 1");
            if (m_window.empty()) pause(50);
        }
        if (m_window.empty()) throw Error(ErrorCode::io, "no window");
        // Screenshots of windows before are not this one's.
        for (const auto& entry : std::filesystem::directory_iterator(m_directory))
            m_seen.insert(entry.path());
    }

    void key(const std::string& name) { xdotool("key " + name); }
    /// The window, by its own key: nothing can be done with it afterwards.
    void close() {
        key("Escape");
        m_closed = true;
    }
    [[nodiscard]] bool has_closed() const { return m_closed; }
    void hold(const std::string& name) { xdotool("keydown " + name); }
    void release(const std::string& name) { xdotool("keyup " + name); }
    void type(const std::string& text) { xdotool("type --delay 20 '" + text + "'"); }
    void move(int x, int y) {
        xdotool(fmt::format("mousemove --window {} -- {} {}", m_window, x, y));
    }
    void click(int x, int y) {
        move(x, y);
        pause(100);
        xdotool("click 1");
        pause(100);
    }
    void wheel(bool up) { xdotool(up ? "click 4" : "click 5"); }
    /// From (x, y) by (dx, dy) in steps of a few pixels.
    void drag(int x, int y, int dx, int dy, int button = 1) {
        constexpr int kSteps = 8;
        move(x, y);
        pause(50);
        xdotool(fmt::format("mousedown {}", button));
        for (int i = 1; i <= kSteps; ++i) {
            move(x + dx * i / kSteps, y + dy * i / kSteps);
            pause(15);
        }
        xdotool(fmt::format("mouseup {}", button));
    }
    void resize(int width, int height) {
        xdotool(fmt::format("windowsize --sync {} {} {}", m_window, width, height));
    }
    /// As a file manager would drop it; no tool speaks that protocol, so it is SDL's event.
    void drop(const std::filesystem::path& file) {
        SDL_Event event{};
        event.type = SDL_DROPFILE;
        event.drop.file = SDL_strdup(file.c_str());
        SDL_PushEvent(&event);
    }

    /// The picture when it has come to rest.
    Shot shot() { return taken("F12"); }
    /// The window, panels and all.
    Shot window_shot() { return taken("shift+F12"); }

    static void pause(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

  private:
    static void xdotool(const std::string& what) {
        EXPECT_EQ(std::system(("xdotool " + what + " >/dev/null").c_str()), 0)
            << "xdotool " << what;
    }

    Shot taken(const std::string& shortcut) {
        pause(100);  // what was done before has arrived
        key(shortcut);
        for (int tries = 0; tries < 1200; ++tries) {
            for (const auto& entry : std::filesystem::directory_iterator(m_directory)) {
                const std::filesystem::path file = entry.path();
                const std::string name = file.filename().string();
                // One that is still being written begins with a point.
                if (name.starts_with('.') || name.find("-view-") == std::string::npos ||
                    file.extension() != ".png" || !m_seen.insert(file).second)
                    continue;
                return {file, load_image(file), load_view_state(file)};
            }
            pause(50);
        }
        ADD_FAILURE() << "no screenshot within a minute";
        return {};
    }

    std::filesystem::path m_directory;
    std::string m_window;
    bool m_closed = false;
    std::set<std::filesystem::path> m_seen;
};

/// A test with a window of the real viewer on a display of its own.
class ViewWindow : public ScratchDirectory {
  protected:
    void SetUp() override {
        ScratchDirectory::SetUp();
        static const VirtualDisplay display;
        if (display.name().empty() || output_of("command -v xdotool").empty())
            GTEST_SKIP() << "needs Xvfb and xdotool";
        std::filesystem::current_path(directory());
    }

    static Scene load(const std::filesystem::path& file) {
        return file.extension() == ".toml" ? load_scene(file).scene : scene_for_mesh(file).scene;
    }
    static FrameStats draw(Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
        return renderer.render(scene, target);
    }

    /// Shows `request` while another thread does `steps`, then closes the window if they did not.
    void show(ViewRequest request, const std::function<void(Hands&)>& steps) {
        if (!request.load) request.load = load;
        if (!request.draw) request.draw = draw;
        // Hands send SDL events, too, which they may not before SDL is there.
        std::atomic<bool> is_there{false};
        request.draw = [&is_there, drawn = request.draw](Renderer& renderer, const Scene& scene,
                                                         int side, Framebuffer& target) {
            is_there = true;
            return drawn(renderer, scene, side, target);
        };
        request.renderer.threads = 2;
        std::thread hands([&] {
            bool has_closed = false;
            try {
                for (int tries = 0; !is_there && tries < 1200; ++tries) Hands::pause(50);
                Hands driver(directory());
                steps(driver);
                has_closed = driver.has_closed();
            } catch (const std::exception& error) {
                ADD_FAILURE() << error.what();
            }
            if (has_closed || !is_there) return;
            SDL_Event quit{};
            quit.type = SDL_QUIT;
            SDL_PushEvent(&quit);
        });
        try {
            view(request);
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
        hands.join();
    }
    void show(const std::filesystem::path& input, const std::function<void(Hands&)>& steps) {
        ViewRequest request;
        request.input = input;
        show(std::move(request), steps);
    }

    /// A sphere in a window of 320 x 240 pixels.
    std::filesystem::path sphere(const std::string& more = "") {
        const std::filesystem::path file = path("sphere.toml");
        write(file, "schema = 1\n" + steel_sphere(320, 240) + more);
        return file;
    }
};

/// Pixels that differ.
inline int differences(const Image8& a, const Image8& b) {
    if (a.width != b.width || a.height != b.height) return a.width * a.height;
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        count += std::equal(&a.rgba[i], &a.rgba[i] + 4, &b.rgba[i]) ? 0 : 1;
    return count;
}

}  // namespace burnish::view
