#include <algorithm>
#include <array>
#include <cmath>

#include "trace/exact_inputs.hpp"
#include "trace/mix.hpp"
#include "trace/texel_bytes.hpp"

/// What ExactInputs finds in the tables of models.
namespace burnish {

namespace {

/// A coordinate of a table as a texture's.
double table_coordinate(const LookUpTableCtx::Axis& axis, double at) {
    const double scaled = at * static_cast<double>(axis.scale) + static_cast<double>(axis.offset);
    return scaled / static_cast<double>(axis.divisor);
}

}  // namespace

ExactInputs::Position ExactInputs::position_along(const LookUpTableCtx::Axis& axis, double at) {
    if (axis.plane < 0) return {};
    return table_position(table_coordinate(axis, at), axis.size, AddressMode::clamp_to_edge, true,
                          false);
}

int ExactInputs::table_values() const {
    const bool given = m_rounding.grid != nullptr && m_rounding.grid->values != kExactBits;
    return given ? m_rounding.grid->values : m_rounding.table;
}

ExactInputs::GridPlace ExactInputs::grid_place(const LookUpTableCtx& ctx, std::size_t axis,
                                               double at) {
    const LookUpTableCtx::Axis& of = axis == 0 ? ctx.s : ctx.t;
    if (of.plane < 0) return {};
    const TableGrid& grid = *m_rounding.grid;
    const auto table = std::find_if(grid.tables.begin(), grid.tables.end(),
                                    [&](const auto& each) { return each.texels == ctx.texels; });
    const TableGrid::Table known = table == grid.tables.end() ? TableGrid::Table{} : *table;
    const SpacedAxis spaced(grid.spacing, known.first.at(axis), known.last.at(axis));
    const Position exact =
        position(table_coordinate(of, at), of.size, AddressMode::clamp_to_edge, true, false);
    const double last = of.size - 1;
    const auto place = [&](double coordinate) {
        const double x = last * spaced.position(coordinate);
        const double left = std::clamp(std::floor(x), 0.0, std::max(last - 1.0, 0.0));
        return Position{static_cast<int>(left), x - left};
    };
    if (of.size < 2) return {exact, exact, 0.0};
    double coordinate =
        spaced.coordinate(std::clamp((exact.texel + exact.weight) / last, 0.0, 1.0));
    Quantiser& quantiser = *m_rounding.quantiser;
    coordinate = quantiser.unsigned_number(coordinate, grid.index);
    if (m_rounding.table == kExactBits || !grid.linear) {
        const Position only = place(quantiser.unsigned_number(coordinate, m_rounding.table));
        return {only, only, 0.0};
    }
    const double steps = std::ldexp(1.0, m_rounding.table) - 1.0;
    const double below = std::min(std::floor(coordinate * steps), steps - 1.0);
    return {place(below / steps), place((below + 1.0) / steps), coordinate * steps - below};
}

void ExactInputs::look_up(const LookUpTableCtx& ctx, double s, double t) {
    m_is_table = true;
    m_is_texel = false;
    m_level = m_layer = 0;
    const Texture& texture = texture_at(m_shading, ctx.texels);
    const auto fetch_all = [&](const auto& use) {
        for (const int out : ctx.out) {
            if (out < 0) continue;
            fetch(texture, out, 1);
            use(m_planes[static_cast<std::size_t>(out)]);
        }
    };
    if (m_rounding.grid == nullptr || m_rounding.quantiser == nullptr) {
        m_column = position_along(ctx.s, s);
        m_row = position_along(ctx.t, t);
        fetch_all([](double&) {});
        return;
    }
    const GridPlace column = grid_place(ctx, 0, s), row = grid_place(ctx, 1, t);
    // Every channel has the same texels.
    std::array<double, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
        m_column = k % 2 == 0 ? column.low : column.high;
        m_row = k < 2 ? row.low : row.high;
        fetch_all([&](double& value) { corners.at(k) = value; });
    }
    const double value = mix(mix(corners[0], corners[1], column.weight),
                             mix(corners[2], corners[3], column.weight), row.weight);
    for (const int out : ctx.out)
        if (out >= 0)
            m_planes[static_cast<std::size_t>(out)] =
                rounded(value, out, texture.is_signed(0), table_values());
}

void ExactInputs::average(const AverageTableCtx& ctx, double s, double t, double half) {
    const auto texels = [&](double at) { return table_coordinate(ctx.s, at) * ctx.s.size - 0.5; };
    const Texture& table = texture_at(m_shading, ctx.texels);
    double low = texels(std::max(s - half, static_cast<double>(ctx.least)));
    double high = texels(std::min(s + half, static_cast<double>(ctx.most)));
    if (!(low < high)) low = high = texels(s);
    m_is_table = true;
    m_row = position_along(ctx.t, t);
    const double mean = mix(mean_of_row(table, m_row.texel, low, high),
                            mean_of_row(table, m_row.texel + 1, low, high), m_row.weight);
    for (const int out : ctx.out)
        if (out >= 0) m_planes[static_cast<std::size_t>(out)] = mean;
}

double ExactInputs::mean_of_row(const Texture& table, int row, double low, double high) {
    const double last = table.width() - 1;
    const auto value = [&](double at) {
        const double inside = std::clamp(at, 0.0, last);
        const auto left = static_cast<int>(inside);
        const auto texel = [&](int x) {
            return texel_value(table, 0, 0, std::min(x, table.width() - 1), row, 0);
        };
        return mix(texel(left), texel(left + 1), inside - left);
    };
    if (!(low < high)) return value(low);
    double sum = 0.0;
    for (double from = low, to = low; from < high; from = to) {
        to = std::min(std::floor(from) + 1.0, high);
        sum += 0.5 * (value(from) + value(to)) * (to - from);
    }
    return sum / (high - low);
}

int any_output(std::span<const int, 4> out) {
    return *std::find_if(out.begin(), out.end(), [](int plane) { return plane >= 0; });
}

}  // namespace burnish
