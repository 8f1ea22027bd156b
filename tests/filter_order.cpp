// Filtering after combining: against the machine's own nearest texels, combined by hand in
// integers; what it must leave as it is; the same in double precision; what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <cstring>
#include <functional>

#include "random_program.hpp"
#include "reference/footprint.hpp"
#include "reference/surface_sampler.hpp"
#include "tests/scenes.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

Framebuffer draw(const Scene& scene, PixelFormat format = PixelFormat::rgba8, int threads = 1) {
    Framebuffer frame(scene.width, scene.height, format);
    Renderer({.threads = threads}).render(scene, frame);
    return frame;
}

Framebuffer draw(Scene scene, FilterOrder order, PixelFormat format = PixelFormat::rgba8) {
    scene.machine.filter_order = order;
    return draw(scene, format);
}

bool same(const Framebuffer& a, const Framebuffer& b) {
    for (int y = 0; y < a.height(); ++y) {
        const auto bytes = static_cast<std::size_t>(a.width()) * pixel_size(a.format());
        if (std::memcmp(a.row(y), b.row(y), bytes) != 0) return false;
    }
    return true;
}

float channel(const Framebuffer& frame, int x, int y, int c) {
    float value = 0.0F;
    std::memcpy(&value,
                frame.row(y) +
                    (std::size_t{4} * static_cast<std::size_t>(x) + static_cast<std::size_t>(c)) *
                        sizeof value,
                sizeof value);
    return value;
}

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

Image8 random_image(Random& random, int width, int height) {
    Image8 image(width, height);
    for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    return image;
}

// ---- four frames of nearest texels

constexpr int kWidth = 13, kHeight = 9;  // pixels, each a quad of its own

/// Every pixel with colours and coordinates of its own, which do not vary within.
struct RandomPixels {
    std::vector<RawVertex> first_corners;

    explicit RandomPixels(Random& random) {
        for (int i = 0; i < kWidth * kHeight; ++i) {
            RawVertex v;
            v.position = {0.0F, 0.0F, 0.5F, 1.0F};
            for (int c = 0; c < 4; ++c) {
                v.color0[c] = random.unit();
                v.color1[c] = random.unit();
            }
            for (glm::vec4& uv : v.uv)
                uv = {random.real(-1.5F, 2.5F), random.real(-1.5F, 2.5F), 0.0F, 1.0F};
            first_corners.push_back(v);
        }
    }
};

Object pixels_of(const RandomPixels& pixels, const std::shared_ptr<Material>& material) {
    RawVertices raw{Space::window, Topology::quads, {}};
    for (int i = 0; i < kWidth * kHeight; ++i) {
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            RawVertex v = pixels.first_corners[static_cast<std::size_t>(i)];
            v.position.x = static_cast<float>(i % kWidth + dx);
            v.position.y = static_cast<float>(i / kWidth + dy);
            raw.vertices.push_back(v);
        }
    }
    return {std::move(raw), material, glm::mat4(1.0F), {.depth_test = DepthTest::always}};
}

/// A coordinate's left texel, unwrapped, and the weight of the right one in 1/256; repeat.
struct Place {
    int texel, weight;
};
Place place_of(float u, int size) {
    const float whole = std::floor(u);
    const int fixed = static_cast<int>((u - whole) * static_cast<float>(256 * size)) - 128;
    return {static_cast<int>(whole) * size + (fixed >> 8), fixed & 255};
}

int filtered(NumberModel numbers, const std::array<int, 4>& code, int wx, int wy) {
    const auto mean = [](int a, int b, int w) { return (256 - w) * a + w * b; };
    if (numbers == NumberModel::nine_bit) {
        const auto rounded = [&](int a, int b, int w) { return (mean(a, b, w) + 128) >> 8; };
        return rounded(rounded(code[0], code[1], wx), rounded(code[2], code[3], wx), wy);
    }
    return (mean(mean(code[0], code[1], wx), mean(code[2], code[3], wx), wy) + 32768) >> 16;
}

/// Units 0 and 4 have the finest maps, 4 to 6 the coordinates of unit 0, others their own.
std::vector<TexturePtr> random_units(Random& random, int count, glm::ivec2 finest, bool nearest) {
    std::vector<TexturePtr> units;
    for (int i = 0; i < count; ++i) {
        const bool fine = i == 0 || i == 4;
        const glm::ivec2 size =
            fine ? finest : glm::ivec2(random.between(1, 6), 1 << random.below(3));
        const bool linear = fine ? !nearest : i % 3 != 2;
        units.push_back(std::make_shared<Texture>(
            random_image(random, size.x, size.y),
            Sampler{linear ? Filter::linear : Filter::nearest, Wrap::repeat, Wrap::repeat}));
    }
    return units;
}

TEST(FilterOrder, AfterIsFourFramesOfNearestTexelsAndTheirFilter) {
    for (int seed = 0; seed < 120; ++seed) {
        const char* profile = seed % 2 == 0 ? "nv2a" : "ideal";
        Scene scene;
        scene.width = kWidth;
        scene.height = kHeight;
        scene.machine = machine_profile(profile);
        Random random(static_cast<unsigned>(seed));
        auto material = std::make_shared<Material>();
        material->program.emplace();
        material->program->combiners = random_program(random, scene.machine);
        const glm::ivec2 finest(random.between(7, 20), random.between(7, 40));
        const RandomPixels pixels(random);
        const auto with_units = [&](bool nearest) {
            Random texels(static_cast<unsigned>(seed + 1000));
            material->program->units =
                random_units(texels, scene.machine.texture_units, finest, nearest);
        };
        with_units(false);
        scene.objects = {pixels_of(pixels, material)};
        const Framebuffer after = draw(scene, FilterOrder::after, PixelFormat::rgba32f);
        with_units(true);
        std::vector<Framebuffer> corners;
        for (int k = 0; k < 4; ++k) {
            RandomPixels moved = pixels;
            for (RawVertex& v : moved.first_corners) {
                // The middle of the 1/256 texel at the centre.
                const auto centre = [&](float u, int size, int second) {
                    const int texel = place_of(u, size).texel + second;
                    return static_cast<float>((texel + 0.5 + 1.0 / 512.0) / size);
                };
                v.uv[0].x = centre(v.uv[0].x, finest.x, k & 1);
                v.uv[0].y = centre(v.uv[0].y, finest.y, k >> 1);
            }
            scene.objects = {pixels_of(moved, material)};
            corners.push_back(draw(scene, FilterOrder::before, PixelFormat::rgba32f));
        }
        const float one = scene.machine.numbers == NumberModel::nine_bit ? 255.0F : 16384.0F;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            const int x = i % kWidth, y = i / kWidth;
            const glm::vec4& uv = pixels.first_corners[static_cast<std::size_t>(i)].uv[0];
            for (int c = 0; c < 4; ++c) {
                std::array<int, 4> code{};
                for (std::size_t k = 0; k < 4; ++k)
                    code[k] = static_cast<int>(std::lround(channel(corners[k], x, y, c) * one));
                const int want =
                    filtered(scene.machine.numbers, code, place_of(uv.x, finest.x).weight,
                             place_of(uv.y, finest.y).weight);
                ASSERT_EQ(std::lround(channel(after, x, y, c) * one), want)
                    << profile << ", seed " << seed << ", pixel " << x << ',' << y << ", channel "
                    << c;
            }
        }
    }
}

// ---- by hand

/// s = 2 expand(texel) . expand((1, 0.5, 0.5)) squared: what is not linear in the texel.
std::shared_ptr<Material> square_of(TexturePtr texture) {
    using namespace combine;
    ProgramBuilder p;
    p.stage().rgb().ab(mul(in(tex(0)), in(tex(0))), Register::spare0);
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(Register::spare0));
    p.out_alpha(alpha(raw(tex(0))));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->units = {std::move(texture)};
    return material;
}

TEST(FilterOrder, TwoTexelsByHand) {
    // Texels 0 and 255, and 51 and 204 below, squares 0, 255, 10 (10.2), 163 (163.2). Eight pixels
    // across 2 texels: pixel i is at (i + 1/2) / 4 texels, weight ((i + 1/2) / 4 - 1/2): at i = 4
    // 0.625: 160 / 256; one row of pixels in the middle: half of each row.
    // After: 255 * 160 / 256 = 159.4 -> 159; 10 + 153 * 160 / 256 = 105.6 -> 106; 132.5 -> 133.
    // Before: 159; 51 + 153 * 160 / 256 = 146.6 -> 147; 153; its square 91.8 -> 92.
    Image8 image(2, 2);
    constexpr std::array<int, 4> kGrey{0, 255, 51, 204};
    for (int i = 0; i < 4; ++i)
        std::fill_n(image.at(i % 2, i / 2), 4, static_cast<std::uint8_t>(kGrey[std::size_t(i)]));
    const auto texture = std::make_shared<Texture>(
        image, Sampler{Filter::linear, Wrap::clamp_to_edge, Wrap::clamp_to_edge});
    Scene scene = textured_scene(texture, 8, 1, flat(0.0F, 1.0F));
    scene.objects[0].material = square_of(texture);
    const auto red = [&](FilterOrder order, int x) {
        return static_cast<int>(draw(scene, order).row(0)[4 * static_cast<std::ptrdiff_t>(x)]);
    };
    EXPECT_EQ(red(FilterOrder::after, 4), 133);
    EXPECT_EQ(red(FilterOrder::before, 4), 92);
    // Beyond the last centres there is one texel in a row: (255 + 163) / 2.
    EXPECT_EQ(red(FilterOrder::after, 7), 209);
    EXPECT_EQ(red(FilterOrder::after, 0), 5);
}

// ---- where the order plays no part

// A program that leaves the texel as it is filters its bytes with the same two lerps.
TEST(FilterOrder, APassedTexelOfNineBitsIsTheSame) {
    Random random(7);
    for (const Filter filter : {Filter::nearest, Filter::linear, Filter::nearest_mipmap_nearest,
                                Filter::linear_mipmap_nearest, Filter::nearest_mipmap_linear,
                                Filter::linear_mipmap_linear}) {
        for (const Wrap wrap :
             {Wrap::repeat, Wrap::clamp_to_edge, Wrap::clamp_to_border, Wrap::mirrored_repeat}) {
            for (const float bias : {0.0F, 1.3F}) {
                const Sampler sampler{
                    .filter = filter,
                    .wrap_s = wrap,
                    .wrap_t = wrap,
                    .mag_filter = random.chance(2) ? Filter::linear : Filter::nearest,
                    .lod_bias = bias,
                    .border = {0.2F, 0.9F, 0.4F, 0.6F}};
                const Image8 image = random_image(random, 24, 16);
                const TexturePtr texture = make_texture(
                    {image},
                    {.sampler = sampler,
                     .box_mipmaps = filter != Filter::linear && filter != Filter::nearest});
                // From 1/3 of a texel a pixel to 8.
                const Corners corners{{{-0.7F, -0.6F, 0.0F, 1.0F},
                                       {2.0F, -0.6F, 0.0F, 1.0F},
                                       {20.0F, 20.0F, 0.0F, 4.0F},
                                       {-18.0F, 20.0F, 0.0F, 4.0F}}};
                const Scene scene = textured_scene(texture, 60, 50, corners);
                EXPECT_TRUE(same(draw(scene, FilterOrder::before), draw(scene, FilterOrder::after)))
                    << static_cast<int>(filter) << ' ' << static_cast<int>(wrap) << ' ' << bias;
            }
        }
    }
}

TEST(FilterOrder, MapsOfOneColourAreTheSame) {
    for (const char* profile : {"nv2a", "ideal"}) {
        Scene scene = scenes::two_lights();
        scene.machine = machine_profile(profile);
        scene.machine.multipass = true;
        for (Object& object : scene.objects) {
            auto material = std::make_shared<Material>(*object.material);
            const Image8 image = plain_image(16, 8, {200, 90, 130, 128});
            material->program->units = {make_texture(
                {image}, {.sampler = {Filter::linear_mipmap_linear}, .box_mipmaps = true})};
            object.material = material;
        }
        EXPECT_TRUE(same(draw(scene, FilterOrder::before), draw(scene, FilterOrder::after)))
            << profile;
        Scene other = scenes::two_lights();
        EXPECT_FALSE(same(draw(other, FilterOrder::before), draw(other, FilterOrder::after)));
    }
}

// ---- several lights; of several passes tests/multipass.cpp has more

// Before the frame is full, light adds up at every texel: the sum's filter is the filters' sum, but
// for one rounding a light.
TEST(FilterOrder, LightsAddUpBeforeTheFilter) {
    Scene scene = scenes::two_lights();
    for (Light& light : scene.lights) light.color *= 0.3F;
    scene.background = glm::vec4(0.0F);
    const Framebuffer both = draw(scene, FilterOrder::after, PixelFormat::rgba32f);
    std::vector<Framebuffer> alone;
    for (const Light& light : scene.lights) {
        Scene one = scene;
        one.lights = {light};
        alone.push_back(draw(one, FilterOrder::after, PixelFormat::rgba32f));
    }
    for (int y = 0; y < scene.height; y += 3) {
        for (int x = 0; x < scene.width; x += 3) {
            const float sum = channel(alone[0], x, y, 0) + channel(alone[1], x, y, 0);
            if (channel(both, x, y, 3) != 1.0F || sum > 0.6F) continue;
            ASSERT_NEAR(channel(both, x, y, 0), sum, 2.5F / 16384.0F) << x << ',' << y;
        }
    }
}

// ---- in double precision

Scene double_quad(std::shared_ptr<Material> material) {
    Scene scene = scenes::lit_scene(machine_profile("double"), 33, 33);
    scene.lights[0].position = {0.2F, 0.5F, 0.9F};
    scene.camera.position = {0.0F, 0.0F, 1.4F};
    scene.objects.push_back({Mesh(shapes::plane(1, 1)), std::move(material), glm::mat4(1.0F), {}});
    return scene;
}

std::shared_ptr<Material> ward_with(TexturePtr direction_map) {
    auto material = std::make_shared<Material>();
    material->model = Model::ward;
    material->kd = {0.1F, 0.1F, 0.1F};
    material->ks = {0.2F, 0.2F, 0.2F};
    material->alpha_x = 0.1F;
    material->alpha_y = 0.4F;
    material->direction_map = std::move(direction_map);
    return material;
}

/// Tangents along u, and along v.
constexpr Bytes kAlongU{255, 128, 128, 255}, kAlongV{128, 255, 128, 255};

TexturePtr directions(const Bytes& left, const Bytes& right) {
    Image8 image = plain_image(2, 1, left);
    for (std::size_t c = 0; c < 4; ++c) image.at(1, 0)[c] = static_cast<std::uint8_t>(right[c]);
    return std::make_shared<Texture>(
        image, Sampler{Filter::linear, Wrap::clamp_to_edge, Wrap::clamp_to_edge});
}

TEST(FilterOrderInDouble, TheCentresWeighWhatTheFootprintWeighs) {
    Random random(3);
    for (int i = 0; i < 400; ++i) {
        const Sampler sampler{random.chance(3) ? Filter::nearest : Filter::linear,
                              static_cast<Wrap>(random.below(4)),
                              static_cast<Wrap>(random.below(4))};
        const int width = random.between(1, 9), height = random.between(1, 9);
        const glm::dvec2 uv(random.real(-2.0F, 3.0F), random.real(-2.0F, 3.0F));
        const auto texel = [](int x, int y) { return std::sin(3.0 * x + 7.0 * y); };
        const auto filtered = [&](const glm::dvec2& at) {
            const bool linear = is_linear_within(sampler.filter);
            return reference::footprint(at, width, height, sampler, linear).mean(texel);
        };
        double mean = 0.0;
        for (const auto& point :
             reference::texel_centres(uv, width, height, is_linear_within(sampler.filter)))
            mean += point.weight * filtered(point.uv);
        ASSERT_NEAR(mean, filtered(uv), 1e-12);
    }
}

TEST(FilterOrderInDouble, OneDirectionIsTheSameAndTwoAreTheMeanOfTheirValues) {
    const auto value = [](const Bytes& left, const Bytes& right, FilterOrder order, int x) {
        const Scene scene = double_quad(ward_with(directions(left, right)));
        return channel(draw(scene, order, PixelFormat::rgba32f), x, 16, 0);
    };
    for (const int x : {3, 15, 16, 30})
        EXPECT_NEAR(value(kAlongU, kAlongU, FilterOrder::before, x),
                    value(kAlongU, kAlongU, FilterOrder::after, x), 1e-6);
    // In the middle of the quad both texels weigh 1/2.
    const float mean = 0.5F * (value(kAlongU, kAlongU, FilterOrder::after, 16) +
                               value(kAlongV, kAlongV, FilterOrder::after, 16));
    EXPECT_NEAR(value(kAlongU, kAlongV, FilterOrder::after, 16), mean, 1e-6F);
    EXPECT_GT(std::abs(value(kAlongU, kAlongV, FilterOrder::before, 16) - mean), 0.02F);
}

/// Largest differences of red from the picture in double precision that is filtered after: of the
/// machine's, and of that in double which is filtered before.
struct Followed {
    double machine = 0.0, order = 0.0;
};
Followed followed(Scene scene) {
    const Framebuffer want = draw(scene, FilterOrder::after, PixelFormat::rgba32f);
    const Framebuffer before = draw(scene, FilterOrder::before, PixelFormat::rgba32f);
    scene.machine = machine_profile("ideal");
    const Framebuffer got = draw(scene, FilterOrder::after, PixelFormat::rgba32f);
    Followed result;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            const auto difference = [&](const Framebuffer& frame) {
                return std::abs(static_cast<double>(channel(frame, x, y, 0)) -
                                static_cast<double>(channel(want, x, y, 0)));
            };
            result.machine = std::max(result.machine, difference(got));
            result.order = std::max(result.order, difference(before));
        }
    }
    return result;
}

TEST(FilterOrderInDouble, TheMachineFollowsIt) {
    Random random(11);
    const Image8 image = random_image(random, 6, 5);
    const Followed f =
        followed(double_quad(ward_with(std::make_shared<Texture>(image, Sampler{}))));
    EXPECT_LT(f.machine, 0.01);
    EXPECT_GT(f.order, 0.05);
}

// The texels are those of the levels that the pixel sees, here between levels 1 and 2.
TEST(FilterOrderInDouble, TheMachineFollowsItToLevels) {
    Random random(12);
    const Image8 image = random_image(random, 100, 90);
    for (const Filter filter : {Filter::linear_mipmap_linear, Filter::linear_mipmap_nearest,
                                Filter::nearest_mipmap_linear}) {
        auto material = ward_with(std::make_shared<Texture>(image, Sampler{filter}));
        material->mipmaps = MaterialMipmaps{.method = MipMethod::moments};
        const Followed f = followed(double_quad(std::move(material)));
        // Five pixels of the nearest texels lie where the coordinates' rounding takes another one.
        const bool nearest = filter == Filter::nearest_mipmap_linear;
        EXPECT_LT(f.machine, nearest ? 0.15 : 0.01);
        if (nearest)
            EXPECT_EQ(f.order, 0.0);
        else
            EXPECT_GT(f.order, 0.05);
    }
}

// ---- what is filtered together

/// Of the layer that `machine` works from, in the middle of two texels.
glm::dvec3 between(const Material& material, const char* machine, std::string_view name) {
    for (const LayerQuantity& q : material_layer(material, machine_profile(machine)))
        if (q.name == name) return reference::layer_value(q, {0.5, 0.5});
    return glm::dvec3(-1.0);
}

TEST(FilteredQuantities, ANamedNumberOfTheTexelIsFilteredApart) {
    // t = (1, 0, 0) and (0, 1, 0), alpha_x = 0.25 and 0.5.
    auto material = ward_with(directions(kAlongU, kAlongV));
    Image8 widths = plain_image(2, 1, {0, 0, 0, 255});
    widths.at(1, 0)[0] = 255;
    material->alpha_x_map = {std::make_shared<Texture>(widths, material->direction_map->sampler()),
                             0, 0.25F, 0.5F};
    material->model = Model::text;
    const auto near = [](const glm::dvec3& got, const glm::dvec3& want, double error) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], error) << c;
    };
    for (const auto& [machine, error] : {std::pair{"nv2a", 0.02}, {"ideal", 1e-3}}) {
        material->model_text = "P = 1 / alpha_x\nu = dot(h, t) * P\nks * max(0, 1 - u^2) * n_dot_l";
        near(between(*material, machine, "t"), {0.5, 0.5, 0.0}, error);
        near(between(*material, machine, "P"), glm::dvec3(3.0), 2.0 * error);
        material->model_text = "X = t / alpha_x\nu = dot(h, X)\nks * max(0, 1 - u^2) * n_dot_l";
        near(between(*material, machine, "X"), {2.0, 1.0, 0.0}, 4.0 * error);
        EXPECT_EQ(between(*material, machine, "t"), glm::dvec3(-1.0)) << "filtered for nobody";
    }
}

// A number that is the same everywhere is a constant of the program, not of the vector beside it.
TEST(FilteredQuantities, ANamedNumberThatIsTheSameEverywhereIsAConstant) {
    auto material = ward_with(directions(kAlongU, kAlongV));
    material->model = Model::text;
    material->model_text = "P = 1 / alpha_x\nu = dot(h, t) * P\nks * max(0, 1 - u^2) * n_dot_l";
    for (const float width : {0.25F, 1.0F}) {
        material->alpha_x = width;
        const auto layer = material_layer(*material, machine_profile("ideal"));
        const auto p = std::find_if(layer.begin(), layer.end(),
                                    [](const LayerQuantity& q) { return q.name == "P"; });
        ASSERT_NE(p, layer.end());
        EXPECT_EQ(p->texture, nullptr);
        EXPECT_NEAR(p->constant.x, 1.0 / static_cast<double>(width), 1e-6);
        EXPECT_NEAR(between(*material, "ideal", "t").x, 0.5, 1e-3) << "without the width";
    }
}

TEST(FilteredQuantities, TheExponentOrItsLogarithm) {
    // Machines by themselves take the logarithm of N = 4 .. 32 and the number of 4 .. 9.
    auto material = ward_with(nullptr);
    material->model = Model::abp;
    Image8 image = plain_image(2, 1, {0, 0, 0, 255});
    image.at(1, 0)[0] = 255;
    const auto texture = std::make_shared<Texture>(
        image, Sampler{Filter::linear, Wrap::clamp_to_edge, Wrap::clamp_to_edge});
    for (const auto& [low, high] : {std::pair{4.0F, 32.0F}, {4.0F, 9.0F}}) {
        material->exponent_map = {texture, 0, low, high};
        const double mean = 0.5 * (static_cast<double>(low) + static_cast<double>(high));
        const double geometric = std::sqrt(static_cast<double>(low) * static_cast<double>(high));
        for (const bool log : {false, true}) {
            material->exponent_coding = log ? ExponentCoding::logarithmic : ExponentCoding::linear;
            const double want = log ? geometric : mean;
            EXPECT_NEAR(between(*material, "ideal", "N").x, want, 1e-3 * want) << low << log;
            EXPECT_NEAR(reference::exact_surface(*material)->at({0.5, 0.5}).N.x, want, 1e-9);
        }
        material->exponent_coding = ExponentCoding::automatic;
        const double want = high > 4.0F * low ? geometric : mean;
        EXPECT_NEAR(between(*material, "ideal", "N").x, want, 1e-3 * want);
    }
}

// ---- what there is no after for

TEST(FilterOrder, DepthsOfTexelsAreRefused) {
    TextureShader shader;
    shader.units[0].operation = TextureOperation::texture_2d;
    shader.units[1] = {.operation = TextureOperation::dot_product, .previous = 0};
    shader.units[2] = {.operation = TextureOperation::dot_product_depth_replace, .previous = 0};
    Scene scene =
        textured_scene(std::make_shared<Texture>(plain_image(4, 4, {9, 9, 9, 9}), Sampler{}), 8, 8,
                       flat(0.0F, 1.0F));
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    material->program->texture_shader = shader;
    scene.objects[0].material = material;
    EXPECT_EQ(message_of([&] { draw(scene, FilterOrder::before); }), "no error");
    EXPECT_NE(message_of([&] { draw(scene, FilterOrder::after); }).find("expected before"),
              std::string::npos);
}

}  // namespace
}  // namespace burnish
