#include "trace/interpolants.hpp"

namespace burnish {

namespace {

std::string name_of(const Varying& v) {
    switch (v.source) {
        case Varying::Source::color0:
            return "color0";
        case Varying::Source::color1:
            return "color1";
        case Varying::Source::uv:
            return "uv" + std::to_string(v.index / 4);
        case Varying::Source::half_tangent:
            return "half_tangent";
        case Varying::Source::light_tangent:
            return "light_tangent";
        case Varying::Source::view_tangent:
            return "view_tangent";
        case Varying::Source::half_sum:
            return "half_sum";
        case Varying::Source::n_dot_l:
            return "n_dot_l";
        case Varying::Source::h_dot_l:
            return "h_dot_l";
        case Varying::Source::lit:
            return "lit";
        case Varying::Source::normal:
            return "vertex_normal";
    }
    return "unknown";
}

char component_of(const Varying& v) {
    const auto letter = [&](const char* letters) { return letters[v.index % 4]; };
    switch (v.source) {
        case Varying::Source::color0:
        case Varying::Source::color1:
        case Varying::Source::lit:
            return letter("rgba");
        case Varying::Source::uv:
            return letter("strq");
        default:
            return letter("xyz ");
    }
}

}  // namespace

std::vector<InterpolantPlanes> interpolant_planes(const Shading& shading) {
    std::vector<InterpolantPlanes> list;
    const auto add = [&](const char* name, const char* components, int first) {
        if (first < 0) return;
        InterpolantPlanes entry{name, components, {}};
        for (std::size_t k = 0; k < entry.components.size(); ++k) {
            entry.planes.push_back(first + static_cast<int>(k));
        }
        list.push_back(std::move(entry));
    };
    if (shading.frame_attributes > 0) add("uv", "uv", 0);
    if (shading.frame_attributes > kUvAttributes) {
        add("tangent", "xyz", kUvAttributes);
        add("bitangent", "xyz", kUvAttributes + 3);
        add("normal", "xyz", kUvAttributes + 6);
        add("position", "xyz", kUvAttributes + 9);
    }
    int plane = shading.frame_attributes;
    for (const Varying& v : shading.varying_list) {
        const std::string name = name_of(v);
        if (list.empty() || list.back().name != name) list.push_back({name, "", {}});
        list.back().components += component_of(v);
        list.back().planes.push_back(plane++);
    }
    for (const InputOp& op : shading.inputs) {
        const auto* lighting = std::get_if<LightingCtx>(&op);
        if (lighting == nullptr) continue;
        add("half_tangent", "xyz", lighting->half_vector);
        add("light_tangent", "xyz", lighting->light_vector);
        add("view_tangent", "xyz", lighting->view_vector);
        add("n_dot_l", "x", lighting->n_dot_l);
        add("h_dot_l", "x", lighting->h_dot_l);
    }
    return list;
}

}  // namespace burnish
