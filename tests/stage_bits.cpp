// Pictures whose numbers have chosen bits at chosen stages.
#include "lab/stage_bits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "lab/measure_model.hpp"
#include "metrics/frame_errors.hpp"
#include "reference/render_double.hpp"
#include "textured_quad.hpp"

namespace burnish::lab {
namespace {

constexpr StageBits kMachineBits{
    .half_vector = 8, .textures = 8, .filter = 8, .combiners = 9, .table = 8, .frame = 8};

glm::vec4 pixel(const Framebuffer& frame, int x, int y) {
    glm::vec4 value;
    std::memcpy(&value, frame.row(y) + static_cast<std::size_t>(x) * sizeof value, sizeof value);
    return value;
}

bool same_bits(const Framebuffer& a, const Framebuffer& b) {
    return std::memcmp(
               a.pixels(), b.pixels(),
               static_cast<std::size_t>(a.height()) * static_cast<std::size_t>(a.pitch())) == 0;
}

/// A highlight of 64 x 64 pixels that fills the frame, on a sphere.
Scene lobe(Model model, float alpha, float exponent, std::string_view machine) {
    ModelParameters parameters = constant_parameters(alpha, alpha, exponent);
    parameters.material.model = model;
    Scene scene = measured_scene(parameters.material, machine);
    scene.width = scene.height = 64;
    expose(scene);
    return scene;
}

Framebuffer in_double(const Scene& scene) {
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    WorkerPool pool(1);
    render_double(scene, frame, pool, {.layer_machine = scene.machine, .machine_grid = true});
    return frame;
}

// By hand: 0.5 is code 127.5 of 8 bits, -0.3 is -76.5 of a sign and 8; 255 x 255 / 256 = 254.004.
TEST(Quantiser, OfNumbersByHand) {
    Quantiser nearest, down(BitRounding::truncate), shift(BitRounding::shift8);
    EXPECT_DOUBLE_EQ(nearest.unsigned_number(0.5, 8), 128.0 / 255.0);
    EXPECT_DOUBLE_EQ(down.unsigned_number(0.5, 8), 127.0 / 255.0);
    EXPECT_DOUBLE_EQ(nearest.signed_number(-0.3, 9), -77.0 / 255.0);
    EXPECT_DOUBLE_EQ(down.signed_number(-0.3, 9), -76.0 / 255.0);
    EXPECT_DOUBLE_EQ(shift.signed_number(-0.3, 9), -77.0 / 255.0);
    EXPECT_DOUBLE_EQ(shift.product(1.0, 9), 254.0 / 255.0);
    EXPECT_DOUBLE_EQ(down.product(1.0, 9), 1.0);
    EXPECT_DOUBLE_EQ(nearest.coded_number(0.5, 8), 0.5);  // 0 of -1 .. 1 stays 0
    EXPECT_DOUBLE_EQ(nearest.coded_number(1.0, 8), 0.5 + 127.0 / 255.0);
    EXPECT_DOUBLE_EQ(nearest.unsigned_number(0.3, kExactBits), 0.3);
}

// Codes are numbers of their own grid: rounding them again, in any way, changes nothing.
TEST(Quantiser, KeepsWhatHasItsBits) {
    for (const auto rounding : {BitRounding::nearest, BitRounding::truncate, BitRounding::shift8,
                                BitRounding::stochastic}) {
        Quantiser q(rounding);
        for (const int bits : {2, 8, 9, 12, 16}) {
            const int one = (1 << bits) - 1;
            for (int code = 0; code <= one; code += 1 + one / 997) {
                const double x = static_cast<double>(code) / one;
                ASSERT_EQ(q.unsigned_number(x, bits), x) << code << " of " << bits;
                ASSERT_EQ(q.signed_number(-x, bits + 1), -x) << code << " of " << bits;
            }
        }
    }
}

/// Mean of Q(x) - x in steps, over evenly spread x.
double bias(BitRounding rounding) {
    Quantiser q(rounding);
    double sum = 0.0;
    constexpr int kCount = 40000;
    for (int i = 0; i < kCount; ++i) {
        q.begin(static_cast<std::uint32_t>(i), 7);
        const double x = (i + 0.37) / kCount;
        sum += q.unsigned_number(x, 8) - x;
    }
    return 255.0 * sum / kCount;
}

// A uniform fraction has mean 1/2; that of a stochastic rounding's error is 0 with a variance of
// f (1 - f), 1/6 on average.
TEST(Quantiser, TruncationIsBiasedByHalfAStep) {
    EXPECT_NEAR(bias(BitRounding::truncate), -0.5, 0.01);
    EXPECT_NEAR(bias(BitRounding::shift8), 0.0, 0.01);  // but for products
    EXPECT_NEAR(bias(BitRounding::nearest), 0.0, 0.01);
    EXPECT_NEAR(bias(BitRounding::stochastic), 0.0, 4.0 * std::sqrt(1.0 / 6.0 / 40000.0));
}

// The red of one pixel: a texel of 100/255 = 0.392, halfway 1.176 steps of 1/3. The program
// multiplies by 1 and hands the result through the final combiner.
TEST(StageBits, OneStageByHand) {
    const Scene scene = textured_scene(make_texture({plain_image(1, 1, {100, 100, 100, 255})}, {}),
                                       1, 1, everywhere({0.5F, 0.5F, 0.0F, 1.0F}));
    const auto red = [&](const StageBits& bits) {
        return pixel(render_with_bits(scene, bits, 1), 0, 0).r;
    };
    EXPECT_FLOAT_EQ(red({}), 100.0F / 255.0F);
    EXPECT_FLOAT_EQ(red({.textures = 2}), 1.0F / 3.0F);
    EXPECT_FLOAT_EQ(red({.filter = 2}), 1.0F / 3.0F);
    EXPECT_FLOAT_EQ(red({.combiners = 3}), 1.0F / 3.0F);
    EXPECT_FLOAT_EQ(red({.frame = 2}), 1.0F / 3.0F);
    EXPECT_FLOAT_EQ(red({.half_vector = 2, .table = 2}), 100.0F / 255.0F);  // it has neither
    EXPECT_FLOAT_EQ(red({.combiners = 3, .rounding = BitRounding::shift8}), 0.0F);  // 0.88 down
    EXPECT_FLOAT_EQ(red({.combiners = 3, .combiner_stages = {kExactBits}}), 100.0F / 255.0F);
    EXPECT_FLOAT_EQ(red({.combiner_stages = {3}}), 1.0F / 3.0F);
}

// Between texels 0 and 1 at a quarter: 2 bits of weight leave it alone, one makes it 0. A program
// that leaves texels as they are gives the same if it is filtered after.
TEST(StageBits, AFilterByHand) {
    Scene scene = textured_scene(make_texture({row_image({0, 255})}, {}), 1, 1,
                                 everywhere({0.375F, 0.5F, 0.0F, 1.0F}));
    for (const FilterOrder order : {FilterOrder::before, FilterOrder::after}) {
        scene.machine.filter_order = order;
        const auto red = [&](int bits) {
            return pixel(render_with_bits(scene, {.filter = bits}, 1), 0, 0).r;
        };
        EXPECT_NEAR(red(kExactBits), 0.25F, 1e-7F);
        EXPECT_FLOAT_EQ(red(4), 4.0F / 15.0F);  // 3.75 steps
        EXPECT_FLOAT_EQ(red(2), 1.0F / 3.0F);   // 0.75 steps
        EXPECT_FLOAT_EQ(red(1), 0.0F);
    }
}

// Texels of 0 and 100/255: their squares, of 3 bits and a sign 0 and 1/7, at a quarter are 1/28.
// The texel at a corner knows nothing of the filter's bits.
TEST(StageBits, AFilterAfterCombiningByHand) {
    Scene scene = textured_scene(make_texture({row_image({0, 100})}, {}), 1, 1,
                                 everywhere({0.375F, 0.5F, 0.0F, 1.0F}));
    Material material = *scene.objects.front().material;
    Portion& rgb = material.program->combiners.stages.front().rgb;
    rgb.b = rgb.a;
    scene.objects.front().material = std::make_shared<const Material>(material);
    scene.machine.filter_order = FilterOrder::after;
    const auto red = [&](const StageBits& bits) {
        return pixel(render_with_bits(scene, bits, 1), 0, 0).r;
    };
    const float square = 100.0F * 100.0F / (255.0F * 255.0F);
    EXPECT_NEAR(red({}), 0.25F * square, 1e-7F);
    EXPECT_NEAR(red({.combiners = 4}), 0.25F / 7.0F, 1e-7F);
    EXPECT_NEAR(red({.filter = 5}), std::round(31.0F * 0.25F * square) / 31.0F, 1e-7F);
    scene.machine.filter_order = FilterOrder::before;
    EXPECT_NEAR(red({}), square / 16.0F, 1e-7F);
}

// A table of 0, 0, 1 at 0.6, which is texel 1.3: 0.3. One bit leaves it the first and the last
// texel, two give it 0, 2/3, 4/3 and 2, and what they say thirds.
TEST(StageBits, ATableByHand) {
    Scene scene = textured_scene(make_texture({plain_image(1, 1, {153, 153, 153, 255})}, {}), 1, 1,
                                 everywhere({0.5F, 0.5F, 0.0F, 1.0F}), "ideal");
    Material material = *scene.objects.front().material;
    Sampler sampler;
    sampler.wrap_s = sampler.wrap_t = Wrap::clamp_to_edge;
    material.program->units.push_back(make_texture(
        {row_image({0, 0, 255})}, {.target = TextureTarget::one_d, .sampler = sampler}));
    GeneralStage& stage = material.program->combiners.stages.front();
    stage.fetches.push_back({tex(1), FetchTarget::table_1d, {{{tex(0), 0, false}}}});
    stage.rgb.a.reg = tex(1);
    scene.objects.front().material = std::make_shared<const Material>(material);
    const auto red = [&](const StageBits& bits) {
        return pixel(render_with_bits(scene, bits, 1), 0, 0).r;
    };
    EXPECT_NEAR(red({}), 0.3F, 1e-6F);
    EXPECT_FLOAT_EQ(red({.table = 1}), 1.0F);
    EXPECT_FLOAT_EQ(red({.table = 2}), 1.0F / 3.0F);
    EXPECT_NEAR(red({.textures = 1, .filter = 8}), 1.0F, 1e-6F);   // of tex0 alone
    EXPECT_THROW(red({.table = 2, .table_linear = true}), Error);  // of models only
}

TEST(TableGrid, CoordinatesOfKnownArguments) {
    // The program's axis ends at x = 1/8.
    const SpacedAxis lobe(TableSpacing::lobe, 0.0, 0.125), unit(TableSpacing::unit, 0.0, 0.125),
        logarithm(TableSpacing::logarithm, 0.0, 0.125);
    EXPECT_DOUBLE_EQ(lobe.coordinate(0.5), 0.5);
    EXPECT_DOUBLE_EQ(unit.coordinate(0.5), 0.0625);
    EXPECT_DOUBLE_EQ(unit.position(0.0625), 0.5);
    EXPECT_DOUBLE_EQ(unit.position(0.5), 1.0) << "beyond the lobe";
    EXPECT_DOUBLE_EQ(logarithm.coordinate(0.5), 12.0 / 16.0) << "x = 2^-4";
    EXPECT_DOUBLE_EQ(logarithm.position(12.0 / 16.0), 0.5);
    EXPECT_DOUBLE_EQ(logarithm.position(0.0), 0.0);
    // Axes that do not begin at 0, as of exponents, stay as they are.
    EXPECT_DOUBLE_EQ(SpacedAxis(TableSpacing::unit, 2.0, 100.0).coordinate(0.3), 0.3);
}

/// The lobe s^(N/2) alone, without cosines, in one channel.
std::vector<double> reds(const Scene& scene, const StageBits& bits) {
    const Framebuffer frame = render_with_bits(scene, bits, 1);
    std::vector<double> values;
    for (int y = 0; y < frame.height(); ++y)
        for (int x = 0; x < frame.width(); ++x)
            values.push_back(static_cast<double>(pixel(frame, x, y).r));
    return values;
}
Scene bare_lobe(float exponent) {
    Scene scene = lobe(Model::abp, 0.9F, exponent, "ideal");
    Material material = *scene.objects.front().material;
    material.model = Model::text;
    material.model_text =
        "X = t / alpha_x\nY = b / alpha_y\nmax(0, 1 - dot(h, X)^2 - dot(h, Y)^2)^(N / 2)";
    scene.objects.front().material = std::make_shared<const Material>(material);
    scene.lights.front().intensity = 1.0F;
    return scene;
}

// N = 100: the lobe ends at 1 - s = 1 - 2^(-24/100) = 0.153, which is texel 9.7 of 63.
TEST(TableGrid, EntriesOverTheWholeAxisAreFewInTheLobe) {
    const Scene scene = bare_lobe(100.0F);
    std::set<double> seen;
    for (const double red :
         reds(scene, {.table = 6, .table_values = 24, .table_axis = TableSpacing::unit})) {
        double nearest = 1.0;
        for (int k = 0; k < 64; ++k)
            nearest = std::min(nearest, std::abs(red - std::pow(1.0 - k / 63.0, 50.0)));
        EXPECT_LT(nearest, 3e-4);
        seen.insert(std::round(red * 4096.0));
    }
    EXPECT_GE(seen.size(), 8U);
    EXPECT_LE(seen.size(), 12U);  // with the background
    // An index of as many steps gives the same picture, whatever the table.
    const std::vector<double> coarse =
        reds(scene, {.table_index = 6, .table_axis = TableSpacing::unit});
    const std::vector<double> both = reds(scene, {.table = 6,
                                                  .table_index = 6,
                                                  .table_values = 24,
                                                  .table_axis = TableSpacing::unit,
                                                  .table_linear = true});
    for (std::size_t i = 0; i < both.size(); ++i) EXPECT_NEAR(coarse[i], both[i], 1e-6);
}

// The chord of s^50 over the first step h at its middle, where it is furthest off.
TEST(TableGrid, LinearTablesAreOffByTheirChords) {
    const Scene scene = bare_lobe(100.0F);
    const std::vector<double> exact = reds(scene, {});
    const auto largest = [&](const StageBits& bits) {
        const std::vector<double> got = reds(scene, bits);
        double most = 0.0;
        for (std::size_t i = 0; i < got.size(); ++i)
            most = std::max(most, std::abs(got[i] - exact[i]));
        return most;
    };
    const auto linear = [&](int table, TableSpacing axis) {
        return largest(
            {.table = table, .table_values = 24, .table_axis = axis, .table_linear = true});
    };
    const auto chord = [](double h) {
        return 0.5 * (1.0 + std::pow(1.0 - h, 50.0)) - std::pow(1.0 - 0.5 * h, 50.0);
    };
    EXPECT_NEAR(linear(6, TableSpacing::unit), chord(1.0 / 63.0), 0.002);
    EXPECT_NEAR(linear(8, TableSpacing::unit), chord(1.0 / 255.0), 0.0003);
    EXPECT_NEAR(linear(6, TableSpacing::lobe), chord(0.159 / 63.0), 0.0003);
    EXPECT_LT(linear(8, TableSpacing::logarithm), 0.001);
    EXPECT_LT(largest({.table_axis = TableSpacing::logarithm, .table_linear = true}), 1e-6);
}

// Against the formula in double precision, on the same corners. X = t / alpha has at most
// 2 / alpha of range as texels of half a 65535th; h.X is off by 3 of these, its square twice that
// times |h.X| <= 1, and there are two squares; the light and ks double it at most.
TEST(StageBits, ExactIsTheFormula) {
    const float alpha = 0.3F;
    const Scene scene = lobe(Model::abp_modified, alpha, 2.0F, "ideal");
    const metrics::FrameErrors errors =
        metrics::interior_errors(render_with_bits(scene, {}, 1), in_double(scene));
    ASSERT_GT(errors.pixels, 1000U);
    const double texel = 2.0 / static_cast<double>(alpha) / 65535.0 / 2.0;
    EXPECT_LT(errors.largest, 2.0 * 2.0 * 2.0 * 3.0 * texel);
    EXPECT_LT(std::abs(errors.bias), texel);
}

// A nine-bit machine's codes come out of the double evaluation, since every number lies on its grid
// and every operation on such numbers is the machine's; interpolated values may meet a rounding
// border in float and not in double, which moves single codes.
TEST(StageBits, ThoseOfAMachineGiveItsPicture) {
    for (const char* machine : {"geforce256", "nv2a"}) {
        const Scene scene = lobe(Model::abp_modified, 0.3F, 2.0F, machine);
        Framebuffer drawn(scene.width, scene.height, PixelFormat::rgba32f);
        Renderer({.threads = 1}).render(scene, drawn);
        const metrics::FrameErrors apart =
            metrics::interior_errors(render_with_bits(scene, kMachineBits, 1), drawn);
        ASSERT_GT(apart.pixels, 1000U);
        EXPECT_LT(apart.rmse, 1.0 / 255.0 / std::sqrt(100.0)) << machine;
        EXPECT_LT(apart.largest, 8.5 / 255.0) << machine;
    }
}

// With maps and tables, too, what is left is far below the machine's error.
TEST(StageBits, ThoseOfAMachineExplainItsError) {
    ModelParameters parameters = shift_variant_parameters("brushed");
    parameters.material.model = Model::abp;
    Scene scene = measured_scene(parameters.material, "nv2a");
    scene.width = scene.height = 64;
    expose(scene);
    for (const FilterOrder order : {FilterOrder::before, FilterOrder::after}) {
        scene.machine.filter_order = order;
        Framebuffer drawn(scene.width, scene.height, PixelFormat::rgba32f);
        Renderer({.threads = 1}).render(scene, drawn);
        const Framebuffer exact = render_with_bits(scene, {}, 1);
        const metrics::FrameErrors machine = metrics::interior_errors(drawn, exact);
        const metrics::FrameErrors left =
            metrics::interior_errors(render_with_bits(scene, kMachineBits, 1), drawn);
        EXPECT_GT(machine.rmse, 0.005);
        EXPECT_LT(left.rmse, 0.1 * machine.rmse);
    }
}

/// Slope of log2(RMSE) over 8 .. 12 bits.
double slope(const Scene& scene, int StageBits::*stage) {
    const Framebuffer exact = render_with_bits(scene, {}, 1);
    double sum = 0.0;
    for (int bits = 8; bits <= 12; ++bits) {
        StageBits chosen;
        chosen.*stage = bits;
        const double rmse =
            metrics::interior_errors(render_with_bits(scene, chosen, 1), exact).rmse;
        sum += (bits - 10) * std::log2(rmse);
    }
    return sum / 10.0;
}

// The steps halve with every bit; least squares over five depths, with a tenth for how they fall.
TEST(StageBits, EveryBitHalvesTheError) {
    const Scene scene = lobe(Model::abp, 0.9F, 16.0F, "ideal");
    EXPECT_NEAR(slope(scene, &StageBits::half_vector), -1.0, 0.1);
    EXPECT_NEAR(slope(scene, &StageBits::combiners), -1.0, 0.1);
    EXPECT_NEAR(slope(scene, &StageBits::table), -1.0, 0.1);
    EXPECT_NEAR(slope(scene, &StageBits::frame), -1.0, 0.1);
}

// A ramp through a frame that is rounded: errors of truncation have mean -1/2 step and variance
// 1/12, others mean 0, stochastic ones twice that variance. Red, green and blue are rounded apart.
TEST(StageBits, TruncatedFramesAreDarkerByHalfAStep) {
    const Scene scene =
        textured_scene(make_texture({row_image({0, 255})}, {}), 512, 16, flat(0.25F, 0.75F));
    const Framebuffer exact = render_with_bits(scene, {}, 1);
    const auto bias_in_steps = [&](BitRounding rounding) {
        const Framebuffer got = render_with_bits(scene, {.frame = 6, .rounding = rounding}, 1);
        return metrics::interior_errors(got, exact).bias * 63.0;
    };
    const double columns = 510.0, values = 3.0 * 14.0 * columns;
    const double standard_error = std::sqrt(1.0 / 12.0 / columns);
    EXPECT_NEAR(bias_in_steps(BitRounding::truncate), -0.5, 4.0 * standard_error);
    // A product with 1 loses 1/64 more, half a step of the ramp's mean.
    EXPECT_NEAR(bias_in_steps(BitRounding::shift8), -0.5 - 0.5 * 63.0 / 64.0, 4.0 * standard_error);
    EXPECT_NEAR(bias_in_steps(BitRounding::nearest), 0.0, 4.0 * standard_error);
    EXPECT_NEAR(bias_in_steps(BitRounding::stochastic), 0.0, 4.0 * std::sqrt(1.0 / 6.0 / values));
}

TEST(StageBits, AreTheSameForAnyNumberOfThreads) {
    Scene scene = lobe(Model::abp, 0.3F, 16.0F, "nv2a");
    scene.width = 130;  // several tiles
    scene.lights.push_back({.position = {-0.6F, 0.2F, 0.7F}, .intensity = 0.3F});
    StageBits bits = kMachineBits;
    bits.rounding = BitRounding::stochastic;
    const Framebuffer one = render_with_bits(scene, bits, 1);
    EXPECT_TRUE(same_bits(one, render_with_bits(scene, bits, 3)));
    bits.rounding = BitRounding::nearest;
    EXPECT_FALSE(same_bits(one, render_with_bits(scene, bits, 1)));
}

std::string complaint(const Scene& scene, const StageBits& bits) {
    try {
        render_with_bits(scene, bits, 1);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(StageBits, SayWhatTheyCannotDraw) {
    Scene scene = lobe(Model::abp_modified, 0.3F, 2.0F, "ideal");
    EXPECT_EQ(complaint(scene, {.table = 25}), "table of 25 bits, expected 1 .. 24 or exact");
    EXPECT_EQ(complaint(scene, {.combiners = 1}), "combiners of 1 bits, expected 2 .. 24 or exact");
    const Scene program = textured_scene(make_texture({plain_image(1, 1, {9, 9, 9, 255})}, {}), 1,
                                         1, everywhere({0.5F, 0.5F, 0.0F, 1.0F}));
    EXPECT_EQ(complaint(program, {.table_linear = true}), "");  // it has no table
    scene.objects.front().raster.blend = Blend::alpha();
    EXPECT_NE(complaint(scene, {}).find("blended"), std::string::npos);
    scene.objects.front().raster.blend.reset();
    scene.machine = machine_profile("double");
    EXPECT_NE(complaint(scene, {}).find("profile double"), std::string::npos);
}

}  // namespace
}  // namespace burnish::lab
