#include "bench/peers/peer_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <utility>

#include "bench/peers/peer_textures.hpp"

namespace burnish::peers {

namespace {

using Fill = std::function<void(PeerScene&)>;
struct Entry {
    std::string_view name;
    Fill fill;
};

/// An ellipsoid whose silhouette is 60 % of a frame of 16:9; its uv tile the maps 4 x 2, so that a
/// texel is about a pixel of 1920 x 1080.
MeshData ellipsoid(int columns, int rows) {
    MeshData data = shapes::sphere(columns, rows, {1.65F, 1.10F, 1.10F});
    for (glm::vec2& uv : data.uvs) uv *= glm::vec2(4.0F, 2.0F);
    return data;
}

/// The same with dents of up to half a percent; normals and silhouette stay what they were, nearly.
MeshData dented_ellipsoid(int columns, int rows) {
    MeshData data = ellipsoid(columns, rows);
    for (glm::vec3& p : data.positions)
        p *= 1.0F - 0.0025F * (1.0F + std::sin(37.0F * p.x) * std::sin(41.0F * p.y + 29.0F * p.z));
    return data;
}

MeshData knot(int segments, int sides) {
    constexpr float kSize = 0.68F;
    const shapes::KnotShape shape;
    return shapes::torus_knot(
        segments, sides,
        {shape.turns_around_axis, shape.turns_around_tube, kSize * shape.axis_radius,
         kSize * shape.torus_radius, kSize * shape.tube_radius});
}

void add_object(PeerScene& peer, const MeshData& data, Material material) {
    peer.scene.objects.push_back({Mesh(data),
                                  std::make_shared<Material>(std::move(material)),
                                  glm::mat4(1.0F),
                                  {.cull = Cull::back}});
}

/// Without diffuse light; as bright as it takes for machines, whose light stops at 1.
Material black_steel() {
    Material steel = brushed_steel();
    steel.kd = glm::vec3(0.0F);
    steel.ks = glm::vec3(1.0F);
    steel.specular_map = brightened(*steel.specular_map);
    return steel;
}

/// What two combiners and three texture units did: (1 - (h.t/ax)^2 - (h.b/ay)^2) ks n.l.
void add_modified(PeerScene& peer, const MeshData& data, bool mipmaps = false) {
    peer.shading = Shading::modified;
    peer.scene.machine = machine_profile("geforce256");
    peer.scene.machine.texture_units = 3;
    peer.has_double = !mipmaps;
    Material steel = black_steel();
    if (mipmaps) {
        for (TexturePtr Material::*map :
             {&Material::tangent_map, &Material::bitangent_map, &Material::specular_map})
            steel.*map = with_mipmaps(*(steel.*map));
    }
    peer.numbers.reach = 1.0F / steel.map_scale;
    peer.textures = {steel.tangent_map, steel.bitangent_map, steel.specular_map};
    add_object(peer, data, std::move(steel));
}

void add_modified_constant(PeerScene& peer, const MeshData& data) {
    add_modified(peer, data);
    peer.shading = Shading::modified_constant;
    Material steel = *peer.scene.objects.front().material;
    steel.specular_map = nullptr;
    steel.tangent_map = opaque(*steel.tangent_map);  // its alpha would be ks
    peer.textures = {steel.tangent_map, steel.bitangent_map};
    peer.scene.objects.front().material = std::make_shared<Material>(steel);
}

/// Models on `ideal` with maps of the normal, t / alpha_x, b / alpha_y, and ks with N.
void add_model(PeerScene& peer, const MeshData& data, Model model, Shading shading,
               float exponent) {
    peer.shading = shading;
    peer.scene.machine = machine_profile("ideal");
    peer.has_double = true;
    Material steel = black_steel();
    steel.model = model;
    steel.specular_map = with_alpha_waves(*steel.specular_map);
    steel.exponent_map = {steel.specular_map, 3, 0.5F * exponent, exponent};
    peer.numbers.reach = 1.0F / steel.map_scale;
    peer.numbers.exponent_low = steel.exponent_map.low;
    peer.numbers.exponent_high = steel.exponent_map.high;
    peer.textures = {steel.tangent_map, steel.bitangent_map, steel.normal_map, steel.specular_map};
    if (shading == Shading::table)
        peer.textures.push_back(power_table(steel.exponent_map.low, steel.exponent_map.high));
    if (shading == Shading::banks) {
        peer.textures = {tangent_bytes(steel), steel.normal_map, steel.specular_map};
    }
    if (shading == Shading::ward) {
        auto [texture, scale] = specular_bytes(steel);
        peer.textures.back() = std::move(texture);
        peer.numbers.specular_scale = scale;
    }
    add_object(peer, data, std::move(steel));
}

Material program_material(const CombinerProgram& program, std::vector<TexturePtr> units) {
    Material material;
    material.program.emplace();
    material.program->combiners = program;
    material.program->units = std::move(units);
    return material;
}

void add_textured(PeerScene& peer, const MeshData& data, bool mipmaps) {
    using namespace combine;
    peer.shading = Shading::textured;
    peer.scene.machine = machine_profile("geforce256");
    TexturePtr texture = black_steel().specular_map;
    if (mipmaps) texture = with_mipmaps(*texture);
    ProgramBuilder p;
    p.lerp(raw(Register::col0), raw(tex(0)), raw(Register::zero), raw(Register::zero));
    p.out_alpha(alpha(one()));
    Material material = program_material(p.build(), {texture});
    material.program->col0_rgb = ColorInput::lit;
    material.program->lit_tint = kLitTint;
    material.program->lit_base = kLitBase;
    peer.textures = {std::move(texture)};
    add_object(peer, data, std::move(material));
}

void add_flat(PeerScene& peer, const MeshData& data) {
    using namespace combine;
    peer.shading = Shading::flat;
    peer.scene.machine = machine_profile("geforce256");
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(Register::const0));
    p.out_alpha(alpha(one()));
    CombinerProgram program = p.build();
    program.const0 = glm::vec4(kFlatColor, 1.0F);
    add_object(peer, data, program_material(program, {}));
}

void add_depth(PeerScene& peer, const MeshData& data) {
    add_flat(peer, data);
    peer.shading = Shading::depth;
    peer.scene.format = PixelFormat::depth32f;
}

/// Eight layers over the whole frame, back to front.
void add_layers(PeerScene& peer, const std::optional<Blend>& blend, bool depth_buffer) {
    using namespace combine;
    peer.shading = Shading::layer;
    peer.depth_buffer = depth_buffer;
    peer.scene.machine = machine_profile("nv2a");
    peer.scene.camera.view = glm::mat4(1.0F);
    peer.scene.camera.projection = glm::mat4(1.0F);
    peer.textures = {stripes_with_alpha()};
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(tex(0)));
    p.out_alpha(alpha(raw(tex(0))));
    for (int layer = 0; layer < 8; ++layer) {
        MeshData data = shapes::plane(1, 1);
        const auto step = static_cast<float>(layer);
        for (glm::vec3& corner : data.positions)
            corner = {2.0F * corner.x, 2.0F * corner.y, 0.8F - 0.2F * step};
        for (glm::vec2& uv : data.uvs) uv = {4.0F * uv.x, 2.0F * uv.y + 0.1F * step};
        add_object(peer, data, program_material(p.build(), peer.textures));
        RasterState& raster = peer.scene.objects.back().raster;
        raster.cull = Cull::none;
        raster.blend = blend;
        if (!depth_buffer) {
            raster.depth_test = DepthTest::always;
            raster.depth_write = false;
        }
    }
}

const std::vector<Entry>& entries() {
    using S = PeerScene;
    constexpr auto s1 = [] { return ellipsoid(144, 72); };
    constexpr auto s4 = [] { return dented_ellipsoid(1000, 501); };
    constexpr auto s4_knot = [] { return knot(5000, 100); };
    static const std::vector<Entry> list{
        {"S1a", [=](S& s) { add_model(s, s1(), Model::abp, Shading::power, 16.0F); }},
        {"S1a_N2", [=](S& s) { add_model(s, s1(), Model::abp, Shading::power, 2.0F); }},
        {"S1a_N128", [=](S& s) { add_model(s, s1(), Model::abp, Shading::power, 128.0F); }},
        {"S1b", [=](S& s) { add_model(s, s1(), Model::abp, Shading::table, 16.0F); }},
        {"S1c", [=](S& s) { add_modified(s, s1()); }},
        {"S1c2", [=](S& s) { add_modified_constant(s, s1()); }},
        {"S1c_mip", [=](S& s) { add_modified(s, s1(), true); }},
        {"S2", [=](S& s) { add_model(s, s1(), Model::ward, Shading::ward, 16.0F); }},
        {"S3", [=](S& s) { add_model(s, s1(), Model::banks, Shading::banks, 16.0F); }},
        {"S4c", [=](S& s) { add_modified(s, s4()); }},
        {"S4c_knot", [=](S& s) { add_modified(s, s4_knot()); }},
        {"S4flat", [=](S& s) { add_flat(s, s4()); }},
        {"S4flat_knot", [=](S& s) { add_flat(s, s4_knot()); }},
        {"S4depth", [=](S& s) { add_depth(s, s4()); }},
        {"S4depth_knot", [=](S& s) { add_depth(s, s4_knot()); }},
        {"S5a", [](S& s) { add_model(s, knot(350, 100), Model::abp, Shading::power, 16.0F); }},
        {"S6", [=](S& s) { add_textured(s, s1(), false); }},
        {"S6_mip", [=](S& s) { add_textured(s, s1(), true); }},
        {"S6_flat", [=](S& s) { add_flat(s, s1()); }},
        {"S7", [=](S& s) { add_depth(s, s1()); }},
        {"S8_opaque", [](S& s) { add_layers(s, std::nullopt, true); }},
        {"S8_opaque_noz", [](S& s) { add_layers(s, std::nullopt, false); }},
        {"S8_blend", [](S& s) { add_layers(s, Blend::alpha(), true); }},
    };
    return list;
}

}  // namespace

std::vector<std::string_view> scene_names() {
    std::vector<std::string_view> names;
    for (const Entry& entry : entries()) names.push_back(entry.name);
    return names;
}

PeerScene peer_scene(std::string_view name, int width, int height, float intensity) {
    const auto found =
        std::ranges::find_if(entries(), [&](const Entry& entry) { return entry.name == name; });
    if (found == entries().end()) {
        throw Error(ErrorCode::bad_option, fmt::format("scene '{}', expected one of {}", name,
                                                       fmt::join(scene_names(), ", ")));
    }
    PeerScene peer;
    peer.name = name;
    peer.scene.width = width;
    peer.scene.height = height;
    peer.scene.background = glm::vec4(0.0F);
    // The same part of the frame at every resolution, whatever its sides.
    peer.scene.camera.projection =
        glm::perspective(glm::radians(45.0F), 16.0F / 9.0F, 0.1F, 100.0F);
    peer.scene.lights.push_back({.position = {0.3F, 0.3F, 0.9F}, .intensity = intensity});
    found->fill(peer);
    return peer;
}

}  // namespace burnish::peers
