#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/machine.hpp>
#include <charconv>

#include "core/nearest.hpp"

namespace burnish {
namespace {

constexpr int kLargestCube = 1024;  // texels a side of a normalisation cube map

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

void check_half_vector(const Machine& machine) {
    check_range("half_vector_size", machine.half_vector_size, 1, kLargestCube);
    const int bits = machine.half_vector_bits;
    if (bits != 8 && bits != 9 && bits != 16) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("half_vector_bits = {}, expected 8, 9 or 16", bits));
    }
    const bool cube = machine.half_vector == HalfVector::cube;
    if (!cube && bits != 8) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("half_vector_bits = {} without half_vector = cube:N", bits));
    }
    if (bits != 8 && machine.numbers == NumberModel::nine_bit) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("half_vector_bits = {} with numbers = nine_bit, expected 8: a "
                                "colour has no more there",
                                bits));
    }
    if (cube && machine.texture_units < 2) {
        throw Error(
            ErrorCode::bad_option,
            "half_vector = cube:N takes a texture unit, expected texture_units = 2 or more");
    }
    if (cube && !machine.normalise_half_vector) {
        throw Error(
            ErrorCode::bad_option,
            "normalise_half_vector = false with half_vector = cube:N, whose map normalises");
    }
    if (machine.tangent_frames == TangentFrames::derivative &&
        machine.half_vector != HalfVector::pixel) {
        throw Error(ErrorCode::bad_option,
                    "tangent_frames = derivative, which differ from triangle to triangle, expected "
                    "half_vector = pixel");
    }
}

void check_table_filter(const Machine& machine) {
    if (!(machine.table_bias >= -8.0F && machine.table_bias <= 8.0F)) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("table_bias = {}, expected -8 .. 8", machine.table_bias));
    }
    if (machine.double_precision && machine.quads == Quads::of_pixels) {
        throw Error(ErrorCode::bad_option,
                    "quads = pixels with profile double, whose differences are the surface's own; "
                    "expected one of the machines");
    }
    if (machine.table_filter == TableFilter::point || machine.double_precision) return;
    const bool has_tables =
        machine.stage_fetches ||
        (machine.multipass && machine.texture_operations != TextureOperations::plain);
    if (!has_tables) {
        throw Error(ErrorCode::bad_option,
                    fmt::format("table_filter other than point on '{}', which looks no tables up, "
                                "expected ideal, nv2a with multipass, or double",
                                machine.name));
    }
    if (machine.table_filter == TableFilter::exact && machine.numbers != NumberModel::wide) {
        throw Error(
            ErrorCode::bad_option,
            "table_filter = exact with numbers = nine_bit, expected numbers = wide: sums of "
            "a table are no texels of eight bits");
    }
}

}  // namespace

void choose_half_vector(Machine& machine, std::string_view word) {
    constexpr std::string_view kCube = "cube:";
    if (word == "pixel") {
        machine.half_vector = HalfVector::pixel;
    } else if (word == "vertex") {
        machine.half_vector = HalfVector::vertex;
    } else {
        int size = 0;
        const char* const end = word.data() + word.size();
        const char* const digits = word.data() + std::min(kCube.size(), word.size());
        const auto [stop, failure] = std::from_chars(digits, end, size);
        if (!word.starts_with(kCube) || failure != std::errc() || stop != end || size < 1 ||
            size > kLargestCube) {
            throw Error(ErrorCode::bad_option,
                        fmt::format("half_vector '{}', expected pixel, vertex or cube:N with N = 1 "
                                    ".. {}",
                                    word, kLargestCube));
        }
        machine.half_vector = HalfVector::cube;
        machine.half_vector_size = size;
    }
}

FilterOrder filter_order_of(std::string_view word) {
    if (word == "before") return FilterOrder::before;
    if (word == "after") return FilterOrder::after;
    throw Error(ErrorCode::bad_option,
                fmt::format("filter order '{}', expected before or after", word));
}

void Machine::validate() const {
    check_range("texture_units", texture_units, 1, 16);
    check_range("general_stages", general_stages, 0, 16);
    check_range("subpixel_bits", subpixel_bits, 4, 8);
    check_half_vector(*this);
    if (double_precision && half_vector != HalfVector::pixel) {
        throw Error(ErrorCode::bad_option,
                    "half vectors of profile double are computed at every sample, expected "
                    "half_vector = pixel");
    }
    check_table_filter(*this);
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

Machine Machine::for_programs() const {
    Machine rest = *this;
    if (half_vector == HalfVector::cube) --rest.texture_units;
    rest.filter_order = FilterOrder::before;
    return rest;
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
