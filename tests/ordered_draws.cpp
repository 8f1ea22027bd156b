// Draws whose fragments need order, mixed with others that do not: many random scenes against a
// painter that takes triangle after triangle, and whole pixels at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/renderer.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/cpu.hpp"
#include "draw.hpp"
#include "image/tile_image.hpp"
#include "kernel_packet.hpp"
#include "raster/bin.hpp"
#include "raster/tile.hpp"
#include "shade/packets.hpp"
#include "tests/vertex_color.hpp"

namespace burnish {
namespace {

using Codes = std::array<int, 4>;

struct Triangle {
    std::array<RawVertex, 3> corner;
    float depth;      ///< level
    float own_depth;  ///< what a fragment may replace it with: uv0.t
    float keeps;      ///< > 0: lives, uv0.s
};
struct Layer {
    std::vector<Triangle> triangles;
    DepthTest depth_test = DepthTest::less;
    bool depth_write = true;
    std::optional<Blend> blend;
    AlphaTest alpha_test;
};

RawVertices vertices(const std::vector<Triangle>& triangles) {
    RawVertices raw{Space::window, Topology::triangles, {}};
    for (const Triangle& t : triangles)
        raw.vertices.insert(raw.vertices.end(), t.corner.begin(), t.corner.end());
    return raw;
}

Triangle random_triangle(Random& random, int width, int height) {
    Triangle t{};
    t.depth = static_cast<float>(random.between(1, 7)) * 0.125F;
    t.own_depth = random.chance(6) ? 1.5F : static_cast<float>(random.between(1, 15)) / 16.0F;
    t.keeps = random.chance(3) ? -1.0F : 1.0F;
    const float reach = random.chance(2) ? 12.0F : static_cast<float>(2 * width);
    const float x = random.real(0.0F, static_cast<float>(width)),
                y = random.real(0.0F, static_cast<float>(height));
    for (RawVertex& v : t.corner) {
        v.position = {x + random.real(-reach, reach), y + random.real(-reach, reach), t.depth,
                      1.0F};
        for (int c = 0; c < 4; ++c) v.color0[c] = random.unit();
        v.uv[0] = {t.keeps, t.own_depth, 0.0F, 1.0F};
    }
    return t;
}

std::vector<Layer> random_layers(Random& random, int width, int height) {
    constexpr std::array<Comparison, 8> kComparisons{
        Comparison::never,   Comparison::less,     Comparison::equal,  Comparison::lequal,
        Comparison::greater, Comparison::notequal, Comparison::gequal, Comparison::always};
    const std::array<Blend, 5> blends{Blend::alpha(), Blend::add(), Blend::multiply(),
                                      Blend::premultiplied(),
                                      Blend{BlendFactor::dst_alpha,
                                            BlendFactor::one_minus_src_color,
                                            BlendEquation::reverse_subtract,
                                            {}}};
    std::vector<Layer> layers(static_cast<std::size_t>(random.between(2, 9)));
    for (Layer& layer : layers) {
        const int count = random.chance(3) ? random.between(20, 60) : random.between(1, 6);
        for (int i = 0; i < count; ++i)
            layer.triangles.push_back(random_triangle(random, width, height));
        layer.depth_test = random.chance(2) ? random.pick(kComparisons) : DepthTest::lequal;
        layer.depth_write = !random.chance(3);
        if (random.chance(2)) layer.blend = random.pick(blends);
        if (random.chance(3)) layer.alpha_test = {random.pick(kComparisons), random.unit()};
    }
    return layers;
}

Scene scene_of(const std::vector<Layer>& layers, int width, int height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.machine = machine_profile("nv2a");
    scene.background = {0.2F, 0.4F, 0.6F, 0.8F};
    for (const Layer& layer : layers) {
        auto material = vertex_color();
        material->alpha_test = layer.alpha_test;
        scene.objects.push_back({vertices(layer.triangles),
                                 material,
                                 glm::mat4(1.0F),
                                 {.depth_test = layer.depth_test,
                                  .depth_write = layer.depth_write,
                                  .blend = layer.blend}});
    }
    return scene;
}

/// Colours of a triangle by itself; nothing where it covers no pixel.
struct Coverage {
    Framebuffer frame;
    [[nodiscard]] std::optional<Codes> at(int x, int y) const {
        const auto* p = reinterpret_cast<const float*>(frame.row(y)) + 4 * x;
        if (p[3] < 0.0F) return std::nullopt;
        Codes codes{};
        for (std::size_t c = 0; c < 4; ++c) codes[c] = static_cast<int>(p[c] * 255.0F + 0.5F);
        return codes;
    }
};
/// Drawn into floats; `uncovered` marks what no fragment reaches: an alpha of -1, which no program
/// leaves.
Coverage coverage_of(const Triangle& triangle, int width, int height) {
    static Renderer renderer({.threads = 1, .isa = "reference"});
    Layer alone;
    alone.triangles = {triangle};
    alone.depth_test = DepthTest::always;
    Scene scene = scene_of({alone}, width, height);
    Coverage black{Framebuffer(width, height, PixelFormat::rgba32f)},
        white{Framebuffer(width, height, PixelFormat::rgba32f)};
    scene.background = glm::vec4(0.0F);
    renderer.render(scene, black.frame);
    scene.background = glm::vec4(1.0F);
    renderer.render(scene, white.frame);
    for (int y = 0; y < height; ++y) {
        auto* b = reinterpret_cast<float*>(black.frame.row(y));
        const auto* w = reinterpret_cast<const float*>(white.frame.row(y));
        for (int x = 0; x < width; ++x)
            if (b[4 * x + 3] != w[4 * x + 3]) b[4 * x + 3] = -1.0F;
    }
    return black;
}

template <class T>
bool passes(Comparison test, T tested, T reference) {
    switch (test) {
        case Comparison::never:
            return false;
        case Comparison::less:
            return tested < reference;
        case Comparison::equal:
            return tested == reference;
        case Comparison::lequal:
            return tested <= reference;
        case Comparison::greater:
            return tested > reference;
        case Comparison::notequal:
            return tested != reference;
        case Comparison::gequal:
            return tested >= reference;
        case Comparison::always:
            return true;
    }
    return false;
}

int factor(BlendFactor f, int c, const Codes& s, const Codes& d) {
    switch (f) {
        case BlendFactor::one:
            return 255;
        case BlendFactor::src_alpha:
            return s[3];
        case BlendFactor::one_minus_src_alpha:
            return 255 - s[3];
        case BlendFactor::one_minus_src_color:
            return 255 - s[static_cast<std::size_t>(c)];
        case BlendFactor::dst_color:
            return d[static_cast<std::size_t>(c)];
        case BlendFactor::dst_alpha:
            return d[3];
        default:
            return 0;
    }
}

Codes blend(const Blend& b, const Codes& s, const Codes& d) {
    Codes out{};
    for (int c = 0; c < 4; ++c) {
        const auto k = static_cast<std::size_t>(c);
        const int source = s[k] * factor(b.src, c, s, d), below = d[k] * factor(b.dst, c, s, d);
        const int p = b.equation == BlendEquation::add ? source + below : below - source;
        out[k] = p < 0 ? 0 : std::min((2 * p + 255) / 510, 255);
    }
    return out;
}

/// Which tests beyond those of a layer its fragments go through.
struct Extras {
    bool keeps = false, replaces_depth = false;
};

struct Painting {
    std::vector<Codes> colors;
    std::vector<float> depths;
};

/// Pixel by pixel in the order of submission.
Painting painted(const std::vector<Layer>& layers, int width, int height,
                 const Extras& extras = {}) {
    std::vector<Codes> colors(static_cast<std::size_t>(width * height), {51, 102, 153, 204});
    std::vector<float> depths(colors.size(), 1.0F);
    for (const Layer& layer : layers) {
        for (const Triangle& t : layer.triangles) {
            const Coverage coverage = coverage_of(t, width, height);
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const std::optional<Codes> s = coverage.at(x, y);
                    if (!s) continue;
                    const auto i = static_cast<std::size_t>(y * width + x);
                    const int reference =
                        static_cast<int>(layer.alpha_test.reference * 255.0F + 0.5F);
                    if (!passes(layer.alpha_test.pass, (*s)[3], reference)) continue;
                    if (extras.keeps && !(t.keeps > 0.0F)) continue;
                    const float depth = extras.replaces_depth ? t.own_depth : t.depth;
                    if (depth > 1.0F || !passes(layer.depth_test, depth, depths[i])) continue;
                    if (layer.depth_write) depths[i] = depth;
                    colors[i] = layer.blend ? blend(*layer.blend, *s, colors[i]) : *s;
                }
            }
        }
    }
    return {colors, depths};
}

std::string difference(const Framebuffer& frame, const std::vector<Codes>& want) {
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const std::byte* p = frame.row(y) + std::ptrdiff_t{4} * x;
            const Codes& w = want[static_cast<std::size_t>(y * frame.width() + x)];
            for (std::size_t c = 0; c < 4; ++c)
                if (std::to_integer<int>(p[c]) != w[c])
                    return "pixel " + std::to_string(x) + ", " + std::to_string(y) + ", channel " +
                           std::to_string(c) + ": got " +
                           std::to_string(std::to_integer<int>(p[c])) + ", want " +
                           std::to_string(w[c]);
        }
    }
    return {};
}

TEST(OrderedDraws, RandomScenesAreWhatAPainterPaints) {
    constexpr int kWidth = 90, kHeight = 70;  // four tiles, three of them cut
    for (unsigned seed = 0; seed < 40; ++seed) {
        Random random(seed);
        const std::vector<Layer> layers = random_layers(random, kWidth, kHeight);
        const Painting want = painted(layers, kWidth, kHeight);
        const Scene scene = scene_of(layers, kWidth, kHeight);
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            for (const std::size_t cap : {std::size_t{1}, std::size_t{1} << 20}) {
                Renderer renderer(
                    {.threads = cap == 1 ? 3 : 1, .isa = std::string(isa.name), .memory_cap = cap});
                Framebuffer frame(kWidth, kHeight);
                renderer.render(scene, frame);
                ASSERT_EQ(difference(frame, want.colors), "")
                    << "seed " << seed << ", " << isa.name << ", cap " << cap;
                std::vector<float> depths(want.depths.size());
                Framebuffer depth_frame(depths.data(), kWidth * std::ptrdiff_t{sizeof(float)},
                                        kWidth, kHeight, PixelFormat::depth32f);
                renderer.render(scene, depth_frame);
                ASSERT_EQ(depths, want.depths)
                    << "seed " << seed << ", " << isa.name << ", cap " << cap;
            }
        }
    }
}

/// A triangle over all of the frame.
Triangle sheet(Random& random, int width, int height, float depth) {
    Triangle t = random_triangle(random, width, height);
    t.depth = depth;
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    t.corner[0].position = {-9.0F, -9.0F, depth, 1.0F};
    t.corner[1].position = {-9.0F, 3.0F * h, depth, 1.0F};
    t.corner[2].position = {3.0F * w, -9.0F, depth, 1.0F};
    return t;
}

// Sheets that lie over everything without a depth test, between other draws: whole tiles begin
// anew there, unless depths of before are compared with later.
TEST(OrderedDraws, SheetsWithoutADepthTestHideWhatWasDrawn) {
    constexpr int kWidth = 70, kHeight = 66;
    for (unsigned seed = 0; seed < 20; ++seed) {
        Random random(seed);
        std::vector<Layer> layers = random_layers(random, kWidth, kHeight);
        const bool writes_before = random.chance(2);
        for (Layer& layer : layers) layer.depth_write = layer.depth_write && writes_before;
        Layer over;
        over.triangles = {sheet(random, kWidth, kHeight, 0.5F)};
        over.depth_test = DepthTest::always;
        over.depth_write = random.chance(3);
        if (random.chance(4)) over.blend = Blend::alpha();
        layers.push_back(over);
        for (Layer& layer : random_layers(random, kWidth, kHeight)) layers.push_back(layer);
        const Painting want = painted(layers, kWidth, kHeight);
        const Scene scene = scene_of(layers, kWidth, kHeight);
        Renderer renderer({.threads = 1});
        Framebuffer frame(kWidth, kHeight);
        renderer.render(scene, frame);
        ASSERT_EQ(difference(frame, want.colors), "") << "seed " << seed;
    }
}

TEST(OrderedDraws, HiddenBlendsAreNotShaded) {
    constexpr int kWidth = 140, kHeight = 130;
    Random random(1);
    Layer below, over;
    for (int i = 0; i < 5; ++i) below.triangles.push_back(sheet(random, kWidth, kHeight, 0.25F));
    below.blend = Blend::alpha();
    over.triangles = {sheet(random, kWidth, kHeight, 0.5F)};
    below.depth_test = over.depth_test = DepthTest::always;
    Renderer renderer({.threads = 1});
    Framebuffer frame(kWidth, kHeight);
    const auto shaded = [&] {
        return renderer.render(scene_of({below, over}, kWidth, kHeight), frame).shaded_pixels;
    };
    EXPECT_EQ(shaded(), 1U * kWidth * kHeight);
    over.depth_write = false;  // depths of before may matter
    EXPECT_EQ(shaded(), 6U * kWidth * kHeight);
    below.depth_write = false;
    EXPECT_EQ(shaded(), 1U * kWidth * kHeight);
}

// ---- what shading may say of a fragment, with shadings made by hand

/// One tile, drawn as the renderer does, after `change` had its way with every draw's shading.
Framebuffer draw_tile(const Scene& scene, const KernelTable& kernels,
                      const std::function<void(Shading&)>& change) {
    WorkerPool pool(1);
    DerivedMaps maps;
    const FrameView view{&scene, make_view(scene.camera, scene.width, scene.height),
                         make_viewport(scene.machine, scene.width, scene.height)};
    const FrameSize size{scene.width, scene.height};
    TileVisibility visibility;
    PacketShader shader;
    TileImage image(PixelFormat::rgba8);
    std::vector<std::unique_ptr<Draw>> draws;
    std::vector<DepthRule> rules;
    std::vector<ShadedDraw> shaded;
    for (const Object& object : scene.objects) {
        draws.push_back(std::make_unique<Draw>());
        Draw& draw = *draws.back();
        prepare_draw(draw, view, object, maps);
        change(draw.shading);
        plan_fragments(draw, view, object);
        transform_draw(draw, view, object, kernels, pool);
        rules.push_back(draw.depth);
        shaded.push_back({&draw.shading, &draw.output, draw.mesh()});
    }
    visibility.begin(0, 0, size, nullptr);
    image.set_background(scene.background);
    image.clear();
    shader.begin(
        {0, 0, {StoreFormat::rgba8, image.pixels(), visibility.depth(), visibility.block_far()}});
    const auto shade_visible = [&] {
        if (visibility.shows_anything()) shader.shade(visibility.collect(kernels), shaded, kernels);
        visibility.forget();
    };
    std::vector<Chunk> chunks(draws.size());
    for (std::size_t i = 0; i < draws.size(); ++i) {
        Chunk& chunk = chunks[i];
        chunk.fill({draws[i]->mesh(), static_cast<std::uint32_t>(i), draws[i]->facing,
                    view.viewport, size},
                   0, draws[i]->triangle_count(), kernels);
        if (!draws[i]->ordered) {
            shader.flush(kernels);
            visibility.draw(chunk, rules, kernels);
            continue;
        }
        shade_visible();
        shader.start_draw(shaded[i], kernels);
        PixelMask passed;
        for (const TileEntry& entry : chunk.tile(0, 0)) {
            const SetupTriangle& triangle = chunk.triangles()[entry.triangle];
            if (visibility.cover(triangle, rules[i], kernels, passed))
                shader.add(triangle, passed, kernels);
        }
    }
    shader.flush(kernels);
    shade_visible();
    Framebuffer frame(scene.width, scene.height);
    image.resolve(frame, 0, 0);
    return frame;
}

/// uv0.s decides who lives, uv0.t is a fragment's own depth.
void use_coordinates(Shading& shading, const Extras& extras, bool quads) {
    const int next = shading.interpolated();
    shading.varying_list.push_back({Varying::Source::uv, 0});
    shading.varying_list.push_back({Varying::Source::uv, 1});
    if (extras.keeps) shading.keep_attribute = next;
    if (extras.replaces_depth) shading.depth_attribute = next + 1;
    shading.quads = quads;
}

void check_by_hand(const Extras& extras, bool quads) {
    constexpr int kWidth = 61, kHeight = 53;  // whole blocks and quads reach beyond it
    for (unsigned seed = 100; seed < 130; ++seed) {
        Random random(seed);
        std::vector<Layer> layers = random_layers(random, kWidth, kHeight);
        if (extras.replaces_depth) {  // depths that went through a division are not compared for
                                      // equality
            for (Layer& layer : layers)
                if (layer.depth_test != DepthTest::always) layer.depth_test = DepthTest::less;
        }
        const std::vector<Codes> want = painted(layers, kWidth, kHeight, extras).colors;
        const Scene scene = scene_of(layers, kWidth, kHeight);
        for (const KernelTable* kernels : available_tables()) {
            const Framebuffer frame =
                draw_tile(scene, *kernels, [&](Shading& s) { use_coordinates(s, extras, quads); });
            ASSERT_EQ(difference(frame, want), "") << "seed " << seed << ", " << kernels->isa;
        }
    }
}

TEST(OrderedDraws, FragmentsLiveWhereTheirAttributeIsPositive) {
    check_by_hand({.keeps = true}, false);
}
TEST(OrderedDraws, FragmentsBringTheirOwnDepth) {
    check_by_hand({.replaces_depth = true}, false);
    check_by_hand({.keeps = true, .replaces_depth = true}, false);
}
TEST(OrderedDraws, QuadsChangeNoPixel) {
    check_by_hand({}, true);
    check_by_hand({.keeps = true, .replaces_depth = true}, true);
}

// ---- quads

/// x and y of a tile pixel.
std::array<int, 2> place(int pixel) {
    return {pixel / 64 % 8 * 8 + pixel % 8, pixel / 512 * 8 + pixel / 8 % 8};
}

TEST(OrderedDraws, QuadsAreWholeAndHelpersAreNotStored) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        Random random(seed);
        PixelMask mask;
        std::vector<std::uint16_t> pixels;
        const int share = random.between(1, 40);
        for (int i = 0; i < kTilePixels; ++i)
            if (random.chance(share)) pixels.push_back(static_cast<std::uint16_t>(i));
        mask_pixels(pixels.data(), static_cast<int>(pixels.size()), mask);
        static PixelList list;
        list_pixels(mask, list);
        ASSERT_EQ(std::vector<std::uint16_t>(list.shaded, list.shaded + list.count), pixels);

        list_quads(mask, list);
        ASSERT_EQ(list.count % 4, 0);
        std::vector<std::uint16_t> stored;
        for (int i = 0; i < list.count; i += 4) {
            const auto [x, y] = place(list.shaded[i]);
            ASSERT_EQ(x % 2 + y % 2, 0);
            int helpers = 0;
            for (int k = 0; k < 4; ++k) {
                ASSERT_EQ(place(list.shaded[i + k]), (std::array{x + k % 2, y + k / 2}));
                if (list.stored[i + k] == kNoPixel) {
                    ++helpers;
                    continue;
                }
                ASSERT_EQ(list.stored[i + k], list.shaded[i + k]);
                stored.push_back(list.stored[i + k]);
            }
            ASSERT_LT(helpers, 4);
        }
        std::sort(stored.begin(), stored.end());
        ASSERT_EQ(stored, pixels);
    }
}

// ---- what the packets are

TEST(OrderedDraws, SmallTrianglesShareAPacket) {
    // 200 triangles of a pixel or so, side by side, under blending: all fit one packet, so that the
    // fragments are as many as the pixels, and stacking them twice costs one more packet.
    Layer layer;
    layer.blend = Blend::alpha();
    layer.depth_test = DepthTest::always;
    for (int i = 0; i < 200; ++i) {
        Random random(static_cast<unsigned>(i));
        Triangle t = random_triangle(random, 64, 64);
        const auto x = static_cast<float>(i % 20 * 3), y = static_cast<float>(i / 20 * 3);
        t.corner[0].position = {x, y, 0.5F, 1.0F};
        t.corner[1].position = {x + 1.0F, y, 0.5F, 1.0F};
        t.corner[2].position = {x, y + 1.5F, 0.5F, 1.0F};
        layer.triangles.push_back(t);
    }
    static int calls = 0;
    static KernelTable counting = table_reference();
    counting.blend_nine_bit = [](Packet& packet, const BlendCtx& ctx) noexcept {
        ++calls;
        table_reference().blend_nine_bit(packet, ctx);
    };
    calls = 0;
    draw_tile(scene_of({layer}, 64, 64), counting, [](Shading&) {});
    EXPECT_EQ(calls, 1);
    Layer twice = layer;
    twice.triangles.insert(twice.triangles.end(), layer.triangles.begin(), layer.triangles.end());
    calls = 0;
    draw_tile(scene_of({twice}, 64, 64), counting, [](Shading&) {});
    EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace burnish
