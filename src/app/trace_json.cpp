#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <span>

#include "app/stats.hpp"
#include "app/trace_print.hpp"

namespace burnish::app {
namespace {

/// JSON has neither NaN nor infinity.
std::string json(double x) {
    return std::isfinite(x) ? fmt::format("{}", x) : "null";
}
std::string json(int x) {
    return fmt::format("{}", x);
}
std::string json(std::uint32_t x) {
    return fmt::format("{}", x);
}
std::string json(std::uint16_t x) {
    return fmt::format("{}", x);
}
std::string json(bool x) {
    return x ? "true" : "false";
}

/// The elements as `f` prints them, between brackets.
template <class Range, class F>
std::string json_list(const Range& range, F&& f) {
    std::string list;
    for (const auto& element : range) {
        if (!list.empty()) list += ", ";
        list += f(element);
    }
    return "[" + list + "]";
}

template <class Range>
std::string json_list(const Range& range) {
    return json_list(range, [](const auto& x) { return json(x); });
}

/// "value", "exact" and "error" of several numbers, without braces.
std::string json_members(std::span<const TracedNumber> numbers) {
    return fmt::format("\"value\": {}, \"exact\": {}, \"error\": {}",
                       json_list(numbers, [](const TracedNumber& n) { return json(n.value); }),
                       json_list(numbers, [](const TracedNumber& n) { return json(n.exact); }),
                       json_list(numbers, [](const TracedNumber& n) { return json(n.error()); }));
}

std::string json(const TracedNumber& n) {
    return fmt::format("{{\"value\": {}, \"exact\": {}, \"error\": {}}}", json(n.value),
                       json(n.exact), json(n.error()));
}

std::string interpolant_json(const TracedInterpolant& i) {
    return fmt::format("{{\"name\": {}, \"components\": {}, {}}}", json_string(i.name),
                       json_string(i.components), json_members(i.numbers));
}

std::string unit_json(const TracedUnit& u) {
    return fmt::format("{{\"unit\": {}, \"text\": {}, \"problem\": {}, \"numbers\": {}}}", u.unit,
                       json_string(u.text), u.problem.empty() ? "null" : json_string(u.problem),
                       json_list(u.numbers, interpolant_json));
}

/// Members of an object, without braces.
std::string taps_json(const TracedTaps& t) {
    return fmt::format(
        "\"level\": {}, \"layer\": {}, \"texels\": [[{}, {}], [{}, {}], [{}, {}], [{}, {}]], "
        "\"taps\": {}, \"weights\": [{}, {}]",
        t.level, t.layer, t.x0, t.y0, t.x1, t.y0, t.x0, t.y1, t.x1, t.y1,
        json_list(t.taps, [](const auto& tap) { return json_list(tap); }), t.weight_x, t.weight_y);
}

std::string fetch_json(const TracedFetch& f) {
    const auto maybe = [](const std::optional<TracedNumber>& n) { return n ? json(*n) : "null"; };
    return fmt::format(
        "{{\"unit\": {}, \"width\": {}, \"height\": {}, \"filter\": \"{}\", \"u\": {}, \"v\": {}, "
        "\"r\": {}, \"level_of_detail\": {}, \"probes\": {}, \"apart\": {}, {}, \"further\": {}, "
        "\"codes\": {}, {}}}",
        f.unit, f.width, f.height, filter_name(f.sampler.filter), json(f.u), json(f.v), maybe(f.r),
        maybe(f.lod), json(f.probes),
        json_list(f.apart, [](const TracedNumber& n) { return json(n); }), taps_json(f),
        json_list(f.further,
                  [](const TracedTaps& t) { return fmt::format("{{{}}}", taps_json(t)); }),
        json_list(f.codes), json_members(f.color));
}

std::string register_json(const TracedRegister& r) {
    return fmt::format(
        "{{\"register\": \"{}\", \"codes\": {}, {}, \"filled\": {}, \"changed\": {}}}",
        register_name(r.reg), json_list(r.codes), json_members(r.color), json_list(r.filled),
        json_list(r.changed));
}

std::string stage_json(const TracedStage& s) {
    return fmt::format("{{\"name\": {}, \"text\": {}, \"registers\": {}}}", json_string(s.name),
                       json_string(s.text), json_list(s.registers, register_json));
}

std::string blend_json(const TracedBlend& b) {
    return fmt::format(
        "{{\"src\": \"{}\", \"dst\": \"{}\", \"equation\": \"{}\", \"source\": {}, "
        "\"source_factor\": {}, \"destination\": {}, \"destination_factor\": {}, \"result\": {}}}",
        blend_factor_name(b.blend.src), blend_factor_name(b.blend.dst),
        blend_equation_name(b.blend.equation), json_list(b.source), json_list(b.source_factor),
        json_list(b.destination), json_list(b.destination_factor), json_list(b.result));
}

/// Members of an object, without braces: a light's part in a fragment and what came of it.
std::string light_members(const TracedFragment& f, const std::array<int, 4>& codes,
                          const std::array<TracedNumber, 4>& color) {
    return fmt::format(
        "\"interpolants\": {}, \"units\": {}, \"fetches\": {}, \"stages\": {}, \"codes\": {}, {}",
        json_list(f.interpolants, interpolant_json), json_list(f.units, unit_json),
        json_list(f.fetches, fetch_json), json_list(f.stages, stage_json), json_list(codes),
        json_members(color));
}

std::string further_lights_json(const TracedFragment& f) {
    return json_list(f.further_lights, [](const TracedFragment& light) {
        return fmt::format("{{{}}}", light_members(light, light.light_codes, light.light_color));
    });
}

std::string corner_json(const TracedFragment& f) {
    const TracedCorner& corner = *f.corner;
    return fmt::format(
        "{{\"right\": {}, \"below\": {}, \"level\": {}, \"u\": {}, \"v\": {}, \"weights\": [{}, "
        "{}], \"level_weight\": {}, {}, \"light_codes\": {}, \"further_lights\": {}}}",
        json(corner.right), json(corner.below), corner.level, json(corner.u), json(corner.v),
        json(corner.weight_x), json(corner.weight_y),
        corner.level_weight ? json(*corner.level_weight) : "null",
        light_members(f, f.codes, f.color), json_list(f.light_codes), further_lights_json(f));
}

std::string fragment_json(const TracedFragment& f) {
    return fmt::format(
        "{{\"object\": {}, \"material\": {}, \"triangle\": {}, \"clipped\": {}, \"vertices\": {}, "
        "\"barycentrics\": {}, \"depth\": {}, \"one_over_w\": {}, {}, \"light_codes\": {}, "
        "\"further_lights\": {}, \"corners\": {}, \"blend\": {}}}",
        f.object, json_string(f.material), f.triangle, f.clipped, json_list(f.vertices),
        json_list(f.barycentrics), json(f.depth), json(f.one_over_w),
        light_members(f, f.codes, f.color), json_list(f.light_codes), further_lights_json(f),
        json_list(f.corners, corner_json), f.blend ? blend_json(*f.blend) : "null");
}

}  // namespace

std::string trace_json(const PixelTrace& trace, const Scene& scene) {
    return fmt::format(
        "{{\"pixel\": [{}, {}], \"size\": [{}, {}], \"machine\": {}, \"one\": {}, \"fragment\": "
        "{}, \"below\": {}, "
        "\"format\": \"{}\", \"stored\": {}}}",
        trace.x, trace.y, scene.width, scene.height, json_string(trace.machine.name), trace.one,
        trace.fragment ? fragment_json(*trace.fragment) : "null",
        json_list(trace.below, fragment_json), format_name(trace.format), json_list(trace.stored));
}

std::string samples_json(const TracedSamples& traced, const Scene& scene, const Scene& large) {
    return fmt::format(
        "{{\"pixel\": [{}, {}], \"size\": [{}, {}], \"samples\": {}, \"format\": \"{}\", "
        "\"stored\": {}}}",
        traced.x, traced.y, scene.width, scene.height,
        json_list(traced.samples, [&](const PixelTrace& t) { return trace_json(t, large); }),
        format_name(scene.format), json_list(traced.stored));
}

}  // namespace burnish::app
