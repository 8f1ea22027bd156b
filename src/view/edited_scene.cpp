#include "view/edited_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <utility>
#include <variant>

#include "view/orbit.hpp"

namespace burnish::view {
namespace {

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

/// Nothing, with the reasons, for a text that is no program.
Parsed<CombinerProgram> program_of(const std::string& text, const std::string& material,
                                   std::vector<ProgramError>& errors) {
    Parsed<CombinerProgram> parsed = parse_combiners(text);
    for (const TextError& error : parsed.errors)
        errors.push_back({material, error.line, error.column, error.message});
    return parsed;
}

/// The pipeline with another text; null for one that is no program.
std::shared_ptr<const Material> edited_pipeline(const MaterialEdit& edit, const Material& loaded,
                                                ProgramLines& lines,
                                                std::vector<ProgramError>& errors) {
    Parsed<CombinerProgram> parsed = program_of(*edit.combiners, edit.name, errors);
    if (!parsed.program) return nullptr;
    lines = std::move(parsed.lines);
    Material material = loaded;
    CombinerProgram& combiners = material.program->combiners;
    // What no text can say stays as it was.
    const CombinerProgram before = std::exchange(combiners, *std::move(parsed.program));
    combiners.fog = before.fog;
    combiners.mux_bit = before.mux_bit;
    return std::make_shared<const Material>(std::move(material));
}

/// A model's program with another text; null for one that is no program.
std::shared_ptr<const EditedProgram> edited_program(const MaterialEdit& edit, ProgramLines& lines,
                                                    std::vector<ProgramError>& errors) {
    if (!edit.compiled) {
        errors.push_back({edit.name, 1, 1, "of a model, expected 'compiled_text' beside it"});
        return nullptr;
    }
    std::vector<ProgramError> own_errors;
    const auto own = program_of(*edit.compiled, edit.name, own_errors).program;
    for (const ProgramError& error : own_errors)
        errors.push_back({edit.name, 1, 1,
                          fmt::format("'compiled_text', line {}: {}", error.line, error.message)});
    Parsed<CombinerProgram> parsed = program_of(*edit.combiners, edit.name, errors);
    if (!own || !parsed.program) return nullptr;
    lines = std::move(parsed.lines);
    return std::make_shared<const EditedProgram>(EditedProgram{*own, *std::move(parsed.program)});
}

/// The model and its parameters alone.
MaterialEdit without_program(MaterialEdit edit) {
    edit.combiners.reset();
    edit.compiled.reset();
    return edit;
}

/// Null: the loaded one.
std::shared_ptr<const Material> edited_model(const MaterialEdit& edit, const Material& loaded,
                                             const std::optional<MaterialMipmaps>& mipmaps) {
    if (without_program(edit) == MaterialEdit{.name = edit.name} && !mipmaps) return nullptr;
    Material material = loaded;
    apply_model(edit, material);
    if (mipmaps) {
        const int probes = material.mipmaps ? material.mipmaps->max_anisotropy : 1;
        material.mipmaps = mipmaps;
        material.mipmaps->max_anisotropy = probes;
    }
    return std::make_shared<const Material>(std::move(material));
}

}  // namespace

std::shared_ptr<const Material> material_of(const Object& object) {
    static const auto kDefault = std::make_shared<const Material>();
    if (object.material || !std::holds_alternative<Mesh>(object.geometry)) return object.material;
    return kDefault;
}

void EditedMaterials::update(Kept& kept, const Material& loaded, const MaterialEdit& edit,
                             const std::optional<MaterialMipmaps>& mipmaps) {
    if (kept.edit == edit && kept.mipmaps == mipmaps) return;
    const MaterialEdit before = std::exchange(kept.edit, edit);
    const bool same_mipmaps = std::exchange(kept.mipmaps, mipmaps) == mipmaps;
    kept.errors.clear();
    if (loaded.program) {
        if (edit.combiners == kept.pipeline) return;
        auto material =
            edit.combiners ? edited_pipeline(edit, loaded, kept.lines, kept.errors) : nullptr;
        if (!kept.errors.empty()) return;
        kept.material = std::move(material);
        kept.pipeline = edit.combiners;
        return;
    }
    if (without_program(before) != without_program(edit) || !same_mipmaps)
        kept.material = edited_model(edit, loaded, mipmaps);
    auto program = edit.combiners ? edited_program(edit, kept.lines, kept.errors) : nullptr;
    if (kept.errors.empty()) kept.program = std::move(program);
}

void EditedMaterials::note(const std::shared_ptr<const Material>& loaded, std::size_t object,
                           const Kept& kept) {
    const bool told = std::any_of(m_errors.begin(), m_errors.end(), [&](const ProgramError& each) {
        return each.material == loaded->name;
    });
    if (!told) m_errors.insert(m_errors.end(), kept.errors.begin(), kept.errors.end());
    if (loaded->program ? !kept.material : !kept.program) return;
    const auto known = std::find_if(m_programs.begin(), m_programs.end(),
                                    [&](const ProgramEdit& each) { return each.loaded == loaded; });
    if (known != m_programs.end())
        known->objects.push_back(object);
    else
        m_programs.push_back({loaded, {object}, kept.errors.empty() ? kept.lines : ProgramLines()});
}

void EditedMaterials::apply(const ViewState& state, Scene& scene) {
    m_programs.clear();
    m_errors.clear();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        Object& object = scene.objects[i];
        const std::shared_ptr<const Material> loaded = material_of(object);
        if (!loaded) continue;
        const MaterialEdit* edit = find_edit(state, loaded->name);
        const auto mipmaps = loaded->program ? std::nullopt : state.mipmaps;
        if (edit == nullptr && !mipmaps) {
            m_kept.erase(loaded.get());
            continue;
        }
        Kept& kept = m_kept[loaded.get()];
        update(kept, *loaded, edit == nullptr ? MaterialEdit{.name = loaded->name} : *edit,
               mipmaps);
        if (kept.material) object.material = kept.material;
        object.edited = kept.program;
        note(loaded, i, kept);
    }
}

const MaterialEdit* find_edit(const ViewState& state, const std::string& material) {
    const auto found =
        std::find_if(state.materials.begin(), state.materials.end(),
                     [&](const MaterialEdit& edit) { return edit.name == material; });
    return found == state.materials.end() ? nullptr : &*found;
}

std::vector<std::string> idle_edits(const ViewState& state, const Scene& loaded) {
    std::vector<std::string> lines;
    for (const MaterialEdit& edit : state.materials) {
        std::shared_ptr<const Material> changed;
        for (const Object& object : loaded.objects) {
            const std::shared_ptr<const Material> material = material_of(object);
            if (material && material->name == edit.name) changed = material;
        }
        MaterialEdit text_alone{.name = edit.name};
        text_alone.combiners = edit.combiners;
        if (!changed)
            lines.push_back(fmt::format("material '{}': {} has none of that name", edit.name,
                                        state.input.string()));
        else if (changed->program && edit != text_alone)
            lines.push_back(fmt::format(
                "material '{}': a program, not a model, expected 'combiners_text' alone",
                edit.name));
    }
    return lines;
}

Machine machine_for(const ViewState& state, const Machine& machine) {
    Machine result = machine;
    if (state.half_vector && !result.double_precision)
        choose_half_vector(result, *state.half_vector);
    result.filter_order = state.filter_order.value_or(result.filter_order);
    return result;
}

Scene edited_scene(const Scene& loaded, const ViewState& state, EditedMaterials& materials) {
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
    materials.apply(state, scene);
    return scene;
}

ViewState state_of(const Scene& scene, const std::filesystem::path& input) {
    ViewState state;
    state.input = input;
    state.width = scene.width;
    state.height = scene.height;
    const Ball ball = ball_around(scene);
    state.camera = by_vectors(scene.camera, ball);
    // A matrix without an inverse has no vectors.
    if (!has_direction(state.camera)) state.camera = seen_from(Side::front, Camera{}, ball, 1.0F);
    return state;
}

}  // namespace burnish::view
