// One picture per scene, whatever the instruction set, the number of threads, the memory cap and
// what the renderer drew before. The hashes hold every CPU to the same bits.
#include <gtest/gtest.h>

#include <burnish/files.hpp>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

/// FNV-1a, 64 bits, over the rows.
std::uint64_t hash_of(const Framebuffer& frame) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (int y = 0; y < frame.height(); ++y) {
        const std::byte* row = frame.row(y);
        for (std::size_t i = 0;
             i < static_cast<std::size_t>(frame.width()) * pixel_size(frame.format()); ++i) {
            hash = (hash ^ static_cast<std::uint64_t>(row[i])) * 0x100000001b3U;
        }
    }
    return hash;
}

/// Pictures as they were looked at. A change here is a change of what the machine computes.
const std::map<std::string, std::uint64_t>& pinned() {
    static const std::map<std::string, std::uint64_t> hashes{
        {"knot", 0xc4cfaa5be5e36861U},       {"ellipsoid", 0x586a6be3e626b2c2U},
        {"million", 0x9d40af5210107e6cU},    {"near_plane", 0x8fadf5d30a7465e0U},
        {"machine", 0xdb208ccc5ef7eb85U},    {"layers", 0x1a060abcf2d0d057U},
        {"two_lights", 0x640cb8c0391767e8U}, {"filtered_after", 0xf26cf756c160d7c0U},
    };
    return hashes;
}

const Scene& scene_named(const std::string& name) {
    static std::map<std::string, Scene> made;
    const auto at = made.find(name);
    if (at != made.end()) return at->second;
    for (const scenes::NamedScene& s : scenes::all()) {
        if (s.name == name) return made.emplace(name, s.make()).first->second;
    }
    throw std::runtime_error("no scene " + name);
}

std::string hex(std::uint64_t hash) {
    char text[24];
    std::snprintf(text, sizeof text, "0x%016" PRIx64, hash);
    return text;
}

/// BURNISH_SAVE_IMAGES=DIR keeps the pictures, to look at.
void keep(const Framebuffer& frame, const std::string& name) {
    const char* directory = std::getenv("BURNISH_SAVE_IMAGES");
    if (directory != nullptr) save_image(frame, std::string(directory) + "/" + name + ".png");
}

struct Case {
    std::string scene;
    std::string isa;
    bool available;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.scene << " on " << c.isa;
}

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const scenes::NamedScene& scene : scenes::all()) {
        for (const IsaInfo& isa : instruction_sets()) {
            list.push_back({scene.name, std::string(isa.name), isa.available});
        }
    }
    return list;
}

class Images : public testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        if (!GetParam().available) GTEST_SKIP() << GetParam().isa << " does not run on this CPU";
    }
    Framebuffer draw(Renderer& renderer, FrameStats* stats = nullptr,
                     PixelFormat format = PixelFormat::rgba8) const {
        const Scene& scene = scene_named(GetParam().scene);
        Framebuffer frame(scene.width, scene.height, format);
        const FrameStats got = renderer.render(scene, frame);
        if (stats != nullptr) *stats = got;
        return frame;
    }
    Framebuffer draw(int threads, std::size_t cap = std::size_t{256} << 20,
                     FrameStats* stats = nullptr, PixelFormat format = PixelFormat::rgba8) const {
        Renderer renderer({.threads = threads, .isa = GetParam().isa, .memory_cap = cap});
        return draw(renderer, stats, format);
    }
    [[nodiscard]] std::uint64_t want() const { return pinned().at(GetParam().scene); }
    [[nodiscard]] bool is_slow() const {
        return GetParam().scene == "million" && GetParam().isa == "reference";
    }
};

TEST_P(Images, IsTheSameForEveryThreadCount) {
    for (const int threads : {1, 2, 3, 8}) {
        if (is_slow() && threads != 3) continue;
        FrameStats stats;
        const Framebuffer frame = draw(threads, std::size_t{256} << 20, &stats);
        if (threads == 1) keep(frame, GetParam().scene + "-" + GetParam().isa);
        ASSERT_EQ(hex(hash_of(frame)), hex(want())) << threads << " threads";
        EXPECT_EQ(stats.flushes, 0U);
        EXPECT_EQ(stats.tiles_per_worker.size(), static_cast<std::size_t>(threads));
    }
}

// The bins hold next to nothing, so depth and colour live on in the frame, many times over.
TEST_P(Images, IsTheSameWhenTheBinsAreFlushed) {
    if (is_slow()) GTEST_SKIP() << "the scalar reference is slow";
    FrameStats stats;
    const std::size_t cap = GetParam().scene == "million" ? std::size_t{4} << 20 : 1;
    ASSERT_EQ(hex(hash_of(draw(2, cap, &stats))), hex(want()));
    EXPECT_GT(stats.flushes, 0U);
}

TEST_P(Images, DoesNotDependOnEarlierFrames) {
    if (is_slow()) GTEST_SKIP() << "the scalar reference is slow";
    Renderer renderer({.threads = 2, .isa = GetParam().isa});
    for (const char* other : {"machine", "ellipsoid", "near_plane"}) {
        const Scene& scene = scene_named(other);
        Framebuffer frame(scene.width, scene.height, PixelFormat::rgba16);
        renderer.render(scene, frame);
    }
    EXPECT_EQ(hex(hash_of(draw(renderer))), hex(want()));
}

// Wider frames hold what the final combiner left, so their top bits are the 8-bit picture's. Every
// blend rounds to half a code of its frame; no pixel of `layers` lies under more than a dozen.
TEST_P(Images, WideFramesAgreeWithTheEightBitFrame) {
    if (is_slow()) GTEST_SKIP() << "the scalar reference is slow";
    const Framebuffer narrow = draw(2),
                      wide = draw(2, std::size_t{256} << 20, nullptr, PixelFormat::rgba16),
                      real = draw(2, std::size_t{256} << 20, nullptr, PixelFormat::rgba32f);
    const bool nine_bit = scene_named(GetParam().scene).machine.numbers == NumberModel::nine_bit;
    const int blends = GetParam().scene == "layers" ? 12 : 0;
    for (int y = 0; y < narrow.height(); ++y) {
        const auto* a = reinterpret_cast<const std::uint8_t*>(narrow.row(y));
        const auto* b = reinterpret_cast<const std::uint16_t*>(wide.row(y));
        const auto* c = reinterpret_cast<const float*>(real.row(y));
        for (int i = 0; i < 4 * narrow.width(); ++i) {
            // An 8-bit code is 257 16-bit ones; the wide model has 64.25 codes for it.
            const int low = blends > 0 ? 129 * blends : nine_bit ? 0 : 129;
            ASSERT_NEAR(b[i], 257 * a[i], low) << "row " << y << ", channel " << i;
            ASSERT_NEAR(c[i] * 65535.0F, static_cast<float>(b[i]),
                        0.51F * static_cast<float>(1 + blends))
                << "row " << y << ", channel " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Images, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& test) {
                             return test.param.scene + "_" + test.param.isa;
                         });

TEST(Images, TheScenesAreWhatTheirNamesSay) {
    EXPECT_EQ(std::get<Mesh>(scene_named("million").objects[0].geometry).triangle_count(),
              1000000U);
    Framebuffer frame(300, 200);
    const FrameStats stats = Renderer().render(scene_named("near_plane"), frame);
    EXPECT_GE(stats.clipped_triangles, 5U);
}

}  // namespace
}  // namespace burnish
