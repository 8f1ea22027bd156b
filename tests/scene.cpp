#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/files.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

class SceneFiles : public ScratchDirectory {
  protected:
    /// The scene that `text` describes, after "schema = 1" in line 1.
    Scene scene(const std::string& text, const std::vector<std::string>& overrides = {}) {
        write(path("s.toml"), "schema = 1\n" + text);
        return load_scene(path("s.toml"), overrides).scene;
    }

    struct Complaint {
        std::string text;
        ErrorCode code = ErrorCode::io;
    };

    /// What is wrong with it; the path of the scene file is cut off.
    Complaint complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
        try {
            scene(text, overrides);
        } catch (const Error& error) {
            std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            const std::string file = path("s.toml").string();
            if (what.starts_with(file)) what = "FILE" + what.substr(file.size());
            return {what, error.code()};
        }
        ADD_FAILURE() << "no error for: " << text;
        return {};
    }

    std::string bad(const std::string& text, const std::vector<std::string>& overrides = {}) {
        const Complaint found = complaint(text, overrides);
        EXPECT_EQ(found.code, ErrorCode::bad_input) << found.text;
        return found.text;
    }
};

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
filter_order = "before"
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

TEST_F(SceneFiles, WhatThisVersionCannotHonourIsRefused) {
    EXPECT_SAYS(bad("[machine]\nfilter_order = \"after\"\n"), "is not supported in this version");
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

TEST_F(SceneFiles, TexelsArriveAsTextures) {
    const Scene s = scene(R"(
[[textures]]
name = "two"
width = 2
height = 1
texels = [1, 2, 3, 4, 255, 128, 0, 9]
filter = "nearest"
wrap = ["clamp_to_edge", "repeat"]
[[materials]]
name = "m"
units = ["", "two"]
[[objects]]
material = "m"
vertices = []
)");
    const ProgramMaterial& program = s.objects.at(0).material->program.value();
    ASSERT_EQ(program.units.size(), 2U);
    EXPECT_EQ(program.units[0], nullptr);
    const Texture& texture = *program.units[1];
    EXPECT_EQ(texture.width(), 2);
    EXPECT_EQ(texture.height(), 1);
    EXPECT_EQ(texture.sampler().filter, Filter::nearest);
    EXPECT_EQ(texture.sampler().wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(texture.sampler().wrap_t, Wrap::repeat);
    EXPECT_EQ(texture.texel(0, 0, 0, 0, 0), 1);
    EXPECT_EQ(texture.texel(0, 0, 1, 0, 0), 255);
}

TEST_F(SceneFiles, TextureErrors) {
    const std::string head = "[[textures]]\nname = \"t\"\n";
    EXPECT_SAYS(bad("[[textures]]\n"), "has no 'name'");
    EXPECT_SAYS(bad(head), "0 sources of texels");
    EXPECT_SAYS(bad(head + "file = \"a\"\ngenerator = \"brushed\"\n"), "2 sources of texels");
    EXPECT_SAYS(bad(head + "texels = [1,2,3,4]\n"), "without a size");
    EXPECT_SAYS(bad(head + "width = 2\nheight = 1\ntexels = [1,2,3,4]\n"),
                "has 4 elements, expected an array of 8");
    EXPECT_SAYS(bad(head + "width = 1\nheight = 1\ntexels = [1,2,3,256]\n"), "value 256");
    EXPECT_SAYS(bad(head + "width = 1\nheight = 1\ntexels = [1,2,3,0.5]\n"), "value 0.5");
    // 2^14 squared texels would be a gigabyte: refused for the count before any memory is taken.
    EXPECT_SAYS(bad(head + "width = 16384\nheight = 16384\ntexels = [1]\n"), "has 1 elements");
    EXPECT_SAYS(bad(head + "generator = \"brushd\"\n"), "did you mean 'brushed'?");
    EXPECT_SAYS(bad(head + "generator = \"brushed\"\nmap = \"tagent\"\n"),
                "did you mean 'tangent'?");
    EXPECT_SAYS(bad(head + "generator = \"brushed\"\nwidth = 4\nwrap = [\"repeet\", \"repeat\"]\n"),
                "did you mean 'repeat'?");
    const std::string once = head + "generator = \"brushed\"\nwidth = 4\n";
    EXPECT_SAYS(bad(once + once), "FILE:7: second [[textures]] with the name 't'");
    const Complaint missing = complaint(head + "file = \"no.png\"\n");
    EXPECT_EQ(missing.code, ErrorCode::io);
    EXPECT_SAYS(missing.text, "FILE:4: ");
    EXPECT_SAYS(missing.text, "no.png");
}

TEST_F(SceneFiles, TextureFilesAreRelativeToTheScene) {
    Image8 image(3, 2);
    save_image(image, path("map.png"));
    const Scene s = scene(R"(
[[textures]]
name = "map"
file = "map.png"
[[materials]]
name = "m"
model = "abp_modified"
normal_map = "map"
[[objects]]
shape = "cube"
material = "m"
)");
    EXPECT_EQ(s.objects.at(0).material->normal_map->width(), 3);
}

TEST_F(SceneFiles, ReflectanceArrives) {
    const Scene s = scene(R"(
[[textures]]
name = "t"
generator = "brushed"
map = "tangent"
width = 8
[[textures]]
name = "b"
generator = "brushed"
map = "bitangent"
width = 8
[[materials]]
name = "brass"
model = "anisotropic-blinn-phong-modified"
kd = [0.1, 0.2, 0.3]
ks = [0.4, 0.5, 0.6]
alpha_x = 0.25
alpha_y = 1.0
tangent_map = "t"
bitangent_map = "b"
specular_map = "t"
[[objects]]
shape = "sphere"
columns = 5
rows = 4
material = "brass"
cull = "back"
depth_test = "lequal"
depth_write = false
)");
    const Object& object = s.objects.at(0);
    EXPECT_EQ(std::get<Mesh>(object.geometry).triangle_count(), 2U * 5U * 3U);
    EXPECT_EQ(object.raster.cull, Cull::back);
    EXPECT_EQ(object.raster.depth_test, DepthTest::lequal);
    EXPECT_FALSE(object.raster.depth_write);
    const Material& brass = *object.material;
    EXPECT_EQ(brass.name, "brass");
    EXPECT_EQ(brass.model, Model::abp_modified);
    EXPECT_FALSE(brass.program.has_value());
    EXPECT_EQ(brass.kd, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(brass.ks, glm::vec3(0.4F, 0.5F, 0.6F));
    EXPECT_EQ(brass.alpha_x, 0.25F);
    EXPECT_EQ(brass.alpha_y, 1.0F);
    EXPECT_NE(brass.tangent_map, nullptr);
    EXPECT_EQ(brass.map_scale, 0.25F) << "known for generated maps";
    EXPECT_EQ(brass.specular_map, brass.tangent_map);
}

TEST_F(SceneFiles, MaterialErrors) {
    const std::string head =
        "[[textures]]\nname = \"t\"\nwidth = 1\nheight = 1\ntexels = "
        "[0,0,0,0]\n[[materials]]\nname = "
        "\"m\"\n";
    EXPECT_SAYS(bad(head + "model = \"wrd\"\n"),
                "'model' = \"wrd\" in [[materials]], did you mean 'ward'?");
    EXPECT_SAYS(bad(head + "alpha_x = 0\n"), "expected a number above 0 and at most 1");
    EXPECT_SAYS(bad(head + "ks = [1, 1, 2]\n"), "value 2");
    EXPECT_SAYS(bad(head + "tangent_map = \"t\"\n"), "expected both or neither");
    EXPECT_SAYS(bad(head + "tangent_map = \"t\"\nbitangent_map = \"t\"\n"), "'map_scale' = 0");
    EXPECT_SAYS(bad(head + "tangent_map = \"t\"\nbitangent_map = \"t\"\nmap_scale = 0.3\n"),
                "expected 1, 0.5, 0.25 or 0.125");
    EXPECT_SAYS(bad(head + "normal_map = \"tt\"\n"), "did you mean 't'?");
    EXPECT_SAYS(bad(head + "units = [\"tt\"]\n"), "did you mean 't'?");
    EXPECT_SAYS(bad(head + "units = [\"t\"]\nmodel = \"abp_modified\"\n"),
                "both 'units' and 'model'");
    EXPECT_SAYS(bad(head + "[materials.inputs]\ncol0_rgb = \"vertex\"\n"),
                "without 'units' or 'combiners'");
    EXPECT_SAYS(bad(head + "units = []\n[materials.inputs]\ncol0_rgb = \"half_tangnt\"\n"),
                "did you mean 'half_tangent'?");
}

TEST_F(SceneFiles, InputsOfAProgram) {
    const Scene s = scene(R"(
[[materials]]
name = "m"
units = []
[materials.inputs]
col0_rgb = "half_tangent"
col0_a = "n_dot_l"
col1_rgb = "view_tangent"
col1_a = "h_dot_l"
half_scale = [4, 4, 1.5]
uv0 = "uv"
uv1 = "half_coded"
uv2 = "light_coded"
uv3 = "view_coded"
[[objects]]
shape = "cube"
material = "m"
)");
    const ProgramMaterial& program = s.objects.at(0).material->program.value();
    EXPECT_EQ(program.col0_rgb, ColorInput::half_tangent);
    EXPECT_EQ(program.col0_a, ColorInput::n_dot_l);
    EXPECT_EQ(program.col1_rgb, ColorInput::view_tangent);
    EXPECT_EQ(program.col1_a, ColorInput::h_dot_l);
    EXPECT_EQ(program.half_scale, glm::vec3(4.0F, 4.0F, 1.5F));
    EXPECT_EQ(program.uv[1], CoordinateInput::half_coded);
    EXPECT_EQ(program.uv[2], CoordinateInput::light_coded);
    EXPECT_EQ(program.uv[3], CoordinateInput::view_coded);
}

TEST_F(SceneFiles, RawVerticesArriveWithTheirDefaults) {
    const Scene s = scene(R"(
[[objects]]
space = "window"
primitive = "quad_strip"
depth_test = "always"
vertices = [
  { position = [10.0, 20.0, 0.5], color0_bytes = [255, 51, 0], uv0 = [0.25, 0.75] },
  { position = [1, 2, 3, 4], color0 = [0.5, 0.5, 0.5, 0.25], color1 = [1, 0, 0, 0], uv3 = [1, 2, 3, 4] },
]
)");
    const RawVertices& raw = std::get<RawVertices>(s.objects.at(0).geometry);
    EXPECT_EQ(raw.space, Space::window);
    EXPECT_EQ(raw.topology, Topology::quad_strip);
    ASSERT_EQ(raw.vertices.size(), 2U);
    EXPECT_EQ(raw.vertices[0].position, glm::vec4(10, 20, 0.5F, 1));
    EXPECT_EQ(raw.vertices[0].color0, glm::vec4(1.0F, 0.2F, 0.0F, 1.0F));
    EXPECT_EQ(raw.vertices[0].color1, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(raw.vertices[0].uv[0], glm::vec4(0.25F, 0.75F, 0, 1));
    EXPECT_EQ(raw.vertices[1].position, glm::vec4(1, 2, 3, 4));
    EXPECT_EQ(raw.vertices[1].color0.w, 0.25F);
    EXPECT_EQ(raw.vertices[1].uv[3], glm::vec4(1, 2, 3, 4));
    // Without a material the colours are shown as they are.
    const ProgramMaterial& program = s.objects.at(0).material->program.value();
    EXPECT_NO_THROW(program.combiners.validate(machine_profile("geforce256")));
    EXPECT_TRUE(program.combiners.stages.empty());
    EXPECT_EQ(program.combiners.final_combiner.a.reg, Register::col0);
    EXPECT_EQ(program.combiners.final_combiner.g.reg, Register::col0);
}

TEST_F(SceneFiles, ATextureInUnitZeroModulatesTheColour) {
    const Scene s = scene(R"(
[[textures]]
name = "t"
width = 1
height = 1
texels = [1, 2, 3, 4]
[[materials]]
name = "m"
units = ["t"]
[[objects]]
material = "m"
vertices = []
)");
    const FinalCombiner& f = s.objects.at(0).material->program->combiners.final_combiner;
    EXPECT_EQ(f.a.reg, Register::col0);
    EXPECT_EQ(f.b.reg, tex(0));
    EXPECT_EQ(f.c.reg, Register::zero);
    EXPECT_EQ(f.d.reg, Register::zero);
}

TEST_F(SceneFiles, BlendingArrivesByNameAndByFactors) {
    const auto blend = [&](const std::string& value) {
        return scene("[[objects]]\nshape = \"cube\"\nblend = " + value + "\n")
            .objects[0]
            .raster.blend;
    };
    EXPECT_FALSE(blend("\"off\""));
    EXPECT_FALSE(scene("[[objects]]\nshape = \"cube\"\n").objects[0].raster.blend);
    EXPECT_EQ(blend("\"alpha\""), Blend::alpha());
    EXPECT_EQ(blend("\"premultiplied\""), Blend::premultiplied());
    EXPECT_EQ(blend("\"add\""), Blend::add());
    EXPECT_EQ(blend("\"multiply\""), Blend::multiply());
    EXPECT_EQ(blend("{ src = \"dst_alpha\", dst = \"one_minus_constant_color\", "
                    "equation = \"reverse_subtract\", constant = [0.25, 0.5, 0.75, 1.0] }"),
              (Blend{BlendFactor::dst_alpha,
                     BlendFactor::one_minus_constant_color,
                     BlendEquation::reverse_subtract,
                     {0.25F, 0.5F, 0.75F, 1.0F}}));
    EXPECT_EQ(blend("{ equation = \"max\" }"),
              (Blend{BlendFactor::one, BlendFactor::zero, BlendEquation::max}));
}

TEST_F(SceneFiles, BlendingErrors) {
    const std::string object = "[[objects]]\nshape = \"cube\"\nblend = ";
    EXPECT_SAYS(bad(object + "\"alhpa\"\n"),
                "FILE:4: 'blend' = \"alhpa\" in [[objects]], did you mean 'alpha'?");
    EXPECT_SAYS(bad(object + "3\n"), "FILE:4: 'blend' in [[objects]] is an integer");
    EXPECT_SAYS(bad(object + "{ src = \"src_alhpa\" }\n"),
                "FILE:4: 'src' = \"src_alhpa\" in 'blend', did you mean 'src_alpha'?");
    EXPECT_SAYS(bad(object + "{ source = \"one\" }\n"), "unknown key 'source' in 'blend'");
    EXPECT_SAYS(bad(object + "{ equation = \"plus\" }\n"),
                "expected add, subtract, reverse_subtract, min, max");
    EXPECT_SAYS(bad(object + "{ constant = [0.0, 0.0, 0.0, 2.0] }\n"),
                "'constant' in 'blend' has the value 2");
}

TEST_F(SceneFiles, AlphaTests) {
    const auto test = [&](const std::string& keys) {
        return scene("[[materials]]\nname = \"m\"\nunits = []\n" + keys +
                     "[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n")
            .objects[0]
            .material->alpha_test;
    };
    EXPECT_EQ(test("").pass, Comparison::always);
    EXPECT_EQ(test("alpha_test = \"off\"\n").pass, Comparison::always);
    EXPECT_EQ(test("alpha_test = \"notequal\"\n").pass, Comparison::notequal);
    EXPECT_EQ(test("alpha_test = \"greater\"\nalpha_ref = 0.25\n").pass, Comparison::greater);
    EXPECT_EQ(test("alpha_test = \"greater\"\nalpha_ref = 0.25\n").reference, 0.25F);
    const std::string material = "[[materials]]\nname = \"m\"\n";
    EXPECT_SAYS(bad(material + "alpha_test = \"grater\"\n"), "did you mean 'greater'?");
    EXPECT_SAYS(bad(material + "alpha_test = \"less\"\nalpha_ref = 1.5\n"), "FILE:5: ");
    EXPECT_SAYS(bad(material + "alpha_ref = 0.5\n"),
                "'alpha_ref' in [[materials]] without 'alpha_test'");
}

TEST_F(SceneFiles, ObjectErrors) {
    EXPECT_SAYS(bad("[[objects]]\n"), "0 of 'mesh', 'shape' and 'vertices'");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"cube\"\nvertices = []\n"), "2 of");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"knoot\"\n"), "did you mean 'knot'?");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n"),
                "unknown material 'm', there is none");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"cube\"\nspace = \"clip\"\n"), "without 'vertices'");
    EXPECT_SAYS(bad("[[objects]]\nvertices = []\nrows = 2\n"), "without 'shape'");
    EXPECT_SAYS(bad("[[objects]]\nvertices = []\nspace = \"clip\"\nscale = 2\n"), "moves nothing");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"cube\"\nrotate = [0, 0, 0, 30]\n"), "axis");
    EXPECT_SAYS(bad("[[objects]]\nshape = \"cube\"\nscale = 0\n"), "above 0");
    EXPECT_SAYS(bad("[[objects]]\nvertices = [{}]\n"), "no 'position'");
    EXPECT_SAYS(
        bad("[[objects]]\nvertices = [{ position = [0,0,0], color0 = [0,0,0], color0_bytes = "
            "[0,0,0] }]\n"),
        "both 'color0' and 'color0_bytes'");
    EXPECT_SAYS(
        bad("[[materials]]\nname = \"m\"\nmodel = \"abp_modified\"\n[[objects]]\nvertices = "
            "[]\nmaterial = \"m\"\n"),
        "raw vertices with the model");
    const Complaint missing = complaint("[[objects]]\nmesh = \"no.obj\"\n");
    EXPECT_EQ(missing.code, ErrorCode::io);
    EXPECT_SAYS(missing.text, "FILE:3: ");
}

TEST_F(SceneFiles, PlacementScalesThenTurnsThenMoves) {
    const Scene s = scene(
        "[[objects]]\nshape = \"cube\"\ntranslate = [10, 0, 0]\nrotate = [0, 0, 5, 90]\nscale = "
        "2\n");
    const glm::vec4 moved = s.objects.at(0).world_from_object * glm::vec4(1, 0, 0, 1);
    EXPECT_NEAR(moved.x, 10.0F, 1e-6F);
    EXPECT_NEAR(moved.y, 2.0F, 1e-6F);
    EXPECT_NEAR(moved.z, 0.0F, 1e-6F);
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

TEST(Placement, IsARotationWithUniformScale) {
    const glm::mat4 m = placement({1, 2, 3}, {1, 1, 0}, 77.0F, 3.0F);
    EXPECT_EQ(m[3], glm::vec4(1, 2, 3, 1));
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(glm::dot(glm::vec3(m[i]), glm::vec3(m[j])), i == j ? 9.0F : 0.0F, 1e-5F);
    }
    EXPECT_GT(glm::determinant(m), 0.0F);
    // The axis stays where it is, 3 times as long.
    const glm::vec3 axis = glm::vec3(m * glm::vec4(1, 1, 0, 0));
    EXPECT_NEAR(axis.x, 3.0F, 1e-5F);
    EXPECT_NEAR(axis.y, 3.0F, 1e-5F);
}

TEST(Placement, QuarterTurnsAreExact) {
    const glm::mat4 m = placement({0, 0, 0}, {0, 0, 1}, 90.0F, 1.0F);
    EXPECT_NEAR(m[0][1], 1.0F, 0.0F);
    EXPECT_NEAR(m[0][0], 0.0F, 1e-16F);
    EXPECT_EQ(placement({0, 0, 0}, {0, 1, 0}, 0.0F, 1.0F), glm::mat4(1.0F));
    EXPECT_EQ(placement({0, 0, 0}, {0, 1, 0}, 725.0F, 1.0F),
              placement({0, 0, 0}, {0, 1, 0}, 5.0F, 1.0F));
}

TEST(Placement, RefusesWhatIsNoPlacement) {
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 0}, 1.0F, 1.0F), Error);
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 1}, 1.0F, 0.0F), Error);
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 1}, 1.0F, -1.0F), Error);
}

TEST(FramingCamera, SeesEveryCornerFromItsDirection) {
    for (const float aspect : {16.0F / 9.0F, 1.0F, 0.4F}) {
        const Bounds bounds{{-3, 1, 2}, {5, 4, 2.5F}};
        const Camera camera = framing_camera(bounds, aspect);
        const glm::vec3 arm = camera.position - camera.focal_point;
        EXPECT_NEAR(arm.x / arm.z, 0.5F, 1e-5F);
        EXPECT_NEAR(arm.y / arm.z, 0.35F, 1e-5F);
        const glm::vec3 forward = -arm / std::sqrt(glm::dot(arm, arm));
        const glm::vec3 side = glm::normalize(glm::cross(forward, camera.view_up));
        const glm::vec3 up = glm::cross(side, forward);
        const float slope = std::tan(camera.view_angle * 3.14159265F / 360.0F);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
                              (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                              (corner & 4) != 0 ? bounds.high.z : bounds.low.z};
            const glm::vec3 d = p - camera.position;
            const float depth = glm::dot(d, forward);
            EXPECT_GT(depth, camera.near);
            EXPECT_LT(depth, camera.far);
            EXPECT_LE(std::abs(glm::dot(d, up)), slope * depth);
            EXPECT_LE(std::abs(glm::dot(d, side)), slope * aspect * depth);
        }
    }
}

TEST(FramingCamera, APointStillGetsACamera) {
    const Camera camera = framing_camera({{1, 2, 3}, {1, 2, 3}}, 1.5F);
    EXPECT_EQ(camera.focal_point, glm::vec3(1, 2, 3));
    EXPECT_GT(camera.near, 0.0F);
    EXPECT_GT(camera.far, camera.near);
    EXPECT_NE(camera.position, camera.focal_point);
}

}  // namespace
}  // namespace burnish
