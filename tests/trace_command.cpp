// `burnish trace` as a shell sees it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/files.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/json.hpp"
#include "tests/run_command.hpp"

namespace burnish {
namespace {

class TraceCommand : public Command {
  protected:
    /// A quad over 8 x 4 pixels from the left to `right`, half red; its alpha is 51.
    void write_quad(const std::string& right = "4.0") {
        write(path("q.toml"), R"(schema = 1
[output]
width = 8
height = 4
background = [0.2, 0.4, 0.6, 1.0]
[machine]
profile = "nv2a"
[[objects]]
space = "window"
primitive = "quads"
vertices = [
  { position = [0.0, 0.0, 0.5], color0 = [0.5, 0.0, 0.0, 0.2] },
  { position = [)" + right + R"(, 0.0, 0.5], color0 = [0.5, 0.0, 0.0, 0.2] },
  { position = [)" + right + R"(, 4.0, 0.5], color0 = [0.5, 0.0, 0.0, 0.2] },
  { position = [0.0, 4.0, 0.5], color0 = [0.5, 0.0, 0.0, 0.2] },
]
)");
    }
    Json json(const std::string& arguments) {
        const Result result = run("trace " + arguments + " --json");
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return Json::parse(result.out);
    }
    static const Json& row(const Json& stage, const std::string& name) {
        for (const Json& r : stage["registers"].list) {
            if (r["register"].text == name) return r;
        }
        throw std::runtime_error("no register " + name);
    }
};

std::vector<double> numbers(const Json& list) {
    std::vector<double> result;
    for (const Json& x : list.list) result.push_back(x.number);
    return result;
}

TEST_F(TraceCommand, JsonHasTheWholeRoad) {
    write_quad();
    const Json trace = json("q.toml --pixel 1,3");
    EXPECT_EQ(numbers(trace["pixel"]), (std::vector<double>{1, 3}));
    EXPECT_EQ(numbers(trace["size"]), (std::vector<double>{8, 4}));
    EXPECT_EQ(trace["machine"].text, "nv2a");
    EXPECT_EQ(trace["one"].number, 255);
    EXPECT_EQ(trace["format"].text, "rgba8");
    EXPECT_EQ(numbers(trace["stored"]), (std::vector<double>{128, 0, 0, 51}));
    const Json& f = trace["fragment"];
    EXPECT_EQ(f["object"].number, 0);
    EXPECT_EQ(f["triangle"].number, 1);
    EXPECT_EQ(f["depth"].number, 0.5);
    EXPECT_FALSE(f["clipped"].boolean);
    EXPECT_EQ(numbers(f["vertices"]), (std::vector<double>{0, 2, 3}));
    const std::vector<double> b = numbers(f["barycentrics"]);
    EXPECT_NEAR(b[0] + b[1] + b[2], 1.0, 1e-15);
    EXPECT_EQ(f["one_over_w"]["value"].number, 1.0);
    EXPECT_EQ(f["interpolants"][0]["name"].text, "color0");
    EXPECT_EQ(f["fetches"].list.size(), 0U);
    const Json& col0 = row(f["stages"][0], "col0");
    EXPECT_EQ(numbers(col0["codes"]), (std::vector<double>{128, 0, 0, 51}));
    EXPECT_NEAR(col0["exact"][0].number, 0.5, 1e-7);
    EXPECT_NEAR(col0["error"][0].number, 0.5 / 255, 1e-7);
    EXPECT_EQ(f["stages"].list.back()["name"].text, "final");
    EXPECT_NE(f["stages"].list.back()["text"].text.find("out.rgb = "), std::string::npos);
    EXPECT_EQ(numbers(f["codes"]), (std::vector<double>{128, 0, 0, 51}));
}

/// Of 2 x 2 samples those at 3.25 are in the quad, those at 3.75 beside it.
TEST_F(TraceCommand, SamplesAreTracedOneByOneAndTheirMeanIsThePixel) {
    write_quad("3.5");
    const Json trace = json("q.toml --pixel 3,1 --samples 4");
    EXPECT_EQ(numbers(trace["pixel"]), (std::vector<double>{3, 1}));
    EXPECT_EQ(numbers(trace["size"]), (std::vector<double>{8, 4}));
    ASSERT_EQ(trace["samples"].list.size(), 4U);
    for (int i = 0; i < 4; ++i) {
        const Json& sample = trace["samples"][static_cast<std::size_t>(i)];
        const bool inside = i % 2 == 0;
        EXPECT_EQ(numbers(sample["pixel"]), (std::vector<double>{6.0 + i % 2, 2.0 + i / 2}));
        EXPECT_EQ(numbers(sample["size"]), (std::vector<double>{16, 8}));
        EXPECT_EQ(sample["fragment"].kind == Json::Kind::null, !inside);
        EXPECT_EQ(numbers(sample["stored"]),
                  inside ? (std::vector<double>{128 * 257, 0, 0, 51 * 257})
                         : (std::vector<double>{51 * 257, 102 * 257, 153 * 257, 65535}));
    }
    ASSERT_EQ(run("render q.toml --samples 4 -o q.png").code, 0);
    const Image8 picture = load_image(path("q.png"));
    const std::uint8_t* drawn = picture.rgba.data() + 4 * (1 * 8 + 3);
    EXPECT_EQ(numbers(trace["stored"]), std::vector<double>(drawn, drawn + 4));
    EXPECT_EQ(numbers(trace["stored"]), (std::vector<double>{90, 51, 77, 153}));

    const std::string text = run("trace q.toml --pixel 3,1 --samples 4").out;
    EXPECT_TRUE(
        text.starts_with("pixel 3,1 of 8 x 4: the mean of 4 samples, which are rgba16 "
                         "pixels of 16 x 8\n"))
        << text;
    EXPECT_SAYS(text, "\nsample 3  0.25, 0.75    32896  0      0      13107\n");
    EXPECT_SAYS(text, "\nmean      rgba8         90     51     77     153\n");
    EXPECT_SAYS(text, "\nsample 4 of 4\npixel 7,3 of 16 x 8, machine nv2a");
    expect_failure("trace q.toml --pixel 3,1 --samples 25", 2, "expected 1, 4, 9 or 16");
    expect_failure("trace q.toml --by-stage --samples 4", 2, "--samples with --by-stage");
}

TEST_F(TraceCommand, TextIsForAPerson) {
    write_quad();
    const Result result = run("trace q.toml --pixel 1,3");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("pixel 1,3 of 8 x 4, machine nv2a, 1 is code 255\n"))
        << result.out;
    EXPECT_SAYS(result.out, "triangle 1\n");
    EXPECT_SAYS(result.out, "\n  depth 0.5\n");
    EXPECT_SAYS(result.out, "\n  corner 1: vertex 2, weight 0.375000000\n");
    EXPECT_SAYS(result.out, "\ninputs\n");
    EXPECT_SAYS(result.out, "\nfinal\nout.rgb = ");
    EXPECT_SAYS(result.out,
                "\n  col0             128      0      0     51  0.5020  0.0000  0.0000  0.2000");
    EXPECT_TRUE(result.out.ends_with("\nstored, rgba8: 128 0 0 51\n")) << result.out;
    EXPECT_EQ(entries(), (std::vector<std::string>{"q.toml"}));
}

TEST_F(TraceCommand, BackgroundPixels) {
    write_quad();
    EXPECT_EQ(run("trace q.toml --pixel 6,0").out,
              "pixel 6,0 of 8 x 4, machine nv2a, 1 is code 255\nbackground\n"
              "stored, rgba8: 51 102 153 255\n");
    const Json trace = json("q.toml --pixel 6,0");
    EXPECT_EQ(trace["fragment"].kind, Json::Kind::null);
    EXPECT_EQ(numbers(trace["stored"]), (std::vector<double>{51, 102, 153, 255}));
}

TEST_F(TraceCommand, TakesTheOptionsOfAPicture) {
    write_scene("s.toml");
    const std::string at = "s.toml --pixel 20,15 ";
    EXPECT_EQ(json(at + "--machine nv2a")["one"].number, 255);
    EXPECT_EQ(json(at)["one"].number, 16384);
    EXPECT_EQ(json(at + "-D output.format=\"\\\"rgba16\\\"\"")["format"].text, "rgba16");
    EXPECT_EQ(numbers(json("s.toml --size 11x7 --pixel 10,6")["size"]),
              (std::vector<double>{11, 7}));
    const std::string plain = run("trace " + at + "--json --isa reference --threads 1").out;
    EXPECT_EQ(run("trace " + at + "--json --threads 3").out, plain);
    for (const char* option : {"--camera-azimuth 30", "--light 0,-1,0", "--camera-zoom 2",
                               "--machine geforce256", "--half-vector vertex"})
        EXPECT_NE(run("trace " + at + "--json " + option).out, plain) << option;
}

TEST_F(TraceCommand, EveryLight) {
    write_scene("s.toml");
    const std::string at = "s.toml --pixel 20,15 --light 0,0.3,1 --light 1,0,1 --light -1,0.5,1,1";
    const Json f = json(at)["fragment"];
    ASSERT_EQ(f["further_lights"].list.size(), 2U);
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = f["light_codes"][c].number;
        for (const Json& light : f["further_lights"].list) sum += light["codes"][c].number;
        EXPECT_EQ(f["codes"][c].number, std::min(sum, 16384.0));
    }
    EXPECT_EQ(f["further_lights"][1]["stages"].list.size(), f["stages"].list.size());
    const std::string text = run("trace " + at).out;
    for (const char* part : {"light 1 of 3\n", "light 2 of 3\n", "light 3 of 3\n", "\nall lights"})
        EXPECT_SAYS(text, part);
}

TEST_F(TraceCommand, BareMeshes) {
    ASSERT_EQ(run("bake mesh sphere --columns 16 --rows 8 -o ball.ply").code, 0);
    const Json trace = json("ball.ply --size 32x32 --pixel 16,16 --quiet");
    EXPECT_EQ(trace["machine"].text, "ideal");
    EXPECT_EQ(trace["fragment"]["fetches"][0]["taps"].list.size(), 4U);
    EXPECT_EQ(trace["fragment"]["fetches"][0]["texels"].list.size(), 4U);
}

TEST_F(TraceCommand, WrongPixelsAreWrongUsage) {
    write_quad();
    expect_failure("trace q.toml", 2, "--pixel");
    expect_failure("trace q.toml --pixel 8,0", 2,
                   "--pixel 8,0, expected one inside the picture of 8 x 4 pixels");
    expect_failure("trace q.toml --pixel 0,4", 2, "--pixel 0,4");
    for (const char* bad : {"3", "-1,2", "1,-2", "1,2,3", "1.5,2", "a,b", "1,", "99999999999,1"})
        expect_failure(fmt::format("trace q.toml --pixel={}", bad), 2,
                       fmt::format("--pixel {}", bad));
    expect_failure("trace q.toml --pixle 1,2", 2, "did you mean '--pixel'?");
    expect_failure("trace q.toml --pixel 1,2 -o x.png", 2, "");
    expect_failure("trace missing.toml --pixel 1,2", 3, "missing.toml");
    write_scene("up.toml", "[camera]\nposition = [0.0, 3.0, 0.0]\n");
    expect_failure("trace up.toml --pixel 1,2", 3, "camera");
}

// 128 is (128 + 255)/2, rounded up, of a byte; files of floats hold 128/255.
TEST_F(TraceCommand, RegistersAsPictures) {
    write_quad();
    ASSERT_EQ(run("render q.toml --aov register:col0@inputs -o bytes.png").code, 0);
    const Image8 bytes = load_image(path("bytes.png"));
    const std::array<int, 4> coded{192, 128, 128, 153};
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(bytes.at(1, 3)[c], coded[static_cast<std::size_t>(c)]) << c;
    EXPECT_EQ(bytes.at(6, 0)[0], 51) << "the background stays";
    ASSERT_EQ(run("render q.toml --aov register:col0 -o floats.exr").code, 0);
    EXPECT_EQ(load_image(path("floats.exr")).at(1, 3)[0], 128);
    ASSERT_EQ(run("render q.toml --aov register:spare1@final --samples 4 -o zero.png").code, 0);
    EXPECT_EQ(load_image(path("zero.png")).at(1, 3)[0], 128);
    ASSERT_EQ(run("render q.toml --aov register:color_sum -o sum.png").code, 0);
    EXPECT_EQ(load_image(path("sum.png")).at(1, 3)[0], 0);
}

TEST_F(TraceCommand, UnknownRegistersAreWrongUsage) {
    write_quad();
    expect_failure("render q.toml --aov colour", 2,
                   "triangle, register:NAME or register:NAME@STAGE");
    expect_failure("render q.toml --aov register:spar0", 2, "did you mean 'spare0'?");
    expect_failure("render q.toml --aov register:discard", 2, "unknown register 'discard'");
    for (const char* stage : {"-1", "16", "1x", "", "last"})
        expect_failure(fmt::format("render q.toml --aov register:tex0@{}", stage), 2,
                       "a stage of 0 .. 15, inputs or final");
    expect_failure("render q.toml --aov register:tex4", 3, "tex0 .. tex3");
}

// The quad of write_quad covers the left half at one depth; what is in files are its numbers.
TEST_F(TraceCommand, GeometryAsPictures) {
    write_quad();
    for (const char* aov : {"depth", "normal", "tangent", "uv", "triangle"}) {
        ASSERT_EQ(run(fmt::format("render q.toml --aov {0} -o {0}.png", aov)).code, 0) << aov;
        const Image8 image = load_image(path(fmt::format("{}.png", aov)));
        EXPECT_EQ(image.at(1, 3)[3], 255) << aov;
        EXPECT_EQ(image.at(6, 0)[3], std::string(aov) == "depth" ? 255 : 0) << aov;
    }
    ASSERT_EQ(run("render q.toml --aov depth --samples 4 -o depth.exr").code, 0);
    expect_failure("render q.toml --aov triangle --samples 4 -o x.png", 2, "numbers have no mean");
    const Result bench = run("bench q.toml --aov depth --frames 1 --json");
    EXPECT_EQ(bench.code, 0) << bench.err;
}

// Half red becomes code 128 of 255 on its way to a register: off by 1/510, the mean square over
// three channels a third of that. Nothing else has an error.
TEST_F(TraceCommand, ByStageSaysWhereTheErrorComesFrom) {
    write_quad();
    const Json picture = json("q.toml --by-stage");
    EXPECT_EQ(picture["pixels"].number, 16);
    EXPECT_EQ(picture["stages"][0]["stage"].text, "half_vector");
    const double rmse = 1.0 / 510.0 / std::sqrt(3.0);
    EXPECT_NEAR(picture["stages"][0]["alone"].number, rmse, 1e-7);
    EXPECT_NEAR(picture["machine_rmse"].number, rmse, 1e-7);
    EXPECT_NEAR(picture["rest"].number, 0.0, 1e-7);
    const Json pixel = json("q.toml --by-stage --pixel 1,1 --bits half_vector=exact");
    EXPECT_NEAR(pixel["steps"][1]["change"][0].number, 0.0, 1e-12);
    EXPECT_NEAR(pixel["machine_color"][0].number, 128.0 / 255.0, 1e-7);

    const Result drawn = run("trace q.toml --by-stage --quiet -o w.svg");
    if (drawn.code == 0) {
        EXPECT_SAYS(read(path("w.svg")), "<svg");
    } else {
        EXPECT_SAYS(drawn.err, "no plots: gnuplot is not there");
    }
    expect_failure("trace q.toml", 2, "expected --pixel X,Y or --by-stage");
    expect_failure("trace q.toml --by-stage --bits film=8", 2, "bits of 'film', expected");
    expect_failure("trace q.toml --by-stage --pixel 6,1", 2, "shows the background");
    expect_failure("trace q.toml --by-stage --machine double", 2, "profile double");
}

TEST_F(TraceCommand, LayersAreListed) {
    const auto quad = [](const char* blend, const char* color) {
        return fmt::format(
            "[[objects]]\nspace = \"window\"\nprimitive = \"quads\"\ndepth_test = \"always\"\n"
            "blend = {}\nvertices = [\n{{ position = [0, 0, 0.5], color0_bytes = {} }},\n"
            "{{ position = [8, 0, 0.5], color0_bytes = {} }},\n"
            "{{ position = [8, 4, 0.5], color0_bytes = {} }},\n"
            "{{ position = [0, 4, 0.5], color0_bytes = {} }} ]\n",
            blend, color, color, color, color);
    };
    write_scene("layers.toml", "[machine]\nprofile = \"nv2a\"\n" +
                                   quad("\"off\"", "[100, 50, 0, 255]") +
                                   quad("\"alpha\"", "[200, 100, 50, 64]"));
    const Json trace = json("layers.toml --size 8x4 --pixel 2,2");
    ASSERT_EQ(trace["below"].list.size(), 1U);
    EXPECT_EQ(trace["below"][0]["object"].number, 1) << "after that of write_scene";
    const Json& blend = trace["fragment"]["blend"];
    EXPECT_EQ(blend["src"].text, "src_alpha");
    EXPECT_EQ(numbers(blend["destination"]), (std::vector<double>{100, 50, 0, 255}));
    EXPECT_EQ(numbers(blend["result"]), (std::vector<double>{125, 63, 13, 207}));
    EXPECT_EQ(numbers(trace["stored"]), numbers(blend["result"]));
    const std::string text = run("trace layers.toml --size 8x4 --pixel 2,2").out;
    EXPECT_SAYS(text, "fragment 1 of 2");
    EXPECT_SAYS(text, "blend add, src src_alpha, dst one_minus_src_alpha");
}

}  // namespace
}  // namespace burnish
