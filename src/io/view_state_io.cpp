#include "io/view_state_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/materials.hpp>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "io/image_io.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

/// A PNG file is told by its first bytes: people rename screenshots.
bool is_png(const std::filesystem::path& path) {
    char start[4] = {};
    std::ifstream(path, std::ios::binary).read(start, sizeof start);
    return std::string_view(start, sizeof start) == "\x89PNG";
}

toml::table parse_state(const std::filesystem::path& path) {
    if (!is_png(path)) return parse_scene(path, {});
    const std::string text = read_description(path);
    if (text.empty())
        throw Error(ErrorCode::bad_input,
                    path.string() +
                        ": a picture without a state, expected a screenshot of "
                        "burnish view or a TOML file");
    return parse_scene_text(text, path);
}

/// A word of a fixed list.
std::optional<std::string> known_word(const Section& section, std::string_view key,
                                      const std::vector<std::string_view>& known) {
    std::optional<std::string> word = section.text(key);
    if (word && std::find(known.begin(), known.end(), *word) == known.end())
        section.fail_unknown_word(key, *word, known);
    return word;
}

void read_machine(const Section& root, ViewState& state) {
    const toml::table* table = root.table("machine");
    if (table == nullptr) return;
    const Section section(
        *table, "[machine]",
        {"profile", "half_vector", "filter_order", "mipmaps", "mipmap_bits", "bits"});
    state.machine = known_word(section, "profile", machine_profile_names()).value_or("");
    state.half_vector = section.text("half_vector");
    Machine tried;
    try {
        if (state.half_vector) choose_half_vector(tried, *state.half_vector);
    } catch (const Error& error) {
        section.fail("half_vector", error.what());
    }
    if (const auto order = known_word(section, "filter_order", {"before", "after"}))
        state.filter_order = filter_order_of(*order);
    state.bits = section.text("bits").value_or("");
    Material mipmapped;
    read_mipmaps(section, {}, mipmapped);
    state.mipmaps = mipmapped.mipmaps;
}

void read_split(const Section& root, ViewState& state) {
    const toml::table* table = root.table("split");
    if (table == nullptr) return;
    const Section section(*table, "[split]", {"on", "lines", "heat_map", "gain"});
    state.split = section.boolean("on").value_or(false);
    state.heat_map = section.boolean("heat_map").value_or(false);
    state.gain = section.number("gain", kPositive).value_or(state.gain);
    if (const auto lines = section.numbers("lines", 3, 3, kUnit)) {
        state.lines = {(*lines)[0], (*lines)[1], (*lines)[2]};
        if (!std::is_sorted(lines->begin(), lines->end()))
            section.fail("lines", "'lines' in [split], expected three numbers in ascending order");
    }
}

MaterialEdit read_edit(const toml::table& table) {
    const Section section(table, "[[materials]]",
                          {"name", "model", "kd", "ks", "alpha_x", "alpha_y", "exponent",
                           "combiners_text", "compiled_text"});
    constexpr Range kWidth{.low = 0.0, .high = 1.0, .open_low = true};
    MaterialEdit edit;
    edit.name = section.required_text("name");
    if (const auto name = known_word(section, "model", model_names()))
        edit.model = model_named(*name);
    edit.kd = section.vec3("kd", kUnit);
    edit.ks = section.vec3("ks", kUnit);
    edit.alpha_x = section.number("alpha_x", kWidth);
    edit.alpha_y = section.number("alpha_y", kWidth);
    edit.exponent = section.number("exponent", kPositive);
    edit.combiners = section.text("combiners_text");
    edit.compiled = section.text("compiled_text");
    section.refuse_without("compiled_text", "combiners_text");
    return edit;
}

}  // namespace

ViewState read_view_state_file(const std::filesystem::path& path) {
    const toml::table table = parse_state(path);
    const Section root(
        table, "the state",
        {"schema", "input", "size", "camera", "light", "machine", "split", "pixel", "materials"});
    require_schema(root);
    ViewState state;
    state.input = path.parent_path() / root.required_text("input");
    constexpr Range kSide{1.0, static_cast<double>(Framebuffer::kMaxSize)};
    if (const auto size = root.numbers("size", 2, 2, kSide)) {
        state.width = static_cast<int>((*size)[0]);
        state.height = static_cast<int>((*size)[1]);
    }
    if (const toml::table* camera = root.table("camera")) {
        const Section section(*camera, "[camera]", kCameraVectors);
        state.camera = read_camera(section);
        if (state.camera.position == state.camera.focal_point)
            section.fail("position",
                         "'position' in [camera] is the focal point, expected two points");
        // Or its square is no float any more.
        const float away = glm::length(state.camera.position - state.camera.focal_point);
        if (!std::isfinite(away) || !std::isnormal(away * away))
            section.fail("position",
                         fmt::format("'position' in [camera] is {:.6g} away from the focal point, "
                                     "expected about 1e-18 .. 1e18",
                                     glm::length(glm::dvec3(state.camera.position) -
                                                 glm::dvec3(state.camera.focal_point))));
    }
    state.light = root.vec3("light");
    if (state.light == glm::vec3(0.0F)) root.fail("light", "'light' has no length");
    read_machine(root, state);
    read_split(root, state);
    constexpr Range kPlace{0.0, static_cast<double>(Framebuffer::kMaxSize - 1)};
    if (const auto pixel = root.numbers("pixel", 2, 2, kPlace))
        state.pixel = {static_cast<int>((*pixel)[0]), static_cast<int>((*pixel)[1])};
    for (const toml::table* each : root.tables("materials"))
        state.materials.push_back(read_edit(*each));
    return state;
}

}  // namespace burnish
