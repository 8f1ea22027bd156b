// Whole pictures, pixel by pixel through the trace: what it says is stored must be what the
// renderer stores, on every machine profile and instruction set, in every format. So must be the
// rest of what a trace promises of any pixel.
#include <gtest/gtest.h>

#include <array>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstring>
#include <string>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

/// Raw vertices in all spaces, perspective, several depth tests; three stages.
Scene raw_scene(Machine machine) {
    Scene scene = scenes::machine();
    machine.general_stages = std::max(machine.general_stages, 3);
    machine.stage_constants = true;
    scene.machine = machine;
    return scene;
}

/// A ball with the model, bump map and all.
Scene ball_scene(const Machine& machine) {
    Scene scene = scenes::lit_scene(machine, 48, 36);
    scene.format = PixelFormat::rgba16;
    scene.lights[0].color = glm::vec3(1.0F);
    scene.ambient = {};
    auto material = std::make_shared<Material>();
    if (machine.texture_units > 2) {
        material = scenes::brushed();
        if (machine.general_stages > 2) scene.ambient = {0.05F, 0.05F, 0.06F};
    } else {
        material->ks = glm::vec3(0.8F);
        material->normal_map = scenes::streaks(32, 16, {128, 128, 240, 255}, 60);
    }
    scene.objects.push_back(
        {Mesh(shapes::sphere(12, 7, {1.4F, 1.0F, 1.0F})), material, glm::mat4(1.0F), {}});
    return scene;
}

/// A ball with a narrow lobe, whose table looks at neighbours.
Scene lobe_scene(const Machine& machine, TableFilter filter) {
    Scene scene = scenes::lit_scene(machine, 24, 18);
    scene.format = PixelFormat::rgba16;
    scene.machine.table_filter = filter;
    auto material = std::make_shared<Material>();
    material->model = Model::abp;
    material->exponent = 200.0F;
    scene.objects.push_back({Mesh(shapes::sphere(12, 7)), material, glm::mat4(1.0F), {}});
    return scene;
}
Scene mip_scene(const Machine& machine) {
    return lobe_scene(machine, TableFilter::mip);
}
Scene exact_scene(const Machine& machine) {
    return lobe_scene(machine, TableFilter::exact);
}

/// Triangles that the near plane and the guard band cut.
Scene cut_scene(const Machine& machine) {
    Scene scene = scenes::near_plane();
    scene.width = 60;
    scene.height = 40;
    scene.format = PixelFormat::rgba32f;
    scene.machine = machine;
    return scene;
}

/// Layers, small enough to follow every pixel.
Scene layers_scene(const Machine& machine) {
    Scene scene = scenes::layers();
    scene.machine = machine;
    scene.width = 40;
    scene.height = 30;
    for (Object& object : scene.objects) {  // window coordinates
        if (auto* raw = std::get_if<RawVertices>(&object.geometry))
            for (RawVertex& v : raw->vertices)
                v.position *= glm::vec4(40.0F / 260.0F, 30.0F / 190.0F, 1.0F, 1.0F);
    }
    return scene;
}

template <class Channel>
std::array<double, 4> channels_at(const Framebuffer& frame, int x, int y) {
    Channel v[4];
    std::memcpy(v, frame.row(y) + static_cast<std::size_t>(x) * sizeof v, sizeof v);
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]),
            static_cast<double>(v[3])};
}

std::array<double, 4> pixel_of(const Framebuffer& frame, int x, int y) {
    if (frame.format() == PixelFormat::rgba8) return channels_at<std::uint8_t>(frame, x, y);
    if (frame.format() == PixelFormat::rgba16) return channels_at<std::uint16_t>(frame, x, y);
    return channels_at<float>(frame, x, y);
}

struct Case {
    const char* scene;
    Scene (*make)(const Machine&);
    const char* machine;
    const char* half_vector;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.scene << " on " << c.machine;
}

Scene raw_scene_of(const Machine& machine) {
    return raw_scene(machine);
}

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const char* machine : {"geforce256", "nv2a", "ideal"}) {
        for (const char* half_vector : {"vertex", "pixel"}) {
            list.push_back({"ball", ball_scene, machine, half_vector});
            list.push_back({"cut", cut_scene, machine, half_vector});
            list.push_back({"layers", layers_scene, machine, half_vector});
        }
        list.push_back({"raw", raw_scene_of, machine, "vertex"});
    }
    list.push_back({"mip", mip_scene, "ideal", "pixel"});
    list.push_back({"exact", exact_scene, "ideal", "pixel"});
    return list;
}

/// What holds at every fragment, whatever is drawn there.
void check_fragment(const PixelTrace& trace) {
    const TracedFragment& f = *trace.fragment;
    ASSERT_NEAR(f.barycentrics[0] + f.barycentrics[1] + f.barycentrics[2], 1.0, 1e-12);
    ASSERT_GE(f.depth, 0.0);
    ASSERT_LE(f.depth, 1.0);
    ASSERT_GT(f.one_over_w.value, 0.0);
    ASSERT_NEAR(f.one_over_w.error() / f.one_over_w.exact, 0.0, 1e-3);
    for (const TracedFetch& fetch : f.fetches) {
        for (std::size_t c = 0; c < 4; ++c) {
            // Two roundings to 8 bits, and weights that are up to 1/256 too small.
            ASSERT_NEAR(fetch.color[c].error(), 0.0, 5.0 / 255.0) << "unit " << fetch.unit;
        }
    }
    for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_GE(f.codes[c], 0);
        ASSERT_LE(f.codes[c], trace.one);
        ASSERT_GE(f.color[c].exact, 0.0);
        ASSERT_LE(f.color[c].exact, 1.0);
    }
}

/// Every pixel, or every third of a row where the sanitizers take their time.
#ifdef BURNISH_SANITIZED
constexpr int kStep = 3;
#else
constexpr int kStep = 1;
#endif

class TracePictures : public testing::TestWithParam<Case> {};

TEST_P(TracePictures, AreThoseOfTheRenderer) {
    Machine machine = machine_profile(GetParam().machine);
    machine.half_vector =
        std::string(GetParam().half_vector) == "pixel" ? HalfVector::pixel : HalfVector::vertex;
    const Scene scene = GetParam().make(machine);
    std::vector<Framebuffer> frames;
    std::vector<std::string> isas;
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        frames.emplace_back(scene.width, scene.height, scene.format);
        Renderer({.threads = 2, .isa = std::string(isa.name)}).render(scene, frames.back());
        isas.emplace_back(isa.name);
    }
    int covered = 0, clipped = 0;
    double worst = 0.0;  // of the colours, 1/255
    for (int y = 0; y < scene.height; ++y) {
        for (int x = y % kStep; x < scene.width; x += kStep) {
            const PixelTrace trace = trace_pixel(scene, x, y);
            for (std::size_t i = 0; i < frames.size(); ++i) {
                ASSERT_EQ(trace.stored, pixel_of(frames[i], x, y))
                    << isas[i] << " at " << x << "," << y;
            }
            if (!trace.fragment) continue;
            covered += kStep;
            clipped += trace.fragment->clipped ? kStep : 0;
            check_fragment(trace);
            for (const TracedNumber& n : trace.fragment->color) {
                worst = std::max(worst, std::abs(n.error()) * 255.0);
            }
        }
    }
    // docs/numbers.md measured 1.85 for the model with maps and h as colours.
    if (machine.numbers == NumberModel::wide) {
        EXPECT_LE(worst, 2.0);
    }
    RecordProperty("worst_error_of_255", std::to_string(worst));
    EXPECT_GT(covered, scene.width * scene.height / 5);
    EXPECT_EQ(clipped > 100, std::string(GetParam().scene) == "cut") << clipped;
}

INSTANTIATE_TEST_SUITE_P(All, TracePictures, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& test) {
                             return std::string(test.param.scene) + "_" + test.param.machine + "_" +
                                    test.param.half_vector;
                         });

}  // namespace
}  // namespace burnish
