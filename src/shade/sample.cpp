#include "shade/sample.hpp"

namespace burnish {

namespace {

bool same(const AddressCtx& a, const AddressCtx& b) {
    return a.u == b.u && a.v == b.v && a.q == b.q && a.width == b.width && a.height == b.height &&
           a.pitch == b.pitch && a.mode_s == b.mode_s && a.mode_t == b.mode_t &&
           a.linear == b.linear;
}

}  // namespace

void plan_sample(const Texture& texture, const SampleCoordinates& at, const SampleTarget& target,
                 SamplePlan& plan, std::vector<InputOp>& ops) {
    const auto mode = [](Wrap wrap) {
        return wrap == Wrap::repeat ? AddressMode::repeat : AddressMode::clamp_to_edge;
    };
    AddressCtx address{};
    address.u = at.s;
    address.v = at.t;
    address.q = at.q;
    address.width = texture.width();
    address.height = texture.height();
    address.pitch = texture.pitch();
    address.mode_s = mode(texture.sampler().wrap_s);
    address.mode_t = mode(texture.sampler().wrap_t);
    address.linear = texture.sampler().filter == Filter::linear ? 1 : 0;
    const bool shares = plan.has_last && same(plan.last, address) && !ops.empty();
    if (!shares) ops.emplace_back(address);
    auto* fetch = shares ? std::get_if<FetchCtx>(&ops.back()) : nullptr;
    if (fetch == nullptr || fetch->count == FetchCtx::kMaxTextures) {
        ops.emplace_back(FetchCtx{{}, {}, {}, 0, texture.pitch()});
        fetch = &std::get<FetchCtx>(ops.back());
    }
    fetch->texels[fetch->count] = texture.texels();
    fetch->is_signed[fetch->count] = texture.format() == TexelFormat::signed_rgba8 ? 1 : 0;
    fetch->plane[fetch->count++] = target.registers;
    plan.last = address;
    plan.has_last = true;
}

}  // namespace burnish
