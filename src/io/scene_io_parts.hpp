#pragma once

#include <array>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/scene_io_section.hpp"

/// The parts of a scene file that refer to each other by name.
namespace burnish {

inline constexpr std::array<std::pair<std::string_view, Comparison>, 8> kComparisons{
    {{"never", Comparison::never},
     {"less", Comparison::less},
     {"equal", Comparison::equal},
     {"lequal", Comparison::lequal},
     {"greater", Comparison::greater},
     {"notequal", Comparison::notequal},
     {"gequal", Comparison::gequal},
     {"always", Comparison::always}}};

struct NamedTexture {
    TexturePtr texture;
    float map_scale = 0.0F;  ///< m of a generated tangent or bitangent map, else 0
    /// What alpha_x, alpha_y and exponent mean in the channels r, g, b of a generated alpha map.
    std::optional<std::array<CodedRange, 3>> ranges{};
    /// What it asks of the materials whose parameter it is; the texture itself has no levels then.
    std::optional<MipMethod> mipmaps{};
};
using TextureTable = std::map<std::string, NamedTexture, std::less<>>;

/// Reads every [[textures]] table; files are relative to `directory`.
TextureTable read_textures(const Section& root, const std::filesystem::path& directory);

/// A square set's seed and side, from `seed` and `size` or `width` and `height`.
struct SetKey {
    std::uint32_t seed;
    int size;
    auto operator<=>(const SetKey&) const = default;
};
SetKey read_set_key(const Section& section, int largest);

/// The texture that `key` names; nothing for a missing key, an error for an unknown name.
std::optional<NamedTexture> texture_of(const Section& section, std::string_view key,
                                       const TextureTable& textures);

struct NamedMaterial {
    std::shared_ptr<const Material> material;
    bool names_pipeline = false;  ///< says `model` or `units`; otherwise raw vertices get a program
};
using MaterialTable = std::map<std::string, NamedMaterial, std::less<>>;

/// Reads every [[materials]] table; files are relative to `directory`.
MaterialTable read_materials(const Section& root, const TextureTable& textures,
                             const std::filesystem::path& directory);

/// Reads the [material] table of a material file, whose name is that of the file if it has none.
Material read_one_material(const Section& root, const TextureTable& textures,
                           const std::filesystem::path& path);

/// Reads the keys of a reflectance model onto a material; those that are missing leave it as it is.
void read_reflectance(const Section& section, const TextureTable& textures, Material& material);

/// Reads `mipmaps`, `mipmap_bits` and `max_anisotropy`; without the former the maps of the section
/// decide.
void read_mipmaps(const Section& section, const TextureTable& textures, Material& material);

/// The pipeline of a material with `units` or `combiners`; nothing if it has neither.
std::optional<ProgramMaterial> read_program(const Section& section, const TextureTable& textures,
                                            const std::filesystem::path& directory);

/// The pipeline of materials that bring textures or vertex colours but no model: colour times the
/// texel of unit 0, if it has a texture; alpha from the colour.
ProgramMaterial vertex_color_program(std::vector<TexturePtr> units);

/// Throws Error{bad_input} unless `schema` is the one that this version reads.
void require_schema(const Section& root);

/// A camera's vectors, angle and depths.
Camera read_camera(const Section& section);
inline constexpr std::array<std::string_view, 6> kCameraVectors{
    "position", "focal_point", "view_up", "view_angle", "near", "far"};

/// Reads every [[objects]] table in order. Lines about meshes go to `notes`.
std::vector<Object> read_objects(const Section& root, const MaterialTable& materials,
                                 const std::filesystem::path& directory,
                                 std::vector<std::string>& notes);

/// Throws Error{bad_input} for a name that two tables have.
template <class Table>
void require_new_name(const Section& section, const Table& table, const std::string& name) {
    if (table.contains(name))
        section.fail("name", "second " + section.label() + " with the name '" + name + "'");
}

/// The keys of a table of names, for messages.
template <class Table>
std::vector<std::string_view> names_of(const Table& table) {
    std::vector<std::string_view> names;
    for (const auto& [name, entry] : table) names.push_back(name);
    return names;
}

}  // namespace burnish
