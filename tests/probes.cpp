#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>

#include <cmath>
#include <functional>
#include <string>

#include "kernel_packet.hpp"
#include "tests/scene_file.hpp"
#include "tests/textured_quad.hpp"

/// Anisotropic footprints of textures: what pixels look like that are seen by several probes.
namespace burnish {
namespace {

/// Texels of 64 x 64 that nothing repeats, with their levels.
TexturePtr noise(TexelFormat format, int max_anisotropy) {
    Random random(7);
    const TextureDescription description{
        .format = format,
        .sampler = {.filter = Filter::linear_mipmap_linear, .max_anisotropy = max_anisotropy},
        .box_mipmaps = true};
    if (has_words(format)) {
        Image16 image(64, 64);
        for (std::uint16_t& word : image.rgba)
            word = static_cast<std::uint16_t>(random.below(65536));
        return std::make_shared<const Texture>(std::span(&image, 1), description);
    }
    Image8 image(64, 64);
    for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    return make_texture({image}, description);
}

/// A level as a texture of its own.
TexturePtr level_of(const Texture& texture, std::size_t level) {
    const TextureLevel& size = texture.levels()[level];
    Image16 words(size.width, size.height);
    Image8 bytes(size.width, size.height);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (int c = 0; c < 4; ++c) {
                const int number = texture.texel(level, 0, x, y, c);
                words.at(x, y)[c] = static_cast<std::uint16_t>(number);
                bytes.at(x, y)[c] = static_cast<std::uint8_t>(number);
            }
        }
    }
    const TextureDescription description{.format = texture.format()};
    if (has_words(texture.format()))
        return std::make_shared<const Texture>(std::span(&words, 1), description);
    return make_texture({bytes}, description);
}

/// 8 x 8 pixels, each `across` texels of 64 wide and `down` high.
Scene quad(TexturePtr texture, float across, float down, const char* machine) {
    return textured_scene(std::move(texture), 8, 8, flat(0.0F, across / 8.0F, 0.0F, down / 8.0F),
                          machine);
}

using Codes = std::array<int, 4>;
Codes codes_at(const Scene& scene, int x, int y) {
    return trace_pixel(scene, x, y).fragment->fetches.at(0).codes;
}

struct Case {
    TexelFormat format;
    const char* machine;
    int unit;  ///< codes are multiples of it
};
constexpr Case kCases[]{{TexelFormat::rgba8, "nv2a", 1},
                        {TexelFormat::signed_rgba8, "nv2a", 2},
                        {TexelFormat::rgba8, "ideal", 1},
                        {TexelFormat::rgba16, "ideal", 1}};

// 16 texels over 2: eight probes in level 1, at (i / 9 - 1/2) of 16 texels. Their mean is rounded
// half up; of signed texels of nine bits, whose codes are even, half of it.
TEST(Probes, PixelsAreTheMeanOfSamplesAlongTheLongerAxis) {
    for (const Case& c : kCases) {
        const TexturePtr texture = noise(c.format, 16), level = level_of(*texture, 1);
        const Scene probed = quad(texture, 2.0F, 16.0F, c.machine);
        for (const auto& [x, y] : {std::pair{0, 0}, {3, 1}, {7, 7}, {5, 4}}) {
            const float u = (static_cast<float>(x) + 0.5F) / 32.0F,
                        v = (static_cast<float>(y) + 0.5F) / 4.0F;
            std::array<double, 4> sums{};
            for (int k = 0; k < 8; ++k) {
                const glm::vec4 at(u, v + 0.25F / 9.0F * (static_cast<float>(k) - 3.5F), 0.0F,
                                   1.0F);
                const Codes codes =
                    codes_at(textured_scene(level, 1, 1, everywhere(at), c.machine), 0, 0);
                for (std::size_t i = 0; i < 4; ++i) sums[i] += codes[i];
            }
            const Codes mean = codes_at(probed, x, y);
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_EQ(mean[i], c.unit * std::floor(sums[i] / (8 * c.unit) + 0.5))
                    << c.machine << " at " << x << "," << y;
        }
    }
}

// Coordinates with a q, and probes that change in number from pixel to pixel.
Scene receding(const Case& c, int max_anisotropy) {
    const TexturePtr texture = noise(c.format, max_anisotropy);
    Corners corners{{{0.0F, 0.0F, 0.0F, 1.0F},
                     {0.4F, 0.0F, 0.0F, 1.0F},
                     {0.08F, 0.35F, 0.0F, 0.1F},
                     {0.0F, 0.35F, 0.0F, 0.1F}}};
    return textured_scene(texture, 24, 40, corners, c.machine);
}

TEST(Probes, EveryInstructionSetThreadAndTheTraceAgree) {
    for (const Case& c : kCases) {
        const Scene scene = receding(c, 16);
        const Framebuffer frame = draw(scene);
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            for (const int threads : {1, 3}) {
                Framebuffer other(scene.width, scene.height);
                Renderer({.threads = threads, .isa = std::string(isa.name)}).render(scene, other);
                for (int y = 0; y < scene.height; ++y)
                    ASSERT_EQ(std::memcmp(frame.row(y), other.row(y), 4 * 24), 0) << isa.name;
            }
        }
        double most = 0.0, least = 16.0;
        for (int y = 0; y < scene.height; y += 3) {
            for (int x = 0; x < scene.width; x += 5) {
                const PixelTrace trace = trace_pixel(scene, x, y);
                const TracedFetch& fetch = trace.fragment->fetches.at(0);
                for (std::size_t i = 0; i < 4; ++i)
                    ASSERT_EQ(bytes_at(frame, x, y)[i], trace.stored[i]) << x << "," << y;
                EXPECT_EQ(fetch.further.size(), 2 * fetch.probes.value - 1);
                EXPECT_NEAR(fetch.probes.value, fetch.probes.exact, 1.0);
                most = std::max(most, fetch.probes.value);
                least = std::min(least, fetch.probes.value);
                const double one = trace.one;
                for (std::size_t i = 0; i < 4; ++i)
                    EXPECT_NEAR(fetch.codes[i] / one, fetch.color[i].exact, 0.03) << x << "," << y;
            }
        }
        EXPECT_LE(least, 2.0);
        EXPECT_GE(most, 8.0);
    }
}

TEST(Probes, OneProbeIsTheSampleWithoutThem) {
    for (const Case& c : kCases) {
        const Framebuffer one = draw(quad(noise(c.format, 1), 3.0F, 3.0F, c.machine)),
                          probed = draw(quad(noise(c.format, 16), 3.0F, 3.0F, c.machine));
        for (int y = 0; y < 8; ++y) EXPECT_EQ(std::memcmp(one.row(y), probed.row(y), 32), 0);
    }
}

// A level of both axes' longer step blurs the stripes that cross it; probes do not.
TEST(Probes, StripesAlongTheLongerAxisStay) {
    Image8 image(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 4; ++c)
                image.at(x, y)[c] = static_cast<std::uint8_t>(x / 2 % 2 == 0 ? 255 : 0);
    const auto contrast = [&](int probes) {
        const TexturePtr texture = make_texture(
            {image}, {.sampler = {.filter = Filter::linear_mipmap_linear, .max_anisotropy = probes},
                      .box_mipmaps = true});
        const std::vector<int> row = reds(draw(quad(texture, 1.0F, 16.0F, "nv2a")), 3);
        return *std::max_element(row.begin(), row.end()) -
               *std::min_element(row.begin(), row.end());
    };
    EXPECT_EQ(contrast(1), 0);
    EXPECT_EQ(contrast(16), 255);
    EXPECT_LT(contrast(4), 255);
}

// ---- what there are no probes for

std::string message_of(const std::function<void()>& run) {
    try {
        run();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Probes, FilteringAfterCombiningHasNone) {
    Scene scene = quad(noise(TexelFormat::rgba8, 4), 2.0F, 16.0F, "nv2a");
    scene.machine.filter_order = FilterOrder::after;
    EXPECT_EQ(message_of([&] { draw(scene); }),
              "max_anisotropy 4 of a texture on a machine with filter_order = after, expected 1");
}

TEST(Probes, ComputedCoordinatesHaveNone) {
    Scene scene = quad(noise(TexelFormat::rgba8, 4), 2.0F, 16.0F, "nv2a");
    auto material = std::make_shared<Material>(*scene.objects[0].material);
    TextureShader shader;
    shader.units[0].operation = TextureOperation::texture_2d;
    shader.units[1] = {.operation = TextureOperation::dependent_ar, .previous = 0};
    material->program->texture_shader = shader;
    const TexturePtr plain = noise(TexelFormat::rgba8, 1), probed = noise(TexelFormat::rgba8, 4);
    ProgramBuilder p;
    p.lerp(combine::raw(Register::zero), combine::raw(Register::zero), combine::raw(tex(1)),
           combine::raw(Register::zero));
    material->program->combiners = p.build();
    material->program->units = {plain, probed};
    scene.objects[0].material = material;
    EXPECT_EQ(message_of([&] { draw(scene); }),
              "max_anisotropy 4 of a texture at coordinates that are not interpolated, expected 1");
}

TEST(Probes, OtherTargetsHaveNone) {
    const Image8 row(8, 1);
    EXPECT_EQ(message_of([&] {
                  make_texture({row},
                               {.target = TextureTarget::one_d, .sampler = {.max_anisotropy = 2}});
              }),
              "max_anisotropy 2, expected 1 for another target than two_d");
    EXPECT_EQ(message_of([&] { make_texture({row}, {.sampler = {.max_anisotropy = 17}}); }),
              "max_anisotropy 17, expected 1 .. 16");
}

class SceneProbes : public SceneFile {};

TEST_F(SceneProbes, TexturesNameTheirProbes) {
    const auto text = [](const std::string& keys) {
        return "[[textures]]\nname = \"a\"\nwidth = 2\nheight = 1\ntexels = [0, 0, 0, 0, 9, 9, 9, "
               "9]\n" +
               keys + "[[materials]]\nname = \"m\"\nunits = [\"a\"]\n" +
               "[[objects]]\nshape = \"cube\"\nmaterial = \"m\"\n";
    };
    const auto probes = [&](const std::string& keys) {
        return scene(text(keys)).objects[0].material->program->units[0]->sampler().max_anisotropy;
    };
    EXPECT_EQ(probes(""), 1);
    EXPECT_EQ(probes("max_anisotropy = 8\n"), 8);
    EXPECT_SAYS(complaint_of([&] { probes("max_anisotropy = 17\n"); }),
                "s.toml:7: 'max_anisotropy' = 17 in [[textures]], expected an integer of 1 .. 16");
    EXPECT_SAYS(complaint_of([&] { probes("max_anisotropy = 2\ntarget = \"1d\"\n"); }),
                "s.toml:7: 'max_anisotropy' in [[textures]] whose target is not 2d");
}

}  // namespace
}  // namespace burnish
