#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "core/nearest.hpp"
#include "io/read_mesh.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

const std::array<std::pair<std::string_view, std::optional<Blend>>, 5> kBlends{
    {{"off", std::nullopt},
     {"alpha", Blend::alpha()},
     {"premultiplied", Blend::premultiplied()},
     {"add", Blend::add()},
     {"multiply", Blend::multiply()}}};
constexpr std::array<std::pair<std::string_view, BlendFactor>, 12> kBlendFactors{
    {{"zero", BlendFactor::zero},
     {"one", BlendFactor::one},
     {"src_color", BlendFactor::src_color},
     {"one_minus_src_color", BlendFactor::one_minus_src_color},
     {"src_alpha", BlendFactor::src_alpha},
     {"one_minus_src_alpha", BlendFactor::one_minus_src_alpha},
     {"dst_color", BlendFactor::dst_color},
     {"one_minus_dst_color", BlendFactor::one_minus_dst_color},
     {"dst_alpha", BlendFactor::dst_alpha},
     {"one_minus_dst_alpha", BlendFactor::one_minus_dst_alpha},
     {"constant_color", BlendFactor::constant_color},
     {"one_minus_constant_color", BlendFactor::one_minus_constant_color}}};
constexpr std::array<std::pair<std::string_view, BlendEquation>, 5> kBlendEquations{
    {{"add", BlendEquation::add},
     {"subtract", BlendEquation::subtract},
     {"reverse_subtract", BlendEquation::reverse_subtract},
     {"min", BlendEquation::min},
     {"max", BlendEquation::max}}};
constexpr std::array<std::pair<std::string_view, Cull>, 3> kCulls{
    {{"none", Cull::none}, {"back", Cull::back}, {"front", Cull::front}}};
constexpr std::array<std::pair<std::string_view, Space>, 3> kSpaces{
    {{"object", Space::object}, {"clip", Space::clip}, {"window", Space::window}}};
constexpr std::array<std::pair<std::string_view, Topology>, 5> kTopologies{
    {{"triangles", Topology::triangles},
     {"triangle_strip", Topology::triangle_strip},
     {"triangle_fan", Topology::triangle_fan},
     {"quads", Topology::quads},
     {"quad_strip", Topology::quad_strip}}};

/// blend = "NAME" or { src, dst, equation, constant }.
std::optional<Blend> read_blend(const Section& section) {
    const toml::table* table = section.has_table("blend") ? section.table("blend") : nullptr;
    if (table == nullptr) {
        const std::optional<std::string> name = section.text("blend");
        if (!name) return std::nullopt;
        std::vector<std::string_view> known;
        for (const auto& [word, blend] : kBlends) {
            if (word == *name) return blend;
            known.push_back(word);
        }
        section.fail_unknown_word("blend", *name, known);
    }
    const Section factors(*table, "'blend'", {"src", "dst", "equation", "constant"});
    Blend blend;
    blend.src = factors.choice<BlendFactor>("src", kBlendFactors).value_or(blend.src);
    blend.dst = factors.choice<BlendFactor>("dst", kBlendFactors).value_or(blend.dst);
    blend.equation =
        factors.choice<BlendEquation>("equation", kBlendEquations).value_or(blend.equation);
    blend.constant = factors.vec4("constant", kUnit).value_or(blend.constant);
    return blend;
}

RasterState read_raster(const Section& section) {
    RasterState raster;
    raster.blend = read_blend(section);
    raster.depth_test =
        section.choice<DepthTest>("depth_test", kComparisons).value_or(raster.depth_test);
    raster.depth_write = section.boolean("depth_write").value_or(raster.depth_write);
    raster.cull = section.choice<Cull>("cull", kCulls).value_or(raster.cull);
    return raster;
}

glm::mat4 read_placement(const Section& section) {
    const glm::vec3 translate = section.vec3("translate").value_or(glm::vec3(0.0F));
    const glm::vec4 rotate = section.vec4("rotate").value_or(glm::vec4(0.0F, 1.0F, 0.0F, 0.0F));
    const float scale = section.number("scale", kPositive).value_or(1.0F);
    try {
        return placement(translate, glm::vec3(rotate), rotate.w, scale);
    } catch (const Error& error) {
        section.fail("rotate", fmt::format("'rotate' in {}: {}", section.label(), error.what()));
    }
}

glm::vec4 read_color(const Section& section, std::string_view key, std::string_view bytes_key) {
    glm::vec4 color{0.0F, 0.0F, 0.0F, 1.0F};
    if (section.has(key) && section.has(bytes_key))
        section.fail(bytes_key, fmt::format("both '{}' and '{}' in {}, expected one", key,
                                            bytes_key, section.label()));
    if (const auto bytes = section.numbers(bytes_key, 3, 4, {0.0, 255.0})) {
        for (std::size_t i = 0; i < bytes->size(); ++i)
            color[static_cast<int>(i)] = (*bytes)[i] / 255.0F;
    } else if (const auto values = section.numbers(key, 3, 4)) {
        for (std::size_t i = 0; i < values->size(); ++i) color[static_cast<int>(i)] = (*values)[i];
    }
    return color;
}

RawVertex read_vertex(const toml::table& table) {
    const Section section(table, "a vertex",
                          {"position", "color0", "color0_bytes", "color1", "color1_bytes", "uv0",
                           "uv1", "uv2", "uv3"});
    RawVertex vertex;
    const auto position = section.numbers("position", 3, 4);
    if (!position) section.fail("position", "a vertex has no 'position'");
    for (std::size_t i = 0; i < position->size(); ++i)
        vertex.position[static_cast<int>(i)] = (*position)[i];
    vertex.color0 = read_color(section, "color0", "color0_bytes");
    vertex.color1 = read_color(section, "color1", "color1_bytes");
    constexpr std::array<std::string_view, 4> kUvKeys{"uv0", "uv1", "uv2", "uv3"};
    for (std::size_t unit = 0; unit < kUvKeys.size(); ++unit) {
        const auto uv = section.numbers(kUvKeys[unit], 2, 4);
        if (!uv) continue;
        for (std::size_t i = 0; i < uv->size(); ++i)
            vertex.uv[unit][static_cast<int>(i)] = (*uv)[i];
    }
    return vertex;
}

RawVertices read_vertices(const Section& section) {
    RawVertices raw;
    raw.space = section.choice<Space>("space", kSpaces).value_or(raw.space);
    raw.topology = section.choice<Topology>("primitive", kTopologies).value_or(raw.topology);
    for (const toml::table* table : section.tables("vertices"))
        raw.vertices.push_back(read_vertex(*table));
    if (raw.space != Space::object) {
        for (const std::string_view key : {"translate", "rotate", "scale"})
            if (section.has(key))
                section.fail(key, fmt::format("'{}' in {} moves nothing in this space, expected "
                                              "space = \"object\"",
                                              key, section.label()));
    }
    return raw;
}

/// u runs from the middle, where it is 0, to both sides: two charts that mirror each other. The
/// vertices in the middle become two, with a tangent each; the surface stays as it is.
MeshData mirrored_charts(const MeshData& whole) {
    MeshData data;
    std::array<std::map<std::uint32_t, std::uint32_t>, 2> copies;
    for (std::size_t corner = 0; corner < whole.indices.size(); ++corner) {
        const std::size_t first = corner - corner % 3;
        float u = 0.0F;
        for (std::size_t k = 0; k < 3; ++k) u += whole.uvs[whole.indices[first + k]].x;
        const bool right = u > 1.5F;
        const std::uint32_t from = whole.indices[corner];
        const auto [at, is_new] =
            copies[right ? 1 : 0].emplace(from, static_cast<std::uint32_t>(data.positions.size()));
        data.indices.push_back(at->second);
        if (!is_new) continue;
        data.positions.push_back(whole.positions[from]);
        data.normals.push_back(whole.normals[from]);
        data.tangents.push_back(right ? whole.tangents[from] : -whole.tangents[from]);
        const glm::vec2 uv = whole.uvs[from];
        data.uvs.emplace_back(std::abs(2.0F * uv.x - 1.0F), uv.y);
    }
    return data;
}

/// A mesh made by formula instead of read.
Mesh make_shape(const Section& section) {
    constexpr int kMostColumns = 2048;
    const std::string name = section.required_text("shape");
    const int columns = section.integer("columns", 1, kMostColumns).value_or(64);
    const int rows = section.integer("rows", 1, kMostColumns).value_or(32);
    const std::vector<std::string_view> known = shapes::names();
    if (std::find(known.begin(), known.end(), name) == known.end())
        section.fail_unknown_word("shape", name, known);
    try {
        MeshData data = shapes::named(name, columns, rows);
        if (section.boolean("mirror_u").value_or(false)) data = mirrored_charts(data);
        if (const auto repeat = section.numbers("uv_repeat", 2, 2, kPositive)) {
            for (glm::vec2& uv : data.uvs) uv *= glm::vec2((*repeat)[0], (*repeat)[1]);
        }
        return Mesh(data);
    } catch (const Error& error) {
        section.fail("shape", fmt::format("'shape' in {}: {}", section.label(), error.what()));
    }
}

Mesh read_mesh(const Section& section, const std::filesystem::path& directory,
               std::vector<std::string>& notes) {
    const std::filesystem::path file = directory / section.required_text("mesh");
    try {
        LoadedMesh loaded = read_mesh_file(file);
        for (const std::string& note : loaded.report.notes())
            notes.push_back(file.string() + ": " + note);
        return std::move(loaded.mesh);
    } catch (const Error& error) {
        throw Error(error.code(), section.place("mesh") + ": " + error.what());
    }
}

/// Raw vertices have colours but no normals: without a pipeline of their own they show the colours.
std::shared_ptr<const Material> raw_material(const Section& section, const NamedMaterial& named) {
    if (named.names_pipeline && !named.material->program)
        section.fail("material",
                     fmt::format("{} draws raw vertices with the model of '{}', expected "
                                 "a material with 'units'",
                                 section.label(), named.material->name));
    if (named.names_pipeline) return named.material;
    Material material = *named.material;
    material.program = vertex_color_program({});
    return std::make_shared<const Material>(std::move(material));
}

NamedMaterial find_material(const Section& section, const MaterialTable& materials) {
    const std::optional<std::string> name = section.text("material");
    if (!name) return {std::make_shared<const Material>(), false};
    const auto found = materials.find(*name);
    if (found == materials.end())
        section.fail("material", fmt::format("'material' in {} names the unknown material '{}', {}",
                                             section.label(), *name,
                                             expected_one_of(*name, names_of(materials))));
    return found->second;
}

void require_one_geometry(const Section& section) {
    const int sources = static_cast<int>(section.has("mesh")) +
                        static_cast<int>(section.has("shape")) +
                        static_cast<int>(section.has("vertices"));
    if (sources != 1)
        section.fail("mesh",
                     fmt::format("{} has {} of 'mesh', 'shape' and 'vertices', expected one",
                                 section.label(), sources));
    for (const std::string_view key : {"space", "primitive"})
        section.refuse_without(key, "vertices");
    for (const std::string_view key : {"columns", "rows", "uv_repeat", "mirror_u"})
        section.refuse_without(key, "shape");
}

}  // namespace

std::vector<Object> read_objects(const Section& root, const MaterialTable& materials,
                                 const std::filesystem::path& directory,
                                 std::vector<std::string>& notes) {
    std::vector<Object> objects;
    for (const toml::table* table : root.tables("objects")) {
        const Section section(*table, "[[objects]]",
                              {"mesh", "shape", "columns", "rows", "uv_repeat", "mirror_u",
                               "material", "translate", "rotate", "scale", "space", "primitive",
                               "vertices", "depth_test", "depth_write", "cull", "blend"});
        require_one_geometry(section);
        Object object;
        object.raster = read_raster(section);
        object.world_from_object = read_placement(section);
        const NamedMaterial named = find_material(section, materials);
        if (section.has("vertices")) {
            object.geometry = read_vertices(section);
            object.material = raw_material(section, named);
        } else {
            object.geometry =
                section.has("shape") ? make_shape(section) : read_mesh(section, directory, notes);
            object.material = named.material;
        }
        objects.push_back(std::move(object));
    }
    return objects;
}

}  // namespace burnish
