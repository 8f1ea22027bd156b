#include "view/session.hpp"

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <numbers>

#include <cstring>

#include "tests/scene_file.hpp"
#include "view/file_watch.hpp"
#include "view/frame_times.hpp"
#include "view/load_thread.hpp"

namespace burnish::view {
namespace {

constexpr float kTight = 1e-4F;

/// A camera and a ball that have nothing to do with each other's axes.
Camera some_camera() {
    Camera camera;
    camera.position = {2.0F, 1.0F, 4.0F};
    camera.focal_point = {0.5F, 0.25F, -1.0F};
    camera.view_angle = 40.0F;
    return camera;
}

float distance(const Camera& camera) {
    return glm::length(camera.position - camera.focal_point);
}

float height_degrees(const Camera& camera) {
    const glm::vec3 arm = glm::normalize(camera.position - camera.focal_point);
    return std::asin(arm.y) * 180.0F / std::numbers::pi_v<float>;
}

TEST(ViewOrbit, KeepsTheDistanceAndTurnsByTheAngle) {
    const Camera before = some_camera();
    const Camera after = orbited(before, 30.0F, 0.0F);
    EXPECT_NEAR(distance(after), distance(before), kTight);
    EXPECT_EQ(after.focal_point, before.focal_point);
    glm::vec3 from = before.position - before.focal_point;
    glm::vec3 to = after.position - after.focal_point;
    EXPECT_NEAR(from.y, to.y, kTight);
    from.y = to.y = 0.0F;
    const float cosine = glm::dot(from, to) / (glm::length(from) * glm::length(to));
    EXPECT_NEAR(cosine, std::cos(std::numbers::pi_v<float> / 6.0F), kTight);
    // A hand to the right turns what is seen to the right: the camera goes to the left.
    EXPECT_LT(glm::dot(glm::cross(glm::vec3(0, 1, 0), from), to), 0.0F);
}

TEST(ViewOrbit, RaisesByTheAngleAndStopsShortOfThePole) {
    const Camera before = some_camera();
    EXPECT_NEAR(height_degrees(orbited(before, 0.0F, 10.0F)), height_degrees(before) + 10.0F, 1e-2);
    EXPECT_NEAR(height_degrees(orbited(before, 0.0F, 500.0F)), 89.0F, 0.05F);
    EXPECT_NEAR(height_degrees(orbited(before, 0.0F, -500.0F)), -89.0F, 0.05F);
}

TEST(ViewOrbit, PanMovesByShareOfTheHeight) {
    const Camera before = some_camera();
    const Camera after = panned(before, 0.0F, 1.0F);
    // The whole height of the picture at the focal point.
    const float height = 2.0F * distance(before) * std::tan(std::numbers::pi_v<float> / 9.0F);
    EXPECT_NEAR(glm::length(after.focal_point - before.focal_point), height, 1e-3F);
    EXPECT_NEAR(
        glm::length((after.position - after.focal_point) - (before.position - before.focal_point)),
        0.0F, kTight);
    EXPECT_GT(after.focal_point.y, before.focal_point.y);
}

TEST(ViewOrbit, ZoomNeverReachesTheFocalPoint) {
    const Ball ball{glm::vec3(0.0F), 2.0F};
    const Camera before = some_camera();
    EXPECT_NEAR(distance(zoomed(before, 2.0F, ball)), 0.5F * distance(before), kTight);
    EXPECT_GE(distance(zoomed(before, 1e30F, ball)), 0.9e-3F * ball.radius);
    EXPECT_LE(distance(zoomed(before, 1e-30F, ball)), 1.1e3F * ball.radius);
}

/// As a scene's file may have it: its distance squared is no float.
TEST(ViewOrbit, ACameraFarAwayComesBack) {
    const Ball ball{glm::vec3(0.0F), 2.0F};
    Camera far = some_camera();
    far.position = {0.0F, 0.0F, 1e30F};
    far = zoomed(zoomed(far, 1.1F, ball), 1.1F, ball);
    EXPECT_TRUE(has_direction(far));
    EXPECT_LE(distance(far), 1.1e3F * ball.radius);
}

/// Half the angle under which the ball is seen is at most half the picture's, both ways.
TEST(ViewOrbit, SidesSeeAllOfTheBall) {
    const Ball ball{glm::vec3(1.0F, -2.0F, 0.5F), 3.0F};
    for (const Side side : {Side::front, Side::right, Side::top, Side::isometric}) {
        for (const float aspect : {0.5F, 1.0F, 2.0F}) {
            const Camera camera = seen_from(side, some_camera(), ball, aspect);
            EXPECT_EQ(camera.focal_point, ball.centre);
            const float half = 20.0F * std::numbers::pi_v<float> / 180.0F;
            const float narrow = std::min(half, std::atan(std::tan(half) * aspect));
            EXPECT_NEAR(ball.radius / distance(camera), std::sin(narrow), kTight);
            const Camera deep = with_depths(camera, ball);
            EXPECT_LT(deep.near, distance(camera) - ball.radius);
            EXPECT_GT(deep.far, distance(camera) + ball.radius);
        }
    }
}

TEST(ViewOrbit, MatricesBecomeVectors) {
    Camera given;
    // From (0, 0, 5) along -z, the focal length of 90 degrees.
    given.view = glm::mat4(1.0F);
    (*given.view)[3] = glm::vec4(0.0F, 0.0F, -5.0F, 1.0F);
    given.projection = glm::mat4(1.0F);
    const Camera camera = by_vectors(given, {glm::vec3(0.0F), 1.0F});
    EXPECT_FALSE(camera.view || camera.projection);
    EXPECT_NEAR(camera.position.z, 5.0F, kTight);
    EXPECT_NEAR(glm::length(camera.focal_point), 0.0F, kTight);
    EXPECT_NEAR(camera.view_angle, 90.0F, 1e-3F);
}

TEST(ViewPace, DividesSidesUntilAFrameFits) {
    Pace pace(10.0);
    pace.took("m", 1e6, 42.0, 2.0);               // 40 ns a pixel, 2 ms whatever its size
    EXPECT_EQ(pace.divisor("m", 0.2e6, 1), 1.0);  // 8 ms are left
    EXPECT_EQ(pace.divisor("m", 0.21e6, 1), 1.125);
    EXPECT_EQ(pace.divisor("m", 0.8e6, 1), 2.0);
    EXPECT_EQ(pace.divisor("m", 0.81e6, 1), 2.125);
    EXPECT_EQ(pace.divisor("m", 1e12, 1), 16.0);
    EXPECT_GT(pace.divisor("m", 0.2e6, 2), 1.0);
    // Of others 60 ns or what is said are guessed.
    EXPECT_EQ(pace.divisor("n", 1e7 / 60.0, 1), 1.0);
    EXPECT_EQ(pace.divisor("n", 1e7 / 60.0 + 1.0, 1), 1.125);
    EXPECT_EQ(pace.divisor("n", 1e7 / 500.0, 1, 2000.0), 2.0);
}

TEST(ViewFrameTimes, QuantilesAndRate) {
    FrameTimes times;
    Picture picture(1, 1);
    picture.panes.resize(1);
    double now = 1000.0;
    times.shown(picture, now);
    for (int i = 1; i <= 200; ++i) times.shown(picture, now += i <= 198 ? 10.0 : 60.0);
    EXPECT_EQ(times.count(), 200U);
    EXPECT_DOUBLE_EQ(times.quantile(0.5), 10.0);
    EXPECT_DOUBLE_EQ(times.quantile(0.99), 10.0);
    EXPECT_DOUBLE_EQ(times.quantile(0.995), 60.0);
    EXPECT_NEAR(times.per_second(), 200.0 / 2.1, 1e-9);
    // A pause is no frame.
    times.rest();
    times.shown(picture, now += 1e6);
    EXPECT_EQ(times.count(), 200U);
    EXPECT_EQ(times.last().size(), 200U);
}

using ViewStateFile = SceneFile;

ViewState full_state() {
    ViewState state;
    state.input = "x \"y\"\\.toml";
    state.width = 321;
    state.height = 123;
    state.camera = some_camera();
    state.camera.view_angle = 1.0F / 3.0F;
    state.light = glm::vec3(0.1F, -1e-20F, 3e10F);
    state.machine = "nv2a";
    state.half_vector = "cube:32";
    state.filter_order = FilterOrder::after;
    state.bits = "textures=7";
    state.mipmaps = MaterialMipmaps{MipMethod::lean, 16};
    state.split = state.heat_map = true;
    state.lines = {0.1F, 0.1F, 1.0F};
    state.gain = 3.5F;
    state.pixel = glm::ivec2(0, 77);
    MaterialEdit edit;
    edit.name = "steel";
    edit.model = Model::ward;
    edit.kd = glm::vec3(0.1F);
    edit.ks = glm::vec3(0.2F, 1.0F, 0.0F);
    edit.alpha_x = 0.05F;
    edit.alpha_y = 1.0F;
    edit.exponent = 700.0F;
    edit.combiners = "!!RC1.0\n{\t\"\x01'''}\n";
    state.materials = {edit, edit};
    return state;
}

/// Equal texts are equal states: they hold every field to its last bit.
TEST_F(ViewStateFile, ComesBackAsItWas) {
    const ViewState state = full_state();
    write(path("s.toml"), view_state_text(state));
    ViewState back = load_view_state(path("s.toml"));
    EXPECT_EQ(back.input, directory() / state.input);
    back.input = state.input;
    EXPECT_EQ(view_state_text(back), view_state_text(state));
    EXPECT_EQ(back.camera.view_angle, state.camera.view_angle);
    EXPECT_EQ(back.light, state.light);
    EXPECT_EQ(back.materials.at(1).combiners, state.materials[1].combiners);
}

TEST_F(ViewStateFile, ComesBackFromAPicture) {
    const std::string text = view_state_text(full_state());
    save_image(Framebuffer(3, 2), path("shot.png"), text);
    ViewState back = load_view_state(path("shot.png"));
    back.input = full_state().input;
    EXPECT_EQ(view_state_text(back), text);
    save_image(Framebuffer(3, 2), path("bare.png"));
    EXPECT_SAYS(complaint_of([&] { load_view_state(path("bare.png")); }),
                "bare.png: a picture without a state");
}

TEST_F(ViewStateFile, WrongOnesAreToldInALine) {
    const auto complaint = [&](const std::string& text) {
        write(path("s.toml"), text);
        return complaint_of([&] { load_view_state(path("s.toml")); });
    };
    EXPECT_SAYS(complaint("schema = 1\n"), "'input'");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\nsplitt = 1\n"), "'split'");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[split]\nlines = [0.5, 0.4, 1.0]\n"),
                "s.toml:4");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[machine]\nprofile = \"nv2b\"\n"), "nv2a");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[machine]\nhalf_vector = \"cube\"\n"),
                "s.toml:4");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\nsize = [0, 1]\n"), "'size'");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[camera]\nposition = [0.0, 0.0, 0.0]\n"),
                "focal point");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[camera]\nposition = [1e30, 0, 0]\n"),
                "s.toml:4: 'position' in [camera] is 1");
    EXPECT_SAYS(complaint("schema = 1\ninput = \"a\"\n[camera]\nposition = [1e-30, 0, 0]\n"),
                "s.toml:4");
}

constexpr const char* kPipeline = R"(
[output]
width = 32
height = 24
[machine]
profile = "nv2a"
[[materials]]
name = "flat"
combiners_text = '''!!RC1.0
{ rgb { spare0 = col0 * col0; } }
out.rgb = spare0; out.a = unsigned_invert(zero);
'''
[[objects]]
shape = "sphere"
material = "flat"
)";

using ViewSession = SceneFile;

LoadScene loader() {
    return [](const std::filesystem::path& file) { return load_scene(file).scene; };
}

TEST_F(ViewSession, ABadProgramLeavesTheLastGoodOne) {
    scene(kPipeline);
    Session session(loader());
    session.open(path("s.toml"));
    const std::string good =
        "!!RC1.0\n{ rgb { spare0 = col0 * zero; } }\nout.rgb = spare0;\nout.a = zero;\n";
    session.edit_of("flat").combiners = good;
    const std::optional<Wish> first = session.wish(false);
    ASSERT_TRUE(first);
    EXPECT_TRUE(session.program_errors().empty());
    const Material& edited = *first->scene->objects[0].material;
    EXPECT_NE(edited.program->combiners, session.loaded().objects[0].material->program->combiners);

    session.edit_of("flat").combiners = "!!RC1.0\n{ rgb { spare0 = col0 * ; } }\n";
    const std::optional<Wish> second = session.wish(false);
    ASSERT_TRUE(second);
    ASSERT_EQ(session.program_errors().size(), 1U);
    EXPECT_EQ(session.program_errors()[0].line, 2U);
    EXPECT_EQ(second->scene->objects[0].material, first->scene->objects[0].material);

    session.edit_of("flat").combiners = good;
    EXPECT_EQ(session.wish(false)->scene->objects[0].material, first->scene->objects[0].material);
    session.forget_edit("flat");
    EXPECT_EQ(session.wish(false)->scene->objects[0].material,
              session.loaded().objects[0].material);
}

TEST_F(ViewSession, MaterialsStayTheSameObjectsWhileNothingChanges) {
    scene("[[materials]]\nname = \"m\"\n[[objects]]\nshape = \"sphere\"\nmaterial = \"m\"\n");
    Session session(loader());
    session.open(path("s.toml"));
    session.edit_of("m").alpha_x = 0.2F;
    const auto first = session.wish(false)->scene->objects[0].material;
    session.orbit(0.1F, 0.0F);
    EXPECT_EQ(session.wish(true)->scene->objects[0].material, first);
    EXPECT_EQ(first->alpha_x, 0.2F);
    session.edit_of("m").alpha_x = 0.3F;
    EXPECT_NE(session.wish(true)->scene->objects[0].material, first);
}

/// Whatever a hand does with a camera that floats do not reach, and with a matrix that has no
/// inverse, every state equals itself.
TEST_F(ViewSession, CamerasStayNumbers) {
    for (const std::string camera :
         {"position = [1e30, 0, 0]", "position = [0, 1e-30, 0]\nfocal_point = [0, 0, 0]",
          "view_up = [0, 1e30, 0]", "view = [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]"}) {
        scene("[camera]\n" + camera + "\n[[objects]]\nshape = \"sphere\"\n");
        Session session(loader());
        session.open(path("s.toml"));
        const auto same = [&] {
            const ViewState state = session.state;
            return session.state == state;
        };
        EXPECT_TRUE(same()) << camera;
        session.orbit(0.1F, 0.1F);
        session.pan(0.1F, 0.1F);
        session.turn_light(0.1F, 0.1F);
        EXPECT_TRUE(same()) << camera;
        session.zoom(1.1F);
        session.zoom(1.1F);
        session.orbit(0.1F, 0.1F);
        session.look_from(Side::top);
        EXPECT_TRUE(same()) << camera;
        session.reset_camera();
        EXPECT_TRUE(same()) << camera;
    }
}

TEST_F(ViewSession, StepsThroughTheDirectoryAndPassesOverWhatIsBroken) {
    for (const char* name : {"a.toml", "c.toml"})
        write(path(name), "schema = 1\n[[objects]]\nshape = \"sphere\"\n");
    write(path("b.toml"), "schema = 2\n");
    write(path("notes.txt"), "");
    Session session(loader());
    session.open(path("a.toml"));
    const auto take = [&](const std::filesystem::path& input, LoadOrder::Purpose purpose) {
        session.take(loaded(loader(), {input, purpose}));
    };
    const auto step = [&](int direction) {
        take(neighbour(session.state.input, direction).value(), LoadOrder::Purpose::step);
    };
    step(1);
    EXPECT_EQ(session.state.input, path("b.toml"));
    EXPECT_SAYS(session.message, "schema");
    step(1);
    EXPECT_EQ(session.state.input, path("c.toml"));
    EXPECT_EQ(session.message, "");
    step(1);
    EXPECT_EQ(session.state.input, path("a.toml"));
    step(-1);
    EXPECT_EQ(session.state.input, path("c.toml"));
    take(path("not-there.toml"), LoadOrder::Purpose::open);
    EXPECT_EQ(session.state.input, path("c.toml"));
    EXPECT_SAYS(session.message, "not-there.toml");
}

TEST_F(ViewSession, SplitPictureHasEachMachinesColumns) {
    scene(
        "[output]\nwidth = 40\nheight = 24\n[[lights]]\ndirection = [0.3, 0.8, 0.5]\n"
        "[[objects]]\nshape = \"sphere\"\n");
    Session session(loader());
    session.open(path("s.toml"));
    session.state.width = 40;
    session.state.height = 24;
    session.state.split = true;
    session.state.lines = {0.25F, 0.5F, 0.75F};
    const std::optional<Wish> wish = session.wish(false);
    ASSERT_TRUE(wish);
    PictureMaker maker(
        [](Renderer& renderer, const Scene& drawn, int side, Framebuffer& target) {
            EXPECT_EQ(side, 1);
            return renderer.render(drawn, target);
        },
        1000.0);
    const Picture picture = maker.make(*wish, Fineness::full);
    EXPECT_EQ(finer(*wish, picture), std::nullopt);
    Renderer renderer;
    for (std::size_t pane = 0; pane < 4; ++pane) {
        Scene alone = *wish->scene;
        alone.machine = wish->panes[pane].machine;
        Framebuffer frame(40, 24);
        renderer.render(alone, frame);
        for (int y = 0; y < 24; ++y)
            EXPECT_EQ(0,
                      std::memcmp(frame.row(y) + 40 * pane, picture.frame.row(y) + 40 * pane, 40))
                << alone.machine.name << " row " << y;
    }
}

TEST_F(ViewSession, ErrorMapOfDoubleItselfIsBlack) {
    // A light that leads beyond what a frame shows.
    scene(
        "[[lights]]\ndirection = [0.3, 0.8, 0.5]\nintensity = 4.0\n"
        "[[objects]]\nshape = \"sphere\"\n");
    Session session(loader());
    session.open(path("s.toml"));
    session.state.width = session.state.height = 32;
    session.state.heat_map = true;
    const auto sum = [&](const std::string& machine) {
        session.state.machine = machine;
        PictureMaker maker({}, 1000.0);
        const Picture picture = maker.make(*session.wish(false), Fineness::full);
        EXPECT_EQ(picture.panes[0].error, "");
        int total = 0;
        for (int i = 0; i < 32 * 32; ++i)
            for (int c = 0; c < 3; ++c)
                total += std::to_integer<int>(picture.frame.pixels()[4 * i + c]);
        return total;
    };
    const int black = sum("double");
    EXPECT_LE(black, 32 * 32 * 4);  // magma begins a little above black
    EXPECT_GT(sum("geforce256"), 2 * black);
}

/// Of a machine that cannot run a program its pane says so, the others are drawn.
TEST_F(ViewSession, APaneThatCannotBeDrawnSaysWhy) {
    scene(kPipeline);
    Session session(loader());
    session.open(path("s.toml"));
    session.state.split = true;
    PictureMaker maker([](Renderer& renderer, const Scene& drawn, int,
                          Framebuffer& target) { return renderer.render(drawn, target); },
                       1000.0);
    const Picture picture = maker.make(*session.wish(false), Fineness::full);
    EXPECT_EQ(picture.panes[1].error, "");
    EXPECT_NE(picture.panes[3].error, "") << "double precision has no programs";
}

TEST_F(ViewSession, WatchSeesAFileOnceItIsWhole) {
    write(path("a"), "1");
    FileWatch watch;
    watch.watch({path("a"), path("b")});
    EXPECT_FALSE(watch.changed());
    write(path("b"), "2");
    EXPECT_FALSE(watch.changed()) << "it may still be written";
    EXPECT_TRUE(watch.changed());
    EXPECT_FALSE(watch.changed());
    std::filesystem::remove(path("a"));
    EXPECT_FALSE(watch.changed());
    EXPECT_TRUE(watch.changed());
}

}  // namespace
}  // namespace burnish::view
