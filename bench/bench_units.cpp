// What texture units cost, operation by operation: unit/<operation>/<isa>, from interpolated
// coordinates to the register that a program reads, all units that the operation needs included.
// Codes are compared with the reference's before anything is timed. Items are fragments; `cycles`
// are those of the time-stamp counter per fragment.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <burnish/program_text.hpp>
#include <burnish/texture_shader.hpp>
#include <string>
#include <vector>

#include "bench/run_benchmarks.hpp"
#include "core/cpu.hpp"
#include "shade/shading.hpp"
#include "tests/kernel_packet.hpp"

namespace burnish {
namespace {

struct UnitTexture {
    TextureTarget target = TextureTarget::two_d;
    TexelFormat format = TexelFormat::rgba8;
    bool box_mipmaps = false;
    int max_anisotropy = 1;
};

/// Noise, linear filters, 128 texels a side; volumes 32 of them.
TexturePtr make_texture(const UnitTexture& kind) {
    Random random(11);
    const bool volume = kind.target == TextureTarget::three_d;
    const int side = volume ? 32 : 128, layers = kind.target == TextureTarget::cube ? 6 : side;
    TextureDescription description{.target = kind.target, .format = kind.format};
    description.box_mipmaps = kind.box_mipmaps;
    if (kind.box_mipmaps) description.sampler.filter = Filter::linear_mipmap_linear;
    description.sampler.max_anisotropy = kind.max_anisotropy;
    if (kind.target == TextureTarget::rectangle || kind.target == TextureTarget::cube)
        description.sampler.wrap_s = description.sampler.wrap_t = Wrap::clamp_to_edge;
    if (volume) description.depth = side;
    const bool many = volume || kind.target == TextureTarget::cube;
    const int height = kind.target == TextureTarget::one_d ? 1 : side;
    std::vector<Image8> images(many ? static_cast<std::size_t>(layers) : 1, Image8(side, height));
    for (Image8& image : images)
        for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    return std::make_shared<const Texture>(images, description);
}

struct Case {
    const char* name;
    const char* shader;  ///< TS1.0 without its header; the last unit is what the program reads
    std::vector<UnitTexture> units;
    float stretch = 0.0F;  ///< > 0: a pixel is 3/2 texels high and so many times as wide
};

std::vector<Case> cases() {
    constexpr auto kOneD = TextureTarget::one_d, kTwoD = TextureTarget::two_d,
                   kRectangle = TextureTarget::rectangle, kCube = TextureTarget::cube,
                   kVolume = TextureTarget::three_d;
    constexpr auto kColor = TexelFormat::rgba8;
    const UnitTexture color{}, cube{kCube}, volume{kVolume}, rectangle{kRectangle};
    const UnitTexture dsdt{kTwoD, TexelFormat::dsdt8}, mag{kTwoD, TexelFormat::dsdt8_mag8},
        hilo{kTwoD, TexelFormat::hilo16}, signed_hilo{kTwoD, TexelFormat::signed_hilo16},
        mips{kTwoD, kColor, true}, probes{kTwoD, kColor, true, 16};
    return {
        {"texture_1d", "texture_1d();", {{kOneD}}},
        {"texture_2d", "texture_2d();", {color}},
        {"texture_2d_signed", "texture_2d();", {{kTwoD, TexelFormat::signed_rgba8}}},
        {"texture_2d_trilinear", "texture_2d();", {mips}},
        {"texture_2d_trilinear_square", "texture_2d();", {mips}, 1.0F},
        {"texture_2d_1_probe_of_16", "texture_2d();", {probes}, 1.0F},
        {"texture_2d_4_probes_of_16", "texture_2d();", {probes}, 3.5F},
        {"texture_2d_16_probes_of_16", "texture_2d();", {probes}, 15.5F},
        {"texture_rectangle", "texture_rectangle();", {rectangle}},
        {"texture_cube_map", "texture_cube_map();", {cube}},
        {"texture_3d", "texture_3d();", {volume}},
        {"pass_through", "pass_through();", {color}},
        {"cull_fragment",
         "texture_2d(); cull_fragment(GEQUAL_TO_ZERO, LESS_THAN_ZERO, GEQUAL_TO_ZERO, "
         "LESS_THAN_ZERO);",
         {color, color}},
        {"offset_2d", "texture_2d(); offset_2d(tex0, 0.1, 0, 0, 0.1);", {dsdt, color}},
        {"offset_2d_scale",
         "texture_2d(); offset_2d_scale(tex0, 0.1, 0, 0, 0.1, 1, 0.5);",
         {mag, color}},
        {"offset_rectangle",
         "texture_2d(); offset_rectangle(tex0, 9, 0, 0, 9);",
         {dsdt, rectangle}},
        {"offset_projective_2d",
         "texture_2d(); offset_projective_2d(tex0, 0.1, 0, 0, 0.1);",
         {dsdt, color}},
        {"offset_hilo_2d",
         "texture_2d(); offset_hilo_2d(tex0, 0.1, 0, 0, 0.1);",
         {signed_hilo, color}},
        {"dependent_ar", "texture_2d(); dependent_ar(tex0);", {color, color}},
        {"dependent_gb", "texture_2d(); dependent_gb(tex0);", {color, color}},
        {"dependent_gb_trilinear", "texture_2d(); dependent_gb(tex0);", {color, mips}},
        {"dependent_hilo", "texture_2d(); dependent_hilo(tex0);", {hilo, color}},
        {"dependent_rgb_3d", "texture_2d(); dependent_rgb_3d(tex0);", {color, volume}},
        {"dependent_rgb_cube_map", "texture_2d(); dependent_rgb_cube_map(tex0);", {color, cube}},
        {"dot_product_1d", "texture_2d(); dot_product_1d(expand(tex0));", {color, {kOneD}}},
        {"dot_product_2d",
         "texture_2d(); dot_product_2d_1of2(expand(tex0)); dot_product_2d_2of2(expand(tex0));",
         {color, color, color}},
        {"dot_product_rectangle",
         "texture_2d(); dot_product_rectangle_1of2(tex0); dot_product_rectangle_2of2(tex0);",
         {color, color, rectangle}},
        {"dot_product_depth_replace",
         "texture_2d(); dot_product_depth_replace_1of2(tex0); "
         "dot_product_depth_replace_2of2(tex0);",
         {color, color, color}},
        {"dot_product_3d",
         "texture_2d(); dot_product_3d_1of3(tex0); dot_product_3d_2of3(tex0); "
         "dot_product_3d_3of3(tex0);",
         {color, color, color, volume}},
        {"dot_product_cube_map",
         "texture_2d(); dot_product_cube_map_1of3(tex0); dot_product_cube_map_2of3(tex0); "
         "dot_product_cube_map_3of3(tex0);",
         {color, color, color, cube}},
        {"dot_product_reflect_cube_map",
         "texture_2d(); dot_product_reflect_cube_map_eye_from_qs_1of3(expand(tex0)); "
         "dot_product_reflect_cube_map_eye_from_qs_2of3(expand(tex0)); "
         "dot_product_reflect_cube_map_eye_from_qs_3of3(expand(tex0));",
         {color, color, color, cube}},
        {"texture_brdf", "texture_2d(); texture_2d(); texture_brdf();", {hilo, hilo, volume}},
    };
}

/// Four blocks of a tile, and everything that shades them.
struct Fragments {
    explicit Fragments(const Case& c) {
        ProgramMaterial material;
        const std::string last = std::to_string(c.units.size() - 1);
        material.combiners =
            parse_combiners("!!RC1.0 out.rgb = tex" + last + "; out.a = tex" + last + ";")
                .program.value();
        material.texture_shader =
            parse_texture_shader("!!TS1.0 " + std::string(c.shader)).program.value();
        for (const UnitTexture& unit : c.units) material.units.push_back(make_texture(unit));
        Machine machine = machine_profile("nv2a");
        machine.texture_operations = TextureOperations::all;
        problems = check_consistency(*material.texture_shader, material.units, machine);
        plan_shading(shading, {&material, 1}, machine, false);
        // 1/w, then coordinates that move a texel or so from pixel to pixel, each another way.
        Random random(5);
        equations.set(0, 0, {1.0F, 0.0005F, 0.0003F});
        for (int k = 0; k < shading.interpolated(); ++k)
            equations.set(k + 1, 0,
                          {random.real(0.2F, 0.8F), random.real(-0.009F, 0.009F),
                           random.real(-0.009F, 0.009F)});
        if (c.stretch > 0.0F) {
            for (int k = 0; k <= shading.interpolated(); ++k)  // 1/w and q are 1
                equations.set(k, 0, {1.0F, 0.0F, 0.0F});
            equations.set(1, 0, {0.3F, 1.5F * c.stretch / 128.0F, 0.0F});
            equations.set(2, 0, {0.4F, 0.0F, 1.5F / 128.0F});
        }
        run = {0, kPacketSize, 100, 200};
    }
    void shade(const KernelTable& table, AlignedVector<std::int16_t>& planes,
               AlignedVector<float>& floats) {
        Packet packet = memory.view();
        packet.attributes = floats.data();
        packet.planes = planes.data();
        shade_packet(shading, table, {&run, 1, shading.interpolated(), equations.data()}, packet);
    }
    AlignedVector<std::int16_t> make_planes() {
        AlignedVector<std::int16_t> planes(static_cast<std::size_t>(shading.program.plane_count) *
                                           kPacketSize);
        Packet packet = memory.view();
        packet.planes = planes.data();
        load_constants(shading.program, packet);
        return planes;
    }
    std::vector<std::int16_t> result(const AlignedVector<std::int16_t>& planes) {
        std::vector<std::int16_t> codes;
        for (const std::int16_t plane : shading.program.result) {
            const auto* from = planes.data() + std::ptrdiff_t{plane} * kPacketSize;
            codes.insert(codes.end(), from, from + kPacketSize);
        }
        return codes;
    }

    Shading shading;
    std::vector<UnitProblem> problems;
    Equations equations = Equations(kMaxInterpolated);
    Run run{};
    PacketMemory memory;
    AlignedVector<float> attributes =
        AlignedVector<float>(std::size_t{kMaxAttributes} * kAttributeStride);
};

void unit(benchmark::State& state, const Case& c, const KernelTable& table) {
    Fragments fragments(c);
    if (!fragments.problems.empty())
        return state.SkipWithError(fragments.problems.front().reason.c_str());
    AlignedVector<std::int16_t> planes = fragments.make_planes(), wanted = planes;
    fragments.shade(table_reference(), wanted, fragments.attributes);
    fragments.shade(table, planes, fragments.attributes);
    if (fragments.result(planes) != fragments.result(wanted))
        return state.SkipWithError("differs from the reference");
    const std::uint64_t start = cycles_so_far();
    for (auto _ : state) {
        fragments.shade(table, planes, fragments.attributes);
        benchmark::ClobberMemory();
    }
    count_items(state, kPacketSize, cycles_so_far() - start);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
    using namespace burnish;
    static const std::vector<Case> all = cases();
    for (const Case& c : all) {
        for (const KernelTable* table : available_tables()) {
            benchmark::RegisterBenchmark(("unit/" + std::string(c.name) + "/" + table->isa).c_str(),
                                         [&c, table](auto& state) { unit(state, c, *table); });
        }
    }
    return run_benchmarks(argc, argv);
}
