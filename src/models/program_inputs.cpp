#include "models/program_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace burnish {

std::vector<ProgramInput> interpolated_inputs(const ProgramMaterial& program) {
    std::vector<ProgramInput> inputs;
    const auto add = [&](const char* name, ColorInput input) {
        if (input == ColorInput::vertex) return;
        std::string value(input_name(input));
        if (input == ColorInput::lit)
            value += fmt::format(": n_dot_l * {} + {}", numbers_text(program.lit_tint),
                                 numbers_text(program.lit_base));
        inputs.push_back({name, std::move(value)});
    };
    add("col0.rgb", program.col0_rgb);
    add("col0.a", program.col0_a);
    add("col1.rgb", program.col1_rgb);
    add("col1.a", program.col1_a);
    for (std::size_t i = 0; i < program.uv.size(); ++i) {
        if (program.uv[i] != CoordinateInput::uv)
            inputs.push_back({fmt::format("uv{}", i), std::string(input_name(program.uv[i]))});
    }
    if (program.half_scale != glm::vec3(1.0F))
        inputs.push_back({"half_scale", numbers_text(program.half_scale)});
    return inputs;
}

int unit_of(const LayerQuantity& quantity, const ProgramMaterial& program) {
    if (!quantity.texture) return -1;
    const std::vector<TexturePtr>& units = program.units;
    return static_cast<int>(std::find(units.begin(), units.end(), quantity.texture) -
                            units.begin());
}

std::string_view channels_of(const LayerQuantity& quantity) {
    if (quantity.components == 3) return "rgb";
    return quantity.channel == 3 ? "a" : "r = g = b";
}

std::string numbers_text(const glm::dvec3& v) {
    if (v.x == v.y && v.y == v.z) return fmt::format("{:.6g}", v.x);
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

}  // namespace burnish
