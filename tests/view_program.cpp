#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <burnish/program_text.hpp>
#include <burnish/trace.hpp>
#include <cstring>

#include "lab/stage_bits.hpp"
#include "tests/scene_file.hpp"
#include "tests/steel_scene.hpp"
#include "view/load_thread.hpp"
#include "view/session.hpp"

/// Programs of models that a hand edited, from the text to the picture.
namespace burnish::view {
namespace {

const std::string kSphere = steel_sphere(48, 32);

using ViewProgram = SceneFile;

LoadScene loader() {
    return [](const std::filesystem::path& file) { return load_scene(file).scene; };
}

/// In a window of 48 x 32 pixels, on a machine that takes passes where they are needed.
Session opened(const std::filesystem::path& file) {
    Session session(loader());
    session.open(file);
    session.state.width = 48;
    session.state.height = 32;
    session.state.machine = "nv2a";
    return session;
}

FrameStats draw_once(Renderer& renderer, const Scene& scene, int, Framebuffer& target) {
    return renderer.render(scene, target);
}

bool are_same(const Framebuffer& a, const Framebuffer& b) {
    for (int y = 0; y < a.height(); ++y)
        if (std::memcmp(a.row(y), b.row(y), 4 * static_cast<std::size_t>(a.width())) != 0)
            return false;
    return true;
}

Framebuffer drawn(const Scene& scene) {
    Framebuffer frame(scene.width, scene.height);
    Renderer({.threads = 1}).render(scene, frame);
    return frame;
}

int channel(const Framebuffer& frame, const glm::ivec2& pixel, std::size_t c) {
    return std::to_integer<int>(frame.row(pixel.y)[4 * static_cast<std::size_t>(pixel.x) + c]);
}

/// Where r differs most.
glm::ivec2 most_different(const Framebuffer& a, const Framebuffer& b) {
    glm::ivec2 found{0, 0};
    int most = -1;
    for (int i = 0; i < a.width() * a.height(); ++i) {
        const glm::ivec2 pixel{i % a.width(), i / a.width()};
        const int difference = std::abs(channel(a, pixel, 0) - channel(b, pixel, 0));
        if (difference > most) found = pixel;
        most = std::max(most, difference);
    }
    return found;
}

/// What the panel does: the text of the model's program becomes another one.
void edit(Session& session, const std::string& material, const std::string& from,
          const std::string& to) {
    session.shows_programs = true;
    const Picture picture =
        PictureMaker(draw_once, 1000.0).make(session.wish(false).value(), Fineness::full);
    ASSERT_EQ(picture.programs.at(0).material, material);
    std::string text = picture.programs[0].text;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text << picture.programs[0].error;
    session.edit_of(material).compiled = text;
    session.edit_of(material).combiners = text.replace(at, from.size(), to);
}

/// Nothing before `final` is needed any more: only the diffuse part is left.
constexpr const char* kDiffuse = "out.rgb = col1; // ";

/// A comment changes nothing, whatever the material, the lights and the machine are: constants,
/// tables and textures still come from the model.
TEST_F(ViewProgram, ATextThatMeansTheSameDrawsTheSame) {
    constexpr std::pair<const char*, Model> kCases[] = {{"nv2a", Model::abp_modified},
                                                        {"geforce256", Model::abp_modified},
                                                        {"ideal", Model::abp_modified},
                                                        {"nv2a", Model::ward},
                                                        {"ideal", Model::ward}};
    scene(kSphere +
          "color = [0.9, 0.8, 0.7]\n[[lights]]\n"
          "direction = [-1.0, 0.2, 0.4]\ncolor = [0.7, 0.9, 0.8]\n");
    for (const auto& [machine, model] : kCases) {
        Session session(loader());
        session.open(path("s.toml"));
        session.state.machine = machine;
        session.edit_of("steel").model = model;
        for (const float k : {0.25F, 0.24F}) {
            session.edit_of("steel").kd = glm::vec3(k, 0.5F, 0.125F);
            session.edit_of("steel").ks = glm::vec3(0.5F, 2.0F * k, 0.75F);
            if (k == 0.25F) edit(session, "steel", "out.a", "// the same\nout.a");
            Scene edited = *session.wish(false)->scene;
            ASSERT_TRUE(edited.objects[0].edited);
            const Framebuffer frame = drawn(edited);
            edited.objects[0].edited = nullptr;
            EXPECT_TRUE(are_same(frame, drawn(edited)))
                << machine << " " << model_name(model) << " " << k;
        }
    }
}

TEST_F(ViewProgram, AnEditIsDrawnTracedAndMeasuredTheSame) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    const Framebuffer plain = drawn(*session.wish(false)->scene);
    edit(session, "steel", "out.rgb = ", kDiffuse);
    const Scene edited = *session.wish(false)->scene;
    const Framebuffer frame = drawn(edited);
    const glm::ivec2 pixel = most_different(frame, plain);
    const PixelTrace trace = trace_pixel(edited, pixel.x, pixel.y);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(trace.stored[c], channel(frame, pixel, c));
    ASSERT_TRUE(trace.fragment);
    EXPECT_SAYS(trace.fragment->stages.back().text, "out.rgb = col1;");
    const Framebuffer exact = lab::render_with_bits(edited, {}, 1);
    const auto* number = reinterpret_cast<const float*>(exact.row(pixel.y)) + 4 * pixel.x;
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(255.0 * number[c], channel(frame, pixel, c), 1.5);
    EXPECT_GT(channel(plain, pixel, 0), channel(frame, pixel, 0) + 50) << "nothing was edited";
}

TEST_F(ViewProgram, AnErrorLeavesTheLastRightTextAndRevertTheModels) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    edit(session, "steel", "out.rgb = ", kDiffuse);
    const auto right = session.wish(false)->scene->objects[0].edited;
    ASSERT_TRUE(right);
    const std::string text = *session.edit_of("steel").combiners;
    session.edit_of("steel").combiners = text + "out.rgb = col2;\n";
    const std::optional<Wish> wrong = session.wish(false);
    ASSERT_TRUE(wrong);
    ASSERT_FALSE(session.program_errors().empty());
    EXPECT_EQ(session.program_errors()[0].line,
              static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
    EXPECT_EQ(wrong->scene->objects[0].edited, right);
    EXPECT_EQ(wrong->scene->objects[0].material, session.loaded().objects[0].material)
        << "textures would be made again";
    session.edit_of("steel").combiners = text;
    EXPECT_TRUE(session.wish(false)->scene->objects[0].edited);
    EXPECT_TRUE(session.program_errors().empty());
    session.revert_program("steel");
    EXPECT_FALSE(session.wish(false)->scene->objects[0].edited);
    EXPECT_EQ(session.find_edit("steel"), nullptr);
}

TEST_F(ViewProgram, RegistersAreExplained) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    session.shows_programs = true;
    session.edit_of("steel").model = Model::ward;
    PictureMaker maker(draw_once, 1000.0);
    const auto inputs = [&](Fineness fineness) {
        return maker.make(*session.wish(false), fineness).programs.at(0).inputs;
    };
    EXPECT_EQ(inputs(Fineness::within_budget), "") << "while a hand moves there is no time";
    const std::string text = inputs(Fineness::full);
    EXPECT_SAYS(text, "col0.rgb  light_tangent\n");
    EXPECT_SAYS(text, "tex1 rgb  X = (t / alpha_x)\n");
    EXPECT_SAYS(text, "dot(v, n) = 0 .. 1\n");
    EXPECT_EQ(inputs(Fineness::within_budget), text);
}

TEST_F(ViewProgram, AStateBringsTheEditBack) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    edit(session, "steel", "out.rgb = ", kDiffuse);
    ViewState state = session.state;
    state.input = "s.toml";
    write(path("state.toml"), view_state_text(state));
    Session again(loader());
    again.open(load_view_state(path("state.toml")));
    EXPECT_TRUE(are_same(drawn(*session.wish(false)->scene), drawn(*again.wish(false)->scene)));
    // One that somebody wrote by hand.
    again.edit_of("steel").compiled.reset();
    EXPECT_TRUE(again.wish(false));
    EXPECT_SAYS(again.program_errors().at(0).message, "compiled_text");
    write(path("bad.toml"),
          "schema = 1\ninput = \"s.toml\"\n[[materials]]\nname = \"a\"\ncompiled_text = \"\"\n");
    EXPECT_SAYS(complaint_of([&] { load_view_state(path("bad.toml")); }), "'combiners_text'");
}

/// Nobody opened a panel: a line says what a state asks for in vain.
TEST_F(ViewProgram, EditsThatChangeNothingSayWhy) {
    scene(kSphere +
          "[[materials]]\nname = \"flat\"\ncombiners_text = '''!!RC1.0\n"
          "{ rgb { spare0 = col0 * col0; } }\nout.rgb = spare0; out.a = zero;\n'''\n"
          "[[objects]]\nshape = \"cube\"\nmaterial = \"flat\"\n");
    Session session = opened(path("s.toml"));
    const auto messages = [&] {
        EXPECT_TRUE(session.wish(false));
        return session.edit_messages();
    };
    session.edit_of("flat").combiners = "!!RC1.0\nout.rgb = col0; out.a = zero;\n";
    session.edit_of("steel").kd = glm::vec3(0.5F);
    EXPECT_TRUE(messages().empty());
    session.edit_of("iron").kd = glm::vec3(0.5F);
    session.edit_of("flat").kd = glm::vec3(0.5F);
    session.edit_of("steel").combiners = "garbage";
    std::vector<std::string> found = messages();
    ASSERT_EQ(found.size(), 3U);
    EXPECT_SAYS(found[0], "material 'flat': a program, not a model");
    EXPECT_SAYS(found[1], "material 'iron': ");
    EXPECT_SAYS(found[2], "material 'steel', its text, line 1, column 1: ");
    EXPECT_SAYS(found[2], "compiled_text");
    session.shows_programs = true;
    EXPECT_EQ(messages().size(), 2U) << "the panel has it at its line";
}

/// The only edited program that gave way; empty: none did.
std::string misfit(const Picture& picture) {
    const std::vector<ProgramError> all = misfits_of(picture);
    EXPECT_LE(all.size(), 1U);
    return all.empty() ? "" : of_material(all[0]);
}

/// On a machine for which the model is another program, or that cannot run the edited one, another
/// is drawn and a line says why.
TEST_F(ViewProgram, WhatDoesNotFitGivesWay) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    edit(session, "steel", "out.rgb = ", kDiffuse);
    PictureMaker maker(draw_once, 1000.0);
    const Picture edited = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(misfit(edited), "");

    session.state.machine = "ideal";
    session.state.pixel = glm::ivec2(24, 12);
    const std::optional<Wish> other = session.wish(false);
    Scene own = *other->scene;
    own.objects[0].edited = nullptr;
    const Picture fallback = maker.make(*other, Fineness::full);
    EXPECT_EQ(fallback.panes[0].error, "");
    EXPECT_EQ(misfit(fallback),
              "material 'steel', its text: the edited program was made of another one than "
              "abp_modified is compiled to on 'ideal'; the model's own is drawn");
    EXPECT_TRUE(are_same(fallback.frame, drawn(own)));
    EXPECT_TRUE(fallback.trace) << fallback.trace_error;

    session.state.machine = "nv2a";
    const Picture back = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(misfit(back), "");
    EXPECT_TRUE(are_same(back.frame, edited.frame));

    std::string& text = *session.edit_of("steel").combiners;
    text.replace(text.find("!!RC1.0"), 7, "!!BRN1.0");
    text.insert(text.find('{'), "{\nwide rgb { spare0 = col0; } }\n");
    const Picture wide = maker.make(*session.wish(false), Fineness::full);
    EXPECT_TRUE(session.program_errors().empty());
    EXPECT_EQ(misfit(wide),
              "material 'steel', its text, line 3: stage 0, rgb: wide results, machine 'nv2a' has "
              "9-bit registers; the last text that runs is drawn");
    EXPECT_TRUE(are_same(wide.frame, edited.frame));

    session.state.split = true;
    const Picture split = maker.make(*session.wish(false), Fineness::full);
    for (const PaneReport& pane : split.panes) {
        EXPECT_EQ(pane.error, "");
        EXPECT_EQ(pane.misfits.empty(), pane.machine == "double") << pane.machine;
    }

    // A text that is no program leaves that one; its lines are not the text's.
    session.state.split = false;
    text += "garbage";
    const Picture both = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(session.program_errors().size(), 1U);
    EXPECT_EQ(misfits_of(both).at(0).line, 0U);
    EXPECT_TRUE(are_same(both.frame, edited.frame));
}

constexpr const char* kTwoPipelines = R"(
[machine]
profile = "nv2a"
[[materials]]
name = "left"
combiners_text = "!!RC1.0 out.rgb = zero; out.a = zero;"
[[materials]]
name = "right"
combiners_text = "!!RC1.0 out.rgb = zero; out.a = zero;"
[[objects]]
shape = "sphere"
material = "left"
translate = [-0.6, 0, 0]
[[objects]]
shape = "sphere"
material = "right"
translate = [0.6, 0, 0]
[[lights]]
direction = [0.3, 0.8, 0.5]
)";

/// Of pipelines, which are drawn with the last text that ran, and of several materials only that
/// one.
TEST_F(ViewProgram, OneThatDoesNotFitLeavesTheOthers) {
    scene(kTwoPipelines);
    Session session = opened(path("s.toml"));
    const auto with = [](const std::string& color) {
        return "!!BRN1.0\nconst0 = (" + color + ");\nout.rgb = const0; out.a = zero;\n";
    };
    PictureMaker maker(draw_once, 1000.0);
    session.edit_of("left").combiners = with("1, 0, 0, 0");
    const Picture before = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(misfit(before), "");

    const std::string wide =
        "!!BRN1.0\n{\n  alpha { spare0 = zero; }\n  wide rgb { spare0 = zero; }\n}\n";
    session.edit_of("left").combiners = wide;
    session.edit_of("right").combiners = with("0, 0, 1, 0");
    const Picture after = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(after.panes[0].error, "");
    const std::vector<ProgramError> misfits = misfits_of(after);
    ASSERT_EQ(misfits.size(), 1U);
    EXPECT_EQ(misfits[0].material, "left");
    EXPECT_EQ(misfits[0].line, 4U);
    EXPECT_SAYS(misfits[0].message, "the last text that runs is drawn");
    int red = 0, blue = 0, was_red = 0;
    for (int i = 0; i < 48 * 32; ++i) {
        const glm::ivec2 pixel{i % 48, i / 48};
        was_red += channel(before.frame, pixel, 0) == 255 ? 1 : 0;
        red += channel(after.frame, pixel, 0) == 255 ? 1 : 0;
        blue += channel(after.frame, pixel, 2) == 255 ? 1 : 0;
    }
    EXPECT_GT(red, 50);
    EXPECT_GT(blue, 50);
    EXPECT_LE(std::abs(red - was_red), was_red / 4) << "but for what the other one covers";

    // Nothing that ran is left once the edit is gone.
    session.forget_edit("left");
    (void)maker.make(*session.wish(false), Fineness::full);
    session.edit_of("left").combiners = wide;
    const Picture loaded = maker.make(*session.wish(false), Fineness::full);
    EXPECT_SAYS(misfits_of(loaded).at(0).message, "what was loaded is drawn");
    for (int i = 0; i < 48 * 32; ++i)
        ASSERT_LT(channel(loaded.frame, {i % 48, i / 48}, 0), 255) << i;
}

TEST_F(ViewProgram, AMeshWithoutAMaterialHasTheDefaultOnesControls) {
    scene("[[objects]]\nshape = \"sphere\"\n[[objects]]\nshape = \"cube\"\n");
    Session session([](const std::filesystem::path& file) {
        Scene scene = load_scene(file).scene;
        scene.objects[1].material = nullptr;  // as programs may leave it
        return scene;
    });
    session.open(path("s.toml"));
    ASSERT_EQ(session.materials().size(), 1U);
    const std::string name = session.materials()[0]->name;
    session.edit_of(name).kd = glm::vec3(0.5F);
    const std::optional<Wish> brighter = session.wish(false);
    ASSERT_TRUE(brighter);
    for (const Object& object : brighter->scene->objects)
        EXPECT_EQ(object.material->kd, glm::vec3(0.5F));
    session.forget_edit(name);
    edit(session, name, "out.rgb = ", kDiffuse);
    const std::optional<Wish> edited = session.wish(false);
    ASSERT_TRUE(edited);
    for (const Object& object : edited->scene->objects) EXPECT_TRUE(object.edited);
}

TEST_F(ViewProgram, AMessageGoesWithTheNextWishThatSucceeds) {
    scene(kSphere);
    Session session = opened(path("s.toml"));
    session.take(loaded(loader(), {path("nowhere.toml"), LoadOrder::Purpose::open}));
    session.state.half_vector = "cube:0";
    EXPECT_FALSE(session.wish(false));
    EXPECT_SAYS(session.wish_message, "cube:0");
    session.state.half_vector = "vertex";
    EXPECT_TRUE(session.wish(false));
    EXPECT_EQ(session.wish_message, "");
    EXPECT_SAYS(session.message, "nowhere.toml") << "of a file, which is still not there";
}

}  // namespace
}  // namespace burnish::view
