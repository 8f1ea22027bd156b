#include "trace/coded_planes.hpp"

namespace burnish {

std::vector<bool> coded_planes(const LightShading& shading, const CombinerProgram& program) {
    Registers<bool> expanded;
    const auto look = [&](const Input& in) {
        if (in.mapping < Mapping::expand || in.mapping > Mapping::half_bias_negate) return;
        std::array<bool, 4>& of = expanded[in.reg];
        if (in.component == Component::rgb) of[0] = of[1] = of[2] = true;
        if (in.component == Component::blue) of[2] = true;
        if (in.component == Component::alpha) of[3] = true;
    };
    for (const GeneralStage& stage : program.stages) {
        for (const StageFetch& fetch : stage.fetches) {
            for (int i = 0; i < coordinate_count(fetch.target); ++i) {
                const FetchCoordinate& at = fetch.coordinates[static_cast<std::size_t>(i)];
                if (at.expand) expanded[at.reg][at.component] = true;
            }
        }
        for (const Portion* p : {&stage.rgb, &stage.alpha}) {
            if (!p->writes()) continue;
            for (const Input* in : {&p->a, &p->b, &p->c, &p->d}) look(*in);
        }
    }
    std::vector<bool> coded(static_cast<std::size_t>(shading.program.plane_count));
    const auto mark = [&](int plane, bool is_coded) {
        if (plane >= 0 && is_coded) coded[static_cast<std::size_t>(plane)] = true;
    };
    for (int r = 0; r < kRegisterCount; ++r) {
        for (std::size_t c = 0; c < 4; ++c)
            mark(shading.program.input[static_cast<std::size_t>(r)][c],
                 expanded[static_cast<Register>(r)][c]);
    }
    for (const BoundFetch& fetch : shading.program.fetches) {
        for (int c = 0; c < 4; ++c)
            mark(fetch.out + c, expanded[tex(fetch.unit)][static_cast<std::size_t>(c)]);
    }
    // What goes to such a plane through others is coded there, too.
    for (auto op = shading.inputs.rbegin(); op != shading.inputs.rend(); ++op) {
        if (const auto* decode = std::get_if<DecodeCtx>(&*op)) {
            mark(decode->plane, decode->reading == Reading::expanded);
        } else if (const auto* copy = std::get_if<CopyCtx>(&*op)) {
            mark(copy->from, coded[static_cast<std::size_t>(copy->to)]);
        } else if (const auto* blend = std::get_if<BlendLevelsCtx>(&*op)) {
            for (int k = 0; k < blend->channels; ++k) {
                mark(blend->a + k, coded[static_cast<std::size_t>(blend->out + k)]);
                mark(blend->b + k, coded[static_cast<std::size_t>(blend->out + k)]);
            }
        }
    }
    return coded;
}

}  // namespace burnish
