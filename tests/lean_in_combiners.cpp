// Moments of slopes through the parameter stage: what the machine's filter and arithmetic make of
// them, against numbers worked out by hand and against double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/materials.hpp>
#include <burnish/mesh.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "models/compile_model.hpp"
#include "models/model_texts.hpp"
#include "tests/float_picture.hpp"

namespace burnish {
namespace {

constexpr int kSide = 96;
constexpr float kReach = 0.8F;  // slopes of half vectors at the edges of the picture

/// A plane that reads its maps at `u` everywhere, light and viewer above its middle: the slope of
/// the half vector grows evenly over the picture, and sqrt(n.l / n.v) is 1.
Scene slopes(const Material& material, const char* machine, float u = 0.5F,
             float intensity = 0.1F) {
    MeshData quad;
    for (const auto& [x, y] :
         {std::pair{-2.0F, -2.0F}, {2.0F, -2.0F}, {2.0F, 2.0F}, {-2.0F, 2.0F}}) {
        quad.positions.emplace_back(x, y, 0.0F);
        quad.normals.emplace_back(0.0F, 0.0F, 1.0F);
        quad.tangents.emplace_back(1.0F, 0.0F, 0.0F, 1.0F);
        quad.uvs.emplace_back(u, 0.5F);
    }
    quad.indices = {0, 1, 2, 0, 2, 3};
    Scene scene;
    scene.width = scene.height = kSide;
    scene.machine = machine_profile(machine);
    scene.camera.position = {0.0F, 0.0F, 1.0F};
    scene.camera.view_angle =
        static_cast<float>(2.0 * std::atan(kReach) * 180.0 / std::numbers::pi);
    scene.lights = {{.position = {0.0F, 0.0F, 1.0F}, .position_w = 1.0F, .intensity = intensity}};
    scene.objects.push_back(
        {Mesh(quad), std::make_shared<Material>(material), glm::mat4(1.0F), {}});
    return scene;
}

Framebuffer drawn(const Scene& scene) {
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    Renderer({.threads = 1}).render(scene, frame);
    return frame;
}

/// A 2 x 1 map of words in r and g, linear between its texels.
TexturePtr pair_of(const glm::uvec2& left, const glm::uvec2& right, unsigned blue = 32768) {
    Image16 image(2, 1);
    for (int x = 0; x < 2; ++x) {
        const glm::uvec2& rg = x == 0 ? left : right;
        std::uint16_t* texel = image.at(x, 0);
        texel[0] = static_cast<std::uint16_t>(rg.x);
        texel[1] = static_cast<std::uint16_t>(rg.y);
        texel[2] = static_cast<std::uint16_t>(blue);
        texel[3] = 65535;
    }
    return std::make_shared<Texture>(
        std::span(&image, 1),
        TextureDescription{.format = TexelFormat::rgba16,
                           .sampler = {Filter::linear, Wrap::clamp_to_edge, Wrap::clamp_to_edge}});
}

Material plain_lean(float alpha_x, float alpha_y) {
    Material material;
    material.model = Model::lean;
    material.ks = glm::vec3(0.8F);
    material.alpha_x = alpha_x;
    material.alpha_y = alpha_y;
    material.encoding = VectorEncoding::b;
    return material;
}

/// Threads along u and along v.
Material crossed() {
    Material material = plain_lean(0.05F, 0.2F);
    material.direction_map = pair_of({65535, 32768}, {32768, 65535});
    return material;
}

/// Normals whose slopes are (-slope, 0) and (slope, 0), to a word.
Material tilted(double slope, float alpha) {
    Material material = plain_lean(alpha, alpha);
    const glm::dvec3 n = glm::normalize(glm::dvec3(slope, 0.0, 1.0));
    const auto word = [](double x) { return static_cast<unsigned>(32768.5 + 32767.0 * x); };
    material.normal_map = pair_of({word(-n.x), word(0.0)}, {word(n.x), word(0.0)}, word(n.z));
    return material;
}

/// Over the plane of slopes the lobe's integral is intensity ks / (8 pi) 2 pi.
double energy_ratio(const Framebuffer& frame) {
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) sum += static_cast<double>(get(frame, x, y).x);
    const double area = std::pow(2.0 * kReach / kSide, 2.0);
    return sum * area / (0.1 * 0.8 / 4.0);
}

struct Difference {
    double largest = 0.0, rms = 0.0, peak = 0.0;
};
Difference difference(const Framebuffer& machine, const Framebuffer& exact) {
    Difference d;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const auto want = static_cast<double>(get(exact, x, y).x);
            const double off = std::abs(static_cast<double>(get(machine, x, y).x) - want);
            d.largest = std::max(d.largest, off);
            d.peak = std::max(d.peak, want);
            d.rms += off * off / (kSide * kSide);
        }
    }
    d.rms = std::sqrt(d.rms);
    return d;
}

TEST(LeanInCombiners, TwoTexelsAt90DegreesKeepTheirEnergyBetweenThem) {
    for (const float u : {0.25F, 0.5F, 0.625F}) {
        EXPECT_NEAR(energy_ratio(drawn(slopes(crossed(), "double", u))), 1.0, 1e-4) << u;
        EXPECT_NEAR(energy_ratio(drawn(slopes(crossed(), "ideal", u))), 1.0, 0.01) << u;
    }
    // What t / alpha_x and b / alpha_y make of it.
    Material ward = crossed();
    ward.model = Model::ward;
    EXPECT_NEAR(energy_ratio(drawn(slopes(ward, "ideal"))), 1.99, 0.05);
}

// Variances (0.00125, 0.02) and (0.02, 0.00125) have the mean (0.010625, 0.010625): half-way
// between the threads the peak is 0.1 0.8 / (8 pi 0.010625), and it is the same in all directions.
TEST(LeanInCombiners, HalfWayBetweenTwoThreadsTheLobeIsRound) {
    const double peak = 0.1 * 0.8 / (8.0 * std::numbers::pi * 0.010625);
    for (const char* machine : {"double", "ideal"}) {
        const Framebuffer frame = drawn(slopes(crossed(), machine));
        for (const int off : {4, 10}) {
            // Pixel centres lie half a pixel from the middle.
            const double s = (off + 0.5) * 2.0 * kReach / kSide, half = kReach / kSide;
            const double expected = peak * std::exp(-(s * s + half * half) / (2.0 * 0.010625));
            const int c = kSide / 2;
            for (const glm::ivec2& at : {glm::ivec2(c + off, c), glm::ivec2(c, c + off),
                                         glm::ivec2(c - 1 - off, c), glm::ivec2(c, c - 1 - off)})
                EXPECT_NEAR(static_cast<double>(get(frame, at.x, at.y).x), expected, 0.003 * peak)
                    << machine << ' ' << off;
        }
    }
}

// Without maps it is Ward's lobe, through the same plan with constants folded into it.
TEST(LeanInCombiners, ConstantParametersAreWard) {
    for (const float alpha_y : {0.05F, 0.3F}) {
        Material ward = plain_lean(0.05F, alpha_y);
        ward.model = Model::ward;
        // Peaks are intensity 0.8 / (4 pi 0.05 alpha_y).
        const float intensity = 0.6F * alpha_y;
        const Framebuffer exact = drawn(slopes(ward, "double", 0.5F, intensity));
        const Framebuffer lean =
            drawn(slopes(plain_lean(0.05F, alpha_y), "ideal", 0.5F, intensity));
        const Difference d = difference(lean, exact);
        EXPECT_GT(d.peak, 0.7);
        EXPECT_LT(d.largest, 0.005 * d.peak);
    }
}

// Slope 0.3, width 0.05: the variance along x is (0.00125) 1.09^2 = 0.001485, the rest of 0.0915
// less 0.09. Four roundings of 2^-15 (of M, of B^2, of the constant that brings it to M's unit and
// of that product) move it by at most 4 0.0915 2^-15 = 1.1e-5, 0.75 %: the peak, which goes with
// its root, by 0.38 %. The half vector's codes are off by 2^-14 and half of a unit of 2 in its sum
// with B: 1.5e-4 of a standard deviation of 0.0385, times the lobe's steepest slope, 0.61: 0.24 %
// along x, and along y. What is left is for tables.
// Of width 0.02 the variance is 0.000238, of which the roundings are 4.6 %, and the deviation
// 0.0154: 2.3 % and twice 0.6 %.
TEST(LeanInCombiners, VariancesOfTiltedNormalsAreAsGoodAsTheirRoundings) {
    for (const auto& [alpha, bound] : {std::pair{0.05F, 0.01}, {0.02F, 0.04}}) {
        // The peak of the texels is 0.7.
        const float intensity = 11.0F * alpha * alpha;
        for (const float u : {0.25F, 0.5F, 0.75F}) {
            const Material material = tilted(0.3, alpha);
            const Difference d = difference(drawn(slopes(material, "ideal", u, intensity)),
                                            drawn(slopes(material, "double", u, intensity)));
            EXPECT_LT(d.largest, bound * d.peak) << alpha << ' ' << u;
            EXPECT_LT(d.rms, 0.2 * bound * d.peak) << alpha << ' ' << u;
        }
    }
}

/// Half-way between two texels the lobe has the mean slope 0 and the variance of both lobes and of
/// their distance: 0.3^2 + 0.001485.
TEST(LeanInCombiners, NormalsThatAreFilteredWidenTheLobe) {
    const Framebuffer frame = drawn(slopes(tilted(0.3, 0.05F), "ideal"));
    const double xx = 0.09 + 0.00125 * 1.09 * 1.09, yy = 0.00125 * 1.09;
    const double height = 0.1 * 0.8 * std::pow(1.09, 1.5) / (8.0 * std::numbers::pi);
    const double half = kReach / kSide;
    const int c = kSide / 2;
    for (const int off : {0, 12, 24}) {
        const double s = (off + 0.5) * 2.0 * half;
        const double expected =
            height / std::sqrt(xx * yy) * std::exp(-0.5 * (s * s / xx + half * half / yy));
        EXPECT_NEAR(static_cast<double>(get(frame, c + off, c).x), expected, 0.005) << off;
    }
}

/// The table that begins like this.
const Texture* table_of(const CompiledModel& model, std::string_view function) {
    for (const TableReport& t : model.tables) {
        if (t.function.starts_with(function))
            return model.program.units[static_cast<std::size_t>(t.unit)].get();
    }
    return nullptr;
}

// Variances of 0 .. 0.02, held at 0.00125 from below: the roots' inverses are 28.28 there and a
// quarter of that at the end, their product 800 and a sixteenth of that. The lobe for (u^2 + w^2)
// of 0 .. 25 and h.z of 0 .. 1, held at 1/8: at its 1365th of 4095 steps exp(-25 / 3 / 2) = 0.0155.
TEST(LeanInCombiners, ItsTablesAreWhatAPencilSays) {
    const CompiledModel model =
        compile_model(crossed(), machine_profile("ideal"), glm::vec3(1.0F), glm::vec3(0.0F));
    const Texture* roots = table_of(model, "((1 / sqrt(max(0.00125, filtered(Mxx)))) * (1 / sqrt(");
    ASSERT_NE(roots, nullptr);
    const int right = roots->width() - 1, below = roots->height() - 1;
    EXPECT_NEAR(roots->texel(0, 0, 0, 0, 0), 65535, 4);
    EXPECT_NEAR(roots->texel(0, 0, right, 0, 0), 65536 / 4, 4);
    EXPECT_NEAR(roots->texel(0, 0, 0, below, 0), 65536 / 4, 4);
    EXPECT_NEAR(roots->texel(0, 0, right, below, 0), 65536 / 16, 4);
    const Texture* lobe = table_of(model, "exp(");
    ASSERT_NE(lobe, nullptr);
    ASSERT_EQ(lobe->height(), 4096);
    const int upright = lobe->width() - 1;
    EXPECT_NEAR(lobe->texel(0, 0, upright, 0, 0), 65535, 4);
    EXPECT_NEAR(lobe->texel(0, 0, upright, 1365, 0), 65536.0 * 0.015504, 4.0);
    EXPECT_NEAR(lobe->texel(0, 0, 0, 1365, 0), 0, 4);
}

// Levels of the layer are means of the level before, whatever parameters they went through: of
// moments those that are weighted alike, of the energy those of `moments`.
TEST(LeanInCombiners, LevelsOfTheMapsAreTheirMeans) {
    Material material = generated_material("orbital", 3, 16);
    material.model = Model::lean;
    for (const MipMethod method : {MipMethod::moments_unweighted, MipMethod::moments}) {
        material.mipmaps = MaterialMipmaps{method};
        const std::string mean_of = method == MipMethod::moments ? "E" : "BM";
        int compared = 0;
        for (const LayerQuantity& q : material_layer(material, machine_profile("ideal"))) {
            if (!q.texture || mean_of.find(q.name[0]) == std::string::npos) continue;
            const Texture& t = *q.texture;
            const auto value = [&](std::size_t level, int x, int y) {
                return t.texel(level, 0, x, y, q.channel);
            };
            for (std::size_t level = 1; level < 3; ++level) {
                for (int y = 0; y < t.levels()[level].height; ++y) {
                    for (int x = 0; x < t.levels()[level].width; ++x, ++compared) {
                        const double mean = 0.25 * (value(level - 1, 2 * x, 2 * y) +
                                                    value(level - 1, 2 * x + 1, 2 * y) +
                                                    value(level - 1, 2 * x, 2 * y + 1) +
                                                    value(level - 1, 2 * x + 1, 2 * y + 1));
                        // Codes are words in steps of four.
                        ASSERT_NEAR(value(level, x, y), mean, 4.0) << q.name << ' ' << level;
                    }
                }
            }
        }
        EXPECT_EQ(compared, (method == MipMethod::moments ? 1 : 5) * (64 + 16));
    }
}

TEST(LeanInCombiners, ItsTextIsTheDoubleRenderersFormulaOnMapsToo) {
    Material material = generated_material("cross_hatch", 2, 32);
    material.model = Model::lean;
    material.mipmaps = MaterialMipmaps{MipMethod::moments};
    const Framebuffer formula = drawn(slopes(material, "double", 0.37F));
    material.model = Model::text;
    material.model_text = std::string(model_text(Model::lean));
    // Beyond five deviations the text is no longer a Gaussian.
    EXPECT_LT(difference(drawn(slopes(material, "double", 0.37F)), formula).largest, 1e-5);
}

float red_between(const Material& of, const char* text, const char* machine) {
    Material material = of;
    material.model = Model::text;
    material.model_text = text;
    return get(drawn(slopes(material, machine, 0.5F, 1.0F)), kSide / 2, kSide / 2).x;
}

// alpha_x is 0.25 and 0.5 at the texels, 0.375 between them.
TEST(LanguageOfModels, FilteredIsWhatTheFilterGivesAndExtremesAreOfAllTexels) {
    Material material = plain_lean(0.05F, 0.2F);
    material.alpha_x_map = {pair_of({0, 0}, {65535, 0}), 0, 0.25F, 0.5F};
    const Material tilts = tilted(0.5, 0.3F);
    for (const char* machine : {"double", "ideal"}) {
        const auto red = [&](const char* text) { return red_between(material, text, machine); };
        EXPECT_NEAR(red("n_dot_l * alpha_x^2"), (0.0625 + 0.25) / 2.0, 3e-4) << machine;
        EXPECT_NEAR(red("n_dot_l * filtered(alpha_x)^2"), 0.375 * 0.375, 3e-4) << machine;
        EXPECT_NEAR(red("a = 2 * alpha_x\nn_dot_l * filtered(a)^2"), 0.75 * 0.75, 3e-4) << machine;
        EXPECT_NEAR(red("n_dot_l * least(alpha_x)"), 0.25, 3e-4) << machine;
        EXPECT_NEAR(red("n_dot_l * most(1 / alpha_x) / 8"), 0.5, 3e-4) << machine;
        EXPECT_NEAR(red("n_dot_l * filtered(0.5)"), 0.5, 3e-4) << machine;
        // Axes of the surface: h = (0.0083, 0.0083, 1), and numbers of both signs.
        EXPECT_NEAR(red("dot(h, ez)^2"), 1.0, 3e-4) << machine;
        EXPECT_NEAR(red("max(0, dot(h, 0.5 * ez - ex))"), 0.5 - 1.0 / 120.0, 2.0 / 120.0)
            << machine;
        const float left = red_between(
            tilts, "B = dot(n, ex) / dot(n, ez)\nx = filtered(B)\nn_dot_l * (0.25 + x)", machine);
        EXPECT_NEAR(left, 0.25, 3e-4) << machine;
    }
}

TEST(LeanInCombiners, MachinesOfNineBitsRefuseIt) {
    Machine nv2a = machine_profile("nv2a");
    nv2a.multipass = true;
    try {
        compile_model(plain_lean(0.1F, 0.2F), nv2a, glm::vec3(1.0F), glm::vec3(0.0F));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_program);
        EXPECT_TRUE(std::string(error.what()).starts_with("lean on 'nv2a': ")) << error.what();
    }
}

}  // namespace
}  // namespace burnish
