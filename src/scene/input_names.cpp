#include <burnish/scene.hpp>

namespace burnish {

std::string_view input_name(ColorInput input) {
    switch (input) {
        case ColorInput::vertex:
            return "vertex";
        case ColorInput::half_tangent:
            return "half_tangent";
        case ColorInput::light_tangent:
            return "light_tangent";
        case ColorInput::view_tangent:
            return "view_tangent";
        case ColorInput::n_dot_l:
            return "n_dot_l";
        case ColorInput::h_dot_l:
            return "h_dot_l";
        case ColorInput::lit:
            return "lit";
        case ColorInput::normal:
            return "normal";
    }
    return {};
}

std::string_view input_name(CoordinateInput input) {
    switch (input) {
        case CoordinateInput::uv:
            return "uv";
        case CoordinateInput::half_tangent:
            return "half_tangent";
        case CoordinateInput::light_tangent:
            return "light_tangent";
        case CoordinateInput::view_tangent:
            return "view_tangent";
        case CoordinateInput::half_coded:
            return "half_coded";
        case CoordinateInput::light_coded:
            return "light_coded";
        case CoordinateInput::view_coded:
            return "view_coded";
        case CoordinateInput::vertex:
            return "vertex";
    }
    return {};
}

}  // namespace burnish
