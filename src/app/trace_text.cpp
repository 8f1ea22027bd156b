#include <fmt/format.h>

#include <cmath>

#include "app/trace_print.hpp"

namespace burnish::app {
namespace {

constexpr const char* kNotFilled = "-";

/// Four numbers of one kind side by side; `cell` prints component c.
template <class F>
std::string four(F&& cell) {
    std::string text;
    for (std::size_t c = 0; c < 4; ++c) text += cell(c);
    return text;
}

/// Prints tables whose columns are wide enough for the machine's codes.
class TableWriter {
  public:
    explicit TableWriter(int one) : m_one(one), m_digits(one > 255 ? 5 : 4) {}

    std::string heading(const std::string& title) const {
        const int wide = 4 * value_width();
        return fmt::format("{:<15}{:<28}{:<{}}{:<{}}{}\n", title, "     code r g b a", "  value",
                           wide, "  exact", wide, "  error, in codes");
    }

    std::string row(const std::string& name, const std::array<int, 4>& codes,
                    const std::array<TracedNumber, 4>& color,
                    const std::array<bool, 4>& filled) const {
        const auto cell = [&](std::size_t c, int width, const std::string& text) {
            return fmt::format("{:>{}}", filled[c] ? text : kNotFilled, width);
        };
        const auto value = [&](double x) { return fmt::format("{:.{}f}", x, m_digits); };
        std::string text = fmt::format("{:<15}", name);
        text += four([&](std::size_t c) { return cell(c, 7, fmt::format("{}", codes[c])); });
        text += four([&](std::size_t c) { return cell(c, value_width(), value(color[c].value)); });
        text += four([&](std::size_t c) { return cell(c, value_width(), value(color[c].exact)); });
        text += four([&](std::size_t c) {
            return cell(c, 8, fmt::format("{:.2f}", color[c].error() * m_one));
        });
        return text + "\n";
    }

    std::string stage(const TracedStage& stage) const {
        std::string text = stage.name + "\n" + stage.text + heading("");
        for (const TracedRegister& r : stage.registers) {
            const bool changed = r.changed[0] || r.changed[1] || r.changed[2] || r.changed[3];
            text += row(fmt::format("{} {}", changed ? '*' : ' ', register_name(r.reg)), r.codes,
                        r.color, r.filled);
        }
        return text;
    }

  private:
    [[nodiscard]] int value_width() const { return m_digits + 4; }

    int m_one;
    int m_digits;
};

constexpr std::array<bool, 4> kAll{true, true, true, true};

std::string triangle_text(const TracedFragment& f) {
    std::string text = fmt::format("object {}, material '{}', triangle {}{}\n", f.object,
                                   f.material, f.triangle, f.clipped ? ", clipped" : "");
    text += fmt::format("  depth {:.9g}\n", f.depth);
    text += fmt::format("  1/w   {:.9g}, exact {:.9g}, error {:.1e}\n", f.one_over_w.value,
                        f.one_over_w.exact, f.one_over_w.error());
    for (std::size_t i = 0; i < 3; ++i) {
        text += fmt::format("  corner {}: vertex {}, weight {:.9f}\n", i, f.vertices[i],
                            f.barycentrics[i]);
    }
    return text;
}

std::string interpolant_text(const std::string& title, const std::vector<TracedInterpolant>& list) {
    if (list.empty()) return "";
    std::string text = fmt::format("{:<20}{:>14}{:>14}{:>11}\n", title, "value", "exact", "error");
    for (const TracedInterpolant& group : list) {
        for (std::size_t k = 0; k < group.numbers.size(); ++k) {
            const TracedNumber& n = group.numbers[k];
            const std::string name = group.name + "." + group.components[k];
            text += fmt::format("  {:<18}{:>14.8f}{:>14.8f}{:>11.1e}\n", name, n.value, n.exact,
                                n.error());
        }
    }
    return text;
}

std::string unit_text(const TracedUnit& unit) {
    std::string text = fmt::format("unit {}: {}\n", unit.unit, unit.text);
    if (!unit.problem.empty()) text += fmt::format("  off: {}\n", unit.problem);
    return text + interpolant_text("", unit.numbers);
}

const char* wrap_name(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return "repeat";
        case Wrap::clamp_to_edge:
            return "clamp_to_edge";
        case Wrap::clamp_to_border:
            return "clamp_to_border";
        case Wrap::mirrored_repeat:
            break;
    }
    return "mirrored_repeat";
}

std::string number_text(const char* name, const TracedNumber& n) {
    return fmt::format("  {} {:.8f}, exact {:.8f}, error {:.1e}\n", name, n.value, n.exact,
                       n.error());
}

std::string taps_text(const TracedTaps& taps) {
    std::string text =
        fmt::format("  weights: right {}/256, lower {}/256\n", taps.weight_x, taps.weight_y);
    for (std::size_t tap = 0; tap < 4; ++tap) {
        const auto& bits = taps.taps[tap];
        const std::string place =
            fmt::format("({}, {})", tap % 2 == 0 ? taps.x0 : taps.x1, tap < 2 ? taps.y0 : taps.y1);
        text += fmt::format("  texel {:<14}{:>4}{:>4}{:>4}{:>4}\n", place, bits[0], bits[1],
                            bits[2], bits[3]);
    }
    return text;
}

/// Where the taps are, for textures of several levels, faces or slices.
std::string place_text(const TracedFetch& f, const TracedTaps& taps) {
    if (f.target == TextureTarget::cube) {
        return fmt::format("  level {}, face {}\n", taps.level, taps.layer);
    }
    if (f.target == TextureTarget::three_d) {
        return fmt::format("  level {}, slice {}\n", taps.level, taps.layer);
    }
    return f.lod ? fmt::format("  level {}\n", taps.level) : "";
}

std::string fetch_text(const TracedFetch& f, const TableWriter& table) {
    std::string text = fmt::format("fetch of unit {}: {} x {} texels, {}, {} {}\n", f.unit, f.width,
                                   f.height, filter_name(f.sampler.filter),
                                   wrap_name(f.sampler.wrap_s), wrap_name(f.sampler.wrap_t));
    text += number_text("u", f.u) + number_text("v", f.v);
    if (f.r) text += number_text("r", *f.r);
    if (f.lod) text += number_text("level of detail", *f.lod);
    if (f.sampler.max_anisotropy > 1) {
        text += fmt::format("  probes {:.0f}, exact {:.0f}\n", f.probes.value, f.probes.exact);
        text += number_text("u from probe to probe", f.apart[0]);
        text += number_text("v from probe to probe", f.apart[1]);
    }
    text += place_text(f, f) + taps_text(f);
    for (const TracedTaps& taps : f.further) text += place_text(f, taps) + taps_text(taps);
    const std::string name = fmt::format("  tex{}", f.unit);
    return text + table.heading("") + table.row(name, f.codes, f.color, kAll);
}

std::string blend_text(const TracedBlend& b, PixelFormat format) {
    const auto channels = [](const std::array<double, 4>& x) {
        return four([&](std::size_t c) { return fmt::format("{:>13.9g}", x[c]); });
    };
    std::string text =
        fmt::format("blend {}, src {}, dst {}\n", blend_equation_name(b.blend.equation),
                    blend_factor_name(b.blend.src), blend_factor_name(b.blend.dst));
    text += fmt::format("  {:<20}{}\n", format_name(format),
                        "            r            g            b            a");
    text += fmt::format("  {:<20}{}\n", "source", channels(b.source));
    text += fmt::format("  {:<20}{}\n", "  factor", channels(b.source_factor));
    text += fmt::format("  {:<20}{}\n", "frame", channels(b.destination));
    text += fmt::format("  {:<20}{}\n", "  factor", channels(b.destination_factor));
    return text + fmt::format("  {:<20}{}\n", "result", channels(b.result));
}

/// What one light gives the fragment, or one of its corners, whose interpolants are the fragment's.
std::string light_text(const TracedFragment& f, const TableWriter& table) {
    std::string text;
    if (!f.corner) text += interpolant_text("interpolants", f.interpolants) + "\n";
    for (const TracedUnit& unit : f.units) text += unit_text(unit);
    if (!f.units.empty()) text += "\n";
    for (const TracedFetch& fetch : f.fetches) text += fetch_text(fetch, table) + "\n";
    for (const TracedStage& stage : f.stages) text += table.stage(stage) + "\n";
    return text + table.heading("result") +
           table.row("  color", f.light_codes, f.light_color, kAll);
}

/// All lights, one after the other, and their sum.
std::string lights_text(const TracedFragment& f, const TableWriter& table) {
    const std::size_t lights = f.further_lights.size() + 1;
    const auto heading = [&](std::size_t number) {
        return lights > 1 ? fmt::format("light {} of {}\n", number, lights) : std::string();
    };
    std::string text = heading(1) + light_text(f, table);
    for (std::size_t i = 0; i < f.further_lights.size(); ++i)
        text += fmt::format("\n{}{}", heading(i + 2), light_text(f.further_lights[i], table));
    if (lights > 1) {
        text += fmt::format("\n{}{}", table.heading("all lights"),
                            table.row("  color", f.codes, f.color, kAll));
    }
    return text;
}

std::string corner_name(const TracedCorner& corner) {
    return fmt::format("{} {}", corner.below ? "lower" : "upper", corner.right ? "right" : "left");
}

/// What the filter after combining takes and gives.
std::string filter_text(const TracedFragment& f, const TableWriter& table) {
    const TracedCorner& place = *f.corners.front().corner;
    std::string text = "filter of the corners\n" + number_text("right", place.weight_x) +
                       number_text("lower", place.weight_y);
    if (place.level_weight) text += number_text("upper level", *place.level_weight);
    text += table.heading("");
    for (const TracedFragment& each : f.corners) {
        std::string name = "  " + corner_name(*each.corner);
        if (place.level_weight) name += fmt::format(" {}", each.corner->level);
        text += table.row(name, each.codes, each.color, kAll);
    }
    return text + table.row("  color", f.codes, f.color, kAll);
}

std::string corners_text(const TracedFragment& f, const TableWriter& table) {
    std::string text = interpolant_text("interpolants", f.interpolants) + "\n";
    for (const TracedFragment& each : f.corners) {
        const TracedCorner& corner = *each.corner;
        text += fmt::format("corner {}, level {}\n{}{}{}\n", corner_name(corner), corner.level,
                            number_text("u", corner.u), number_text("v", corner.v),
                            lights_text(each, table));
    }
    return text + filter_text(f, table);
}

std::string fragment_text(const TracedFragment& f, const TableWriter& table, PixelFormat format) {
    std::string text = triangle_text(f) + "\n" +
                       (f.corners.empty() ? lights_text(f, table) : corners_text(f, table));
    if (f.blend) text += fmt::format("\n{}", blend_text(*f.blend, format));
    return text;
}

}  // namespace

const char* filter_name(Filter filter) {
    switch (filter) {
        case Filter::nearest:
            return "nearest";
        case Filter::linear:
            return "linear";
        case Filter::nearest_mipmap_nearest:
            return "nearest_mipmap_nearest";
        case Filter::linear_mipmap_nearest:
            return "linear_mipmap_nearest";
        case Filter::nearest_mipmap_linear:
            return "nearest_mipmap_linear";
        case Filter::linear_mipmap_linear:
            break;
    }
    return "linear_mipmap_linear";
}

const char* blend_factor_name(BlendFactor factor) {
    switch (factor) {
        case BlendFactor::zero:
            return "zero";
        case BlendFactor::one:
            return "one";
        case BlendFactor::src_color:
            return "src_color";
        case BlendFactor::one_minus_src_color:
            return "one_minus_src_color";
        case BlendFactor::src_alpha:
            return "src_alpha";
        case BlendFactor::one_minus_src_alpha:
            return "one_minus_src_alpha";
        case BlendFactor::dst_color:
            return "dst_color";
        case BlendFactor::one_minus_dst_color:
            return "one_minus_dst_color";
        case BlendFactor::dst_alpha:
            return "dst_alpha";
        case BlendFactor::one_minus_dst_alpha:
            return "one_minus_dst_alpha";
        case BlendFactor::constant_color:
            return "constant_color";
        case BlendFactor::one_minus_constant_color:
            return "one_minus_constant_color";
    }
    return "";
}

const char* blend_equation_name(BlendEquation equation) {
    switch (equation) {
        case BlendEquation::add:
            return "add";
        case BlendEquation::subtract:
            return "subtract";
        case BlendEquation::reverse_subtract:
            return "reverse_subtract";
        case BlendEquation::min:
            return "min";
        case BlendEquation::max:
            return "max";
    }
    return "";
}

const char* format_name(PixelFormat format) {
    switch (format) {
        case PixelFormat::rgba8:
            return "rgba8";
        case PixelFormat::rgba16:
            return "rgba16";
        case PixelFormat::rgba32f:
            return "rgba32f";
        case PixelFormat::depth32f:
            return "depth32f";
    }
    return "";
}

std::string trace_text(const PixelTrace& trace, const Scene& scene) {
    const TableWriter table(trace.one);
    std::string text =
        fmt::format("pixel {},{} of {} x {}, machine {}, 1 is code {}\n", trace.x, trace.y,
                    scene.width, scene.height, trace.machine.name, trace.one);
    if (!trace.fragment) text += "background\n";
    for (std::size_t i = 0; i < trace.below.size(); ++i) {
        text += fmt::format("fragment {} of {}\n", i + 1, trace.below.size() + 1);
        text += fragment_text(trace.below[i], table, trace.format) + "\n";
    }
    if (!trace.below.empty()) text += fmt::format("fragment {0} of {0}\n", trace.below.size() + 1);
    if (trace.fragment) text += fragment_text(*trace.fragment, table, trace.format);
    const auto& s = trace.stored;
    return text + fmt::format("stored, {}: {} {} {} {}\n", format_name(trace.format), s[0], s[1],
                              s[2], s[3]);
}

}  // namespace burnish::app
