// Pictures of textures of every kind are those of the trace, with every instruction set; units that
// share addresses, and maps that models derive.
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>
#include <string>

#include "tests/kernel_packet.hpp"
#include "tests/textured_quad.hpp"

namespace burnish {
namespace {

// ---- several units

/// A noisy texture of 16 x 16 texels; equal sizes and samplers share their addresses.
TexturePtr noisy(unsigned seed, const Sampler& sampler, TexelFormat format, bool mipmaps) {
    Random random(seed);
    Image8 image(16, 16);
    for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    return make_texture({image}, {.format = format, .sampler = sampler, .box_mipmaps = mipmaps});
}

/// Eight units on a machine, which share what they can.
struct Shared {
    const char* machine;
    std::vector<TexturePtr> textures;
};

/// Of seven units with levels five share addresses, one has its own in between and one has no
/// levels. With probes the fifth of six is alone, and another has fewer of them.
std::vector<Shared> shared_units() {
    const Sampler trilinear = filtered(Filter::linear_mipmap_linear);
    const Sampler biased = filtered(Filter::linear_mipmap_linear, 0.4F);
    Sampler probed = trilinear, fewer = trilinear;
    probed.max_anisotropy = 8;
    fewer.max_anisotropy = 2;
    const std::vector<TexturePtr> bytes{
        noisy(1, trilinear, TexelFormat::rgba8, true),
        noisy(2, trilinear, TexelFormat::signed_rgba8, true),
        noisy(3, trilinear, TexelFormat::signed_rgb8_unsigned_alpha8, true),
        noisy(4, filtered(Filter::linear), TexelFormat::rgba8, false),
        noisy(5, trilinear, TexelFormat::rgba8, true),
        noisy(6, trilinear, TexelFormat::rgba8, true),  // the fifth: a fetch of its own
        noisy(7, biased, TexelFormat::rgba8, true),
        noisy(8, filtered(Filter::linear), TexelFormat::rgba8, false)};
    const std::vector<TexturePtr> with_probes{
        noisy(1, probed, TexelFormat::rgba8, true),
        noisy(2, probed, TexelFormat::signed_rgba8, true),
        noisy(3, probed, TexelFormat::signed_rgb8_unsigned_alpha8, true),
        noisy(4, probed, TexelFormat::rgba8, true),
        noisy(5, probed, TexelFormat::rgba8, true),
        noisy(6, fewer, TexelFormat::rgba8, true),
        noisy(7, filtered(Filter::linear), TexelFormat::rgba8, false),
        noisy(8, probed, TexelFormat::rgba8, true)};
    const auto words = [](const Sampler& sampler) {
        std::vector<TexturePtr> textures;
        for (unsigned k = 0; k < 8; ++k)
            textures.push_back(noisy(k, sampler, TexelFormat::rgba16, true));
        const std::vector<TexturePtr> quartet = Texture::quartet(std::span(textures).subspan(5));
        std::copy(quartet.begin(), quartet.end(), textures.begin() + 5);
        return textures;
    };
    return {{"ideal", bytes},
            {"geforce256", bytes},
            {"ideal", with_probes},
            {"geforce256", with_probes},
            {"ideal", words(trilinear)},
            {"ideal", words(probed)}};
}

// Each must give what it gives alone, and the picture must be the one of the trace.
TEST(Units, ThatShareLevelsGiveWhatTheyGiveAlone) {
    Corners corners = flat(-0.4F, 3.0F, 0.1F, 2.7F);
    corners[1].w = 1.5F;
    for (const auto& [machine, textures] : shared_units()) {
        using namespace combine;
        ProgramBuilder p;
        for (int unit = 0; unit < static_cast<int>(textures.size()); ++unit) {
            p.stage()
                .rgb()
                .ab(mul(in(unit == 0 ? Register::col0 : Register::spare0), one()))
                .cd(mul(in(tex(unit)), one()))
                .sum(Register::spare0)
                .scale(Scale::half);
        }
        p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::spare0),
               raw(Register::zero));
        const auto scene_with = [&, name = machine](std::vector<TexturePtr> units) {
            Scene scene = textured_scene(nullptr, 30, 20, corners, name);
            scene.machine.texture_units = scene.machine.general_stages = 8;
            auto material = std::make_shared<Material>();
            material->program.emplace();
            material->program->combiners = p.build();
            material->program->units = std::move(units);
            auto& quad = std::get<RawVertices>(scene.objects[0].geometry);
            for (RawVertex& v : quad.vertices) v.uv.fill(v.uv[0]);
            scene.objects[0].material = material;
            return scene;
        };
        const Scene together = scene_with(textures);
        std::vector<Scene> alone;
        for (std::size_t unit = 0; unit < textures.size(); ++unit) {
            std::vector<TexturePtr> units(textures.size());
            units[unit] = textures[unit];
            alone.push_back(scene_with(units));
        }
        const Framebuffer frame = draw(together);
        for (int y = 0; y < 20; y += 3) {
            for (int x = 0; x < 30; x += 2) {
                const PixelTrace trace = trace_pixel(together, x, y);
                for (int c = 0; c < 4; ++c) {
                    const auto at = static_cast<std::size_t>(c);
                    ASSERT_EQ(bytes_at(frame, x, y)[at], trace.stored[at]) << x << "," << y;
                }
                ASSERT_EQ(trace.fragment->fetches.size(), textures.size());
                for (const TracedFetch& fetch : trace.fragment->fetches) {
                    const auto unit = static_cast<std::size_t>(fetch.unit);
                    const PixelTrace single = trace_pixel(alone[unit], x, y);
                    ASSERT_EQ(fetch.codes, single.fragment->fetches.at(0).codes)
                        << "unit " << unit << " at " << x << "," << y;
                    const bool levels = textures[unit]->levels().size() > 1;
                    ASSERT_EQ(fetch.further.size(), levels ? 2 * fetch.probes.value - 1 : 0);
                }
            }
        }
    }
}

// ---- models

Scene ball(const TexturePtr& normal_map) {
    Scene scene;
    scene.width = 24;
    scene.height = 18;
    scene.machine = machine_profile("nv2a");
    scene.lights.push_back({});
    auto material = std::make_shared<Material>();
    material->normal_map = normal_map;
    scene.objects.push_back({Mesh(shapes::sphere(12, 7)), material, glm::mat4(1.0F), {}});
    return scene;
}

// The maps that a model derives from a normal map with levels have levels, too.
TEST(Models, DerivedMapsHaveLevelsWhereTheNormalMapHas) {
    const Scene scene =
        ball(noisy(1, filtered(Filter::linear_mipmap_linear, 2.0F), TexelFormat::rgba8, true));
    const Framebuffer frame = draw(scene);
    const PixelTrace trace = trace_pixel(scene, 12, 9);
    ASSERT_TRUE(trace.fragment);
    ASSERT_EQ(trace.fragment->fetches.size(), 2U);
    for (const TracedFetch& fetch : trace.fragment->fetches) {
        ASSERT_TRUE(fetch.lod);
        EXPECT_GT(fetch.lod->value, 0.5);
        EXPECT_EQ(fetch.further.at(0).level, fetch.level + 1);
    }
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        EXPECT_EQ(bytes_at(frame, 12, 9)[at], trace.stored[at]);
    }
}

TEST(Models, TakeFlatMapsOfEveryFormat) {
    const TexturePtr cube =
        make_texture({6, plain_image(2, 2, {})}, {.target = TextureTarget::cube});
    EXPECT_THROW(draw(ball(cube)), Error);
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::signed_rgba8, false))));
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::hilo8, false))));
    EXPECT_NO_THROW(draw(ball(noisy(1, {}, TexelFormat::rgb8, false))));
}

struct Kind {
    const char* name;
    TextureTarget target;
    TexelFormat format;
    Filter filter;
    Wrap wrap;
};
void PrintTo(const Kind& k, std::ostream* out) {
    *out << k.name;
}

const std::vector<Kind>& kinds() {
    using enum TexelFormat;
    using enum TextureTarget;
    static const std::vector<Kind> list{
        {"trilinear", two_d, rgba8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"signed_trilinear", two_d, signed_rgba8, Filter::linear_mipmap_linear,
         Wrap::mirrored_repeat},
        {"mixed", two_d, signed_rgb8_unsigned_alpha8, Filter::nearest_mipmap_linear,
         Wrap::clamp_to_border},
        {"line", one_d, luminance8_alpha8, Filter::linear_mipmap_nearest, Wrap::mirrored_repeat},
        {"rectangle", rectangle, rgba8, Filter::linear, Wrap::clamp_to_border},
        {"cube", cube, rgba8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"slices", three_d, signed_rgba8, Filter::linear_mipmap_linear, Wrap::mirrored_repeat},
        {"border_slices", three_d, rgba8, Filter::linear, Wrap::clamp_to_border},
        {"intensity", two_d, dsdt8_mag8_intensity8, Filter::linear_mipmap_linear, Wrap::repeat},
        {"words", two_d, rgba16, Filter::linear_mipmap_linear, Wrap::clamp_to_border},
        {"word_slices", three_d, rgba16, Filter::linear_mipmap_nearest, Wrap::repeat}};
    return list;
}

/// Noise, in perspective and with a q, from magnified to the last level.
Scene scene_of(const Kind& kind, const char* machine) {
    Random random(static_cast<unsigned>(kind.name[0] + kind.name[1]));
    const int layers = kind.target == TextureTarget::cube      ? 6
                       : kind.target == TextureTarget::three_d ? 5
                                                               : 1;
    const int width = 16, height = kind.target == TextureTarget::one_d  ? 1
                                   : kind.target == TextureTarget::cube ? 16
                                                                        : 11;
    std::vector<Image8> images;
    for (int k = 0; k < layers; ++k) {
        images.emplace_back(width, height);
        for (std::uint8_t& byte : images.back().rgba)
            byte = static_cast<std::uint8_t>(random.below(256));
    }
    TextureDescription d{.target = kind.target, .format = kind.format};
    d.sampler = filtered(kind.filter);
    d.sampler.mag_filter = Filter::linear;
    d.sampler.wrap_s = d.sampler.wrap_r = kind.wrap;
    d.sampler.wrap_t =
        kind.target == TextureTarget::rectangle ? Wrap::clamp_to_edge : Wrap::mirrored_repeat;
    d.sampler.border = {0.3F, 0.9F, -0.2F, 0.5F};
    d.depth = kind.target == TextureTarget::three_d ? 5 : 1;
    d.box_mipmaps = kind.target != TextureTarget::rectangle;
    const float unit = kind.target == TextureTarget::rectangle ? 16.0F : 1.0F;
    const Corners corners{{{-1.5F * unit, -1.0F * unit, -1.0F, 1.0F},
                           {2.0F * unit, -1.0F * unit, 0.8F, 1.5F},
                           {2.5F * unit, 1.7F * unit, 1.6F, 1.0F},
                           {-0.5F * unit, 1.2F * unit, 0.4F, 0.8F}}};
    Scene scene = textured_scene(make_texture(images, d), 36, 24, corners, machine);
    auto& quad = std::get<RawVertices>(scene.objects[0].geometry);
    quad.vertices[0].position.w = quad.vertices[1].position.w = 4.0F;
    return scene;
}

class EveryKind : public testing::TestWithParam<std::tuple<Kind, const char*>> {};

TEST_P(EveryKind, IsTheSameEverywhereAndAsTraced) {
    const auto& [kind, machine] = GetParam();
    if (kind.format == TexelFormat::rgba16 && std::string(machine) != "ideal") return;
    const Scene scene = scene_of(kind, machine);
    std::vector<Framebuffer> frames;
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        frames.emplace_back(scene.width, scene.height);
        Renderer({.threads = 2, .isa = std::string(isa.name)}).render(scene, frames.back());
    }
    int various = 0;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            const PixelTrace trace = trace_pixel(scene, x, y);
            const Bytes stored = {
                static_cast<int>(trace.stored[0]), static_cast<int>(trace.stored[1]),
                static_cast<int>(trace.stored[2]), static_cast<int>(trace.stored[3])};
            for (const Framebuffer& frame : frames)
                ASSERT_EQ(bytes_at(frame, x, y), stored) << x << "," << y;
            ASSERT_TRUE(trace.fragment);
            const TracedFetch& fetch = trace.fragment->fetches.at(0);
            for (std::size_t c = 0; c < 4; ++c) {
                // Roundings to 8 bits in both directions, slices and levels; and weights that are
                // up to 1/256 too small in each. A nearest texel or level may be another one.
                if (kind.filter == Filter::linear || kind.filter == Filter::linear_mipmap_linear) {
                    ASSERT_NEAR(fetch.color[c].error(), 0.0, 8.0 / 255.0)
                        << x << "," << y << " channel " << c;
                }
            }
            various += stored != bytes_at(frames[0], 0, 0) ? 1 : 0;
        }
    }
    EXPECT_GT(various, 200);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryKind, testing::Combine(testing::ValuesIn(kinds()), testing::Values("nv2a", "ideal")),
    [](const testing::TestParamInfo<EveryKind::ParamType>& test) {
        return std::string(std::get<0>(test.param).name) + "_" + std::get<1>(test.param);
    });

}  // namespace
}  // namespace burnish
