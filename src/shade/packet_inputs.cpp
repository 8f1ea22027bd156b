#include "shade/packet_inputs.hpp"

#include <algorithm>
#include <array>

namespace burnish {

namespace {

bool takes_its_time(const InputOp& op) {
    return std::holds_alternative<LightingCtx>(op);
}
/// Between lighting and textures.
bool is_about_colors(const InputOp& op) {
    return std::holds_alternative<EncodeCtx>(op) || std::holds_alternative<ClearCtx>(op);
}

/// Bytes that a second-level cache does not keep beside everything else.
bool are_many(const AddressCtx& texels) {
    constexpr std::int64_t kBytes = 1 << 20;
    return std::int64_t{texels.pitch} * texels.height >= kBytes;
}

}  // namespace

std::vector<InputOp> plan_packet_inputs(const Shading& shading) {
    std::vector<InputOp> ops = shading.inputs;
    if (ops.empty() || !takes_its_time(ops.front())) return ops;
    const auto textures = std::find_if_not(ops.begin() + 1, ops.end(), is_about_colors);
    if (ops.end() - textures < 2) return ops;
    const auto* const address = std::get_if<AddressCtx>(&textures[0]);
    const auto* const fetch = std::get_if<FetchQuartetCtx>(&textures[1]);
    if (address == nullptr || fetch == nullptr || !are_many(*address)) return ops;
    const bool of_uv = std::max({address->u, address->v, address->q}) < kUvAttributes;
    if (!of_uv) return ops;
    const std::array<InputOp, 2> early{*address, PrefetchQuartetCtx{fetch->texels, fetch->pitch}};
    ops.erase(textures);
    ops.insert(ops.begin(), early.begin(), early.end());
    return ops;
}

}  // namespace burnish
