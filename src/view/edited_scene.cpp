#include "view/edited_scene.hpp"

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

#include "view/orbit.hpp"

namespace burnish::view {
namespace {

const MaterialEdit* edit_named(const ViewState& state, const std::string& name) {
    const auto found = std::find_if(state.materials.begin(), state.materials.end(),
                                    [&](const MaterialEdit& edit) { return edit.name == name; });
    return found == state.materials.end() ? nullptr : &*found;
}

/// What makes two edits the same: their text.
std::string text_of(const MaterialEdit* edit, const std::optional<MaterialMipmaps>& mipmaps) {
    ViewState only;
    if (edit != nullptr) only.materials.push_back(*edit);
    only.mipmaps = mipmaps;
    return view_state_text(only);
}

void apply_model(const MaterialEdit& edit, Material& material) {
    material.model = edit.model.value_or(material.model);
    material.kd = edit.kd.value_or(material.kd);
    material.ks = edit.ks.value_or(material.ks);
    if (edit.alpha_x) material.alpha_x_map = {};
    if (edit.alpha_y) material.alpha_y_map = {};
    if (edit.exponent) material.exponent_map = {};
    // Maps of t / alpha hold their widths.
    if (edit.alpha_x || edit.alpha_y) {
        material.tangent_map = nullptr;
        material.bitangent_map = nullptr;
    }
    material.alpha_x = edit.alpha_x.value_or(material.alpha_x);
    material.alpha_y = edit.alpha_y.value_or(material.alpha_y);
    material.exponent = edit.exponent.value_or(material.exponent);
}

/// False, with the reasons, for a text that is no program.
bool apply_combiners(const MaterialEdit& edit, Material& material,
                     std::vector<ProgramError>& errors) {
    const Parsed<CombinerProgram> parsed = parse_combiners(*edit.combiners);
    for (const TextError& error : parsed.errors)
        errors.push_back({edit.name, error.line, error.column, error.message});
    if (!parsed.program) return false;
    const CombinerProgram before = material.program->combiners;
    material.program->combiners = *parsed.program;
    // What no text can say stays as it was.
    material.program->combiners.fog = before.fog;
    material.program->combiners.mux_bit = before.mux_bit;
    return true;
}

}  // namespace

void EditedMaterials::apply(const ViewState& state, Scene& scene,
                            std::vector<ProgramError>& errors) {
    for (Object& object : scene.objects) {
        if (!object.material) continue;
        const Material& loaded = *object.material;
        const MaterialEdit* edit = edit_named(state, loaded.name);
        const auto mipmaps = loaded.program ? std::nullopt : state.mipmaps;
        if (edit == nullptr && !mipmaps) continue;
        Kept& kept = m_kept[&loaded];
        std::string text = text_of(edit, mipmaps);
        const bool is_program = edit != nullptr && edit->combiners && loaded.program;
        if (!kept.material || kept.edit != text || is_program) {
            Material material = loaded;
            bool right = true;
            if (edit != nullptr && is_program)
                right = apply_combiners(*edit, material, errors);
            else if (edit != nullptr)
                apply_model(*edit, material);
            if (mipmaps) {
                const int probes = material.mipmaps ? material.mipmaps->max_anisotropy : 1;
                material.mipmaps = mipmaps;
                material.mipmaps->max_anisotropy = probes;
            }
            if (right && kept.edit != text) {
                kept.material = std::make_shared<const Material>(std::move(material));
                kept.edit = std::move(text);
            }
        }
        if (kept.material) object.material = kept.material;
    }
}

Machine machine_for(const ViewState& state, const Machine& machine) {
    Machine result = machine;
    if (state.half_vector && !result.double_precision)
        choose_half_vector(result, *state.half_vector);
    result.filter_order = state.filter_order.value_or(result.filter_order);
    return result;
}

Scene edited_scene(const Scene& loaded, const ViewState& state, EditedMaterials& materials,
                   std::vector<ProgramError>& errors) {
    Scene scene = loaded;
    scene.width = state.width;
    scene.height = state.height;
    scene.format = PixelFormat::rgba8;
    const bool multipass = loaded.machine.multipass;
    if (!state.machine.empty()) {
        scene.machine = machine_profile(state.machine);
        scene.machine.multipass = multipass || state.machine != loaded.machine.name;
    }
    scene.machine = machine_for(state, scene.machine);
    scene.machine.validate();
    scene.camera = with_depths(state.camera, ball_around(loaded));
    if (state.light) {
        if (scene.lights.empty()) scene.lights.emplace_back();
        scene.lights.front().position = *state.light;
        scene.lights.front().position_w = 0.0F;
    }
    materials.apply(state, scene, errors);
    return scene;
}

ViewState state_of(const Scene& scene, const std::filesystem::path& input) {
    ViewState state;
    state.input = input;
    state.width = scene.width;
    state.height = scene.height;
    state.camera = by_vectors(scene.camera, ball_around(scene));
    return state;
}

}  // namespace burnish::view
