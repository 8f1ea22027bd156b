// Tables of functions that change from pixel to pixel: in double precision and on machines.
#include "reference/power_filter.hpp"

#include <gtest/gtest.h>
#include <burnish/materials.hpp>
#include <burnish/program_text.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>

#include <cmath>
#include <cstring>

#include "core/cpu.hpp"
#include "tests/scene_file.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

using reference::mean_power;
using reference::mip_power;

double sampled_mean(double low, double high, double m) {
    constexpr int steps = 20000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
        sum += std::pow(std::max(low + (high - low) * (i + 0.5) / steps, 0.0), m);
    return sum / steps;
}

TEST(MeanPower, IsTheMeanOfManySamples) {
    for (const double m : {0.0, 0.5, 1.0, 8.0, 256.0}) {
        EXPECT_NEAR(mean_power(0.2, 0.9, m), sampled_mean(0.2, 0.9, m), 1e-6);
        EXPECT_NEAR(mean_power(0.99, 1.0, m), sampled_mean(0.99, 1.0, m), 1e-6);
        EXPECT_EQ(mean_power(0.7, 0.7, m), std::pow(0.7, m));
        EXPECT_NEAR(mean_power(0.7, 0.7 + 1e-6, m), std::pow(0.7, m), 1e-6 * (m + 1.0));
        // 0^0 is 1, so of m = 0 the sum is another one below 0.
        if (m == 0.0) continue;
        EXPECT_NEAR(mean_power(-0.5, 0.5, m), sampled_mean(-0.5, 0.5, m), 1e-4);
    }
    EXPECT_EQ(mean_power(-0.5, -0.1, 3.0), 0.0);
}

TEST(MipPower, LevelsAreMeansOfTwo) {
    EXPECT_EQ(mip_power(51.0 / 255.0, 0.0, 3.0), std::pow(51.0 / 255.0, 3.0)) << "a texel";
    EXPECT_NEAR(mip_power(0.5, 1.0 / 256.0, 1.0), 0.5, 1e-12) << "magnified: between two";
    // Level 4: 16 texels. Between texel centres, s = 7.5 / 255 is the middle of its first one.
    EXPECT_NEAR(mip_power(7.5 / 255.0, 16.0 / 256.0, 2.0), sampled_mean(0.0, 15.0 / 255.0, 2.0),
                1e-4);
    EXPECT_NEAR(mip_power(0.3, 1e9, 1.0), 0.5, 1e-12) << "one texel for all";
    EXPECT_EQ(mip_power(-3.0, 0.0, 2.0), 0.0);
    for (const double s : {0.1, 0.5, 0.95})
        EXPECT_NEAR(mip_power(s, 0.05, 4.0), mean_power(s - 0.025, s + 0.025, 4.0), 0.02);
}

/// A sphere with a lobe narrower than a pixel.
Scene glint_scene(TableFilter filter, float turn) {
    Scene scene;
    scene.machine = machine_profile("double");
    scene.machine.table_filter = filter;
    scene.background = glm::vec4(0.0F);
    Light light;
    light.position = {0.4F + turn, 0.5F, 0.8F};
    scene.lights.push_back(light);
    Material material;
    material.model = Model::abp;
    material.alpha_x = 0.3F;
    material.alpha_y = 0.6F;
    material.exponent = 1024.0F;
    Object object;
    object.geometry = Mesh(shapes::sphere(48, 24));
    object.material = std::make_shared<const Material>(material);
    scene.objects.push_back(std::move(object));
    return scene;
}

Framebuffer glint(TableFilter filter, int samples, float turn = 0.0F) {
    Framebuffer frame(32, 32, PixelFormat::rgba32f);
    Renderer({.threads = 1, .double_samples = samples}).render(glint_scene(filter, turn), frame);
    return frame;
}

double error(const Framebuffer& a, const Framebuffer& b) {
    double sum = 0.0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            float p, q;
            std::memcpy(&p, a.row(y) + 16 * x, sizeof p);
            std::memcpy(&q, b.row(y) + 16 * x, sizeof q);
            sum += static_cast<double>(p - q) * static_cast<double>(p - q);
        }
    }
    return std::sqrt(sum / 1024.0);
}

// N = 1024 from pixels of 1/32 of the picture: the exact integral is nearer to the truth; a mip
// level is wider than the lobe and is not.
TEST(TableFilter, TheExactMeanComesNearerToManySamples) {
    double point = 0.0, mip = 0.0, exact = 0.0;
    for (const float turn : {0.0F, 0.02F, 0.05F, 0.09F}) {
        const Framebuffer truth = glint(TableFilter::point, 256, turn);
        point += error(glint(TableFilter::point, 1, turn), truth);
        mip += error(glint(TableFilter::mip, 1, turn), truth);
        exact += error(glint(TableFilter::exact, 1, turn), truth);
    }
    EXPECT_LT(exact, 0.8 * point);
    EXPECT_LT(exact, 0.8 * mip);
}

// ---- machines

/// A table whose level k is k / 16 everywhere.
TexturePtr level_numbers(int size) {
    std::vector<Image8> levels;
    for (; size > 0; size /= 2)
        levels.push_back(plain_image(size, 1, {16 * static_cast<int>(levels.size()), 0, 0, 255}));
    Sampler sampler;
    sampler.filter = Filter::linear_mipmap_linear;
    sampler.wrap_s = Wrap::clamp_to_edge;
    return make_texture(levels, {.target = TextureTarget::one_d, .sampler = sampler});
}

/// 64 x 64 pixels; across them the coordinate of a table grows from `left` by `across`, downwards
/// by `down`. Red is the level that was looked at, in 1/16.
Framebuffer levels_seen(float left, float across, float down) {
    constexpr float kSide = 64.0F;
    Scene scene = textured_scene(level_numbers(256), 64, 64, flat(0.0F, 1.0F), "ideal");
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = *parse_combiners(R"(!!BRN1.0
        fetch { tex0 = table_1d(col0.r); }
        { rgb { spare0 = tex0; } }
        out.rgb = spare0; out.a = one;)")
                                        .program;
    material->program->units = {level_numbers(256)};
    auto& raw = std::get<RawVertices>(scene.objects[0].geometry);
    for (RawVertex& v : raw.vertices)
        v.color0.x = left + across * v.position.x / kSide + down * v.position.y / kSide;
    scene.objects[0].material = std::move(material);
    return draw(scene);
}

// Texels of 256: a step of 1/64 is 4 of them, level 2; a pixel's longer step counts, and what the
// triangle has beyond its edges is no seam: along the quad's diagonal nothing changes.
TEST(TableLevels, AreThoseOfTheStepBetweenPixels) {
    struct Ramp {
        float left, across, down;
        double level;
    };
    for (const Ramp& ramp : {Ramp{0.3F, 0.0F, 0.0F, 0.0}, Ramp{0.0F, 0.25F, 0.0F, 0.0},
                             Ramp{0.0F, 1.0F, 0.0F, 2.0}, Ramp{0.0F, 0.0F, 0.5F, 1.0},
                             Ramp{0.5F, 0.5F, -0.25F, 1.0}, Ramp{0.0F, 0.25F, 0.75F, 1.585}}) {
        const Framebuffer frame = levels_seen(ramp.left, ramp.across, ramp.down);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                ASSERT_NEAR(bytes_at(frame, x, y)[0], 16.0 * ramp.level, 0.51)
                    << x << ", " << y << ", level " << ramp.level;
    }
}

/// A sphere of a lobe that is narrower than a pixel, on a machine.
Scene small_sphere(TableFilter filter, const char* profile = "ideal") {
    Scene scene = glint_scene(filter, 0.0F);
    scene.machine = machine_profile(profile);
    scene.machine.table_filter = filter;
    scene.machine.multipass = scene.machine.numbers == NumberModel::nine_bit;
    return scene;
}

bool same(const Framebuffer& a, const Framebuffer& b) {
    for (int y = 0; y < a.height(); ++y)
        if (std::memcmp(a.row(y), b.row(y), 4 * static_cast<std::size_t>(a.width())) != 0)
            return false;
    return true;
}

TEST(TableFilter, HasTheSameBitsForEveryInstructionSetAndAnyThreads) {
    for (const char* profile : {"ideal", "nv2a"}) {
        const Scene scene = small_sphere(TableFilter::mip, profile);
        Framebuffer want(150, 100);
        Renderer({.threads = 1, .isa = "reference"}).render(scene, want);
        Framebuffer point(150, 100);
        Renderer({.threads = 1}).render(small_sphere(TableFilter::point, profile), point);
        EXPECT_FALSE(same(point, want)) << profile << ": nothing is filtered";
        for (const KernelTable* table : available_tables()) {
            for (const int threads : {1, 3}) {
                Framebuffer frame(150, 100);
                Renderer({.threads = threads, .isa = table->isa}).render(scene, frame);
                EXPECT_TRUE(same(frame, want)) << profile << ", " << table->isa;
            }
        }
    }
}

class TableFilterKey : public SceneFile {};

TEST_F(TableFilterKey, AsksForAMachineThatLooksTablesUp) {
    const auto filter = [&](const std::string& machine) {
        return scene("[machine]\n" + machine).machine.table_filter;
    };
    const auto complaint = [&](const std::string& machine) {
        return complaint_of([&] { filter(machine); });
    };
    EXPECT_EQ(filter("profile = \"double\"\ntable_filter = \"exact\"\n"), TableFilter::exact);
    const std::string mip = "table_filter = \"mip\"\n";
    EXPECT_EQ(filter(mip), TableFilter::mip);
    EXPECT_EQ(filter("profile = \"nv2a\"\nmultipass = true\n" + mip), TableFilter::mip);
    EXPECT_SAYS(complaint("profile = \"nv2a\"\n" + mip), "looks no tables up");
    EXPECT_SAYS(complaint("profile = \"geforce256\"\nmultipass = true\n" + mip),
                "looks no tables up");
}

}  // namespace
}  // namespace burnish
