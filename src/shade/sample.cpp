#include "shade/sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <burnish/error.hpp>
#include <cmath>

namespace burnish {

namespace {

AddressMode mode_of(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return AddressMode::repeat;
        case Wrap::clamp_to_edge:
            return AddressMode::clamp_to_edge;
        case Wrap::clamp_to_border:
            return AddressMode::clamp_to_border;
        case Wrap::mirrored_repeat:
            break;
    }
    return AddressMode::mirrored_repeat;
}

bool blends_levels(const Texture& texture) {
    const Filter f = texture.sampler().filter;
    return texture.levels().size() > 1 &&
           (f == Filter::nearest_mipmap_linear || f == Filter::linear_mipmap_linear);
}

bool takes_nearest_level(const Texture& texture) {
    const Filter f = texture.sampler().filter;
    return texture.levels().size() > 1 &&
           (f == Filter::nearest_mipmap_nearest || f == Filter::linear_mipmap_nearest);
}

/// Whether pixels may look at it at several places.
bool has_probes(const Texture& texture) {
    return texture.sampler().max_anisotropy > 1 &&
           (blends_levels(texture) || takes_nearest_level(texture));
}

std::uint8_t signed_channels(const Texture& texture) {
    unsigned mask = 0;
    for (int c = 0; c < 4; ++c) mask |= texture.is_signed(c) ? 1U << c : 0U;
    return static_cast<std::uint8_t>(mask);
}

/// Whether one address of level 0 and the plain fetch do.
bool is_plain(const Texture& texture) {
    const bool flat =
        texture.target() != TextureTarget::cube && texture.target() != TextureTarget::three_d;
    return flat && !is_hilo(texture.format()) && !needs_level_of_detail(texture);
}

/// Whether the sample is the very texel at a corner.
bool is_texel_at_corner(const Texture& texture, const SampleCoordinates& at,
                        const SamplePlan& plan) {
    if (!plan.corners || !plan.corners->hold(at)) return false;
    const Texture& finest = *plan.corners->finest;
    const Sampler &a = texture.sampler(), &b = finest.sampler();
    return texture.target() == finest.target() && texture.width() == finest.width() &&
           texture.height() == finest.height() &&
           texture.levels().size() == finest.levels().size() && a.filter == b.filter &&
           a.mag_is_linear() == b.mag_is_linear() && a.lod_bias == b.lod_bias;
}

bool same(const AddressCtx& a, const AddressCtx& b) {
    return a.u == b.u && a.v == b.v && a.q == b.q && a.width == b.width && a.height == b.height &&
           a.pitch == b.pitch && a.mode_s == b.mode_s && a.mode_t == b.mode_t &&
           a.linear == b.linear && a.rectangle == b.rectangle && a.texel_shift == b.texel_shift;
}

void add_texture(FetchCtx& fetch, const Texture& texture, int plane) {
    fetch.texels[fetch.count] = texture.texels();
    fetch.is_signed[fetch.count] = signed_channels(texture);
    fetch.plane[fetch.count++] = plane;
}

/// The quartet that the texture is in, of which it alone is fetched.
FetchQuartetCtx quartet_of(const Texture& texture, int plane) {
    FetchQuartetCtx fetch{texture.texels() - FetchQuartetCtx::kNextTexture * texture.place(),
                          {-1, -1, -1, -1},
                          texture.pitch()};
    fetch.plane[texture.place()] = plane;
    return fetch;
}

/// Adds what `more` fetches, if it is one place more of the same quartet.
bool takes_too(FetchQuartetCtx& fetch, const FetchQuartetCtx& more, int place) {
    if (fetch.texels != more.texels || fetch.plane[place] >= 0) return false;
    fetch.plane[place] = more.plane[place];
    return true;
}

/// The fetch of the texture's quartet at the addresses that the packet has now, if there is one.
FetchQuartetCtx* quartet_in(std::vector<InputOp>& ops, const std::uint8_t* texels) {
    for (auto op = ops.rbegin(); op != ops.rend(); ++op) {
        const bool is_address =
            std::holds_alternative<AddressCtx>(*op) || std::holds_alternative<LevelAddressCtx>(*op);
        if (is_address) return nullptr;
        auto* const fetch = std::get_if<FetchQuartetCtx>(&*op);
        if (fetch != nullptr && fetch->texels == texels) return fetch;
    }
    return nullptr;
}

/// Planes from `plane` on get the texture's texels at the packet's addresses, which are the same as
/// for all fetches since they were worked out.
void plan_fetch_of_quartet(const Texture& texture, int plane, std::vector<InputOp>& ops) {
    const FetchQuartetCtx fetch = quartet_of(texture, plane);
    FetchQuartetCtx* const before = quartet_in(ops, fetch.texels);
    if (before != nullptr && takes_too(*before, fetch, texture.place())) return;
    ops.emplace_back(fetch);
}

std::uint8_t texel_shift(const Texture& texture) {
    return static_cast<std::uint8_t>(
        std::countr_zero(static_cast<unsigned>(texture.texel_bytes())));
}

void plan_plain(const Texture& texture, const SampleCoordinates& at, int plane, SamplePlan& plan,
                std::vector<InputOp>& ops) {
    const Sampler& sampler = texture.sampler();
    const bool linear = is_linear_within(sampler.filter) && !is_texel_at_corner(texture, at, plan);
    const AddressCtx address{
        at.s,
        texture.target() == TextureTarget::one_d ? at.s : at.t,
        at.q,
        texture.width(),
        texture.height(),
        texture.pitch(),
        mode_of(sampler.wrap_s),
        mode_of(sampler.wrap_t),
        static_cast<std::uint8_t>(linear ? 1 : 0),
        static_cast<std::uint8_t>(texture.target() == TextureTarget::rectangle ? 1 : 0),
        texel_shift(texture)};
    const bool shares = plan.last && at.interpolated && same(*plan.last, address);
    if (!shares) ops.emplace_back(address);
    plan.last.reset();
    if (at.interpolated) plan.last = address;
    if (texture.place() >= 0) return plan_fetch_of_quartet(texture, plane, ops);
    if (has_words(texture.format())) {
        ops.emplace_back(FetchWordsCtx{texture.texels(), plane, texture.pitch()});
        return;
    }
    auto* fetch = shares ? std::get_if<FetchCtx>(&ops.back()) : nullptr;
    if (fetch == nullptr || fetch->count == FetchCtx::kMaxTextures) {
        ops.emplace_back(FetchCtx{{}, {}, {}, 0, texture.pitch()});
        fetch = &std::get<FetchCtx>(ops.back());
    }
    add_texture(*fetch, texture, plane);
}

bool same(const SampleCoordinates& a, const SampleCoordinates& b) {
    return a.s == b.s && a.t == b.t && a.r == b.r && a.q == b.q && a.interpolated == b.interpolated;
}

/// Of two textures of one target at the same coordinates.
bool same(const LevelAddressCtx& a, const LevelAddressCtx& b) {
    const auto same_level = [](const LevelAddressCtx::Level& x, const LevelAddressCtx::Level& y) {
        return x.width == y.width && x.height == y.height && x.offset == y.offset;
    };
    const bool at_corner = a.lambda == SampledCorners::kLevel;
    return at_corner == (b.lambda == SampledCorners::kLevel) && a.texel_bytes == b.texel_bytes &&
           a.mode_s == b.mode_s && a.mode_t == b.mode_t && a.mag_linear == b.mag_linear &&
           a.min_linear == b.min_linear && a.choice == b.choice && a.rectangle == b.rectangle &&
           a.pitch == b.pitch && a.layer_bytes == b.layer_bytes && a.level_count == b.level_count &&
           std::equal(a.levels, a.levels + a.level_count, b.levels, same_level);
}

/// A sample with levels, faces, slices or words, step by step.
class LevelPlanner {
  public:
    LevelPlanner(const Texture& texture, const SampleCoordinates& at, SamplePlan& plan,
                 std::vector<InputOp>& ops)
        : m_texture(texture), m_at(at), m_plan(plan), m_ops(ops) {
        m_address.u = at.s;
        m_address.v = texture.target() == TextureTarget::one_d ? at.s : at.t;
        m_address.q = at.q;
        m_address.r = texture.target() == TextureTarget::three_d ? at.r : -1;
        m_address.face = m_address.lambda = m_address.slice_weight = -1;
        const Sampler& sampler = texture.sampler();
        m_address.mode_s = mode_of(sampler.wrap_s);
        m_address.mode_t = mode_of(sampler.wrap_t);
        m_address.mode_r = mode_of(sampler.wrap_r);
        m_address.mag_linear = sampler.mag_is_linear() ? 1 : 0;
        m_address.min_linear = is_linear_within(sampler.filter) ? 1 : 0;
        m_address.rectangle = texture.target() == TextureTarget::rectangle ? 1 : 0;
        m_address.pitch = texture.pitch();
        m_address.layer_bytes = texture.layer_bytes();
        m_address.texel_bytes = texture.texel_bytes();
        m_address.level_count = static_cast<std::int32_t>(texture.levels().size());
        std::transform(texture.levels().begin(), texture.levels().end(), m_address.levels,
                       [](const TextureLevel& l) {
                           return LevelAddressCtx::Level{l.width, l.height, l.depth, l.offset};
                       });
    }

    void plan(const SampleTarget& target) {
        m_plan.uses_planes = true;
        m_address.choice = choice();
        const bool at_corner = is_texel_at_corner(m_texture, m_at, m_plan);
        if (at_corner) {
            m_address.choice = LevelChoice::floor;
            m_address.lambda = SampledCorners::kLevel;
            m_address.mag_linear = m_address.min_linear = 0;
        }
        if (m_plan.levels && joins(*m_plan.levels)) {
            join(*m_plan.levels, target.registers);
            return;
        }
        m_plan.last.reset();
        m_plan.levels.reset();
        if (needs_level_of_detail(m_texture) && !at_corner) plan_level_of_detail();
        if (m_texture.target() == TextureTarget::cube) plan_face();
        const bool hilo = is_hilo(m_texture.format());
        const int out = hilo ? scratch(kFirst) : target.registers;
        const LevelAddressCtx first = m_address;
        SharedLevels shared{first, m_at, bias(), m_texture.sampler().max_anisotropy, {}, 0,
                            {},    0,    0};
        if (has_probes(m_texture)) shared.probed = begin_probed(out);
        plan_level(out);
        shared.fetch = m_ops.size() - 1;
        if (blends_levels(m_texture) && !at_corner) {
            shared.blended = begin_blended(m_address.lambda);
            m_address.choice = LevelChoice::ceiling;
            plan_level(scratch(kSecond));
            shared.ceiling = m_ops.size() - 1;
            m_ops.emplace_back(blend(out, scratch(kSecond), m_address.lambda));
            end_blended(*shared.blended);
        }
        shared.end = m_ops.size();
        if (shared.probed) end_probed(*shared.probed);
        if (hilo) {
            m_ops.emplace_back(HiloCtx{out, target.values,
                                       static_cast<std::uint8_t>(m_texture.is_signed(0) ? 1 : 0)});
        }
        if (may_share()) m_plan.levels = shared;
    }

    /// At the pixel's own coordinates.
    TexelCornerCtx plan_corner(const SampledCorners& corners, int weight, int level) {
        if (needs_level_of_detail(m_texture)) plan_level_of_detail();
        TexelCornerCtx ctx{};
        ctx.u = corners.s;
        ctx.v = corners.t;
        ctx.q = corners.q;
        ctx.lambda = m_address.lambda;
        ctx.to = corners.corner_s;
        ctx.weight = weight;
        ctx.level = level;
        ctx.mode_s = m_address.mode_s;
        ctx.mode_t = m_address.mode_t;
        ctx.choice = choice();
        ctx.mag_linear = m_address.mag_linear;
        ctx.min_linear = m_address.min_linear;
        ctx.rectangle = m_address.rectangle;
        ctx.level_count = m_address.level_count;
        std::copy_n(m_address.levels, m_address.level_count, ctx.levels);
        return ctx;
    }

  private:
    [[nodiscard]] LevelChoice choice() const {
        if (takes_nearest_level(m_texture)) return LevelChoice::nearest;
        return blends_levels(m_texture) ? LevelChoice::floor : LevelChoice::base;
    }

    // Scratch register planes.
    static constexpr int kFace = 0, kLambda = 1, kSliceWeight = 2, kFirst = 3, kSecond = 7,
                         kBehind = 23;
    // Scratch attribute planes.
    static constexpr int kU = 0, kV = 1, kFootprint = 2, kProbes = 3, kStep = 4, kSum = 6;

    /// Planes of a dependent fetch may be others' later.
    [[nodiscard]] bool may_share() const {
        return m_at.interpolated && m_texture.target() != TextureTarget::three_d &&
               !is_hilo(m_texture.format());
    }

    [[nodiscard]] bool joins(const SharedLevels& shared) const {
        const bool cube = shared.address.face >= 0;
        // Operations go between those of `shared`, and others must not move.
        const bool inserts = has_words(m_texture.format()) || shared.probed;
        return may_share() && (m_texture.target() == TextureTarget::cube) == cube &&
               same(shared.coordinates, m_at) && same(shared.address, m_address) &&
               shared.bias == bias() &&
               shared.max_anisotropy == m_texture.sampler().max_anisotropy &&
               shared.textures < SharedLevels::kMostTextures &&
               !(inserts && m_ops.size() != shared.end);
    }

    /// One texture more at the addresses of `shared`.
    void join(SharedLevels& shared, int out) {
        const int second = scratch(kSecond + 4 * shared.textures), lambda = shared.address.lambda;
        if (shared.probed) add_to_mean(std::get<ProbedCtx>(m_ops[*shared.probed]).sum, out);
        ++shared.textures;
        shared.fetch = fetch_too(shared, shared.fetch, out);
        if (!shared.blended) return;
        shared.ceiling = fetch_too(shared, shared.ceiling, second);
        if (m_ops.size() == shared.end)
            return insert(shared, shared.end, blend(out, second, lambda));
        const std::size_t blended = begin_blended(lambda);
        m_ops.emplace_back(blend(out, second, lambda));
        end_blended(blended);
    }

    /// Texels from the addresses of operation `fetch`, by it or the next one, whose place is given.
    std::size_t fetch_too(SharedLevels& shared, std::size_t fetch, int out) {
        if (auto* const bytes = std::get_if<FetchCtx>(&m_ops[fetch])) {
            add_texture(*bytes, m_texture, out);
            return fetch;
        }
        if (m_texture.place() < 0) {
            insert(shared, fetch + 1, FetchWordsCtx{m_texture.texels(), out, m_texture.pitch()});
            return fetch + 1;
        }
        const FetchQuartetCtx more = quartet_of(m_texture, out);
        auto* const quartet = std::get_if<FetchQuartetCtx>(&m_ops[fetch]);
        if (quartet != nullptr && takes_too(*quartet, more, m_texture.place())) return fetch;
        insert(shared, fetch + 1, more);
        return fetch + 1;
    }

    /// Between the operations of `shared`, or at their end.
    void insert(SharedLevels& shared, std::size_t at, const InputOp& op) {
        m_ops.insert(m_ops.begin() + static_cast<std::ptrdiff_t>(at), op);
        if (shared.probed) ++std::get<ProbedCtx>(m_ops[*shared.probed]).count;
        if (shared.blended && *shared.blended >= at) {
            ++*shared.blended;
        } else if (shared.blended) {
            ++std::get<BlendedCtx>(m_ops[*shared.blended]).count;
        }
        if (shared.ceiling >= at) ++shared.ceiling;
        ++shared.end;
    }

    /// What is planned from here to end_blended() is for packets that blend by plane `weight`.
    std::size_t begin_blended(int weight) {
        m_ops.emplace_back(BlendedCtx{weight, 0});
        return m_ops.size() - 1;
    }
    void end_blended(std::size_t begin) {
        std::get<BlendedCtx>(m_ops[begin]).count = static_cast<int>(m_ops.size() - begin - 1);
    }

    /// What is planned from here to end_probed() is for one probe: planes from `out` on get texels.
    std::size_t begin_probed(int out) {
        ProbedCtx probed{};
        probed.point = {m_address.u,
                        m_address.v,
                        m_address.q,
                        scratch_attribute(kStep),
                        scratch_attribute(kProbes),
                        scratch_attribute(kU),
                        0};
        probed.sum.probes = probed.point.probes;
        probed.sum.sum = scratch_attribute(kSum);
        add_to_mean(probed.sum, out);
        m_ops.emplace_back(probed);
        m_address.u = scratch_attribute(kU);
        m_address.v = scratch_attribute(kV);
        m_address.q = -1;
        return m_ops.size() - 1;
    }
    void add_to_mean(ProbeSumCtx& sum, int out) const {
        sum.doubled = static_cast<std::uint16_t>(sum.doubled | doubled() << sum.channels);
        for (int c = 0; c < channels(); ++c)
            sum.plane[sum.channels++] = static_cast<std::int16_t>(out + c);
    }
    void end_probed(std::size_t begin) {
        std::get<ProbedCtx>(m_ops[begin]).count = static_cast<int>(m_ops.size() - begin - 1);
    }

    [[nodiscard]] int channels() const { return is_hilo(m_texture.format()) ? 2 : 4; }
    /// Channels that come as even codes.
    [[nodiscard]] std::uint8_t doubled() const {
        const bool halves = !is_hilo(m_texture.format()) && m_plan.numbers == NumberModel::nine_bit;
        return halves ? signed_channels(m_texture) : std::uint8_t{0};
    }

    /// 1/256.
    [[nodiscard]] std::int32_t bias() const {
        return static_cast<std::int32_t>(std::floor(256.0F * m_texture.sampler().lod_bias + 0.5F));
    }

    [[nodiscard]] int scratch(int plane) const { return m_plan.planes + plane; }
    [[nodiscard]] int scratch_attribute(int plane) const { return m_plan.attributes + plane; }

    void plan_face() {
        m_address.u = scratch_attribute(kU);
        m_address.v = scratch_attribute(kV);
        m_address.q = -1;
        m_address.face = scratch(kFace);
        m_ops.emplace_back(
            CubeFaceCtx{m_at.s, m_at.t, m_at.r, m_address.u, m_address.v, m_address.face});
    }

    void plan_level_of_detail() {
        const TextureLevel& base = m_texture.levels().front();
        const TextureTarget target = m_texture.target();
        const bool cube = target == TextureTarget::cube;
        const bool at_corner = m_plan.corners && m_plan.corners->hold(m_at);
        FootprintCtx footprint{at_corner ? m_plan.corners->s : m_at.s,
                               at_corner ? m_plan.corners->t : m_address.v,
                               cube ? m_at.r : m_address.r,
                               at_corner ? m_plan.corners->q
                               : cube    ? -1
                                         : m_at.q,
                               static_cast<std::uint8_t>(cube ? 1 : 0),
                               {static_cast<float>(base.width), static_cast<float>(base.height),
                                static_cast<float>(base.depth)},
                               scratch_attribute(kFootprint)};
        if (target == TextureTarget::one_d) footprint.scale[1] = 0.0F;
        if (target == TextureTarget::rectangle) footprint.scale[0] = footprint.scale[1] = 1.0F;
        if (cube) footprint.scale[0] = footprint.scale[1] = 0.5F * static_cast<float>(base.width);
        if (has_probes(m_texture)) {
            m_ops.emplace_back(
                ProbeExtentCtx{footprint,
                               {},
                               scratch_attribute(kProbes),
                               scratch_attribute(kStep),
                               static_cast<float>(m_texture.sampler().max_anisotropy)});
        } else if (m_at.interpolated) {
            m_ops.emplace_back(PlaneFootprintCtx{footprint, {}});
        } else {
            m_ops.emplace_back(QuadFootprintCtx{footprint});
        }
        m_address.lambda = scratch(kLambda);
        const bool levels = blends_levels(m_texture) || takes_nearest_level(m_texture);
        // With one level only, lambda says whether texels are smaller than pixels.
        m_ops.emplace_back(LevelOfDetailCtx{footprint.out, m_address.lambda, bias(),
                                            levels ? 256 * (m_address.level_count - 1) : 1});
    }

    /// Four or two planes from `out` on, from one level.
    void plan_level(int out) {
        const bool linear = m_address.mag_linear != 0 || m_address.min_linear != 0;
        m_address.behind = 0;
        m_address.slice_weight = m_address.r >= 0 && linear ? scratch(kSliceWeight) : -1;
        m_ops.emplace_back(m_address);
        plan_fetch(out);
        if (m_address.slice_weight < 0) return;
        m_address.behind = 1;
        m_ops.emplace_back(m_address);
        plan_fetch(scratch(kBehind));
        m_ops.emplace_back(blend(out, scratch(kBehind), m_address.slice_weight));
    }

    void plan_fetch(int out) {
        if (is_hilo(m_texture.format())) {
            m_ops.emplace_back(FetchHiloCtx{m_texture.texels(), out, m_texture.pitch()});
        } else if (m_texture.place() >= 0) {
            plan_fetch_of_quartet(m_texture, out, m_ops);
        } else if (has_words(m_texture.format())) {
            m_ops.emplace_back(FetchWordsCtx{m_texture.texels(), out, m_texture.pitch()});
        } else {
            FetchCtx fetch{{}, {}, {}, 0, m_texture.pitch()};
            add_texture(fetch, m_texture, out);
            m_ops.emplace_back(fetch);
        }
    }

    [[nodiscard]] BlendLevelsCtx blend(int out, int other, int weight) const {
        return {out,
                other,
                out,
                channels(),
                weight,
                doubled(),
                static_cast<std::uint8_t>(is_hilo(m_texture.format()) ? 1 : 0)};
    }

    const Texture& m_texture;
    const SampleCoordinates& m_at;
    SamplePlan& m_plan;
    std::vector<InputOp>& m_ops;
    LevelAddressCtx m_address{};
};

}  // namespace

bool needs_level_of_detail(const Texture& texture) {
    const Sampler& sampler = texture.sampler();
    return blends_levels(texture) || takes_nearest_level(texture) ||
           is_linear_within(sampler.filter) != sampler.mag_is_linear();
}

bool needs_quads(const Texture& texture) {
    return texture.summed() || needs_level_of_detail(texture);
}

TexelCornerCtx plan_texel_corner(const SampledCorners& corners, int weight, int level,
                                 SamplePlan& plan, std::vector<InputOp>& ops) {
    const SampleCoordinates at{corners.s, corners.t, -1, corners.q, true};
    return LevelPlanner(*corners.finest, at, plan, ops).plan_corner(corners, weight, level);
}

void plan_sample(const Texture& texture, const SampleCoordinates& coordinates,
                 const SampleTarget& target, SamplePlan& plan, std::vector<InputOp>& ops) {
    if (texture.format() == TexelFormat::rgba16 && plan.numbers == NumberModel::nine_bit) {
        throw Error(ErrorCode::bad_program,
                    "a texture of format rgba16 on a machine of nine bits, expected one of 8 bits "
                    "or a wide machine");
    }
    if (texture.is_table()) {
        throw Error(
            ErrorCode::bad_program,
            "a table at the coordinates of a texture unit, expected a fetch between general "
            "stages");
    }
    if (has_probes(texture) && (plan.corners || !coordinates.interpolated)) {
        throw Error(ErrorCode::bad_program,
                    fmt::format("max_anisotropy {} of a texture {}, expected 1",
                                texture.sampler().max_anisotropy,
                                plan.corners ? "on a machine with filter_order = after"
                                             : "at coordinates that are not interpolated"));
    }
    const bool flat =
        texture.target() != TextureTarget::cube && texture.target() != TextureTarget::three_d;
    if (!flat && coordinates.r < 0) {
        throw Error(ErrorCode::bad_program,
                    "a cube map or 3D texture where coordinates have no r, expected three "
                    "coordinates or a flat texture");
    }
    if (is_plain(texture)) {
        plan_plain(texture, coordinates, target.registers, plan, ops);
    } else {
        LevelPlanner(texture, coordinates, plan, ops).plan(target);
    }
}

}  // namespace burnish
