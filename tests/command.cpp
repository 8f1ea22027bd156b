// The command as a shell sees it: exit codes, one line per error, files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <burnish/files.hpp>
#include <string>
#include <vector>

#include "tests/json.hpp"
#include "tests/run_command.hpp"
#include "tests/steel_scene.hpp"

namespace burnish {
namespace {

TEST_F(Command, HelpVersionAndInfoLoadNoImageLibrary) {
    for (const char* arguments :
         {"--help", "render --help", "bake mesh --help", "--version", "info", "info --json",
          "frobnicate", "render", "render x.toml --szie 3x3"}) {
        const Result result = run(arguments, "LD_DEBUG=files");
        EXPECT_EQ(result.err.find("OpenImageIO"), std::string::npos) << arguments;
        EXPECT_SAYS(result.err, "libburnish.so") << "the loader should have reported its files";
    }
    // The same check does find it where files are read.
    write_scene("s.toml");
    EXPECT_SAYS(run("render s.toml", "LD_DEBUG=files").err, "OpenImageIO");
}

TEST_F(Command, HelpListsTheCommandsThatAreThere) {
    const Result help = run("--help");
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* verb :
         {"render", "view", "trace", "compare", "experiment", "bake", "bench", "compile", "info"})
        EXPECT_SAYS(help.out, verb);
    const Result render = run("render --help");
    EXPECT_EQ(render.code, 0);
    for (const char* option : {"--output", "--size", "--threads", "--isa", "--machine", "--samples",
                               "--half-vector", "--filter-order", "--camera-position", "--light",
                               "--background", "--turntable", "-D", "--stats", "--quiet"})
        EXPECT_SAYS(render.out, option);
}

TEST_F(Command, WrongUsageIsCodeTwo) {
    write_scene("s.toml");
    expect_failure("", 2, "");
    expect_failure("rendr s.toml", 2, "unknown command 'rendr', did you mean 'render'?");
    expect_failure("bake brushd -o x", 2, "did you mean 'brushed'?");
    expect_failure("bake mesh knoot -o x.ply", 2, "did you mean 'knot'?");
    expect_failure("render", 2, "INPUT");
    expect_failure("render s.toml --szie 3x3", 2,
                   "unknown option '--szie', did you mean '--size'?");
    expect_failure("render s.toml --size 3", 2, "--size 3");
    expect_failure("render s.toml --size 0x3", 2, "--size 0x3");
    expect_failure("render s.toml --size 99999x3", 2, "16384");
    expect_failure("render s.toml --threads -1", 2, "--threads");
    expect_failure("render s.toml --threads 1e9", 2, "--threads");
    expect_failure("render s.toml --isa mmx", 2, "mmx");
    expect_failure("render s.toml --machine nv2b", 2, "did you mean 'nv2a'?");
    expect_failure("render s.toml --half-vector nowhere", 2, "expected pixel, vertex");
    expect_failure("render s.toml --filter-order last", 2, "expected before or after");
    expect_failure("render s.toml --samples 5", 2, "--samples");
    expect_failure("render s.toml --camera-position 1,2", 2, "--camera-position 1,2");
    expect_failure("render s.toml --light 1,2,x", 2, "--light 1,2,x");
    expect_failure("render s.toml --light 0,0,0", 2, "not zero");
    expect_failure("render s.toml --background 1,1,2", 2, "0 .. 1");
    expect_failure("render s.toml --stats yaml", 2, "--stats yaml");
    expect_failure("render s.toml --turntable 4 -o one.png", 2, "{frame:4}");
    expect_failure("render s.toml -o 'a{frame:x}.png'", 2, "{frame:W}");
    expect_failure("render s.toml -D output.width", 2, "key.path=value");
    expect_failure("render s.toml --quiet -v", 2, "excludes");
}

TEST_F(Command, BadInputIsCodeThree) {
    write_scene("misspelt.toml", "colour = 3\n");
    expect_failure("render misspelt.toml", 3, "misspelt.toml:10: unknown key 'colour'");
    write_scene("texture.toml", "[[textures]]\nname = \"t\"\nfile = \"no.png\"\n");
    expect_failure("render texture.toml", 3, "no.png");
    save_image(Image8(64, 64), path("cut.png"));
    write(path("cut.png"), read(path("cut.png")).substr(0, 60));
    write_scene("cut.toml", "[[textures]]\nname = \"t\"\nfile = \"cut.png\"\n");
    expect_failure("render cut.toml", 3, "cut.png");
    write(path("empty.toml"), "");
    expect_failure("render empty.toml", 3, "schema = 1");
    write(path("empty.obj"), "");
    expect_failure("render empty.obj", 3, "empty.obj");
    expect_failure("render missing.toml", 3, "missing.toml");
    expect_failure("render missing.ply", 3, "missing.ply");
    expect_failure("bench missing.toml", 3, "missing.toml");
    std::filesystem::create_directory(path("directory.toml"));
    expect_failure("render directory.toml", 3, "directory");
    write(path("new\nline.toml"), "schema = 2");
    expect_failure("render 'new\nline.toml'", 3, "schema");
}

TEST_F(Command, UnwritableOutputIsCodeThreeAndLeavesNothing) {
    write_scene("s.toml");
    expect_failure("render s.toml -o no/such/place.png", 3, "no/such/place.png");
    expect_failure("render s.toml -o s.toml/under.png", 3, "s.toml/under.png");
    expect_failure("render s.toml -o picture.xyz", 3, "picture.xyz");
    std::filesystem::create_directory(path("taken.png"));
    expect_failure("render s.toml -o taken.png", 3, "taken.png");
    expect_failure("bake mesh cube -o no/such/cube.ply", 3, "cube.ply");
    expect_failure("bake brushed --size 4 -o no/such/steel", 3, "steel");
    if (std::filesystem::exists("/dev/full")) {
        const Result full = run("info >/dev/full 2>/dev/null; test $? = 3");
        EXPECT_EQ(full.code, 0) << full.err;
    }
}

TEST_F(Command, RenderWritesThePictureAndSaysSo) {
    write_scene("s.toml");
    const Result result = run("render s.toml --threads 2 --isa reference");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_SAYS(result.out, "s.png: 40 x 30, ");
    EXPECT_SAYS(result.out, " ms, reference, 2 threads\n");
    EXPECT_EQ(entries(), (std::vector<std::string>{"s.png", "s.toml"}));
    const Image8 image = load_image(path("s.png"));
    ASSERT_EQ(image.width, 40);
    ASSERT_EQ(image.height, 30);
    EXPECT_EQ(image.at(0, 0)[0], 51);  // the background: 0.2 * 255
    EXPECT_EQ(image.at(0, 0)[2], 153);
    bool covered = false;
    for (int i = 0; i < 3; ++i) covered |= image.at(20, 15)[i] != image.at(0, 0)[i];
    EXPECT_TRUE(covered) << "the sphere is in the middle";
}

TEST_F(Command, QuietPrintsNothing) {
    write_scene("s.toml");
    const Result result = run("render s.toml --quiet -o q.png");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Command, FilterOrderChangesThePictureOfMaps) {
    write_scene("s.toml",
                "material = \"m\"\n[[materials]]\nname = \"m\"\ngenerator = \"brushed\"\n");
    const auto texels = [&](const std::string& options) {
        const Result result = run("render s.toml -o o.png " + options);
        EXPECT_EQ(result.code, 0) << options << result.err;
        return load_image(path("o.png")).rgba;
    };
    const auto before = texels("--filter-order before");
    EXPECT_TRUE(texels("--filter-order after") != before);
    EXPECT_TRUE(texels("-D machine.filter_order=after") == texels("--filter-order after"));
}

TEST_F(Command, OptionsChangeThePicture) {
    write_scene("s.toml");
    ASSERT_EQ(run("render s.toml -o plain.png").code, 0);
    const Image8 plain = load_image(path("plain.png"));
    for (const char* option :
         {"--camera-position 3,0,0.5", "--camera-focal-point 0.5,0,0", "--camera-azimuth 30",
          "--camera-elevation 20", "--camera-zoom 2", "--camera-view-angle 60", "--light 0,-1,0",
          "--light 0,2,0,1", "--light 1,1,1 --light -1,0,1", "--half-vector cube:4",
          "-D machine.viewer=infinite", "-D machine.normalise_half_vector=false", "--aov bitangent",
          "--aov stripes", "--background 0,0,0", "-D ambient=[0.5,0.5,0.5]"}) {
        const Result result = run(std::string("render s.toml -o other.png ") + option);
        ASSERT_EQ(result.code, 0) << option << result.err;
        EXPECT_TRUE(load_image(path("other.png")).rgba != plain.rgba) << option;
    }
    ASSERT_EQ(run("render s.toml -o small.png --size 11x7").code, 0);
    EXPECT_EQ(load_image(path("small.png")).width, 11);
    EXPECT_EQ(load_image(path("small.png")).height, 7);
}

TEST_F(Command, ThePictureDoesNotDependOnThreadsOrISA) {
    write_scene("s.toml");
    ASSERT_EQ(run("render s.toml -o one.png --threads 1").code, 0);
    ASSERT_EQ(run("render s.toml -o three.png --threads 3").code, 0);
    ASSERT_EQ(run("render s.toml -o scalar.png --isa reference").code, 0);
    EXPECT_TRUE(read(path("one.png")) == read(path("three.png")));
    EXPECT_TRUE(read(path("one.png")) == read(path("scalar.png")));
}

TEST_F(Command, StandardOutputCarriesThePictureAndNothingElse) {
    write_scene("s.toml");
    const Result result = run("render s.toml -o - --stats json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("\x89PNG\r\n\x1a\n"));
    EXPECT_TRUE(result.out.ends_with("IEND\xae\x42\x60\x82"));
    EXPECT_SAYS(result.err, "standard output: 40 x 30");
    EXPECT_EQ(entries(), (std::vector<std::string>{"s.toml"}));
}

TEST_F(Command, StatsAreCountsAndTimes) {
    write_scene("s.toml");
    const Result json = run("render s.toml --stats json");
    EXPECT_EQ(json.code, 0);
    EXPECT_TRUE(json.out.starts_with("{\"triangles\": ")) << json.out;
    EXPECT_TRUE(json.out.ends_with("}\n")) << json.out;
    for (const char* key :
         {"shaded_pixels", "geometry_ms", "tiles_ms", "busy_threads", "isa", "transform", "setup",
          "bin", "coverage", "interpolate", "texture", "combine", "resolve", "waiting_ms"})
        EXPECT_SAYS(json.out, fmt::format("\"{}\": ", key));
    const std::string text = run("render s.toml --stats text").out;
    EXPECT_SAYS(text, "shaded_pixels");
    EXPECT_SAYS(text, "values, ");
}

// 40 x 30 pixels are one tile: it is the whole of the tiles' time, and no worker more helps.
TEST_F(Command, BalanceTellsTheLongestTile) {
    write_scene("s.toml");
    const Result text = run("bench s.toml --balance --frames 2");
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_SAYS(text.out, "1.0 times that");
    const Result json = run("bench s.toml --balance --frames 2 --json");
    EXPECT_TRUE(json.out.starts_with("{\"tiles\": 1, ")) << json.out;
    EXPECT_SAYS(json.out, "\"workers\": 64, ");
    EXPECT_EQ(run("bench s.toml --balance --machine double").code, 2);
}

TEST_F(Command, TurntableNumbersItsFiles) {
    write_scene("s.toml",
                "rotate = [0.0, 0.0, 1.0, 20.0]\nscale = 0.5\ntranslate = [0.6, 0.0, 0.0]\n");
    const Result result = run("render s.toml --turntable 3 -o 't{frame:2}.png' --quiet");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(entries(), (std::vector<std::string>{"s.toml", "t00.png", "t01.png", "t02.png"}));
    EXPECT_TRUE(read(path("t00.png")) != read(path("t01.png")));
    ASSERT_EQ(run("render s.toml -o still.png --quiet").code, 0);
    EXPECT_TRUE(read(path("t00.png")) == read(path("still.png")));
    ASSERT_EQ(run("render s.toml --camera-azimuth 120 -o turned.png --quiet").code, 0);
    EXPECT_TRUE(read(path("t01.png")) == read(path("turned.png")));
}

TEST_F(Command, SamplesAverageToExactValues) {
    // A window-space quad that covers one quarter of pixel (1, 1): white on black.
    write(path("s.toml"), R"(schema = 1
[output]
width = 4
height = 4
background = [0.0, 0.0, 0.0, 1.0]
[[objects]]
space = "window"
primitive = "quads"
depth_test = "always"
vertices = [
  { position = [1.0, 1.0, 0.5], color0 = [1, 1, 1, 1] },
  { position = [1.5, 1.0, 0.5], color0 = [1, 1, 1, 1] },
  { position = [1.5, 1.5, 0.5], color0 = [1, 1, 1, 1] },
  { position = [1.0, 1.5, 0.5], color0 = [1, 1, 1, 1] },
]
)");
    ASSERT_EQ(run("render s.toml -o four.png --samples 4").code, 0);
    const Image8 four = load_image(path("four.png"));
    EXPECT_EQ(four.at(1, 1)[0], 64);  // 255 / 4, rounded to nearest
    EXPECT_EQ(four.at(0, 0)[0], 0);
    EXPECT_EQ(four.at(2, 1)[0], 0);
    ASSERT_EQ(run("render s.toml -o sixteen.png --samples 16").code, 0);
    EXPECT_EQ(load_image(path("sixteen.png")).at(1, 1)[0], 64);
    expect_failure("render s.toml --samples 16 --size 5000x4", 3, "4096");
}

TEST_F(Command, ProfileDoubleTakesManySamplesAndShowsColoursOnly) {
    write(path("ball.toml"), "schema = 1\n" + steel_sphere(32, 32, "[0, 0, 1]"));
    const std::string ball = "render ball.toml -o ball.png ";
    ASSERT_EQ(run(ball + "--machine double").code, 0);
    const Image8 one = load_image(path("ball.png"));
    const Result many = run(ball + "--machine double --samples 400");
    EXPECT_EQ(many.code, 0) << many.err;
    EXPECT_SAYS(many.out, "double precision");
    EXPECT_NE(load_image(path("ball.png")).rgba, one.rgba);
    expect_failure(ball + "--samples 25", 2, "--samples 25, expected 1, 4, 9 or 16");
    expect_failure(ball + "--machine double --samples 1089", 2, "a square, 1 .. 1024");
    expect_failure(ball + "--machine double --aov uv", 3, "profile double");
    expect_failure(ball + "--machine double --aov register:spare0", 3, "profile double");
    expect_failure("trace ball.toml --machine double --pixel 3,3", 2, "profile double");
}

TEST_F(Command, BareMeshesAreFramedAndNoted) {
    ASSERT_EQ(run("bake mesh knot --columns 60 --rows 12 -o knot.ply").code, 0);
    const Result result = run("render knot.ply --size 64x48");
    EXPECT_EQ(result.code, 0) << result.err;
    const Image8 image = load_image(path("knot.png"));
    int covered = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) covered += image.at(x, y)[0] != image.at(0, 0)[0] ? 1 : 0;
    }
    EXPECT_GT(covered, 64 * 48 / 10);
    EXPECT_LT(covered, 64 * 48 * 9 / 10);
    expect_failure("render knot.ply -D output.width=3", 2, "is a mesh");
}

TEST_F(Command, BakeWritesFourMapsInADirectoryOrUnderAPrefix) {
    std::filesystem::create_directory(path("maps"));
    EXPECT_EQ(run("bake brushed --size 16 --seed 5 -o maps").code, 0);
    EXPECT_EQ(run("bake brushed --size 16 --seed 5 -o steel").code, 0);
    for (const char* name : {"normal", "tangent", "bitangent", "specular"}) {
        const std::string in_directory = read(path("maps") / (std::string(name) + ".png"));
        EXPECT_NE(in_directory, "");
        EXPECT_TRUE(in_directory == read(path("steel-" + std::string(name) + ".png")));
    }
}

TEST_F(Command, BakedMapsGiveTheSamePictureAsTheGenerator) {
    const auto scene = [](const std::string& source_of_t, const std::string& source_of_b) {
        return "[[textures]]\nname = \"t\"\n" + source_of_t + "[[textures]]\nname = \"b\"\n" +
               source_of_b +
               "[[materials]]\nname = \"steel\"\ntangent_map = \"t\"\nbitangent_map = \"b\"\n"
               "map_scale = 0.25\n";
    };
    ASSERT_EQ(run("bake brushed --size 16 --seed 5 -o steel").code, 0);
    write_scene("made.toml",
                "material = \"steel\"\n" +
                    scene("generator = \"brushed\"\nmap = \"tangent\"\nseed = 5\nwidth = 16\n",
                          "generator = \"brushed\"\nmap = \"bitangent\"\nseed = 5\nwidth = 16\n"));
    write_scene("read.toml", "material = \"steel\"\n" + scene("file = \"steel-tangent.png\"\n",
                                                              "file = \"steel-bitangent.png\"\n"));
    ASSERT_EQ(run("render made.toml").code, 0);
    ASSERT_EQ(run("render read.toml").code, 0);
    EXPECT_TRUE(read(path("made.png")) == read(path("read.png")));
}

TEST_F(Command, BenchReportsOrderStatistics) {
    write_scene("s.toml");
    const Result json = run("bench s.toml --frames 5 --json");
    EXPECT_EQ(json.code, 0) << json.err;
    for (const char* key : {"median_ms", "min_ms", "max_ms", "p95_ms", "geometry_ms", "tiles_ms",
                            "mpixel_per_s", "isa", "threads", "frames"})
        EXPECT_SAYS(json.out, fmt::format("\"{}\": ", key));
    const Result text = run("bench s.toml --frames 5");
    EXPECT_SAYS(text.out, "median");
    // Four samples per pixel are a picture of four times the pixels.
    const auto shaded = [&](const std::string& options) {
        const Json bench = Json::parse(run("bench s.toml --frames 1 --json " + options).out);
        return bench["last_frame"]["shaded_pixels"].number;
    };
    const double four = shaded("--samples 4");
    EXPECT_EQ(four, shaded("--size 80x60"));
    EXPECT_NEAR(four, shaded("--samples 4 --machine double"), 0.01 * four) << "in other places";
    EXPECT_SAYS(run("bench s.toml --frames 1 --samples 4").out, "s.toml: 40 x 30, 4 samples, ");
    expect_failure("bench s.toml --samples 25", 2, "expected 1, 4, 9 or 16");
    EXPECT_EQ(entries(), (std::vector<std::string>{"s.toml"}));
}

TEST_F(Command, InfoNamesWhatThereIs) {
    const Result json = run("info --json");
    EXPECT_EQ(json.code, 0);
    EXPECT_SAYS(json.out, "\"profiles\": [\"geforce256\", \"nv2a\", \"ideal\", \"double\"]");
    EXPECT_SAYS(json.out, "\"reference\"");
    EXPECT_SAYS(json.out, "\"models\": [\"blinn_phong\", \"abp\", \"abp_modified\",");
    EXPECT_SAYS(run("info").out, "burnish 0");
}

TEST_F(Command, EveryProfileDrawsTheDefaultScene) {
    for (const char* machine : {"geforce256", "nv2a", "ideal"}) {
        const Result result =
            run("render '" BURNISH_SOURCE_DIR "/meshes/brushed.toml' --size 64x36 -o " +
                std::string(machine) + ".png --machine " + machine);
        EXPECT_EQ(result.code, 0) << result.err;
    }
    EXPECT_TRUE(read(path("nv2a.png")) != read(path("ideal.png")));
}

TEST_F(Command, ViewSaysWhatItLacks) {
    write_scene("s.toml");
    expect_failure("view", 2, "expected INPUT or --load-state FILE");
    expect_failure("view nowhere.toml", 3, "nowhere.toml");
    const Result blind = run("view s.toml", "env -u DISPLAY -u WAYLAND_DISPLAY -u SDL_VIDEODRIVER");
    EXPECT_EQ(blind.code, 3);
    EXPECT_TRUE(blind.err.starts_with("burnish: view: ")) << blind.err;
    EXPECT_EQ(blind.err.find('\n'), blind.err.size() - 1) << blind.err;
}

}  // namespace
}  // namespace burnish
