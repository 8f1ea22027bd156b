#include "view/trace_tables.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace burnish::view {
namespace {

const ImVec4 kChangedColor(1.0F, 0.85F, 0.4F, 1.0F);

/// A cell of the table that is open.
void cell(const std::string& text, bool stands_out = false) {
    ImGui::TableNextColumn();
    if (stands_out)
        ImGui::TextColored(kChangedColor, "%s", text.c_str());
    else
        ImGui::TextUnformatted(text.c_str());
}

/// With the titles of its columns, at least so many characters wide: where the panel is narrower,
/// it scrolls. False if it is not to be seen.
bool begin_table(const std::string& id, float characters,
                 std::initializer_list<const char*> titles) {
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV;
    const float width =
        std::max(characters * ImGui::CalcTextSize("0").x, ImGui::GetContentRegionAvail().x);
    if (!ImGui::BeginTable(id.c_str(), static_cast<int>(titles.size()), kFlags,
                           ImVec2(width, 0.0F)))
        return false;
    for (const char* title : titles) ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    return true;
}

template <class Number>
std::string four(const std::array<bool, 4>& filled, int width, const Number& number) {
    std::string text;
    for (std::size_t c = 0; c < 4; ++c)
        text += fmt::format("{:>{}}", filled[c] ? number(c) : "-", width);
    return text;
}

std::string taps_text(const TracedTaps& taps, bool has_layers) {
    std::string text;
    if (has_layers) text += fmt::format("level {}, face or slice {}, ", taps.level, taps.layer);
    text += fmt::format("weights: right {}/256, lower {}/256\n", taps.weight_x, taps.weight_y);
    for (std::size_t tap = 0; tap < 4; ++tap) {
        const auto& bits = taps.taps[tap];
        const std::string place =
            fmt::format("({}, {})", tap % 2 == 0 ? taps.x0 : taps.x1, tap < 2 ? taps.y0 : taps.y1);
        text += fmt::format("texel {:<14}{:>6}{:>6}{:>6}{:>6}\n", place, bits[0], bits[1], bits[2],
                            bits[3]);
    }
    return text;
}

}  // namespace

void color_table(const std::string& id, const std::vector<ColorRow>& rows, int one) {
    if (!begin_table(id, 138.0F, {"", "code r g b a", "value", "exact", "error, in codes"})) return;
    for (const ColorRow& row : rows) {
        ImGui::TableNextRow();
        const auto numbers = [&](int width, const auto& number) {
            cell(four(row.filled, width, number), row.changed);
        };
        cell(row.name, row.changed);
        numbers(7, [&](std::size_t c) { return fmt::format("{}", row.codes[c]); });
        numbers(8, [&](std::size_t c) { return fmt::format("{:.4f}", row.color[c].value); });
        numbers(8, [&](std::size_t c) { return fmt::format("{:.4f}", row.color[c].exact); });
        numbers(8,
                [&](std::size_t c) { return fmt::format("{:.2f}", row.color[c].error() * one); });
    }
    ImGui::EndTable();
}

void number_table(const std::string& id, const std::vector<TracedInterpolant>& rows) {
    if (rows.empty() || !begin_table(id, 64.0F, {"", "value", "exact", "error"})) return;
    for (const TracedInterpolant& group : rows) {
        for (std::size_t k = 0; k < group.numbers.size(); ++k) {
            const TracedNumber& number = group.numbers[k];
            ImGui::TableNextRow();
            cell(fmt::format("{}.{}", group.name, group.components[k]));
            cell(fmt::format("{:>12.7f}", number.value));
            cell(fmt::format("{:>12.7f}", number.exact));
            cell(fmt::format("{:>9.1e}", number.error()));
        }
    }
    ImGui::EndTable();
}

void fetch_table(const std::string& id, const TracedFetch& fetch, int one) {
    std::vector<TracedInterpolant> where{{"coordinates", "uv", {fetch.u, fetch.v}}};
    if (fetch.r) where.push_back({"coordinates", "r", {*fetch.r}});
    if (fetch.lod) where.push_back({"level", "k", {*fetch.lod}});
    if (fetch.sampler.max_anisotropy > 1) {
        where.push_back({"probes", "n", {fetch.probes}});
        where.push_back({"from probe to probe", "uv", {fetch.apart[0], fetch.apart[1]}});
    }
    number_table(id + " where", where);
    const bool has_layers = fetch.lod || fetch.target != TextureTarget::two_d;
    std::string texels = taps_text(fetch, has_layers);
    for (const TracedTaps& taps : fetch.further) texels += taps_text(taps, has_layers);
    ImGui::TextUnformatted(texels.c_str());
    color_table(id, {{fmt::format("tex{}", fetch.unit), fetch.codes, fetch.color}}, one);
}

void blend_table(const std::string& id, const TracedBlend& blend) {
    if (!begin_table(id, 64.0F, {"blend", "r", "g", "b", "a"})) return;
    const auto row = [](const char* name, const std::array<double, 4>& numbers) {
        ImGui::TableNextRow();
        cell(name);
        for (const double number : numbers) cell(fmt::format("{:>10.6g}", number));
    };
    row("source", blend.source);
    row("its factor", blend.source_factor);
    row("frame", blend.destination);
    row("its factor", blend.destination_factor);
    row("result", blend.result);
    ImGui::EndTable();
}

}  // namespace burnish::view
