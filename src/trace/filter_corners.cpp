#include "trace/filter_corners.hpp"

#include "core/aligned.hpp"
#include "kernels/kernel_table.hpp"
#include "machine/interpreter.hpp"
#include "trace/mix.hpp"

namespace burnish {

namespace {

/// The mean of four corners in one level.
double exact_mean(std::span<const TracedFragment> corners, std::size_t c) {
    const auto color = [&](std::size_t k) { return corners[k].color[c].exact; };
    const TracedCorner& place = *corners.front().corner;
    return mix(mix(color(0), color(1), place.weight_x.exact),
               mix(color(2), color(3), place.weight_x.exact), place.weight_y.exact);
}

/// Planes of one fragment for the kernels: eight corners, three weights, two results.
class FilterPlanes {
  public:
    static constexpr int kCorners = 0, kWeights = 16, kLower = 19, kUpper = 23, kCount = 27;

    void set(int plane, int value) { at(plane) = static_cast<std::int16_t>(value); }
    [[nodiscard]] int get(int plane) { return at(plane); }
    Packet packet() { return {1, &m_pixel, nullptr, m_planes.data(), nullptr, nullptr, nullptr}; }

  private:
    std::int16_t& at(int plane) { return m_planes[static_cast<std::size_t>(plane) * kPacketSize]; }
    AlignedVector<std::int16_t> m_planes =
        AlignedVector<std::int16_t>(std::size_t{kCount} * kPacketSize);
    std::uint16_t m_pixel = 0;
};

}  // namespace

void filter_corners(NumberModel numbers, std::span<const TracedFragment> corners,
                    TracedFragment& out) {
    const bool nine_bit = numbers == NumberModel::nine_bit;
    const KernelTable& kernels = table_reference();
    FilterPlanes planes;
    Packet packet = planes.packet();
    const auto code = [](const TracedNumber& weight) {
        return static_cast<int>(weight.value * 256.0);
    };
    const auto filter = [&](std::span<const TracedFragment> level, int to) {
        for (int k = 0; k < FilterCtx::kCorners; ++k)
            for (int c = 0; c < 4; ++c)
                planes.set(FilterPlanes::kCorners + 4 * k + c,
                           level[static_cast<std::size_t>(k)].codes[static_cast<std::size_t>(c)]);
        planes.set(FilterPlanes::kWeights, code(level.front().corner->weight_x));
        planes.set(FilterPlanes::kWeights + 1, code(level.front().corner->weight_y));
        (nine_bit ? kernels.filter_nine_bit : kernels.filter_wide)(
            packet, {FilterPlanes::kCorners, FilterPlanes::kWeights, to});
    };
    filter(corners.first(4), FilterPlanes::kLower);
    const auto& level_weight = corners.front().corner->level_weight;
    const bool blends = corners.size() > 4;
    if (blends) {
        filter(corners.subspan(4), FilterPlanes::kUpper);
        planes.set(FilterPlanes::kWeights + 2, code(*level_weight));
        const std::uint8_t any_words = nine_bit ? 0 : 1;
        kernels.blend_levels(packet,
                             {FilterPlanes::kLower, FilterPlanes::kUpper, FilterPlanes::kLower, 4,
                              FilterPlanes::kWeights + 2, 0, any_words});
    }
    const double one = code_of_one(numbers);
    for (std::size_t c = 0; c < 4; ++c) {
        out.codes[c] = planes.get(FilterPlanes::kLower + static_cast<int>(c));
        double exact = exact_mean(corners.first(4), c);
        if (blends) exact = mix(exact, exact_mean(corners.subspan(4), c), level_weight->exact);
        out.color[c] = {out.codes[c] / one, exact};
    }
    out.light_codes = out.codes;
    out.light_color = out.color;
}

}  // namespace burnish
