#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// What a register of the combiner machine holds (docs/numbers.md).
enum class NumberModel {
    nine_bit,  ///< integer v in [-256, 255], value v / 255
    wide,      ///< integer v in [-2^15, 2^15 - 1], value v / 2^14
};

/// Where the half vector is computed and what of it reaches the combiners.
enum class HalfVector {
    vertex,  ///< per vertex, interpolated as a colour, never renormalised: what the first chips saw
    pixel,   ///< from the interpolated frame and position, normalised at every pixel
};

/// What texture units can do before the combiners (burnish/texture_shader.hpp).
enum class TextureOperations {
    plain,  ///< fetches by interpolated coordinates from 1D, 2D, rectangle and cube map textures
    nv2a,   ///< those of NV_texture_shader and NV_texture_shader2, and the chip's BRDF mode
    all,    ///< NV_texture_shader3, too
};

/// A machine profile: data that says what a program may use and how numbers behave.
/// Any field may be overridden after `machine_profile()`; `validate()` checks the result.
struct Machine {
    std::string name = "ideal";
    int texture_units = 16;       ///< 1 .. 16
    int general_stages = 16;      ///< 0 .. 16
    bool stage_constants = true;  ///< const0 and const1 may differ from stage to stage
    bool stage_fetches = true;    ///< texture fetches between general stages
    TextureOperations texture_operations = TextureOperations::all;
    NumberModel numbers = NumberModel::wide;
    HalfVector half_vector = HalfVector::pixel;
    int subpixel_bits = 8;    ///< 4 .. 8: vertices are snapped to 2^-subpixel_bits pixel
    bool snap_floor = false;  ///< snap by floor, as the NV2A does, instead of to nearest

    /// Throws Error{bad_option} for a field outside its range.
    void validate() const;
};

/// The names that `machine_profile` knows, in order of age.
std::vector<std::string_view> machine_profile_names();

/// "geforce256", "nv2a" or "ideal". Throws Error{bad_option} for another name.
Machine machine_profile(std::string_view name);

}  // namespace burnish
