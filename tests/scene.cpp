// Scene files as a whole: output, machine, camera and lights, overrides, and files that are none.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/scene_file.hpp"

namespace burnish {
namespace {

TEST_F(SceneFiles, DefaultsAreThoseOfTheStruct) {
    const Scene empty = scene("");
    const Scene plain;
    EXPECT_EQ(empty.width, plain.width);
    EXPECT_EQ(empty.height, plain.height);
    EXPECT_EQ(empty.machine.name, "ideal");
    EXPECT_TRUE(empty.lights.empty());
    EXPECT_TRUE(empty.objects.empty());
}

TEST_F(SceneFiles, EveryKeyOfOutputMachineCameraAndLightsArrives) {
    const Scene s = scene(R"(
ambient = [0.1, 0.2, 0.3]
[output]
width = 64
height = 48
background = [0.0, 0.25, 0.5, 1.0]
format = "rgba16"
[machine]
profile = "nv2a"
filter_order = "after"
texture_units = 3
general_stages = 5
stage_constants = false
numbers = "wide"
half_vector = "pixel"
subpixel_bits = 6
snap = "nearest"
[camera]
position = [1.0, 2.0, 3.0]
focal_point = [0, 1, 0]
view_up = [0.0, 0.0, 1.0]
view_angle = 20
near = 0.5
far = 50.0
[[lights]]
direction = [0.0, 1.0, 0.0]
color = [1.0, 0.5, 0.25]
intensity = 2.0
[[lights]]
position = [4.0, 5.0, 6.0]
)");
    EXPECT_EQ(s.width, 64);
    EXPECT_EQ(s.height, 48);
    EXPECT_EQ(s.background, glm::vec4(0.0F, 0.25F, 0.5F, 1.0F));
    EXPECT_EQ(s.format, PixelFormat::rgba16);
    EXPECT_EQ(s.ambient, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(s.machine.name, "nv2a");
    EXPECT_EQ(s.machine.texture_units, 3);
    EXPECT_EQ(s.machine.general_stages, 5);
    EXPECT_FALSE(s.machine.stage_constants);
    EXPECT_EQ(s.machine.numbers, NumberModel::wide);
    EXPECT_EQ(s.machine.half_vector, HalfVector::pixel);
    EXPECT_EQ(s.machine.filter_order, FilterOrder::after);
    EXPECT_EQ(s.machine.subpixel_bits, 6);
    EXPECT_FALSE(s.machine.snap_floor);
    EXPECT_EQ(s.camera.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(s.camera.focal_point, glm::vec3(0, 1, 0));
    EXPECT_EQ(s.camera.view_up, glm::vec3(0, 0, 1));
    EXPECT_EQ(s.camera.view_angle, 20.0F);
    EXPECT_EQ(s.camera.near, 0.5F);
    EXPECT_EQ(s.camera.far, 50.0F);
    ASSERT_EQ(s.lights.size(), 2U);
    EXPECT_EQ(s.lights[0].position, glm::vec3(0, 1, 0));
    EXPECT_EQ(s.lights[0].position_w, 0.0F);
    EXPECT_EQ(s.lights[0].color, glm::vec3(1.0F, 0.5F, 0.25F));
    EXPECT_EQ(s.lights[0].intensity, 2.0F);
    EXPECT_EQ(s.lights[1].position, glm::vec3(4, 5, 6));
    EXPECT_EQ(s.lights[1].position_w, 1.0F);
}

TEST_F(SceneFiles, MatricesAreColumnMajor) {
    const Scene s = scene(
        "[camera]\nview = [1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1]\n"
        "projection = [1,2,3,4, 5,6,7,8, 9,10,11,12, 13,14,15,16]\n");
    ASSERT_TRUE(s.camera.view.has_value());
    EXPECT_EQ((*s.camera.view)[3], glm::vec4(7, 8, 9, 1));
    ASSERT_TRUE(s.camera.projection.has_value());
    EXPECT_EQ((*s.camera.projection)[0], glm::vec4(1, 2, 3, 4));
}

TEST_F(SceneFiles, UnknownKeysNameTheNearestKnownOne) {
    EXPECT_EQ(bad("[output]\nwidht = 3\n"),
              "FILE:3: unknown key 'widht' in [output], did you mean 'width'?");
    EXPECT_SAYS(bad("[ouptut]\n"),
                "FILE:2: unknown key 'ouptut' in the scene, did you mean 'output'?");
    EXPECT_SAYS(bad("[[lights]]\ndirection = [0,1,0]\n\ncolour = [1,1,1]\n"),
                "FILE:5: unknown key 'colour' in [[lights]], did you mean 'color'?");
    EXPECT_SAYS(bad("[camera]\nqqqqqqqq = 1\n"), "expected position, focal_point");
    EXPECT_SAYS(
        bad("[[objects]]\nvertices = [\n{ position = [0,0,0] },\n{ positoin = [0,0,0] }]\n"),
        "FILE:5: unknown key 'positoin'");
}

TEST_F(SceneFiles, WrongTypesSayWhatWasFoundAndExpected) {
    EXPECT_EQ(bad("[output]\nwidth = \"wide\"\n"),
              "FILE:3: 'width' in [output] is a string, expected an integer of 1 .. 16384");
    EXPECT_SAYS(bad("[output]\nwidth = 1.5\n"), "is a number, expected an integer");
    EXPECT_SAYS(bad("output = 3\n"),
                "FILE:2: 'output' in the scene is an integer, expected a table");
    EXPECT_SAYS(bad("lights = {}\n"), "expected an array of tables");
    EXPECT_SAYS(bad("lights = [1]\n"), "expected an array of tables");
    EXPECT_SAYS(bad("[camera]\nposition = [1, 2]\n"),
                "has 2 elements, expected an array of 3 numbers");
    EXPECT_SAYS(bad("[camera]\nposition = [1, 2,\n true]\n"),
                "FILE:4: 'position' in [camera] is a boolean");
}

TEST_F(SceneFiles, ValuesOutOfRangeAreErrors) {
    EXPECT_SAYS(bad("[output]\nwidth = 0\n"), "'width' = 0 in [output], expected");
    EXPECT_SAYS(bad("[output]\nwidth = 16385\n"), "expected an integer of 1 .. 16384");
    EXPECT_SAYS(bad("[output]\nwidth = 9223372036854775807\n"), "expected an integer");
    EXPECT_SAYS(bad("[output]\nbackground = [0,0,0,1.5]\n"), "value 1.5");
    EXPECT_SAYS(bad("[camera]\nnear = 0\n"), "expected a number above 0");
    EXPECT_SAYS(bad("[camera]\nnear = nan\n"), "value nan");
    EXPECT_SAYS(bad("[camera]\nfar = inf\n"), "value inf");
    EXPECT_SAYS(bad("[camera]\nfar = 1e300\n"), "value 1e+300");
    EXPECT_SAYS(bad("[camera]\nnear = 2\nfar = 1\n"), "'far' = 1");
    EXPECT_SAYS(bad("[camera]\nview_angle = 180\n"), "view_angle");
    EXPECT_SAYS(bad("[camera]\nposition = [0,0,0]\n"), "is the focal point");
    EXPECT_SAYS(bad("[machine]\ntexture_units = 17\n"), "expected an integer of 1 .. 16");
    EXPECT_SAYS(bad("[machine]\nprofile = \"nv2b\"\n"), "did you mean 'nv2a'?");
    EXPECT_SAYS(bad("[[lights]]\ndirection = [0,0,0]\n"), "no length");
    EXPECT_SAYS(bad("[[lights]]\n"), "needs one of 'direction' and 'position'");
}

TEST_F(SceneFiles, TheSchemaIsRequired) {
    for (const char* text : {"", "schema = 2\n", "schema = \"1\"\n"}) {
        write(path("s.toml"), text);
        EXPECT_THROW(load_scene(path("s.toml")), Error) << text;
    }
}

TEST_F(SceneFiles, SyntaxErrorsCarryTheLine) {
    EXPECT_SAYS(bad("[output]\nwidth = = 3\n"), "FILE:3: ");
    EXPECT_SAYS(bad("[output\n"), "FILE:2: ");
    EXPECT_SAYS(bad("a = \"\xff\xfe\"\n"), "FILE:2: ");
}

TEST_F(SceneFiles, FilesThatCannotBeReadAreIoErrors) {
    const auto code = [](const std::filesystem::path& file) {
        try {
            load_scene(file);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::bad_option;
    };
    EXPECT_EQ(code(path("missing.toml")), ErrorCode::io);
    EXPECT_EQ(code(directory()), ErrorCode::io);
}

TEST_F(SceneFiles, VectorsOfAMachine) {
    const Machine m = scene(
                          "[machine]\nhalf_vector = \"cube:32\"\nhalf_vector_bits = 16\n"
                          "viewer = \"infinite\"\ntangent_frames = \"orthonormal\"\n")
                          .machine;
    EXPECT_EQ(m.half_vector, HalfVector::cube);
    EXPECT_EQ(m.half_vector_size, 32);
    EXPECT_EQ(m.half_vector_bits, 16);
    EXPECT_EQ(m.viewer, Viewer::infinite);
    EXPECT_EQ(m.tangent_frames, TangentFrames::orthonormal);
    EXPECT_FALSE(scene("[machine]\nnormalise_half_vector = false\n").machine.normalise_half_vector);
    EXPECT_EQ(bad("[machine]\nhalf_vector = \"cube:0\"\n"),
              "FILE:3: half_vector 'cube:0', expected pixel, vertex or cube:N with N = 1 .. 1024, "
              "in [machine]");
    EXPECT_SAYS(bad("[machine]\nprofile = \"nv2a\"\nhalf_vector = \"cube:8\"\n"
                    "half_vector_bits = 9\n"),
                "FILE:3: half_vector_bits = 9 with numbers = nine_bit, expected 8");
    EXPECT_SAYS(bad("[machine]\nhalf_vector_bits = 17\n"), "half_vector_bits");
    EXPECT_SAYS(bad("[machine]\nviewer = \"far\"\n"), "expected local, infinite");
    EXPECT_SAYS(bad("[machine]\ntangent_frames = \"derivatives\"\n"), "did you mean 'derivative'?");
    EXPECT_SAYS(bad("[machine]\nhalf_vector = \"vertex\"\ntangent_frames = \"derivative\"\n"),
                "expected half_vector = pixel");
}

// What a scene says of its machine stays in the file when the double renderer draws it.
TEST_F(SceneFiles, ProfileDoubleTakesTheKeysOfMachines) {
    EXPECT_FALSE(scene("[machine]\nprofile = \"ideal\"\n").machine.double_precision);
    const Machine machine =
        scene("[machine]\nprofile = \"double\"\ntexture_units = 3\nproduct_rounding = \"shift8\"\n")
            .machine;
    EXPECT_TRUE(machine.double_precision);
    EXPECT_EQ(machine.name, "double");
    EXPECT_SAYS(bad("[machine]\nprofile = \"double\"\nhalf_vector = \"vertex\"\n"),
                "half vectors of profile double");
}

TEST_F(SceneFiles, DefaultValuesOfSuchKeysAreAccepted) {
    EXPECT_NO_THROW(scene(R"(
[machine]
filter_order = "before"
[[textures]]
name = "t"
generator = "brushed"
width = 4
format = "rgba8"
target = "2d"
mipmaps = "none"
lod_bias = 0.0
[[materials]]
name = "m"
alpha_test = "off"
[[objects]]
shape = "cube"
material = "m"
blend = "off"
)"));
}

TEST_F(SceneFiles, OverridesReachEveryKey) {
    const std::string text =
        "[output]\nwidth = 3\n[[materials]]\nname = \"m\"\n[[objects]]\nshape = \"cube\"\nmaterial "
        "= "
        "\"m\"\n";
    EXPECT_EQ(scene(text, {"output.width=5"}).width, 5);
    EXPECT_EQ(scene(text, {"output.height=7"}).height, 7);
    EXPECT_EQ(scene(text, {"output.width=5", "output.width=6"}).width, 6);
    EXPECT_EQ(scene(text, {"camera.position=[1, 2, 4]"}).camera.position, glm::vec3(1, 2, 4));
    EXPECT_EQ(scene(text, {"machine.profile=nv2a"}).machine.name, "nv2a");
    EXPECT_EQ(scene(text, {"machine.profile=\"nv2a\""}).machine.name, "nv2a");
    EXPECT_EQ(scene(text, {"materials.0.alpha_x=0.5"}).objects.at(0).material->alpha_x, 0.5F);
    EXPECT_EQ(scene(text, {"materials.m.alpha_x=0.5"}).objects.at(0).material->alpha_x, 0.5F);
    EXPECT_EQ(scene(text, {"ambient=[1,0,0]"}).ambient, glm::vec3(1, 0, 0));
}

TEST_F(SceneFiles, OverrideErrorsNameTheOverride) {
    EXPECT_EQ(bad("[output]\nwidth = 3\n", {"output.widht=4"}),
              "-D output.widht=4: unknown key 'widht' in [output], did you mean 'width'?");
    EXPECT_SAYS(bad("", {"output.width=no"}),
                "-D output.width=no: 'width' in [output] is a string");
    for (const char* text :
         {"output", "=3", "output..width=3", "objects.x.scale=1", "schema.x=1", "a.=1"}) {
        const Complaint found = complaint("objects = []\n", {text});
        EXPECT_EQ(found.code, ErrorCode::bad_option) << found.text;
        EXPECT_SAYS(found.text, std::string("-D ") + text);
    }
}

TEST_F(SceneFiles, MutatedFilesNeverCrash) {
    const std::string good = R"(schema = 1
[output]
width = 8
[[textures]]
name = "t"
width = 1
height = 1
texels = [1, 2, 3, 4]
[[materials]]
name = "m"
units = ["t"]
[materials.inputs]
col0_rgb = "vertex"
[[objects]]
material = "m"
space = "window"
vertices = [ { position = [1, 2, 3], color0_bytes = [1, 2, 3] } ]
)";
    std::uint32_t state = 1;
    const auto next = [&state] { return (state = state * 1664525U + 1013904223U) >> 8; };
    for (int i = 0; i < 1500; ++i) {
        std::string text = good;
        const unsigned edits = 1 + next() % 4;
        for (unsigned k = 0; k < edits; ++k) {
            const std::size_t at = next() % text.size();
            if (next() % 3 == 0)
                text.erase(at, 1 + next() % 8);
            else
                text[at] = static_cast<char>(next() % 256);
        }
        write(path("s.toml"), text);
        try {
            load_scene(path("s.toml"));
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
}

TEST_F(SceneFiles, DeepNestingIsAnError) {
    EXPECT_SAYS(bad("a = " + std::string(100000, '[') + "\n"), "FILE:2: ");
}

}  // namespace
}  // namespace burnish
