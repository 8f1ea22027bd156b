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

/// Reads no register plane.
bool fills_only(const InputOp& op) {
    return takes_its_time(op) || is_about_colors(op) || std::holds_alternative<AddressCtx>(op) ||
           std::holds_alternative<FetchCtx>(op) || std::holds_alternative<FetchWordsCtx>(op) ||
           std::holds_alternative<FetchQuartetCtx>(op);
}

/// Which register planes a program finds something in: those that it reads before it writes them.
class PlanesRead {
  public:
    explicit PlanesRead(const BoundProgram& program)
        : m_uses(static_cast<std::size_t>(program.plane_count), Use::none) {
        auto fetch = program.fetches.begin();
        const auto run_fetches = [&](std::size_t before) {
            for (; fetch != program.fetches.end() && fetch->before == before; ++fetch) {
                note_all(fetch->plane, Use::read);
                for (int c = 0; c < 4; ++c) note(fetch->out + c, Use::written);
            }
        };
        for (std::size_t i = 0; i < program.portions.size(); ++i) {
            run_fetches(i);
            const PortionCtx& p = program.portions[i];
            for (const Operand* operand : {&p.a, &p.b, &p.c, &p.d})
                note_all(operand->plane, Use::read);
            note(p.mux_plane, Use::read);
            for (const auto* out : {&p.ab_out, &p.cd_out, &p.third_out})
                note_all(*out, Use::written);
        }
        run_fetches(program.portions.size());
        const FinalCtx& f = program.final_combiner;
        for (const Operand* operand : {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f, &f.g})
            note_all(operand->plane, Use::read);
        note_all(f.spare0, Use::read);
        note_all(f.secondary, Use::read);
        if (program.has_final) note_all(f.out, Use::written);
        note_all(program.result, Use::read);
    }
    /// Of others than the program's planes nothing is known.
    [[nodiscard]] bool operator()(std::size_t plane) const {
        return plane >= m_uses.size() || m_uses[plane] == Use::read;
    }

  private:
    enum class Use : std::uint8_t { none, read, written };

    void note(int plane, Use use) {
        if (plane < 0) return;
        Use& first = m_uses[static_cast<std::size_t>(plane)];
        if (first == Use::none) first = use;
    }
    template <class Planes>
    void note_all(const Planes& planes, Use use) {
        for (const int plane : planes) note(plane, use);
    }
    std::vector<Use> m_uses;
};

/// Leaves out what quartets bring and nobody reads.
void leave_out_unread(const BoundProgram& program, std::vector<InputOp>& ops) {
    if (!std::all_of(ops.begin(), ops.end(), fills_only)) return;
    const PlanesRead is_read(program);
    for (InputOp& op : ops) {
        auto* const fetch = std::get_if<FetchQuartetCtx>(&op);
        if (fetch == nullptr) continue;
        for (int k = 0; k < FetchQuartetCtx::kTextures; ++k) {
            if (fetch->plane[k] < 0) continue;
            fetch->channels[k] = 0;
            for (unsigned c = 0; c < 4; ++c) {
                if (is_read(static_cast<unsigned>(fetch->plane[k]) + c))
                    fetch->channels[k] |= static_cast<std::uint8_t>(1U << c);
            }
        }
    }
}

}  // namespace

std::vector<InputOp> plan_packet_inputs(const Shading& shading) {
    std::vector<InputOp> ops = shading.inputs;
    leave_out_unread(shading.program, ops);
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
