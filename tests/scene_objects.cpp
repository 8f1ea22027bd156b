// Textures, materials and objects of scene files as they arrive, and what is said of wrong ones.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/scene_file.hpp"

namespace burnish {
namespace {

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

}  // namespace
}  // namespace burnish
