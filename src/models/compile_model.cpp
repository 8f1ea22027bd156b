#include "models/compile_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/multipass.hpp>
#include <cmath>
#include <limits>

#include "machine/material_passes.hpp"
#include "models/bake.hpp"
#include "models/bounds.hpp"
#include "models/make_plan.hpp"
#include "models/model_texts.hpp"
#include "models/texel.hpp"

namespace burnish {

namespace {

[[noreturn]] void fail_unbounded(const Expr& quantity, const std::string& material) {
    const Expr& value = *quantity.args.front();
    throw Error(ErrorCode::bad_program,
                fmt::format("material '{}', model_text:{}:{}: {} is not finite at every texel, "
                            "expected a bound, as max(1/32, ...)",
                            material, value.line, value.column, print_expression(value)));
}

/// What quantities are over the texels.
std::map<const Expr*, QuantityValues, ByAge> values_of(const std::vector<const Expr*>& quantities,
                                                       const TexelSource& source,
                                                       const std::string& material,
                                                       double& most_tilt) {
    TexelTape tape(quantities);
    std::vector<glm::dvec3> at(quantities.size());
    std::vector<QuantityValues> values(quantities.size());
    most_tilt = 0.0;
    for (int y = 0; y < source.height(); ++y) {
        for (int x = 0; x < source.width(); ++x) {
            const TexelParameters texel = source.at(x, y);
            most_tilt = std::max({most_tilt, std::abs(texel.n.x), std::abs(texel.n.y)});
            tape.run(texel, at.data());
            const bool first = x == 0 && y == 0;
            for (std::size_t i = 0; i < at.size(); ++i) {
                QuantityValues& v = values[i];
                const double length = std::sqrt(glm::dot(at[i], at[i]));
                if (!std::isfinite(length)) fail_unbounded(*quantities[i], material);
                if (first) v.somewhere = at[i];
                v.low = first ? at[i] : glm::min(v.low, at[i]);
                v.high = first ? at[i] : glm::max(v.high, at[i]);
                v.shortest = first ? length : std::min(v.shortest, length);
                v.longest = first ? length : std::max(v.longest, length);
                if (length > 0.0)
                    v.spread = glm::max(v.spread, glm::abs(at[i]) / (length * length));
            }
        }
    }
    std::map<const Expr*, QuantityValues, ByAge> result;
    for (std::size_t i = 0; i < at.size(); ++i) result.emplace(quantities[i], values[i]);
    return result;
}

AxisReport report_of(const PlanAxis& axis) {
    return {axis.name, axis.argument(0), axis.argument(axis.size - 1), axis.logarithmic, axis.size};
}

/// The model for `machine`, within what `room` has.
CompiledModel model_within(const Machine& room, const Material& material, const Machine& machine,
                           const glm::vec3& light, const glm::vec3& ambient) {
    ExprBuilder builder;
    ExprPtr value = model_expression(material, builder);
    const TexelSource source(material);
    PlanTask task;
    task.quantities = values_of(quantities_of(*value), source, material.name, task.most_tilt);

    // Numbers and colours that do not vary are constants of the program.
    std::vector<std::pair<const Expr*, glm::dvec3>> constants;
    std::vector<LayerQuantity> constant_layer;
    for (const auto& [quantity, v] : task.quantities) {
        if (v.low != v.high) continue;
        // Registers hold no signs in constants; a vector of length 0 is none.
        if (quantity->kind == ValueKind::vector && v.longest > 0.0) continue;
        constants.emplace_back(quantity, v.low);
        LayerQuantity same;
        same.name = quantity->name;
        same.components = quantity->kind == ValueKind::scalar ? 1 : 3;
        same.constant = v.low;
        same.definition = print_expression(*quantity->args.front());
        constant_layer.push_back(std::move(same));
    }
    value = with_constants(value, builder, constants);

    const std::vector<ModelTerm> terms = terms_of(value, builder);
    Ranges ranges;
    for (const auto& [quantity, v] : task.quantities) {
        if (quantity->kind == ValueKind::vector) {
            ranges.set(quantity, {v.shortest, v.longest});
        } else {
            ranges.set(quantity, {std::min({v.low.x, v.low.y, v.low.z}),
                                  std::max({v.high.x, v.high.y, v.high.z})});
        }
    }
    std::vector<const Expr*> roots;
    for (const ModelTerm& term : terms) {
        if (term.scalar) roots.push_back(term.scalar.get());
    }
    require_bounds(roots, ranges, material.name);
    const TablePrice price = machine.stage_fetches ? TablePrice::fetch
                             : room.stage_fetches  ? TablePrice::passes
                                                   : TablePrice::none;
    Cover cover(roots, ranges, machine.numbers, price);
    task.terms = &terms;
    task.varies = source.varies();
    task.light = light;
    task.ambient = ambient;
    task.numbers = machine.numbers;
    task.vertex_light = machine.half_vector == HalfVector::vertex;
    task.scaled_half_vector = machine.half_vector == HalfVector::pixel;
    const Plan plan = make_plan(task, cover, ranges);
    Schedule scheduled = schedule(plan, room, machine);
    BakedTextures baked = bake(plan, scheduled, source, machine.numbers);

    CompiledModel compiled;
    compiled.program = std::move(scheduled.material);
    compiled.program.units = std::move(baked.units);
    compiled.layer = std::move(baked.layer);
    for (std::size_t i = 0; i < plan.quantities.size(); ++i)
        compiled.layer[i].definition = print_expression(*plan.quantities[i].expr->args.front());
    compiled.layer.insert(compiled.layer.end(), constant_layer.begin(), constant_layer.end());
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

/// All that the model takes, whatever `machine` has. Without tables if combiners can do it; `first`
/// is what was short there.
ModelNeeds count_needs(const Shortage& first, const Material& material, const Machine& machine,
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
            needs = model_within(room, material, target, light, ambient).needs;
            needs.stage_constants = own && !machine.multipass;
            return needs;
        } catch (const Shortage& shortage) {
            needs = shortage.needs;
        }
    }
    return needs;
}

/// "ward", or the text of a material and where in it.
std::string name_of(const Material& material, const Shortage& shortage) {
    if (material.model != Model::text) return std::string(model_name(material.model));
    std::string name = fmt::format("material '{}', model_text", material.name);
    if (shortage.line > 0) name += fmt::format(":{}:{}", shortage.line, shortage.column);
    return name;
}

/// What several passes would change.
std::string with_passes(const Material& material, Machine machine, const ModelNeeds& needs,
                        const glm::vec3& light, const glm::vec3& ambient) {
    const Machine room = with_room(machine);
    if (machine.multipass) {
        if (needs.stages <= room.general_stages) return "";
        return fmt::format("several passes have {} together", room.general_stages);
    }
    machine.multipass = true;
    try {
        const std::size_t passes = compile_model(material, machine, light, ambient).passes.size();
        return fmt::format("in {} passes it fits (multipass)", passes);
    } catch (const Error&) {
        return "";
    }
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

CompiledModel compile_model(const Material& material, const Machine& machine,
                            const glm::vec3& light, const glm::vec3& ambient) {
    try {
        CompiledModel model = model_within(machine.multipass ? with_room(machine) : machine,
                                           material, machine, light, ambient);
        if (!machine.multipass || has_room_for(machine, model.program)) return model;
        try {
            model.passes = passes_of(model.program, machine);
        } catch (const Error& obstacle) {
            refuse(material, machine, Shortage("", model.needs), obstacle.what());
        }
        return model;
    } catch (Shortage& shortage) {
        shortage.needs = count_needs(shortage, material, machine, light, ambient);
        refuse(material, machine, shortage,
               with_passes(material, machine, shortage.needs, light, ambient));
    }
}

const CompiledModel& CompiledModels::get(const std::shared_ptr<const Material>& material,
                                         const Machine& machine, const glm::vec3& light,
                                         const glm::vec3& ambient) {
    for (const auto& e : m_entries) {
        if (e->material == material && e->machine == machine && e->light == light &&
            e->ambient == ambient) {
            e->used = true;
            return e->model;
        }
    }
    CompiledModel model = compile_model(*material, machine, light, ambient);
    m_entries.push_back(
        std::make_unique<Entry>(Entry{material, machine, light, ambient, std::move(model), true}));
    return m_entries.back()->model;
}

void CompiledModels::drop_unused() {
    std::erase_if(m_entries, [](const auto& e) { return !e->used; });
    for (const auto& e : m_entries) e->used = false;
}

std::vector<LayerQuantity> material_layer(const Material& material, const Machine& machine) {
    return compile_model(material, machine, glm::vec3(1.0F), glm::vec3(0.0F)).layer;
}

}  // namespace burnish
