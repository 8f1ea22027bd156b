#include <burnish/combiner.hpp>
#include <burnish/error.hpp>

namespace burnish {
namespace {

GeneralStage& open_stage(CombinerProgram& program) {
    if (program.stages.empty())
        throw Error(ErrorCode::bad_program, "no open stage, expected stage() before a portion");
    return program.stages.back();
}

}  // namespace

GeneralStage idle_stage() {
    GeneralStage stage;
    // Zero reads the same in every component; alpha is the one that an alpha portion can name.
    for (Input* input : {&stage.alpha.a, &stage.alpha.b, &stage.alpha.c, &stage.alpha.d})
        input->component = Component::alpha;
    return stage;
}

PortionBuilder& PortionBuilder::ab(const combine::ProductExpr& p, Register out) {
    m_portion->a = p.x;
    m_portion->b = p.y;
    m_portion->ab_product = p.kind;
    m_portion->ab_out = out;
    return *this;
}

PortionBuilder& PortionBuilder::cd(const combine::ProductExpr& p, Register out) {
    m_portion->c = p.x;
    m_portion->d = p.y;
    m_portion->cd_product = p.kind;
    m_portion->cd_out = out;
    return *this;
}

PortionBuilder& PortionBuilder::sum(Register out) {
    m_portion->third = Third::sum;
    m_portion->third_out = out;
    return *this;
}

PortionBuilder& PortionBuilder::mux(Register out) {
    m_portion->third = Third::mux;
    m_portion->third_out = out;
    return *this;
}

PortionBuilder& PortionBuilder::scale(Scale s) {
    m_portion->scale = s;
    return *this;
}

PortionBuilder& PortionBuilder::bias() {
    m_portion->bias_minus_half = true;
    return *this;
}

PortionBuilder& PortionBuilder::wide() {
    m_portion->wide = true;
    return *this;
}

ProgramBuilder& ProgramBuilder::stage() {
    m_program.stages.push_back(idle_stage());
    return *this;
}

PortionBuilder ProgramBuilder::rgb() {
    return PortionBuilder(open_stage(m_program).rgb);
}

PortionBuilder ProgramBuilder::alpha() {
    return PortionBuilder(open_stage(m_program).alpha);
}

ProgramBuilder& ProgramBuilder::lerp(Input a, Input b, Input c, Input d) {
    FinalCombiner& final_combiner = m_program.final_combiner;
    final_combiner.a = a;
    final_combiner.b = b;
    final_combiner.c = c;
    final_combiner.d = d;
    return *this;
}

ProgramBuilder& ProgramBuilder::product(Input e, Input f) {
    m_program.final_combiner.e = e;
    m_program.final_combiner.f = f;
    return *this;
}

ProgramBuilder& ProgramBuilder::out_alpha(Input g) {
    m_program.final_combiner.g = g;
    return *this;
}

ProgramBuilder& ProgramBuilder::constants(const glm::vec4& const0, const glm::vec4& const1) {
    m_program.const0 = const0;
    m_program.const1 = const1;
    return *this;
}

}  // namespace burnish
