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
/// by `down`. What the table has there is shown.
Framebuffer through_table(const TexturePtr& table, float left, float across, float down,
                          PixelFormat format = PixelFormat::rgba8) {
    constexpr float kSide = 64.0F;
    Scene scene = textured_scene(table, 64, 64, flat(0.0F, 1.0F), "ideal");
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = *parse_combiners(R"(!!BRN1.0
        fetch { tex0 = table_1d(col0.r); }
        { rgb { spare0 = tex0; } }
        out.rgb = spare0; out.a = one;)")
                                        .program;
    material->program->units = {table};
    auto& raw = std::get<RawVertices>(scene.objects[0].geometry);
    for (RawVertex& v : raw.vertices)
        v.color0.x = left + across * v.position.x / kSide + down * v.position.y / kSide;
    scene.objects[0].material = std::move(material);
    Framebuffer frame(64, 64, format);
    Renderer({.threads = 1}).render(scene, frame);
    return frame;
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
        const Framebuffer frame =
            through_table(level_numbers(256), ramp.left, ramp.across, ramp.down);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                ASSERT_NEAR(bytes_at(frame, x, y)[0], 16.0 * ramp.level, 0.51)
                    << x << ", " << y << ", level " << ramp.level;
    }
}

/// s^m of 256 texels from 0 to 1.
Texture power_table(double m) {
    Image16 image(256, 1);
    for (int x = 0; x < 256; ++x)
        for (int c = 0; c < 4; ++c)
            image.at(x, 0)[c] =
                static_cast<std::uint16_t>(std::lround(65535.0 * std::pow(x / 255.0, m)));
    Sampler sampler;
    sampler.wrap_s = sampler.wrap_t = Wrap::clamp_to_edge;
    sampler.span_s = TexelSpan::centers;
    return {std::span<const Image16>(&image, 1),
            {.target = TextureTarget::one_d, .format = TexelFormat::rgba16, .sampler = sampler}};
}

double red(const Framebuffer& frame, int x, int y) {
    std::uint16_t word;
    std::memcpy(&word, frame.row(y) + 8 * x, sizeof word);
    return word / 65535.0;
}

// What (F(s2) - F(s1)) / (s2 - s1) is, up to the lerps between texels and half a code of s.
TEST(SummedTable, GivesThePowersIntegral) {
    struct Ramp {
        float left, across, down;
    };
    for (const double m : {1.0, 8.0, 64.0}) {
        const TexturePtr table = Texture::summed_table(power_table(m), {-8.0F, 1.0F});
        for (const Ramp& ramp : {Ramp{0.0F, 1.0F, 0.0F}, Ramp{0.6F, 0.125F, 0.25F},
                                 Ramp{1.0F, -0.01F, 0.0F}, Ramp{0.9F, 0.0F, 0.1F}}) {
            const Framebuffer frame =
                through_table(table, ramp.left, ramp.across, ramp.down, PixelFormat::rgba16);
            const double step =
                static_cast<double>(std::max(std::abs(ramp.across), std::abs(ramp.down))) / 64.0;
            for (int y = 0; y < 64; y += 3) {
                for (int x = 0; x < 64; ++x) {
                    const double s = static_cast<double>(ramp.left) +
                                     (static_cast<double>(ramp.across) * (x + 0.5) +
                                      static_cast<double>(ramp.down) * (y + 0.5)) /
                                         64.0;
                    const double high = std::min(s + 0.5 * step, 1.0);
                    // m of a code, and the height of a parabola over a texel.
                    ASSERT_NEAR(red(frame, x, y), mean_power(s - 0.5 * step, high, m),
                                m * 0x1p-14 + m * m / 8.0 / (255.0 * 255.0) + 1e-4)
                        << "m " << m << ", s " << s << ", step " << step;
                }
            }
        }
    }
}

TEST(SummedTable, OfOneNumberIsTheTable) {
    for (const Texture& power : {power_table(3.0), power_table(100.0)})
        for (float s = 0.0F; s <= 1.0F; s += 0.03F)
            EXPECT_EQ(
                red(through_table(Texture::summed_table(power, {}), s, 0.0F, 0.0F,
                                  PixelFormat::rgba16),
                    9, 9),
                red(through_table(Texture::table(power), s, 0.0F, 0.0F, PixelFormat::rgba16), 9, 9))
                << s;
}

/// A sphere of a lobe that is narrower than a pixel, on a machine.
Scene small_sphere(TableFilter filter, const char* profile = "ideal") {
    Scene scene = glint_scene(filter, 0.0F);
    scene.machine = machine_profile(profile);
    scene.machine.table_filter = filter;
    scene.machine.multipass = scene.machine.numbers == NumberModel::nine_bit;
    return scene;
}

Framebuffer drawn(const Scene& scene, const RendererOptions& options) {
    Framebuffer frame(150, 100);
    Renderer(options).render(scene, frame);
    return frame;
}

bool same(const Framebuffer& a, const Framebuffer& b) {
    for (int y = 0; y < a.height(); ++y)
        if (std::memcmp(a.row(y), b.row(y), 4 * static_cast<std::size_t>(a.width())) != 0)
            return false;
    return true;
}

TEST(TableFilter, HasTheSameBitsForEveryInstructionSetAndAnyThreads) {
    struct Way {
        const char* profile;
        TableFilter filter;
        Quads quads;
    };
    for (const Way& way : {Way{"ideal", TableFilter::mip, Quads::of_triangle},
                           Way{"nv2a", TableFilter::mip, Quads::of_triangle},
                           Way{"ideal", TableFilter::exact, Quads::of_triangle},
                           Way{"ideal", TableFilter::exact, Quads::of_pixels}}) {
        Scene scene = small_sphere(way.filter, way.profile);
        scene.machine.quads = way.quads;
        const Framebuffer want = drawn(scene, {.threads = 1, .isa = "reference"});
        EXPECT_FALSE(same(drawn(small_sphere(TableFilter::point, way.profile), {}), want))
            << way.profile << ": nothing is filtered";
        for (const KernelTable* table : available_tables())
            for (const int threads : {1, 3})
                EXPECT_TRUE(same(drawn(scene, {.threads = threads, .isa = table->isa}), want))
                    << way.profile << ", " << table->isa;
    }
}

// Another object changes which fragments share packets, and pixels only where it is.
TEST(TableFilter, DoesNotSeeWhatElseIsInAPacket) {
    for (const TableFilter filter : {TableFilter::mip, TableFilter::exact}) {
        Scene other = small_sphere(filter);
        other.objects[0].world_from_object =
            placement({0.5F, -0.6F, 0.9F}, {0.0F, 1.0F, 0.0F}, 30.0F, 0.3F);
        const Scene alone = small_sphere(filter);
        Scene both = alone;
        both.objects.push_back(other.objects[0]);
        const Framebuffer a = drawn(alone, {}), b = drawn(other, {}), ab = drawn(both, {});
        int covered = 0;
        for (int y = 0; y < 100; ++y) {
            for (int x = 0; x < 150; ++x) {
                const bool is_other = bytes_at(b, x, y)[3] != 0;
                covered += is_other ? 1 : 0;
                ASSERT_EQ(bytes_at(ab, x, y), bytes_at(is_other ? b : a, x, y)) << x << ", " << y;
            }
        }
        EXPECT_GT(covered, 100);
    }
}

TEST(TableFilter, OfQuadsOfPixelsChangesNothingAtPoints) {
    Scene scene = small_sphere(TableFilter::point);
    const Framebuffer want = drawn(scene, {});
    scene.machine.quads = Quads::of_pixels;
    EXPECT_TRUE(same(drawn(scene, {}), want));
}

TEST(TableFilter, OnAMachineComesNearerToManySamples) {
    double point = 0.0, exact = 0.0;
    for (const float turn : {0.0F, 0.02F, 0.05F, 0.09F}) {
        const Framebuffer truth = glint(TableFilter::point, 256, turn);
        const auto error_of = [&](TableFilter filter) {
            Scene scene = glint_scene(filter, turn);
            scene.machine = machine_profile("ideal");
            scene.machine.table_filter = filter;
            Framebuffer frame(32, 32, PixelFormat::rgba32f);
            Renderer({.threads = 1}).render(scene, frame);
            return error(frame, truth);
        };
        point += error_of(TableFilter::point);
        exact += error_of(TableFilter::exact);
    }
    EXPECT_LT(exact, 0.8 * point);
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
    EXPECT_EQ(filter("table_filter = \"exact\"\ntable_bias = -0.5\n"), TableFilter::exact);
    EXPECT_SAYS(complaint("table_bias = 9\n"), "at least -8 and at most 8");
    EXPECT_SAYS(complaint("profile = \"double\"\nquads = \"pixels\"\n"),
                "expected one of the machines");
    EXPECT_SAYS(complaint("profile = \"nv2a\"\nmultipass = true\ntable_filter = \"exact\"\n"),
                "expected numbers = wide");
    EXPECT_SAYS(complaint("profile = \"nv2a\"\n" + mip), "looks no tables up");
    EXPECT_SAYS(complaint("profile = \"geforce256\"\nmultipass = true\n" + mip),
                "looks no tables up");
}

TEST_F(TableFilterKey, SaysWhatCannotBeFiltered) {
    const auto complaint = [&](const Scene& scene) {
        return complaint_of([&] { drawn(scene, {}); });
    };
    Scene scene = small_sphere(TableFilter::exact);
    Material ward = *scene.objects[0].material;
    ward.model = Model::ward;
    scene.objects[0].material = std::make_shared<const Material>(ward);
    EXPECT_SAYS(complaint(scene), "mip filters both");
    scene.machine.table_filter = TableFilter::mip;
    EXPECT_NO_THROW(drawn(scene, {}));
    scene = small_sphere(TableFilter::exact);
    scene.machine.quads = Quads::of_pixels;
    scene.objects[0].raster.blend = Blend{};
    EXPECT_SAYS(complaint(scene), "expected quads = triangle");
}

}  // namespace
}  // namespace burnish
