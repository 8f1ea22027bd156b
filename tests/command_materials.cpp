#include <gtest/gtest.h>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "models/texel.hpp"
#include "tests/run_command.hpp"

namespace burnish {
namespace {

TEST_F(Command, BakedMaterialIsTheGeneratedOne) {
    for (const std::string name : {"weave", "lathe", "brushed"}) {
        ASSERT_EQ(run("bake material " + name + " --seed 5 --size 16 -o out/" + name).code, 0);
        const TexelSource read(load_material(path("out") / name / "material.toml"));
        const TexelSource made(generated_material(name, 5, 16));
        ASSERT_EQ(read.width(), 16);
        EXPECT_EQ(read.sampler().wrap_s, made.sampler().wrap_s);
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const TexelParameters a = read.at(x, y), b = made.at(x, y);
                ASSERT_EQ(a.n, b.n);
                ASSERT_EQ(a.t, b.t);
                ASSERT_EQ(a.alpha_x, b.alpha_x);
                ASSERT_EQ(a.alpha_y, b.alpha_y);
                ASSERT_EQ(a.exponent, b.exponent);
                ASSERT_EQ(a.kd, b.kd);
                ASSERT_EQ(a.ks, b.ks);
            }
        }
    }
}

TEST_F(Command, BakedLevelsAreThoseOfTheMethod) {
    ASSERT_EQ(run("bake mips --set weave --seed 3 --size 12 --method moments --bits 16 -o m").code,
              0);
    Material made = generated_material("weave", 3, 12);
    made.mipmaps = MaterialMipmaps{MipMethod::moments, 16};
    const TexelSource want(made), read(load_material(path("m/material.toml")));
    ASSERT_EQ(read.levels(), 4);
    const auto expect_near = [](const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(a[c], b[c], tolerance);
    };
    for (int level = 0; level < 4; ++level) {
        ASSERT_EQ(read.width(level), want.width(level));
        for (int y = 0; y < want.height(level); ++y) {
            for (int x = 0; x < want.width(level); ++x) {
                const TexelParameters a = read.at(level, x, y), b = want.at(level, x, y);
                expect_near(a.n, b.n, 5e-5);
                expect_near(a.t, b.t, 1e-4);
                expect_near(a.ks, b.ks, 2e-5);
                expect_near(a.kd, b.kd, 2e-5);
                expect_near({a.alpha_x, a.alpha_y, 0.0}, {b.alpha_x, b.alpha_y, 0.0}, 2e-5);
                ASSERT_NEAR(a.exponent, b.exponent, 1e-3);
            }
        }
    }
    // The baked file itself is a material like any other.
    ASSERT_EQ(run("bake mips m/material.toml --method lean -o n").code, 0);
    EXPECT_EQ(TexelSource(load_material(path("n/material.toml"))).levels(), 4);
    EXPECT_EQ(run("bake mips -o n").code, 2);
    EXPECT_EQ(run("bake mips --set weave --method maps -o n").code, 2);
    EXPECT_EQ(run("bake mips missing.toml -o n").code, 3);
}

TEST_F(Command, BakedMaterialBringsItsTruth) {
    ASSERT_EQ(run("bake material lathe --size 8 -o d").code, 0);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path("d")))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"alpha.png", "direction.png", "ks.png",
                                               "material.toml", "normal.png", "truth_direction.exr",
                                               "truth_kd.exr", "truth_ks.exr", "truth_normal.exr",
                                               "truth_parameters.exr"}));
    // As bytes, an EXR's numbers of 0 .. 1 are rounded: the widths of the texel in the corner.
    const GeneratedSet set = generated_set("lathe", 1, 8);
    const Image8 truth = load_image(path("d/truth_parameters.exr"));
    EXPECT_NEAR(truth.at(0, 0)[0], 255.0F * set.alpha_x[0], 0.51F);
    EXPECT_NEAR(truth.at(0, 0)[1], 255.0F * set.alpha_y[0], 0.51F);
}

TEST_F(Command, BakeMaterialErrors) {
    expect_failure("bake material lath -o d", 2, "material lath, did you mean 'lathe'?");
    expect_failure("bake material lathe --size 4096 -o d", 2, "--size");
    expect_failure("bake material lathe", 2, "--output");
    write(path("file"), "");
    expect_failure("bake material lathe --size 4 -o file/d", 3, "file/d");
}

TEST_F(Command, MaterialAndModelReplaceThoseOfEveryMesh) {
    write_scene("s.toml");
    write(path("red.toml"), "schema = 1\n[material]\nkd = [1, 0, 0]\nks = 0\nalpha_x = 0.5\n");
    ASSERT_EQ(run("render s.toml -o plain.png").code, 0);
    ASSERT_EQ(run("render s.toml --material red.toml -o red.png").code, 0);
    const Image8 red = load_image(path("red.png"));
    bool lit = false;
    for (std::size_t i = 0; i < red.rgba.size(); i += 4) {
        const bool background = red.rgba[i + 2] == 153;  // 0.6
        if (background) continue;
        EXPECT_EQ(red.rgba[i + 1], 0);
        lit = lit || red.rgba[i] > 128;
    }
    EXPECT_TRUE(lit);
    EXPECT_TRUE(read(path("plain.png")) != read(path("red.png")));
    EXPECT_EQ(run("render s.toml --model abp_modified -o same.png").code, 0);
    EXPECT_TRUE(read(path("plain.png")) == read(path("same.png")));
    expect_failure("render s.toml --model wrd", 2, "--model wrd, did you mean 'ward'?");
    expect_failure("render s.toml --material none.toml", 3, "none.toml: No such file");
    write(path("pipe.toml"), "schema = 1\n[material]\nunits = []\n");
    expect_failure("render s.toml --material pipe.toml --model ward", 2,
                   "material 'pipe' is a pipeline");
}

TEST_F(Command, AnisotropyAsNumbers) {
    // 0.25 * 0.64 + 0.36 along the direction, 0.25 across it.
    EXPECT_EQ(run("bake anisotropy --roughness 0.5 --strength 0.6").out,
              "alpha_x = 0.52\nalpha_y = 0.25\ndirection = 0\n");
    const Result json = run("bake anisotropy --alpha-x 0.25 --alpha-y 0.52 --json");
    EXPECT_SAYS(json.out, "\"roughnessFactor\": 0.5, \"anisotropyStrength\": 0.6");
    EXPECT_SAYS(json.out, "\"anisotropyRotation\": 1.570796") << "across our tangent";
    expect_failure("bake anisotropy", 2, "expected one of");
    expect_failure("bake anisotropy --roughness 0.5 --alpha-x 0.5", 2, "expected one of");
    expect_failure("bake anisotropy --alpha-x 0.5", 2, "expected --alpha-x and --alpha-y");
    expect_failure("bake anisotropy --rotation nan", 2, "");
    expect_failure("bake anisotropy --texture t.png", 2, "textures need -o DIR");
    expect_failure("bake anisotropy --texture t.png -o d", 3, "t.png");
    expect_failure("bake anisotropy --roughness-texture t.png --roughness 1", 2,
                   "without --texture");
}

TEST_F(Command, AnisotropyAsTexturesThereAndBack) {
    write(path("m.toml"),
          "schema = 1\n[material]\nalpha_x = 0.25\nalpha_y = 0.52\ndirection = 30\n");
    ASSERT_EQ(run("bake anisotropy --material m.toml -o gltf").code, 0);
    const Image8 texture = load_image(path("gltf/anisotropy.png"));
    // Across a tangent at 30 degrees: 120, which as a line is -60: (0.5, -0.866).
    EXPECT_NEAR(texture.at(0, 0)[0], 127.5 * 1.5, 1.0);
    EXPECT_NEAR(texture.at(0, 0)[1], 127.5 * (1.0 - 0.8660), 1.0);
    EXPECT_EQ(texture.at(0, 0)[2], 153);  // 0.6
    EXPECT_NEAR(load_image(path("gltf/roughness.png")).at(0, 0)[1], 127.5, 1.0);
    ASSERT_EQ(run("bake anisotropy --texture gltf/anisotropy.png --roughness-texture "
                  "gltf/roughness.png -o ours")
                  .code,
              0);
    const TexelParameters p = TexelSource(load_material(path("ours/material.toml"))).at(0, 0);
    EXPECT_NEAR(p.alpha_x, 0.52, 0.005);
    EXPECT_NEAR(p.alpha_y, 0.25, 0.005);
    EXPECT_NEAR(p.t.x, 0.5, 0.02);
    EXPECT_NEAR(p.t.y, -0.866, 0.02);
}

TEST_F(Command, ProbesOfEveryMaterialWithLevels) {
    write(path("floor.toml"), R"(schema = 1
[output]
width = 32
height = 16
[camera]
position = [0, -1.2, 0.25]
focal_point = [0, 0, 0]
near = 0.05
[[lights]]
position = [0.1, 1, 0.6]
[[materials]]
name = "m"
model = "abp"
generator = "weave"
size = 64
[[objects]]
shape = "plane"
material = "m"
)");
    const auto picture = [&](const std::string& options) {
        const Result result =
            run("render floor.toml -o f.png --machine ideal --mipmaps box " + options);
        EXPECT_EQ(result.code, 0) << result.err;
        return load_image(path("f.png")).rgba;
    };
    const auto one = picture(""), four = picture("--max-anisotropy 4");
    EXPECT_TRUE(four != one);
    EXPECT_TRUE(picture("--max-anisotropy 1") == one);
    EXPECT_TRUE(picture("-D materials.m.mipmaps=box -D materials.m.max_anisotropy=4") == four);
    const std::string floor = "render floor.toml -o f.png --machine ideal ";
    expect_failure(floor + "--max-anisotropy 4", 2, "without mip levels of a material");
    expect_failure(floor + "--mipmaps box --max-anisotropy 17", 2, "--max-anisotropy");
    expect_failure(floor + "--mipmaps box --max-anisotropy 4 --filter-order after", 3,
                   "max_anisotropy 4 of a texture on a machine with filter_order = after");
}

/// Those that show the library, but for what is drawn.
TEST_F(Command, ScenesOfTheLibraryAreRead) {
    for (const char* name : {"ward", "fibres", "generated", "generated_spheres"}) {
        const LoadedScene loaded = load_scene(std::filesystem::path(BURNISH_SOURCE_DIR) / "meshes" /
                                              (std::string(name) + ".toml"));
        EXPECT_GE(loaded.scene.objects.size(), 8U);
    }
}

}  // namespace
}  // namespace burnish
