#include <atomic>
#include <cmath>
#include <numbers>

#include "tests/view_hands.hpp"

namespace burnish::view {
namespace {

float degrees_between(const glm::vec3& a, const glm::vec3& b) {
    const float cosine = glm::dot(a, b) / (glm::length(a) * glm::length(b));
    return std::acos(std::clamp(cosine, -1.0F, 1.0F)) * 180.0F / std::numbers::pi_v<float>;
}

glm::vec3 arm(const Shot& shot) {
    return shot.state.camera.position - shot.state.camera.focal_point;
}

glm::ivec3 color_at(const Image8& image, int x, int y) {
    const std::uint8_t* at = const_cast<Image8&>(image).at(x, y);
    return {at[0], at[1], at[2]};
}

/// Pixels of that colour, as panels have them.
int count(const Image8& image, const glm::ivec3& color, int tolerance = 12) {
    int found = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            found += glm::all(glm::lessThanEqual(glm::abs(color_at(image, x, y) - color),
                                                 glm::ivec3(tolerance)))
                         ? 1
                         : 0;
    return found;
}

TEST_F(ViewWindow, MouseOrbitsZoomsPansAndTurnsTheLight) {
    show(sphere(), [](Hands& hands) {
        hands.key("Tab");  // panels away
        const Shot before = hands.shot();
        // A third of the height is a third of half a turn; what begins a drag is within 3 pixels.
        hands.drag(100, 120, 80, 0);
        const Shot orbited = hands.shot();
        EXPECT_NEAR(degrees_between(arm(before), arm(orbited)), 60.0F, 3.0F);
        EXPECT_NEAR(glm::length(arm(before)), glm::length(arm(orbited)), 1e-3F);
        EXPECT_GT(differences(before.image, orbited.image), 300);

        hands.move(160, 120);
        hands.wheel(true);
        const Shot nearer = hands.shot();
        EXPECT_NEAR(glm::length(arm(nearer)), glm::length(arm(orbited)) / 1.1F, 1e-3F);
        hands.drag(160, 120, 0, 60, 3);
        const Shot farther = hands.shot();
        EXPECT_GT(glm::length(arm(farther)), 1.3F * glm::length(arm(nearer)));

        hands.drag(160, 120, 0, 40, 2);
        const Shot panned = hands.shot();
        EXPECT_GT(panned.state.camera.focal_point.y, farther.state.camera.focal_point.y + 0.1F);
        EXPECT_NEAR(degrees_between(arm(panned), arm(farther)), 0.0F, 0.1F);

        EXPECT_FALSE(panned.state.light);
        hands.hold("l");
        hands.drag(160, 120, 60, 0);
        hands.release("l");
        const Shot lit = hands.shot();
        ASSERT_TRUE(lit.state.light);
        EXPECT_EQ(lit.state.camera.position, panned.state.camera.position);
        EXPECT_GT(differences(panned.image, lit.image), 300);

        hands.key("3");
        EXPECT_NEAR(degrees_between(arm(hands.shot()), {1.0F, 0.0F, 0.0F}), 0.0F, 0.1F);
        hands.key("7");
        EXPECT_NEAR(degrees_between(arm(hands.shot()), {0.0F, 1.0F, 0.0F}), 0.0F, 0.1F);
        hands.key("Return");
        const Shot reset = hands.shot();
        EXPECT_EQ(differences(before.image, reset.image), 0);
        EXPECT_FALSE(reset.state.light);
    });
}

TEST_F(ViewWindow, MachinesSplitAndErrors) {
    show(sphere(), [](Hands& hands) {
        hands.key("Tab");
        const Shot ideal = hands.shot();
        hands.key("m");  // after ideal
        EXPECT_EQ(hands.shot().state.machine, "double");
        hands.key("m");
        const Shot old = hands.shot();
        EXPECT_EQ(old.state.machine, "geforce256");
        EXPECT_GT(differences(ideal.image, old.image), 300);
        hands.key("s");
        const Shot split = hands.shot();
        EXPECT_TRUE(split.state.split);
        for (int y = 0; y < 240; y += 7)
            EXPECT_EQ(color_at(split.image, 60, y), color_at(old.image, 60, y)) << y;
        // The line between the second and third machine goes with the hand.
        hands.drag(160, 200, 48, 0);
        const Shot moved = hands.shot();
        EXPECT_NEAR(moved.state.lines[1], 0.65F, 0.01F);
        EXPECT_EQ(moved.state.camera.position, split.state.camera.position);
        hands.key("e");
        const Shot errors = hands.shot();
        EXPECT_TRUE(errors.state.heat_map);
        EXPECT_GT(differences(moved.image, errors.image), 20000);
        for (int y = 0; y < 240; y += 7)  // double is the truth
            EXPECT_LE(color_at(errors.image, 310, y).r, 8) << y;
    });
}

TEST_F(ViewWindow, AClickTracesThePixel) {
    show(sphere(), [](Hands& hands) {
        hands.resize(700, 500);
        const Shot before = hands.window_shot();
        hands.click(430, 200);
        const Shot traced = hands.window_shot();
        ASSERT_TRUE(traced.state.pixel);
        EXPECT_EQ(*traced.state.pixel, glm::ivec2(430, 200));
        EXPECT_GT(differences(before.image, traced.image), 50000) << "no panel";
        hands.key("t");
        const Shot after = hands.window_shot();
        EXPECT_FALSE(after.state.pixel);
        EXPECT_LT(differences(before.image, after.image), 5000) << "but for times, it is gone";
    });
}

TEST_F(ViewWindow, ProgramTextIsEditedErrorsAreShownAndRepaired) {
    write(path("p.toml"), R"(schema = 1
[output]
width = 640
height = 480
[machine]
profile = "nv2a"
[[materials]]
name = "flat"
combiners_text = '''!!RC1.0
{ rgb { spare0 = unsigned_invert(zero) * col0; } }
out.rgb = spare0;
out.a = unsigned_invert(zero);
'''
[materials.inputs]
col0_rgb = "n_dot_l"
[[lights]]
direction = [0.0, 0.0, 1.0]
[[objects]]
shape = "sphere"
material = "flat"
)");
    const glm::ivec3 wrong(255, 115, 102);
    show(path("p.toml"), [&](Hands& hands) {
        const Shot before = hands.shot();
        hands.key("p");
        hands.click(400, 58);  // into the text
        hands.key("ctrl+Home");
        for (int line = 1; line < 4; ++line) hands.key("Down");
        hands.key("End");  // of "spare0 = one * col0;"
        hands.type("q");
        const Shot with_error = hands.window_shot();
        EXPECT_GT(count(with_error.image, wrong), 50) << "nobody was told";
        ASSERT_EQ(with_error.state.materials.size(), 1U);
        EXPECT_EQ(differences(before.image, hands.shot().image), 0) << "not the last right one";
        hands.key("BackSpace");
        EXPECT_EQ(count(hands.window_shot().image, wrong), 0);
        EXPECT_EQ(differences(before.image, hands.shot().image), 0);
        for (int i = 0; i < 5; ++i) hands.key("BackSpace");
        hands.type("zero;");
        const Shot edited = hands.shot();
        EXPECT_EQ(count(hands.window_shot().image, wrong), 0);
        EXPECT_SAYS(edited.state.materials.at(0).combiners.value(), "spare0 = one * zero;");
        EXPECT_GT(differences(before.image, edited.image), 20000);
    });
}

/// The same for what a model is compiled to, of which there is no text but the panel's.
TEST_F(ViewWindow, AModelsProgramIsEditedRepairedAndReverted) {
    write(path("p.toml"), "schema = 1\n" + steel_sphere(640, 480, "[0.0, 0.0, 1.0]"));
    const glm::ivec3 wrong(255, 115, 102);
    Shot edited;
    show(path("p.toml"), [&](Hands& hands) {
        const Shot before = hands.shot();
        hands.key("p");
        EXPECT_EQ(differences(before.image, hands.shot().image), 0);  // the panel has its text
        hands.click(400, 58);
        hands.key("ctrl+End");
        hands.key("Up");
        hands.key("Up");
        hands.key("Home");
        hands.type("q");
        EXPECT_GT(count(hands.window_shot().image, wrong), 50) << "nobody was told";
        EXPECT_EQ(differences(before.image, hands.shot().image), 0) << "not the last right one";
        hands.key("BackSpace");
        EXPECT_EQ(count(hands.window_shot().image, wrong), 0);
        EXPECT_EQ(differences(before.image, hands.shot().image), 0);
        hands.type("out.rgb = zero; // ");
        edited = hands.shot();
        EXPECT_EQ(count(hands.window_shot().image, wrong), 0);
        EXPECT_SAYS(edited.state.materials.at(0).combiners.value(), "\nout.rgb = zero; // out");
        EXPECT_GT(differences(before.image, edited.image), 20000);
        EXPECT_EQ(color_at(edited.image, 320, 240), glm::ivec3(0)) << "in the middle of the sphere";
        hands.click(285, 192);  // revert
        const Shot reverted = hands.shot();
        EXPECT_EQ(differences(before.image, reverted.image), 0);
        EXPECT_TRUE(reverted.state.materials.empty()) << view_state_text(reverted.state);
    });
    ViewRequest again;
    again.load_state = edited.file;
    again.quiet = true;
    testing::internal::CaptureStdout();
    show(again, [&](Hands& hands) {
        EXPECT_EQ(differences(edited.image, hands.shot().image), 0);
        hands.key("m");  // double precision has no programs
        const Shot exact = hands.shot();
        EXPECT_EQ(exact.state.machine, "double");
        EXPECT_GT(differences(edited.image, exact.image), 20000);
        hands.key("m");
        const Shot old = hands.window_shot();  // the program of geforce256 is another one
        EXPECT_EQ(old.state.machine, "geforce256");
        EXPECT_GT(count(old.image, {150, 30, 30}, 25), 200) << "nobody was told";
        EXPECT_GT(differences(edited.image, hands.shot().image), 20000);
    });
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "names of screenshots";
}

TEST_F(ViewWindow, FollowsItsSizeAndItsFile) {
    const std::filesystem::path file = sphere();
    show(file, [&](Hands& hands) {
        hands.key("Tab");
        EXPECT_EQ(hands.shot().image.width, 320);
        hands.resize(400, 200);
        const Shot wide = hands.shot();
        EXPECT_EQ(wide.image.width, 400);
        EXPECT_EQ(wide.image.height, 200);
        sphere("[machine]\nprofile = \"geforce256\"\n");
        Hands::pause(1200);
        EXPECT_GT(differences(wide.image, hands.shot().image), 300);
        write(file, "schema = 1\n[");  // as an editor may leave it for a moment
        Hands::pause(1200);
        sphere();
        Hands::pause(1200);
        EXPECT_EQ(differences(wide.image, hands.shot().image), 0);
    });
}

TEST_F(ViewWindow, DroppedFilesAndNeighboursAreOpened) {
    write(path("torus.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write(path("broken.ply"), "ply\n");
    show(sphere(), [&](Hands& hands) {
        hands.key("Tab");
        const Shot before = hands.shot();
        hands.drop(path("torus.obj"));
        const Shot dropped = hands.shot();
        EXPECT_EQ(dropped.state.input, path("torus.obj"));
        EXPECT_GT(differences(before.image, dropped.image), 300);
        hands.drop(path("broken.ply"));
        const Shot refused = hands.shot();
        EXPECT_EQ(refused.state.input, path("torus.obj"));
        EXPECT_EQ(differences(dropped.image, refused.image), 0);
        EXPECT_GT(count(hands.window_shot().image, {150, 30, 30}, 25), 200) << "nobody was told";
        hands.key("Left");
        EXPECT_EQ(hands.shot().state.input, path("sphere.toml"));
    });
}

/// Where a picture cannot be written, as in a directory that is gone, the window says so until the
/// next one can.
TEST_F(ViewWindow, WhatAScreenshotSaidGoesWithTheNext) {
    std::filesystem::create_directory(path("gone"));
    show(sphere(), [&](Hands& hands) {
        hands.resize(700, 400);
        const glm::ivec3 wrong(150, 30, 30);
        EXPECT_EQ(count(hands.window_shot().image, wrong, 25), 0);
        std::filesystem::current_path(path("gone"));
        std::filesystem::remove(path("gone"));
        hands.key("F12");
        Hands::pause(1000);
        std::filesystem::current_path(directory());
        EXPECT_GT(count(hands.window_shot().image, wrong, 25), 200) << "nobody was told";
        EXPECT_EQ(count(hands.window_shot().image, wrong, 25), 0) << "it stays";
    });
}

/// False if it does not come true within a minute.
template <class Condition>
bool wait_for(const Condition& condition) {
    for (int tries = 0; tries < 1200 && !condition(); ++tries) Hands::pause(50);
    return condition();
}

/// A file that takes for ever to be read, and then is none.
TEST_F(ViewWindow, WhileAFileIsReadTheOldOneStaysInTheHand) {
    std::atomic<bool> reading{false}, may_end{false};
    std::atomic<int> drawn{0};
    ViewRequest request;
    request.input = sphere();
    request.load = [&](const std::filesystem::path& file) {
        if (file.filename() != "long.toml") return load(file);
        reading = true;
        EXPECT_TRUE(wait_for([&] { return may_end.load(); }));
        throw Error(ErrorCode::bad_input, "long.toml: found, expected");
    };
    request.draw = [&](Renderer& renderer, const Scene& scene, int side, Framebuffer& target) {
        ++drawn;
        return draw(renderer, scene, side, target);
    };
    show(request, [&](Hands& hands) {
        hands.key("Tab");
        const Shot before = hands.shot();
        hands.drop(path("long.toml"));
        EXPECT_TRUE(wait_for([&] { return reading.load(); }));
        const int drawn_before = drawn;
        hands.drag(100, 120, 80, 0);
        EXPECT_TRUE(wait_for([&] { return drawn > drawn_before; })) << "the hand is held up";
        may_end = true;
        const Shot after = hands.shot();
        EXPECT_EQ(after.state.input, before.state.input);
        EXPECT_NEAR(degrees_between(arm(before), arm(after)), 60.0F, 3.0F);
        EXPECT_GT(count(hands.window_shot().image, {150, 30, 30}, 25), 200) << "nobody was told";
    });
}

/// What is shown was written while another file was read that then is none.
TEST_F(ViewWindow, AChangeDuringAnotherReadIsNotForgotten) {
    std::atomic<bool> may_end{false};
    std::atomic<int> shown_reads{0}, other_reads{0};
    ViewRequest request;
    request.input = sphere();
    request.load = [&](const std::filesystem::path& file) {
        if (file.filename() != "long.toml") {
            ++shown_reads;
            return load(file);
        }
        ++other_reads;
        EXPECT_TRUE(wait_for([&] { return may_end.load(); }));
        throw Error(ErrorCode::bad_input, "long.toml: found, expected");
    };
    show(request, [&](Hands& hands) {
        hands.drop(path("long.toml"));
        EXPECT_TRUE(wait_for([&] { return other_reads == 1; }));
        const int before = shown_reads;
        sphere("[machine]\nprofile = \"geforce256\"\n");
        Hands::pause(800);  // time enough to see it and take it for the other one's
        may_end = true;
        EXPECT_TRUE(wait_for([&] { return shown_reads > before; })) << "never read again";
        EXPECT_EQ(other_reads, 1);
    });
}

TEST_F(ViewWindow, AStateBringsTheSamePictureBack) {
    ViewRequest first;
    first.input = sphere();
    first.save_state = path("end.toml");
    Shot seen;
    show(first, [&](Hands& hands) {
        hands.key("Tab");
        hands.drag(100, 100, 37, -21);
        hands.key("m");
        hands.key("m");
        seen = hands.shot();
        hands.close();
    });
    EXPECT_EQ(view_state_text(load_view_state(path("end.toml"))), view_state_text(seen.state));
    for (const std::filesystem::path& state : {path("end.toml"), seen.file}) {
        ViewRequest again;
        again.load_state = state;
        show(again, [&](Hands& hands) {
            const Shot shot = hands.shot();
            EXPECT_EQ(differences(seen.image, shot.image), 0) << state;
        });
    }
}

}  // namespace
}  // namespace burnish::view
