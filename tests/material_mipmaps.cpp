#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "models/layer.hpp"
#include "models/mips/parameter_mips.hpp"
#include "models/texel.hpp"
#include "reference/level_of_detail.hpp"
#include "reference/render_double.hpp"
#include "reference/surface_cache.hpp"
#include "reference/surface_sampler.hpp"
#include "tests/scene_file.hpp"

namespace burnish {
namespace {

Material weave(std::optional<MaterialMipmaps> mipmaps, int size = 32) {
    Material m = generated_material("weave", 1, size);
    m.mipmaps = mipmaps;
    return m;
}

TEST(MaterialMipmaps, TexelsHaveTheLevelsOfTheMethod) {
    const TexelSource plain(weave({})), none(weave(MaterialMipmaps{})),
        source(weave(MaterialMipmaps{MipMethod::moments, 16}));
    EXPECT_EQ(plain.levels(), 1);
    EXPECT_EQ(none.levels(), 1);
    ASSERT_EQ(source.levels(), 6);
    EXPECT_EQ(plain.sampler().filter, Filter::linear);
    EXPECT_EQ(source.sampler().filter, Filter::linear_mipmap_linear);
    EXPECT_EQ(source.width(2), 8);
    EXPECT_EQ(source.height(5), 1);
    EXPECT_EQ(source.at(0, 3, 4).n, source.at(3, 4).n);
    const auto levels = mips::parameter_mips([&](int x, int y) { return plain.at(x, y); }, 32, 32,
                                             mips::LobeShape(weave({})), {MipMethod::moments, 16});
    EXPECT_EQ(source.at(2, 7, 1).alpha_x, levels[1].at(7, 1).alpha_x);
}

// A material is worked out once while every frame has it.
TEST(SurfaceCache, KeepsWhatIsDrawnAgain) {
    const auto drawn =
        std::make_shared<const Material>(weave(MaterialMipmaps{MipMethod::moments, 16}));
    const auto same = std::make_shared<const Material>(*drawn);
    reference::SurfaceCache cache;
    const auto first = cache.of(drawn).surface;
    ASSERT_TRUE(first);
    EXPECT_NE(cache.of(same).surface, first) << "a material is what it is, not what it has";
    cache.drop_unused();
    EXPECT_EQ(cache.of(drawn).surface, first);
    cache.drop_unused();
    cache.drop_unused();
    EXPECT_NE(cache.of(drawn).surface, first) << "a frame was without it";
}

TEST(SurfaceCache, ForgetsWhatNobodyElseHas) {
    auto drawn = std::make_shared<const Material>(weave(MaterialMipmaps{MipMethod::moments, 16}));
    reference::SurfaceCache cache;
    const std::weak_ptr<const reference::SurfaceSampler> kept = cache.of(drawn).surface;
    cache.drop_orphans();
    EXPECT_FALSE(kept.expired());
    drawn.reset();
    cache.drop_orphans();
    EXPECT_TRUE(kept.expired());
}

TEST(SurfaceCache, FramesBeforeMakeNoDifference) {
    Scene scene;
    scene.machine = machine_profile("double");
    scene.lights.push_back({.position = {0.3F, 0.8F, 0.5F}, .position_w = 0.0F});
    scene.objects.push_back({Mesh(shapes::sphere(16, 8)), nullptr, glm::mat4(1.0F), {}});
    Renderer renderer({.threads = 2});
    for (const MipMethod method : {MipMethod::moments, MipMethod::none, MipMethod::moments}) {
        scene.objects[0].material =
            std::make_shared<const Material>(weave(MaterialMipmaps{method}, 64));
        Framebuffer want(40, 30), got(40, 30);
        Renderer({.threads = 1}).render(scene, want);
        for (int frame = 0; frame < 2; ++frame) {
            renderer.render(scene, got);
            EXPECT_EQ(
                std::memcmp(got.row(0), want.row(0), static_cast<std::size_t>(got.pitch()) * 30),
                0);
        }
    }
}

// Maps with levels of their own, and a material that says nothing: what a machine keeps is
// averaged.
TEST(MaterialMipmaps, WithoutAWordLevelsOfMapsAverageTheLayer) {
    Material m = weave({});
    const Image8 image(32, 32);
    m.normal_map = std::make_shared<const Texture>(
        std::span(&image, 1),
        TextureDescription{.sampler = {.filter = Filter::linear_mipmap_linear},
                           .box_mipmaps = true});
    EXPECT_TRUE(TexelSource(m).averages_layer());
    EXPECT_EQ(TexelSource(m).levels(), 1);
    m.mipmaps = MaterialMipmaps{};
    EXPECT_FALSE(TexelSource(m).averages_layer());
    m.normal_map = nullptr;
    m.mipmaps.reset();
    EXPECT_FALSE(TexelSource(m).averages_layer());
}

TEST(MaterialMipmaps, TexturesOfTheLayerHoldTheLevels) {
    const Material m = weave(MaterialMipmaps{MipMethod::moments});
    const TexelSource source(m);
    int seen = 0;
    for (const LayerQuantity& q : material_layer(m, machine_profile("ideal"))) {
        if (q.name != "X" && q.name != "Y") continue;
        ++seen;
        ASSERT_TRUE(q.texture);
        ASSERT_EQ(q.texture->levels().size(), 6U);
        for (int level = 0; level < 6; ++level) {
            const TexelParameters p = source.at(level, 0, 0);
            glm::dvec3 x;
            for (int c = 0; c < 3; ++c)
                x[c] = q.texture->texel(static_cast<std::size_t>(level), 0, 0, 0, q.channel + c) /
                       65535.0;
            const glm::dvec3 want = q.name == "X" ? p.t / p.alpha_x : p.b / p.alpha_y;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.decoded(x)[c], want[c], 0.003);
        }
    }
    EXPECT_EQ(seen, 2);
}

// log2 of the longer step in texels.
TEST(LevelsSeen, FollowTheSampler) {
    const auto seen = [](double texels, Filter filter, float bias = 0.0F) {
        return reference::levels_seen({{texels / 64.0, 0.0}, {0.0, 0.5 / 32.0}}, 64, 32, 6,
                                      {.filter = filter, .lod_bias = bias});
    };
    const auto trilinear = seen(6.0, Filter::linear_mipmap_linear);
    EXPECT_EQ(trilinear.first, 2);
    EXPECT_EQ(trilinear.second, 3);
    EXPECT_NEAR(trilinear.weight, std::log2(1.5), 1e-12);
    EXPECT_NEAR(seen(6.0, Filter::linear_mipmap_linear, 1.0F).weight, std::log2(1.5), 1e-12);
    EXPECT_EQ(seen(6.0, Filter::linear_mipmap_linear, 1.0F).first, 3);
    EXPECT_EQ(seen(6.0, Filter::nearest_mipmap_nearest).first, 3);
    EXPECT_EQ(seen(5.0, Filter::nearest_mipmap_nearest).first, 2);
    EXPECT_FALSE(seen(5.0, Filter::nearest_mipmap_nearest).linear);
    EXPECT_EQ(seen(1e9, Filter::linear_mipmap_linear).second, 5);
    EXPECT_EQ(seen(1e9, Filter::linear_mipmap_linear).weight, 0.0);
    EXPECT_EQ(seen(1e9, Filter::linear).first, 0);
    EXPECT_EQ(seen(1.0, Filter::linear_mipmap_linear).second, 0) << "magnified";
    EXPECT_EQ(seen(NAN, Filter::linear_mipmap_linear).first, 0);
}

// Probes share the longer step among them, at i / (N + 1) - 1/2 of it.
TEST(LevelsSeen, ProbesFollowTheLongerStep) {
    const auto seen = [](double across, double down, int most) {
        return reference::levels_seen(
            {{across / 64.0, 0.0}, {0.0, down / 64.0}}, 64, 64, 7,
            {.filter = Filter::linear_mipmap_linear, .max_anisotropy = most});
    };
    EXPECT_EQ(seen(2.0, 16.0, 1).probes, 1);
    EXPECT_EQ(seen(2.0, 16.0, 1).first, 4);
    const auto eight = seen(2.0, 16.0, 16);
    EXPECT_EQ(eight.probes, 8);
    EXPECT_EQ(eight.first, 1);
    EXPECT_EQ(eight.weight, 0.0);
    EXPECT_EQ(eight.apart, glm::dvec2(0.0, 16.0 / 64.0 / 9.0));
    EXPECT_EQ(seen(2.0, 16.0, 4).probes, 4);
    EXPECT_EQ(seen(2.0, 16.0, 4).first, 2);
    EXPECT_EQ(seen(12.0, 4.0, 16).apart, glm::dvec2(12.0 / 64.0 / 4.0, 0.0));
    EXPECT_EQ(seen(0.1, 4.0, 16).probes, 4) << "a texel is the shortest that counts";
    EXPECT_EQ(seen(0.1, 0.9, 16).probes, 1) << "magnified";
    EXPECT_EQ(seen(4.0, std::nextafter(4.0, 5.0), 16).probes, 1) << "as wide as it is high";
    EXPECT_EQ(seen(4.0, 8.02, 16).probes, 3);
    EXPECT_EQ(seen(NAN, 4.0, 16).probes, seen(NAN, 4.0, 1).probes);
    // The mean of what the probes see: of a ramp along v the middle.
    const auto ramp = reference::filtered(
        {0.5, 0.5}, eight, {.wrap_t = Wrap::clamp_to_edge},
        [](int level) { return glm::ivec2(64 >> level); },
        [](int level, int, int y) { return (y + 0.5) / (64 >> level); });
    EXPECT_NEAR(ramp, 0.5, 1e-12);
}

/// A floor towards the horizon.
Scene floor(const Material& material) {
    Scene scene;
    scene.format = PixelFormat::rgba32f;
    scene.camera.position = {0.0F, -1.2F, 0.25F};
    scene.camera.focal_point = {0.0F, 0.0F, 0.0F};
    scene.camera.near = 0.05F;
    Light light;
    light.position = {0.1F, 1.0F, 0.6F};
    scene.lights.push_back(light);
    Object object;
    object.geometry = Mesh(shapes::plane(1, 1));
    object.material = std::make_shared<const Material>(material);
    scene.objects.push_back(std::move(object));
    return scene;
}

double rms_difference(const Framebuffer& a, const Framebuffer& b) {
    double sum = 0.0;
    for (int y = 0; y < a.height(); ++y) {
        for (int i = 0; i < 4 * a.width(); ++i) {
            float p, q;
            std::memcpy(&p, a.row(y) + 4 * i, sizeof p);
            std::memcpy(&q, b.row(y) + 4 * i, sizeof q);
            sum += static_cast<double>(p - q) * static_cast<double>(p - q);
        }
    }
    return std::sqrt(sum / (4.0 * a.width() * a.height()));
}

Framebuffer drawn(const Scene& scene, int samples = 1) {
    Framebuffer frame(64, 48, PixelFormat::rgba32f);
    Renderer renderer({.threads = 1, .double_samples = samples});
    renderer.render(scene, frame);
    return frame;
}

TEST(MaterialMipmaps, MachinesAndFormulasSeeTheSameLevels) {
    for (const MaterialMipmaps& mipmaps :
         {MaterialMipmaps{MipMethod::box}, MaterialMipmaps{MipMethod::moments},
          MaterialMipmaps{MipMethod::moments, 0, 4}, MaterialMipmaps{MipMethod::box, 0, 16}}) {
        Scene scene = floor(weave(mipmaps, 128));
        const Framebuffer machine = drawn(scene);
        scene.machine = machine_profile("double");
        EXPECT_LT(rms_difference(machine, drawn(scene)), 0.0015) << mipmaps.max_anisotropy;
    }
}

// What mip levels are for. The truth has 64 samples of level 0.
TEST(MaterialMipmaps, LevelsAreNearerToTheTruthThanNone) {
    Scene scene = floor(weave(MaterialMipmaps{}, 128));
    scene.machine = machine_profile("double");
    const Framebuffer truth = drawn(scene, 64);
    const auto error = [&](MipMethod method) {
        Scene tried = floor(weave(MaterialMipmaps{method}, 128));
        tried.machine = scene.machine;
        return rms_difference(drawn(tried), truth);
    };
    const double none = error(MipMethod::none), box = error(MipMethod::box),
                 moments = error(MipMethod::moments);
    EXPECT_LT(moments, 0.5 * none);
    EXPECT_LT(moments, 0.9 * box);
    Scene probed = floor(weave(MaterialMipmaps{MipMethod::moments, 0, 16}, 128));
    EXPECT_LT(rms_difference(drawn(probed), truth), moments) << "the machine's";
    probed.machine = scene.machine;
    EXPECT_LT(rms_difference(drawn(probed), truth), moments);
    probed = floor(weave(MaterialMipmaps{MipMethod::box, 0, 16}, 128));
    EXPECT_LT(rms_difference(drawn(probed), truth), 0.9 * box) << "the machine's";
}

/// What a call leaves, should it be stopped.
template <class Call>
bool was_stopped(const Call& call) {
    try {
        call();
        return false;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::stopped) << error.what();
        return true;
    }
}

// Maps of 64 rows have 63 more in their levels, and a machine's program goes twice through all 127:
// the caller is asked at each. A stopped frame leaves the next one's bits alone.
TEST(MaterialMipmaps, MakingThemEndsWhenNobodyWantsThem) {
    Scene scene = floor(weave(MaterialMipmaps{MipMethod::moments}, 64));
    scene.width = 64;
    scene.height = 48;
    for (const auto& [profile, rows] :
         {std::pair{"double", 63}, std::pair{"ideal", 63 + 2 * 127}}) {
        scene.machine = machine_profile(profile);
        const Framebuffer want = drawn(scene);
        Framebuffer got(64, 48, PixelFormat::rgba32f);
        int asked = 0, last = std::numeric_limits<int>::max();
        const RendererOptions options{.threads = 1, .stop = [&] { return ++asked >= last; }};
        Renderer(options).render(scene, got);
        EXPECT_GE(asked, rows) << profile;
        for (int fifth = 0; fifth < 5; ++fifth) {
            Renderer renderer(options);
            asked = 0;
            last = 1 + fifth * rows / 5;
            EXPECT_TRUE(was_stopped([&] { renderer.render(scene, got); })) << last;
            EXPECT_EQ(asked, last) << "it went on";
            last = std::numeric_limits<int>::max();
            renderer.render(scene, got);
            EXPECT_EQ(rms_difference(got, want), 0.0) << profile << ", " << fifth;
        }
    }
    int asked = 0;
    EXPECT_TRUE(was_stopped([&] { trace_pixel(scene, 32, 40, [&] { return ++asked >= 100; }); }));
    EXPECT_EQ(asked, 100);
}

// A model that one pass has no room for is compiled again, to tell in how many it would fit.
TEST(MaterialMipmaps, AStoppedCompilationIsNoRefusal) {
    Scene scene = floor(weave(std::nullopt, 64));
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    material->model = Model::abp;
    scene.objects[0].material = material;
    scene.machine = machine_profile("geforce256");
    Framebuffer frame(scene.width, scene.height);
    int asked = 0, last = std::numeric_limits<int>::max();
    const RendererOptions options{.threads = 1, .stop = [&] { return ++asked >= last; }};
    EXPECT_THROW(Renderer(options).render(scene, frame), Error);
    const int all = asked;
    EXPECT_GT(all, 2 * 64);
    for (last = all; last > 0; last -= 16) {
        asked = 0;
        EXPECT_TRUE(was_stopped([&] { Renderer(options).render(scene, frame); })) << last;
    }
}

class SceneMipmaps : public SceneFile {
  protected:
    std::optional<MaterialMipmaps> mipmaps(const std::string& material,
                                           const std::string& texture = "") {
        return scene("[[textures]]\nname = \"n\"\ngenerator = \"weave\"\nsize = 8\n" + texture +
                     "[[textures]]\nname = \"lean\"\ngenerator = \"weave\"\nmap = \"direction\"\n"
                     "size = 8\nmipmaps = \"lean\"\n"
                     "[[materials]]\nname = \"m\"\n" +
                     material + "[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n")
            .objects.at(0)
            .material->mipmaps;
    }
    std::string complaint(const std::string& material, const std::string& texture = "") {
        return complaint_of([&] { mipmaps(material, texture); });
    }
};

TEST_F(SceneMipmaps, MaterialsOrTheirMapsNameTheMethod) {
    using Mipmaps = MaterialMipmaps;
    const std::string model = "model = \"abp\"\nnormal_map = \"n\"\n";
    EXPECT_FALSE(mipmaps(model));
    EXPECT_EQ(mipmaps(model + "mipmaps = \"moments\"\n"), (Mipmaps{MipMethod::moments, 0}));
    EXPECT_EQ(mipmaps(model + "mipmaps = \"lean\"\nmipmap_bits = 8\n"),
              (Mipmaps{MipMethod::lean, 8}));
    EXPECT_EQ(mipmaps(model + "mipmaps = \"none\"\n"), Mipmaps{});
    EXPECT_EQ(mipmaps(model, "mipmaps = \"toksvig\"\n"), (Mipmaps{MipMethod::toksvig, 0}));
    EXPECT_EQ(mipmaps(model + "mipmap_bits = 16\n", "mipmaps = \"clean\"\n"),
              (Mipmaps{MipMethod::clean, 16}));
    EXPECT_EQ(mipmaps(model + "mipmaps = \"mag\"\n", "mipmaps = \"toksvig\"\n"),
              (Mipmaps{MipMethod::mag, 0}));
    EXPECT_FALSE(mipmaps(model, "mipmaps = \"box\"\n")) << "the texture's own levels";
    EXPECT_EQ(mipmaps("kd = { map = \"n\" }\n", "mipmaps = \"mag\"\n"),
              (Mipmaps{MipMethod::mag, 0}));
}

TEST_F(SceneMipmaps, ErrorsSayWhatIsExpected) {
    const std::string model = "model = \"abp\"\nnormal_map = \"n\"\n";
    EXPECT_SAYS(complaint(model + "mipmaps = \"moment\"\n"),
                "'mipmaps' = \"moment\" in [[materials]], did you mean 'moments'?");
    EXPECT_SAYS(complaint(model, "mipmaps = \"toxvig\"\n"), "did you mean 'toksvig'?");
    EXPECT_SAYS(complaint(model + "mipmaps = \"lean\"\nmipmap_bits = 12\n"),
                "'mipmap_bits' = 12 in [[materials]], expected 8, 16 or 32");
    EXPECT_SAYS(complaint(model + "mipmap_bits = 8\n"), "mipmaps");
    EXPECT_SAYS(complaint(model + "direction_map = \"lean\"\n", "mipmaps = \"moments\"\n"),
                "'direction_map' in [[materials]] has other 'mipmaps' than the maps before it");
    EXPECT_SAYS(complaint("units = [\"lean\"]\n"), "'units' in [[materials]] names 'lean'");
    EXPECT_SAYS(complaint("units = [\"n\"]\nmipmaps = \"lean\"\n"), "which is a pipeline");
}

}  // namespace
}  // namespace burnish
