#include "models/compile_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/multipass.hpp>
#include <limits>
#include <map>
#include <utility>

#include "machine/material_passes.hpp"
#include "models/bake.hpp"
#include "models/make_plan.hpp"
#include "models/material_terms.hpp"

namespace burnish {

namespace {

AxisReport report_of(const PlanAxis& axis) {
    return {axis.name, axis.argument(0), axis.argument(axis.size - 1), axis.logarithmic, axis.size};
}

/// "ward", or the text of a material and where in it.
std::string name_of(const Material& material, const Shortage& shortage) {
    if (material.model != Model::text) return std::string(model_name(material.model));
    std::string name = fmt::format("material '{}', model_text", material.name);
    if (shortage.line > 0) name += fmt::format(":{}:{}", shortage.line, shortage.column);
    return name;
}

/// Throws what is short, and `more` behind it.
[[noreturn]] void refuse(const Material& material, const Machine& machine, const Shortage& shortage,
                         const std::string& more) {
    std::string missing = shortages(shortage.needs, machine);
    if (missing.empty()) missing = shortage.what();
    throw Error(ErrorCode::bad_program,
                fmt::format("{} on '{}': {}{}{}", name_of(material, shortage), machine.name,
                            missing, more.empty() ? "" : "; ", more));
}

}  // namespace

/// What is kept of a material.
struct ModelCompiler::Parts {
    Parts(const Material& of, std::function<bool()> stop)
        : material(of), terms(of, std::move(stop)) {}

    CompiledModel compile(const Machine& machine, const glm::vec3& light, const glm::vec3& ambient);

    TexelPrecision precision = TexelPrecision::machine;

  private:
    Cover& cover_for(const Machine& room, const Machine& machine);
    /// The model for `machine`, within what `room` has.
    CompiledModel model_within(const Machine& room, const Machine& machine, const glm::vec3& light,
                               const glm::vec3& ambient, bool few_stages = false);
    /// The one that takes more fetches, if the other takes too many stages.
    CompiledModel model_that_fits(const Machine& room, const Machine& machine,
                                  const glm::vec3& light, const glm::vec3& ambient);
    /// All that the model takes, whatever `machine` has. Without tables if combiners can do it;
    /// `first` is what was short there.
    ModelNeeds count_needs(const Shortage& first, const Machine& machine, const glm::vec3& light,
                           const glm::vec3& ambient);
    /// What several passes would change.
    std::string with_passes(Machine machine, const ModelNeeds& needs, const glm::vec3& light,
                            const glm::vec3& ambient);

    Material material;
    MaterialTerms terms;
    std::map<std::pair<NumberModel, TablePrice>, Cover> covers;
    FilledTables tables;
};

Cover& ModelCompiler::Parts::cover_for(const Machine& room, const Machine& machine) {
    const TablePrice price = machine.stage_fetches ? TablePrice::fetch
                             : room.stage_fetches  ? TablePrice::passes
                                                   : TablePrice::none;
    const auto key = std::pair(machine.numbers, price);
    const auto at = covers.find(key);
    if (at != covers.end()) return at->second;
    return covers.emplace(key, Cover(terms.roots(), terms.ranges(), machine.numbers, price))
        .first->second;
}

CompiledModel ModelCompiler::Parts::model_within(const Machine& room, const Machine& machine,
                                                 const glm::vec3& light, const glm::vec3& ambient,
                                                 bool few_stages) {
    PlanTask task;
    task.quantities = terms.quantities();
    task.most_tilt = terms.most_tilt();
    task.terms = &terms.terms();
    task.varies = terms.varies();
    task.light = light;
    task.ambient = ambient;
    task.numbers = machine.numbers;
    task.fine_tables = precision == TexelPrecision::fine;
    task.table_filter = machine.table_filter;
    task.vertex_light = machine.half_vector == HalfVector::vertex;
    task.scaled_half_vector = machine.half_vector == HalfVector::pixel;
    task.few_stages = few_stages;
    const Plan plan = make_plan(task, cover_for(room, machine), terms.ranges(), tables);
    Schedule scheduled = schedule(plan, room, machine);
    BakedTextures baked =
        bake(plan, scheduled, terms.texels(),
             task.fine_tables ? TexelCoding::fine : texel_coding(machine.numbers), machine);

    CompiledModel compiled;
    compiled.program = std::move(scheduled.material);
    compiled.program.units = std::move(baked.units);
    compiled.layer = std::move(baked.layer);
    for (std::size_t i = 0; i < plan.quantities.size(); ++i)
        compiled.layer[i].definition = print_expression(*plan.quantities[i].expr->args.front());
    compiled.layer.insert(compiled.layer.end(), terms.constants().begin(), terms.constants().end());
    for (std::size_t i = 0; i < plan.tables.size(); ++i) {
        const PlanTable& t = plan.tables[i];
        TableReport& report = compiled.tables.emplace_back();
        report.function = t.function;
        for (const PlanAxis& axis : t.axes) report.axes.push_back(report_of(axis));
        report.unit = scheduled.tables[i];
        report.interpolation = t.interpolation;
    }
    compiled.needs = scheduled.needs;
    return compiled;
}

CompiledModel ModelCompiler::Parts::model_that_fits(const Machine& room, const Machine& machine,
                                                    const glm::vec3& light,
                                                    const glm::vec3& ambient) {
    try {
        return model_within(room, machine, light, ambient);
    } catch (const Shortage& shortage) {
        if (machine.numbers != NumberModel::wide || shortage.needs.stages <= room.general_stages)
            throw;
    }
    return model_within(room, machine, light, ambient, true);
}

ModelNeeds ModelCompiler::Parts::count_needs(const Shortage& first, const Machine& machine,
                                             const glm::vec3& light, const glm::vec3& ambient) {
    Machine target = machine;
    target.texture_units = with_room(machine).texture_units;
    Machine room = target;
    room.general_stages = std::numeric_limits<int>::max();
    room.stage_fetches = with_room(machine).stage_fetches || first.needs.tables > 0;
    room.texture_operations = TextureOperations::all;
    ModelNeeds needs = first.needs;
    for (const bool own : {machine.stage_constants || machine.multipass, true}) {
        room.stage_constants = own;
        try {
            needs = model_within(room, target, light, ambient).needs;
            needs.stage_constants = own && !machine.multipass;
            return needs;
        } catch (const Shortage& shortage) {
            needs = shortage.needs;
        }
    }
    return needs;
}

std::string ModelCompiler::Parts::with_passes(Machine machine, const ModelNeeds& needs,
                                              const glm::vec3& light, const glm::vec3& ambient) {
    const Machine room = with_room(machine);
    if (machine.multipass) {
        if (needs.stages <= room.general_stages) return "";
        return fmt::format("several passes have {} together", room.general_stages);
    }
    machine.multipass = true;
    try {
        const std::size_t passes = compile(machine, light, ambient).passes.size();
        return fmt::format("in {} passes it fits (multipass)", passes);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::stopped) throw;
        return "";
    }
}

CompiledModel ModelCompiler::Parts::compile(const Machine& machine, const glm::vec3& light,
                                            const glm::vec3& ambient) {
    if (material.model == Model::lean && machine.numbers == NumberModel::nine_bit)
        throw Error(ErrorCode::bad_program,
                    fmt::format("lean on '{}': variances are small differences of filtered "
                                "squares, which need registers of 16 bits, expected profile ideal "
                                "or double",
                                machine.name));
    try {
        CompiledModel model = model_that_fits(machine.multipass ? with_room(machine) : machine,
                                              machine, light, ambient);
        if (!machine.multipass || has_room_for(machine, model.program)) return model;
        try {
            model.passes = passes_of(model.program, machine);
        } catch (const Error& obstacle) {
            refuse(material, machine, Shortage("", model.needs), obstacle.what());
        }
        return model;
    } catch (Shortage& shortage) {
        shortage.needs = count_needs(shortage, machine, light, ambient);
        refuse(material, machine, shortage, with_passes(machine, shortage.needs, light, ambient));
    }
}

ModelCompiler::ModelCompiler(const Material& material, std::function<bool()> stop)
    : m_parts(std::make_unique<Parts>(material, std::move(stop))) {}
ModelCompiler::~ModelCompiler() = default;

CompiledModel ModelCompiler::compile(const Machine& machine, const glm::vec3& light,
                                     const glm::vec3& ambient, TexelPrecision precision) {
    m_parts->precision = precision;
    return m_parts->compile(machine, light, ambient);
}

CompiledModel compile_model(const Material& material, const Machine& machine,
                            const glm::vec3& light, const glm::vec3& ambient) {
    return ModelCompiler(material).compile(machine, light, ambient);
}

Light light_of(const Scene& scene, std::size_t number) {
    if (scene.lights.empty()) return Light{.intensity = 0.0F};
    return scene.lights[number];
}

LightOfModel light_of_model(const Scene& scene, std::size_t number) {
    const Light light = light_of(scene, number);
    return {light.color * light.intensity, number == 0 ? scene.ambient : glm::vec3(0.0F)};
}

const CompiledModel& CompiledModels::get(const std::shared_ptr<const Material>& material,
                                         const Machine& machine, const glm::vec3& light,
                                         const glm::vec3& ambient) {
    for (const auto& e : m_entries) {
        if (e->material == material && e->machine == machine && e->light == light &&
            e->ambient == ambient) {
            e->idle = 0;
            return e->model;
        }
    }
    if (!m_compiler || m_compiled_last != material) {
        m_compiler.reset();
        m_compiler = std::make_unique<ModelCompiler>(*material, stop);
        m_compiled_last = material;
    }
    CompiledModel model = m_compiler->compile(machine, light, ambient);
    m_entries.push_back(
        std::make_unique<Entry>(Entry{material, machine, light, ambient, std::move(model), 0}));
    return m_entries.back()->model;
}

void CompiledModels::drop_unused(int frames) {
    std::erase_if(m_entries, [frames](const auto& e) { return e->idle >= frames; });
    const bool is_drawn = std::any_of(m_entries.begin(), m_entries.end(), [&](const auto& e) {
        return e->material == m_compiled_last;
    });
    if (!is_drawn) {
        m_compiler.reset();
        m_compiled_last.reset();
    }
    for (const auto& e : m_entries) ++e->idle;
}

std::vector<LayerQuantity> material_layer(const Material& material, const Machine& machine) {
    return compile_model(material, machine, glm::vec3(1.0F), glm::vec3(0.0F)).layer;
}

}  // namespace burnish
