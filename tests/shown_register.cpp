// Registers as pictures: every register after every stage, against the trace of each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstring>
#include <string>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

Scene ball_scene(const Machine& machine) {
    Scene scene = scenes::lit_scene(machine, 24, 18);
    scene.background = {0.2F, 0.4F, 0.6F, 1.0F};
    scene.lights[0].color = glm::vec3(1.0F);
    auto material = scenes::brushed();
    if (machine.texture_units < 3) material->specular_map = nullptr;
    scene.objects.push_back({Mesh(shapes::sphere(12, 7)), material, glm::mat4(1.0F), {}});
    return scene;
}

Scene raw_scene(const Machine& machine) {
    Scene scene = scenes::machine();
    scene.machine = machine;
    scene.machine.general_stages = 16;
    scene.width = 100;
    scene.height = 60;
    scene.background = {0.2F, 0.4F, 0.6F, 1.0F};
    return scene;
}

/// Blended, and with alpha tests: the register is that of the last fragment that is in the picture.
Scene tested_scene(const Machine& machine) {
    Scene scene = raw_scene(machine);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        auto material = std::make_shared<Material>(*scene.objects[i].material);
        if (i != 2) material->alpha_test = {Comparison::greater, 0.3F};
        scene.objects[i].material = material;
        if (i % 2 == 1) scene.objects[i].raster.blend = Blend::add();
    }
    return scene;
}

template <class Channel>
std::array<Channel, 4> pixel(const Framebuffer& frame, int x, int y) {
    std::array<Channel, 4> v;
    std::memcpy(v.data(), frame.row(y) + static_cast<std::size_t>(x) * sizeof v, sizeof v);
    return v;
}

/// value/2 + 1/2 as docs/numbers.md rounds it: half up in the machine, then to the byte.
int coded_byte(int code, int one) {
    const int half = std::clamp((code + one + 1) >> 1, 0, one);
    return one == 255 ? half : (255 * half + 8192) >> 14;
}

struct Case {
    const char* name;
    Scene (*make)(const Machine&);
    const char* machine;
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name << " on " << c.machine;
}

/// Every pixel, or every third of a row where the sanitizers take their time.
#ifdef BURNISH_SANITIZED
constexpr int kStep = 3;
#else
constexpr int kStep = 1;
#endif

class ShownRegisters : public testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        m_scene = GetParam().make(machine_profile(GetParam().machine));
        for (int y = 0; y < m_scene.height; ++y) {
            for (int x = y % kStep; x < m_scene.width; x += kStep) {
                m_traces.push_back(trace_pixel(m_scene, x, y));
                if (m_traces.back().fragment) m_found = m_traces.size();
            }
        }
        ASSERT_GT(m_found, 0U);
        m_some = &*m_traces[m_found - 1].fragment;
    }

    /// Row `r` of stage `s` of every traced pixel against pictures of it.
    void check(std::size_t s, std::size_t r, const ShownRegister& shown, const std::string& isa) {
        Renderer renderer({.threads = 2, .isa = isa});
        Framebuffer floats(m_scene.width, m_scene.height, PixelFormat::rgba32f);
        Framebuffer bytes(m_scene.width, m_scene.height, PixelFormat::rgba8);
        renderer.render(m_scene, floats, shown);
        renderer.render(m_scene, bytes, shown);
        for (const PixelTrace& t : m_traces) {
            const auto real = pixel<float>(floats, t.x, t.y);
            const auto byte = pixel<std::uint8_t>(bytes, t.x, t.y);
            if (!t.fragment) {
                ASSERT_EQ(byte, (std::array<std::uint8_t, 4>{51, 102, 153, 255}));
                continue;
            }
            const TracedRegister& row = t.fragment->stages.at(s).registers.at(r);
            for (std::size_t c = 0; c < 4; ++c) {
                if (!row.filled[c]) continue;
                const std::string where = std::string(register_name(row.reg)) + " of " +
                                          t.fragment->stages[s].name + ", component " +
                                          std::to_string(c) + ", " + isa;
                ASSERT_EQ(real[c], static_cast<float>(row.codes[c]) / static_cast<float>(t.one))
                    << where;
                ASSERT_EQ(byte[c], coded_byte(row.codes[c], t.one)) << where;
            }
        }
    }

    Scene m_scene;
    std::vector<PixelTrace> m_traces;
    std::size_t m_found = 0;
    const TracedFragment* m_some = nullptr;
};

TEST_P(ShownRegisters, AreThoseOfTheTrace) {
    std::size_t pictures = 0;
    const std::size_t stages = m_some->stages.size() - 1;  // without the final combiner
    for (std::size_t s = 0; s < stages; ++s) {
        const std::vector<TracedRegister>& rows = m_some->stages[s].registers;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const ShownRegister shown{rows[r].reg, s};
            for (const IsaInfo& isa : instruction_sets()) {
                if (isa.available) check(s, r, shown, std::string(isa.name));
                ++pictures;
            }
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(pictures, 50U);
}

// What only the final combiner knows: not negative, so not coded, and it stops at 1.
TEST_P(ShownRegisters, SumAndProductOfTheFinalCombiner) {
    for (const Register reg : {Register::color_sum, Register::final_product}) {
        Framebuffer floats(m_scene.width, m_scene.height, PixelFormat::rgba32f);
        Renderer().render(m_scene, floats, ShownRegister{reg});
        for (const PixelTrace& t : m_traces) {
            if (!t.fragment) continue;
            const auto& rows = t.fragment->stages.back().registers;
            const auto row = std::find_if(rows.begin(), rows.end(),
                                          [&](const TracedRegister& r) { return r.reg == reg; });
            ASSERT_NE(row, rows.end());
            const auto got = pixel<float>(floats, t.x, t.y);
            for (std::size_t c = 0; c < 4; ++c) {
                if (!row->filled[c]) continue;
                ASSERT_EQ(got[c], static_cast<float>(std::min(row->codes[c], t.one)) /
                                      static_cast<float>(t.one))
                    << register_name(reg);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, ShownRegisters,
    testing::Values(Case{"ball", ball_scene, "geforce256"}, Case{"ball", ball_scene, "nv2a"},
                    Case{"ball", ball_scene, "ideal"}, Case{"raw", raw_scene, "nv2a"},
                    Case{"raw", raw_scene, "ideal"}, Case{"tested", tested_scene, "nv2a"},
                    Case{"tested", tested_scene, "ideal"}),
    [](const testing::TestParamInfo<Case>& test) {
        return std::string(test.param.name) + "_" + test.param.machine;
    });

TEST(ShownRegister, BeyondTheLastStageIsTheLast) {
    const Scene scene = ball_scene(machine_profile("nv2a"));
    Framebuffer last(24, 18), beyond(24, 18), unnumbered(24, 18);
    Renderer renderer;
    renderer.render(scene, last, ShownRegister{Register::spare1, 5});
    renderer.render(scene, beyond, ShownRegister{Register::spare1, 14});
    renderer.render(scene, unnumbered, ShownRegister{Register::spare1});
    EXPECT_EQ(std::memcmp(last.pixels(), beyond.pixels(), 24 * 18 * 4), 0);
    EXPECT_EQ(std::memcmp(last.pixels(), unnumbered.pixels(), 24 * 18 * 4), 0);
}

// Wide registers reach -2: bytes end at 0 and 255, floats do not.
TEST(ShownRegister, BytesStopWhereWideRegistersGoOn) {
    using namespace combine;
    ProgramBuilder p;
    p.stage()
        .rgb()
        .ab(mul(expand(Register::col0), one()), Register::spare0)
        .scale(Scale::two)
        .wide();
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    RawVertices quad{Space::window, Topology::quads, {}};
    for (const glm::vec2& at : {glm::vec2(0, 0), {4, 0}, {4, 4}, {0, 4}}) {
        RawVertex v;
        v.position = {at.x, at.y, 0.5F, 1.0F};
        v.color0 = {0.125F, 0.9375F, 0.5F, 1.0F};  // 2 (2 x - 1): -1.5, 1.75, 0
        quad.vertices.push_back(v);
    }
    Scene scene;
    scene.width = scene.height = 4;
    scene.objects.push_back({quad, material, glm::mat4(1.0F), {}});
    for (const IsaInfo& isa : instruction_sets()) {
        if (!isa.available) continue;
        Renderer renderer({.threads = 1, .isa = std::string(isa.name)});
        Framebuffer floats(4, 4, PixelFormat::rgba32f), bytes(4, 4);
        renderer.render(scene, floats, ShownRegister{Register::spare0});
        renderer.render(scene, bytes, ShownRegister{Register::spare0});
        EXPECT_EQ(pixel<float>(floats, 1, 1), (std::array<float, 4>{-1.5F, 1.75F, 0.0F, 1.0F}));
        EXPECT_EQ(pixel<std::uint8_t>(bytes, 1, 1), (std::array<std::uint8_t, 4>{0, 255, 128, 255}))
            << isa.name;
    }
}

// How a byte codes a register does not depend on how the machine rounds.
TEST(ShownRegister, CodesAreTheSameOnEveryMachine) {
    Machine machine = machine_profile("nv2a");
    machine.product_rounding = ProductRounding::shift8;
    machine.halving = Halving::down;
    for (const Register reg : {Register::tex0, Register::spare1}) {
        const Scene scene = ball_scene(machine);
        Framebuffer floats(24, 18, PixelFormat::rgba32f), bytes(24, 18);
        Renderer renderer;
        renderer.render(scene, floats, ShownRegister{reg, 1});
        renderer.render(scene, bytes, ShownRegister{reg, 1});
        const auto real = pixel<float>(floats, 12, 9);
        for (std::size_t c = 0; c < 4; ++c) {
            const auto code = static_cast<int>(std::lround(real[c] * 255.0F));
            EXPECT_EQ(int{pixel<std::uint8_t>(bytes, 12, 9)[c]}, coded_byte(code, 255)) << c;
        }
    }
}

TEST(ShownRegister, IsForOneCallOnly) {
    const Scene scene = ball_scene(machine_profile("nv2a"));
    Framebuffer before(24, 18), shown(24, 18), after(24, 18);
    Renderer renderer;
    renderer.render(scene, before);
    renderer.render(scene, shown, ShownRegister{Register::tex0});
    renderer.render(scene, after);
    EXPECT_NE(std::memcmp(before.pixels(), shown.pixels(), 24 * 18 * 4), 0);
    EXPECT_EQ(std::memcmp(before.pixels(), after.pixels(), 24 * 18 * 4), 0);
}

TEST(ShownRegister, UnknownOnesAreErrors) {
    const Scene scene = ball_scene(machine_profile("geforce256"));
    Framebuffer frame(24, 18);
    Renderer renderer;
    for (const Register reg : {Register::tex2, Register::discard}) {
        try {
            renderer.render(scene, frame, ShownRegister{reg});
            ADD_FAILURE() << register_name(reg);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::bad_option) << error.what();
        }
    }
}

}  // namespace
}  // namespace burnish
