// What runs beside the window's thread: pictures that a newer wish ends, files that are read.
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/shapes.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <stdexcept>

#include "tests/scene_file.hpp"
#include "view/load_thread.hpp"
#include "view/picture_thread.hpp"

namespace burnish::view {
namespace {

/// How long something may take that nothing holds up, on the slowest machine.
constexpr std::chrono::seconds kPatience{60};
constexpr double kBudgetMs = 20.0;

/// What a thread was told, counted and waited for.
class Bell {
  public:
    void ring() {
        {
            const std::scoped_lock lock(m_mutex);
            ++m_rings;
        }
        m_changed.notify_all();
    }
    /// False if it does not come to `rings`.
    bool wait_for(int rings) {
        std::unique_lock lock(m_mutex);
        return m_changed.wait_for(lock, kPatience, [&] { return m_rings >= rings; });
    }

  private:
    std::mutex m_mutex;
    std::condition_variable m_changed;
    int m_rings = 0;
};

/// A small sphere on the machine `ideal`.
Wish wish_number(std::uint64_t id, bool moving = false) {
    auto scene = std::make_shared<Scene>();
    scene->width = 40;
    scene->height = 30;
    scene->objects.push_back({Mesh(shapes::sphere(16, 8)), nullptr, glm::mat4(1.0F), {}});
    Wish wish;
    wish.id = id;
    wish.panes.push_back({scene->machine, 0.0F, 1.0F});
    wish.scene = std::move(scene);
    wish.moving = moving;
    wish.renderer.threads = 2;
    return wish;
}

/// Draws the same over and over, as one very long picture, until the renderer is told to stop. Were
/// it never told, the picture would be there in the end, and be seen.
FrameStats draw_for_long(Renderer& renderer, const Scene& scene, Framebuffer& target) {
    const auto end = std::chrono::steady_clock::now() + kPatience / 6;
    while (std::chrono::steady_clock::now() < end) renderer.render(scene, target);
    return renderer.render(scene, target);
}

TEST(PictureThread, ANewerWishEndsAFinerPicture) {
    Bell pictures, finer_ones;
    int drawn = 0;
    PictureThread thread(
        [&](Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
            if (++drawn != 2) return renderer.render(scene, target);
            finer_ones.ring();
            return draw_for_long(renderer, scene, target);
        },
        kBudgetMs, [&] { pictures.ring(); });
    thread.wish(wish_number(1));
    ASSERT_TRUE(pictures.wait_for(1));
    EXPECT_EQ(thread.take()->id, 1U);
    ASSERT_TRUE(finer_ones.wait_for(1));
    thread.wish(wish_number(2, true));
    ASSERT_TRUE(pictures.wait_for(2));
    EXPECT_EQ(thread.take()->id, 2U);
    EXPECT_EQ(drawn, 3) << "the newer one has no finer ones while things move";
}

/// Or there would be none while a hand moves.
TEST(PictureThread, TheFirstPictureIsFinished) {
    Bell pictures;
    PictureThread* self = nullptr;
    int drawn = 0;
    PictureThread thread(
        [&](Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
            if (++drawn == 1) self->wish(wish_number(2, true));
            return renderer.render(scene, target);
        },
        kBudgetMs, [&] { pictures.ring(); });
    self = &thread;
    thread.wish(wish_number(1));
    ASSERT_TRUE(pictures.wait_for(2));
    EXPECT_EQ(thread.take()->id, 2U);
    EXPECT_EQ(drawn, 2) << "one for each wish";
}

/// What takes long without a use for the newest wish does not hold it up: its mip levels and
/// programs are others. Of a wish that moves the camera alone they are the same, and it would wait
/// again.
TEST(PictureThread, AFirstPictureThatTakesLongMakesWayForOtherMaterials) {
    for (const bool is_other : {true, false}) {
        Bell pictures;
        PictureThread* self = nullptr;
        int drawn = 0;
        PictureThread thread(
            [&](Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
                if (++drawn > 1) return renderer.render(scene, target);
                Wish newer = wish_number(2, true);
                if (is_other) {
                    auto other = std::make_shared<Scene>(*newer.scene);
                    other->objects[0].material = std::make_shared<const Material>();
                    newer.scene = other;
                }
                self->wish(std::move(newer));
                const FrameStats stats = renderer.render(scene, target);
                EXPECT_FALSE(is_other) << "it was finished";
                return stats;
            },
            kBudgetMs, [&] { pictures.ring(); }, std::chrono::milliseconds(0));
        self = &thread;
        thread.wish(wish_number(1));
        ASSERT_TRUE(pictures.wait_for(is_other ? 1 : 2));
        EXPECT_EQ(thread.take()->id, 2U);
        EXPECT_EQ(drawn, 2);
    }
}

TEST(PictureThread, ItsEndEndsEvenTheFirst) {
    Bell begun;
    int pictures = 0;
    {
        PictureThread thread(
            [&](Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
                begun.ring();
                return draw_for_long(renderer, scene, target);
            },
            kBudgetMs, [&] { ++pictures; });
        thread.wish(wish_number(1));
        ASSERT_TRUE(begun.wait_for(1));
    }
    EXPECT_EQ(pictures, 0);
}

/// A trace comes with the picture of full size; the window may see finer ones only.
TEST(PictureThread, TheLastPictureHasTheTrace) {
    Bell pictures;
    PictureThread thread([](Renderer& renderer, const Scene& scene, int,
                            Framebuffer& target) { return renderer.render(scene, target); },
                         kBudgetMs, [&] { pictures.ring(); });
    Wish wish = wish_number(1);
    wish.pixel = glm::ivec2(20, 15);
    thread.wish(std::move(wish));
    ASSERT_TRUE(pictures.wait_for(4)) << "smaller, full, 4 and 16 samples";
    const std::optional<Picture> last = thread.take();
    ASSERT_TRUE(last && last->is_last);
    EXPECT_EQ(last->fineness, Fineness::smoothest);
    ASSERT_TRUE(last->trace) << last->trace_error;
    EXPECT_EQ(last->trace->x, 20);
    EXPECT_FALSE(thread.take()) << "twice";
}

TEST(LoadThread, TheNewestOrderCounts) {
    Bell results, begun, wait;
    LoadThread thread(
        [&](const std::filesystem::path& input) {
            begun.ring();
            if (input == "first") {
                EXPECT_TRUE(wait.wait_for(1));
            }
            if (input == "bad") throw Error(ErrorCode::bad_input, "bad:1: found, expected");
            return Scene{};
        },
        [&] { results.ring(); });
    thread.order({"first"});
    ASSERT_TRUE(begun.wait_for(1));
    EXPECT_FALSE(thread.take()) << "it is not there yet";
    thread.order({"second"});
    thread.order({"bad", LoadOrder::Purpose::step});
    wait.ring();
    ASSERT_TRUE(results.wait_for(1));
    const std::optional<Loaded> result = thread.take();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->order, (LoadOrder{"bad", LoadOrder::Purpose::step}));
    EXPECT_FALSE(result->scene);
    EXPECT_EQ(result->error, "bad:1: found, expected");
    EXPECT_TRUE(begun.wait_for(2));
    EXPECT_FALSE(thread.take());
}

/// What nobody has taken yet when there is a newer order, of the same file, is not what came of it.
TEST(LoadThread, AnOlderResultIsNotTheNewestOnes) {
    Bell results, wait;
    int reads = 0;
    LoadThread thread(
        [&](const std::filesystem::path&) {
            Scene scene;
            scene.width = ++reads;
            if (reads == 2) {
                EXPECT_TRUE(wait.wait_for(1));
            }
            return scene;
        },
        [&] { results.ring(); });
    thread.order({"file"});
    ASSERT_TRUE(results.wait_for(1));
    thread.order({"file"});
    EXPECT_FALSE(thread.take()) << "of the first order";
    EXPECT_TRUE(thread.pending());
    wait.ring();
    ASSERT_TRUE(results.wait_for(2));
    const std::optional<Loaded> result = thread.take();
    ASSERT_TRUE(result && result->scene);
    EXPECT_EQ(result->scene->width, 2);
    EXPECT_FALSE(thread.pending());
    EXPECT_FALSE(thread.take());
}

TEST(LoadThread, WhateverIsThrownIsALine) {
    const auto error_of = [](const LoadScene& load) { return loaded(load, {"f"}).error; };
    EXPECT_EQ(error_of([](const auto&) -> Scene { throw std::bad_alloc(); }), "f: out of memory");
    EXPECT_EQ(error_of([](const auto&) -> Scene { throw std::length_error("long"); }), "f: long");
}

/// The thread lives on and says what went wrong, whether a pane fails or what is around it.
TEST(PictureThread, WhateverIsThrownIsALine) {
    Bell pictures;
    PictureThread thread([](Renderer&, const Scene&, int,
                            Framebuffer&) -> FrameStats { throw std::length_error("long"); },
                         kBudgetMs, [&] { pictures.ring(); });
    thread.wish(wish_number(1, true));
    ASSERT_TRUE(pictures.wait_for(1));
    EXPECT_EQ(thread.take()->panes.at(0).error, "long");
    Wish wish = wish_number(2, true);
    auto scene = std::make_shared<Scene>(*wish.scene);
    scene->width = Framebuffer::kMaxSize + 1;
    wish.scene = scene;
    thread.wish(std::move(wish));
    ASSERT_TRUE(pictures.wait_for(2));
    const std::optional<Picture> none = thread.take();
    ASSERT_TRUE(none);
    EXPECT_EQ(none->id, 2U);
    EXPECT_TRUE(none->is_last);
    EXPECT_NE(none->panes.at(0).error, "");
}

using LoadOrders = SceneFile;

/// What is written while a file is read is in the next picture.
TEST_F(LoadOrders, ChangesWhileReadingAreSeen) {
    scene("[[objects]]\nshape = \"sphere\"\n");
    Loaded result = loaded(
        [&](const std::filesystem::path& input) {
            Scene read = load_scene(input).scene;
            const auto later = std::filesystem::last_write_time(input) + std::chrono::seconds(1);
            std::filesystem::last_write_time(input, later);
            return read;
        },
        {path("s.toml")});
    ASSERT_TRUE(result.scene);
    EXPECT_FALSE(result.files.changed()) << "it may still be written";
    EXPECT_TRUE(result.files.changed());
    EXPECT_FALSE(result.files.changed());
}

/// A failure says so and leaves everything else; the rest of a state outlives its input.
TEST_F(LoadOrders, ReadingAgainKeepsTheState) {
    scene("[[objects]]\nshape = \"sphere\"\n");
    const LoadScene load = [](const std::filesystem::path& file) { return load_scene(file).scene; };
    const LoadOrder again{path("s.toml"), LoadOrder::Purpose::again};
    Session session(load);
    session.open(path("s.toml"));
    session.orbit(0.1F, 0.2F);
    session.state.machine = "nv2a";
    const std::string state = view_state_text(session.state);
    write(path("s.toml"), "schema = 1\n[");
    session.take(loaded(load, again));
    EXPECT_SAYS(session.message, "s.toml:2");
    EXPECT_EQ(session.message.find('\n'), std::string::npos);
    EXPECT_EQ(view_state_text(session.state), state);
    EXPECT_EQ(session.loaded().objects.size(), 1U);
    scene("[[objects]]\nshape = \"sphere\"\n[[objects]]\nshape = \"cube\"\n");
    session.take(loaded(load, again));
    EXPECT_EQ(session.message, "");
    EXPECT_EQ(view_state_text(session.state), state);
    EXPECT_EQ(session.loaded().objects.size(), 2U);
}

}  // namespace
}  // namespace burnish::view
