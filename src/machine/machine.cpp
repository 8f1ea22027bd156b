#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/machine.hpp>

#include "core/nearest.hpp"

namespace burnish {
namespace {

/// The NV2A's choices: 1/16 pixel grid by floor and half vectors at the vertices.
Machine nv2a() {
    Machine machine;
    machine.name = "nv2a";
    machine.texture_units = 4;
    machine.general_stages = 8;
    machine.stage_fetches = false;
    machine.texture_operations = TextureOperations::nv2a;
    machine.magnitude_factor = MagnitudeFactor::unclamped;
    machine.numbers = NumberModel::nine_bit;
    machine.half_vector = HalfVector::vertex;
    machine.subpixel_bits = 4;
    machine.snap_floor = true;
    return machine;
}

/// No capture of this chip is known, so everything that its specification leaves open is the
/// NV2A's.
Machine geforce256() {
    Machine machine = nv2a();
    machine.name = "geforce256";
    machine.texture_units = 2;
    machine.general_stages = 2;
    machine.stage_constants = false;
    machine.texture_operations = TextureOperations::plain;
    return machine;
}

/// The formulas instead of a machine.
Machine double_precision() {
    Machine machine;
    machine.name = "double";
    machine.double_precision = true;
    return machine;
}

void check_range(const char* field, int value, int low, int high) {
    if (value >= low && value <= high) return;
    throw Error(ErrorCode::bad_option,
                fmt::format("{} = {}, expected {} .. {}", field, value, low, high));
}

}  // namespace

void Machine::validate() const {
    check_range("texture_units", texture_units, 1, 16);
    check_range("general_stages", general_stages, 0, 16);
    check_range("subpixel_bits", subpixel_bits, 4, 8);
    if (double_precision && half_vector == HalfVector::vertex) {
        throw Error(ErrorCode::bad_option,
                    "half_vector = vertex with profile double, which computes everything at every "
                    "sample; expected pixel");
    }
    if (numbers == NumberModel::nine_bit || double_precision) return;
    const auto check_default = [](const char* field, bool is_default) {
        if (!is_default) {
            throw Error(ErrorCode::bad_option,
                        fmt::format("{} is a choice of the nine-bit model, expected numbers = "
                                    "nine_bit",
                                    field));
        }
    };
    check_default("product_rounding", product_rounding == ProductRounding::nearest);
    check_default("expand", expand == ExpandRule::hardware);
    check_default("halving", halving == Halving::half_up);
    check_default("lerp_rounding", lerp_rounding == LerpRounding::once);
}

std::vector<std::string_view> machine_profile_names() {
    return {"geforce256", "nv2a", "ideal", "double"};
}

Machine machine_profile(std::string_view name) {
    if (name == "geforce256") return geforce256();
    if (name == "nv2a") return nv2a();
    if (name == "ideal") return {};
    if (name == "double") return double_precision();
    throw Error(ErrorCode::bad_option, fmt::format("unknown machine profile '{}', {}", name,
                                                   expected_one_of(name, machine_profile_names())));
}

}  // namespace burnish
