#include <fmt/format.h>

#include <burnish/materials.hpp>
#include <burnish/view_state.hpp>
#include <string_view>

namespace burnish {
namespace {

/// A basic string of TOML.
std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            result += fmt::format("\\{}", c);
        else if (c == '\n')
            result += "\\n";
        else if (byte < 0x20 || byte == 0x7f)
            result += fmt::format("\\u{:04x}", byte);
        else
            result += c;
    }
    return result + "\"";
}

/// With as many digits as the float needs, and a point, since TOML tells integers from numbers.
std::string number(float value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string vector(const glm::vec3& v) {
    return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
}

std::string camera_text(const Camera& camera) {
    return fmt::format(
        "\n[camera]\nposition = {}\nfocal_point = {}\nview_up = {}\nview_angle = {}\nnear = {}\n"
        "far = {}\n",
        vector(camera.position), vector(camera.focal_point), vector(camera.view_up),
        number(camera.view_angle), number(camera.near), number(camera.far));
}

std::string machine_text(const ViewState& state) {
    std::string text;
    if (!state.machine.empty()) text += fmt::format("profile = {}\n", toml_string(state.machine));
    if (state.half_vector)
        text += fmt::format("half_vector = {}\n", toml_string(*state.half_vector));
    if (state.filter_order)
        text += fmt::format("filter_order = \"{}\"\n",
                            *state.filter_order == FilterOrder::after ? "after" : "before");
    if (state.mipmaps) {
        const auto method = static_cast<std::size_t>(state.mipmaps->method);
        text += fmt::format("mipmaps = \"{}\"\n", mip_method_names()[method]);
        if (state.mipmaps->bits != 0)
            text += fmt::format("mipmap_bits = {}\n", state.mipmaps->bits);
    }
    if (!state.bits.empty()) text += fmt::format("bits = {}\n", toml_string(state.bits));
    return text.empty() ? text : "\n[machine]\n" + text;
}

std::string edit_text(const MaterialEdit& edit) {
    std::string text = fmt::format("\n[[materials]]\nname = {}\n", toml_string(edit.name));
    if (edit.model) text += fmt::format("model = \"{}\"\n", model_name(*edit.model));
    if (edit.kd) text += fmt::format("kd = {}\n", vector(*edit.kd));
    if (edit.ks) text += fmt::format("ks = {}\n", vector(*edit.ks));
    if (edit.alpha_x) text += fmt::format("alpha_x = {}\n", number(*edit.alpha_x));
    if (edit.alpha_y) text += fmt::format("alpha_y = {}\n", number(*edit.alpha_y));
    if (edit.exponent) text += fmt::format("exponent = {}\n", number(*edit.exponent));
    if (edit.combiners) text += fmt::format("combiners_text = {}\n", toml_string(*edit.combiners));
    if (edit.compiled) text += fmt::format("compiled_text = {}\n", toml_string(*edit.compiled));
    return text;
}

}  // namespace

std::string view_state_text(const ViewState& state) {
    std::string text = fmt::format("schema = 1\ninput = {}\nsize = [{}, {}]\n",
                                   toml_string(state.input.string()), state.width, state.height);
    if (state.light) text += fmt::format("light = {}\n", vector(*state.light));
    if (state.pixel) text += fmt::format("pixel = [{}, {}]\n", state.pixel->x, state.pixel->y);
    text += camera_text(state.camera);
    text += machine_text(state);
    text += fmt::format("\n[split]\non = {}\nlines = [{}, {}, {}]\nheat_map = {}\ngain = {}\n",
                        state.split, number(state.lines[0]), number(state.lines[1]),
                        number(state.lines[2]), state.heat_map, number(state.gain));
    for (const MaterialEdit& edit : state.materials) text += edit_text(edit);
    return text;
}

}  // namespace burnish
