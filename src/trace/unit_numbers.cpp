#include "trace/unit_numbers.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/program_text.hpp>

namespace burnish {

namespace {

/// As the text has it, or the bare name where no text can say it.
std::string unit_text(const TextureShader& shader, int unit) {
    try {
        return print_texture_unit(shader, unit);
    } catch (const Error&) {
        return std::string(
            texture_operation_name(shader.units.at(static_cast<std::size_t>(unit)).operation));
    }
}

/// Unit whose texel a register plane is part of.
std::string texel_name(const Shading& shading, int plane, int& component) {
    for (const PlannedUnit& unit : shading.units) {
        component = plane - unit.registers;
        if (unit.registers >= 0 && component >= 0 && component < 4)
            return fmt::format("tex{}", unit.unit);
    }
    component = 0;
    return "texel";
}

const char* reading_name(Reading reading) {
    switch (reading) {
        case Reading::unsigned_texel:
        case Reading::signed_texel:
            return "";
        case Reading::expanded:
            return "expand ";
        case Reading::two_complement:
            return "signed ";
        case Reading::nv2a_d3d:
            return "mapping 1 ";
        case Reading::nv2a_gl:
            return "mapping 2 ";
        case Reading::nv2a_signed:
            return "mapping 3 ";
    }
    return "";
}

}  // namespace

std::vector<TracedUnit> traced_units(const ProgramMaterial& program, const Machine& machine) {
    std::vector<TracedUnit> units;
    if (!program.texture_shader) return units;
    for (int i = 0; i < kTextureShaderUnits; ++i) {
        units.push_back({i, unit_text(*program.texture_shader, i), {}, {}});
    }
    for (const UnitProblem& p : check_consistency(*program.texture_shader, program.units, machine))
        units.at(static_cast<std::size_t>(p.unit)).problem = p.reason;
    return units;
}

std::optional<UnitNumbers> unit_numbers(const InputOp& op, const Shading& shading) {
    if (const auto* c = std::get_if<DecodeCtx>(&op)) {
        int component = 0;
        const std::string name = texel_name(shading, c->plane, component);
        return UnitNumbers{
            reading_name(c->reading) + name, std::string(1, "rgba"[component]), {c->attribute}};
    }
    if (const auto* c = std::get_if<HiloCtx>(&op))
        return UnitNumbers{"texel", "hl", {c->out, c->out + 1}};
    if (const auto* c = std::get_if<AffineCtx>(&op)) return UnitNumbers{"mapped", "x", {c->to}};
    if (const auto* c = std::get_if<DotCtx>(&op)) return UnitNumbers{"dot", "p", {c->to}};
    if (const auto* c = std::get_if<HemisphereCtx>(&op))
        return UnitNumbers{"hemisphere", "z", {c->to}};
    if (const auto* c = std::get_if<OffsetCtx>(&op))
        return UnitNumbers{"moved", "st", {c->to, c->to + 1}};
    if (const auto* c = std::get_if<ReflectCtx>(&op))
        return UnitNumbers{"reflection", "xyz", {c->to, c->to + 1, c->to + 2}};
    if (const auto* c = std::get_if<QuotientCtx>(&op)) return UnitNumbers{"depth", "z", {c->to}};
    if (const auto* c = std::get_if<AngleCtx>(&op)) return UnitNumbers{"phi", "r", {c->to}};
    if (const auto* c = std::get_if<CullCtx>(&op)) return UnitNumbers{"keep", "k", {c->keep}};
    return std::nullopt;
}

int unit_of_operation(const Shading& shading, std::size_t op) {
    int unit = -1;
    for (const PlannedUnit& u : shading.units) {
        if (u.first_op <= op) unit = u.unit;
    }
    return unit;
}

}  // namespace burnish
