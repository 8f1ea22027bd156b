#include "io/scene_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <utility>

#include "core/nearest.hpp"
#include "io/read_mesh.hpp"
#include "io/scene_io_parts.hpp"

namespace burnish {
namespace {

constexpr std::array<std::pair<std::string_view, PixelFormat>, 3> kFormats{
    {{"rgba8", PixelFormat::rgba8},
     {"rgba16", PixelFormat::rgba16},
     {"rgba32f", PixelFormat::rgba32f}}};
constexpr std::array<std::pair<std::string_view, NumberModel>, 2> kNumbers{
    {{"nine_bit", NumberModel::nine_bit}, {"wide", NumberModel::wide}}};
constexpr std::array<std::pair<std::string_view, Viewer>, 2> kViewers{
    {{"local", Viewer::local}, {"infinite", Viewer::infinite}}};
constexpr std::array<std::pair<std::string_view, TangentFrames>, 3> kTangentFrames{
    {{"mikktspace", TangentFrames::mikktspace},
     {"orthonormal", TangentFrames::orthonormal},
     {"derivative", TangentFrames::derivative}}};
constexpr std::array<std::pair<std::string_view, TableFilter>, 3> kTableFilters{
    {{"point", TableFilter::point}, {"mip", TableFilter::mip}, {"exact", TableFilter::exact}}};
constexpr std::array<std::pair<std::string_view, Quads>, 2> kQuads{
    {{"triangle", Quads::of_triangle}, {"pixels", Quads::of_pixels}}};
constexpr std::array<std::pair<std::string_view, ProductRounding>, 3> kProductRoundings{
    {{"nearest", ProductRounding::nearest},
     {"truncate", ProductRounding::truncate},
     {"shift8", ProductRounding::shift8}}};
constexpr std::array<std::pair<std::string_view, ExpandRule>, 2> kExpandRules{
    {{"hardware", ExpandRule::hardware}, {"ideal", ExpandRule::ideal}}};
constexpr std::array<std::pair<std::string_view, Halving>, 2> kHalvings{
    {{"half_up", Halving::half_up}, {"down", Halving::down}}};
constexpr std::array<std::pair<std::string_view, LerpRounding>, 2> kLerpRoundings{
    {{"once", LerpRounding::once}, {"each", LerpRounding::each}}};
constexpr std::array<std::pair<std::string_view, MagnitudeFactor>, 2> kMagnitudeFactors{
    {{"unclamped", MagnitudeFactor::unclamped}, {"clamped", MagnitudeFactor::clamped}}};
constexpr std::array<std::pair<std::string_view, FilterOrder>, 2> kFilterOrders{
    {{"before", FilterOrder::before}, {"after", FilterOrder::after}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kSnaps{
    {{"nearest", false}, {"floor", true}}};

void read_output(const toml::table& table, Scene& scene) {
    const Section section(table, "[output]", {"width", "height", "background", "format"});
    scene.width = section.integer("width", 1, Framebuffer::kMaxSize).value_or(scene.width);
    scene.height = section.integer("height", 1, Framebuffer::kMaxSize).value_or(scene.height);
    scene.background = section.vec4("background", kUnit).value_or(scene.background);
    scene.format = section.choice<PixelFormat>("format", kFormats).value_or(scene.format);
}

Machine read_profile(const Section& section) {
    const std::string name = section.text("profile").value_or("ideal");
    const std::vector<std::string_view> known = machine_profile_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
        section.fail_unknown_word("profile", name, known);
    return machine_profile(name);
}

/// How the vectors of light come about.
void read_vectors(const Section& section, Machine& machine) {
    if (const std::optional<std::string> word = section.text("half_vector")) {
        try {
            choose_half_vector(machine, *word);
        } catch (const Error& error) {
            section.fail("half_vector", std::string(error.what()) + ", in [machine]");
        }
    }
    machine.half_vector_bits =
        section.integer("half_vector_bits", 8, 16).value_or(machine.half_vector_bits);
    machine.normalise_half_vector =
        section.boolean("normalise_half_vector").value_or(machine.normalise_half_vector);
    machine.viewer = section.choice<Viewer>("viewer", kViewers).value_or(machine.viewer);
    machine.tangent_frames = section.choice<TangentFrames>("tangent_frames", kTangentFrames)
                                 .value_or(machine.tangent_frames);
}

void read_machine(const toml::table& table, Scene& scene) {
    const Section section(table, "[machine]",
                          {"profile",
                           "filter_order",
                           "texture_units",
                           "general_stages",
                           "stage_constants",
                           "numbers",
                           "product_rounding",
                           "expand",
                           "halving",
                           "lerp_rounding",
                           "magnitude_factor",
                           "multipass",
                           "subpixel_bits",
                           "snap",
                           "half_vector",
                           "half_vector_bits",
                           "normalise_half_vector",
                           "viewer",
                           "tangent_frames",
                           "table_filter",
                           "table_bias",
                           "quads"});
    Machine machine = read_profile(section);
    machine.filter_order =
        section.choice<FilterOrder>("filter_order", kFilterOrders).value_or(machine.filter_order);
    machine.texture_units = section.integer("texture_units", 1, 16).value_or(machine.texture_units);
    machine.general_stages =
        section.integer("general_stages", 0, 16).value_or(machine.general_stages);
    machine.stage_constants = section.boolean("stage_constants").value_or(machine.stage_constants);
    machine.numbers = section.choice<NumberModel>("numbers", kNumbers).value_or(machine.numbers);
    machine.product_rounding =
        section.choice<ProductRounding>("product_rounding", kProductRoundings)
            .value_or(machine.product_rounding);
    machine.expand = section.choice<ExpandRule>("expand", kExpandRules).value_or(machine.expand);
    machine.halving = section.choice<Halving>("halving", kHalvings).value_or(machine.halving);
    machine.lerp_rounding = section.choice<LerpRounding>("lerp_rounding", kLerpRoundings)
                                .value_or(machine.lerp_rounding);
    machine.magnitude_factor =
        section.choice<MagnitudeFactor>("magnitude_factor", kMagnitudeFactors)
            .value_or(machine.magnitude_factor);
    machine.multipass = section.boolean("multipass").value_or(machine.multipass);
    read_vectors(section, machine);
    machine.table_filter =
        section.choice<TableFilter>("table_filter", kTableFilters).value_or(machine.table_filter);
    machine.table_bias = section.number("table_bias", {-8.0, 8.0}).value_or(machine.table_bias);
    machine.quads = section.choice<Quads>("quads", kQuads).value_or(machine.quads);
    machine.subpixel_bits = section.integer("subpixel_bits", 4, 8).value_or(machine.subpixel_bits);
    machine.snap_floor = section.choice<bool>("snap", kSnaps).value_or(machine.snap_floor);
    try {
        machine.validate();
    } catch (const Error& error) {
        section.fail("profile", std::string(error.what()) + ", in [machine]");
    }
    scene.machine = std::move(machine);
}

void read_scene_camera(const toml::table& table, Scene& scene) {
    const Section section(
        table, "[camera]",
        {"position", "focal_point", "view_up", "view_angle", "near", "far", "view", "projection"});
    scene.camera = read_camera(section);
    scene.camera.view = section.mat4("view");
    scene.camera.projection = section.mat4("projection");
    if (!scene.camera.view && scene.camera.position == scene.camera.focal_point)
        section.fail("position", "'position' in [camera] is the focal point, expected two points");
}

Light read_light(const toml::table& table) {
    const Section section(table, "[[lights]]", {"direction", "position", "color", "intensity"});
    if (section.has("direction") == section.has("position"))
        section.fail("direction", "[[lights]] needs one of 'direction' and 'position'");
    Light light;
    light.position_w = section.has("position") ? 1.0F : 0.0F;
    light.position = section.vec3("direction").value_or(light.position);
    light.position = section.vec3("position").value_or(light.position);
    if (light.position_w == 0.0F && light.position == glm::vec3(0.0F))
        section.fail("direction", "'direction' in [[lights]] has no length");
    light.color = section.vec3("color", kNotNegative).value_or(light.color);
    light.intensity = section.number("intensity", kNotNegative).value_or(light.intensity);
    return light;
}

LoadedScene interpret(const toml::table& table, const std::filesystem::path& directory) {
    const Section root(table, "the scene",
                       {"schema", "output", "machine", "camera", "lights", "ambient", "textures",
                        "materials", "objects"});
    require_schema(root);
    LoadedScene loaded;
    Scene& scene = loaded.scene;
    if (const toml::table* output = root.table("output")) read_output(*output, scene);
    if (const toml::table* machine = root.table("machine")) read_machine(*machine, scene);
    if (const toml::table* camera = root.table("camera")) read_scene_camera(*camera, scene);
    for (const toml::table* light : root.tables("lights"))
        scene.lights.push_back(read_light(*light));
    scene.ambient = root.vec3("ambient", kNotNegative).value_or(scene.ambient);
    const TextureTable textures = read_textures(root, directory);
    const MaterialTable materials = read_materials(root, textures, directory);
    scene.objects = read_objects(root, materials, directory, loaded.notes);
    return loaded;
}

}  // namespace

Camera read_camera(const Section& section) {
    constexpr Range kAngle{.low = 0.0, .high = 179.9, .open_low = true};
    Camera camera;
    camera.position = section.vec3("position").value_or(camera.position);
    camera.focal_point = section.vec3("focal_point").value_or(camera.focal_point);
    camera.view_up = section.vec3("view_up").value_or(camera.view_up);
    camera.view_angle = section.number("view_angle", kAngle).value_or(camera.view_angle);
    camera.near = section.number("near", kPositive).value_or(camera.near);
    camera.far = section.number("far", kPositive).value_or(camera.far);
    if (!(camera.far > camera.near))
        section.fail("far", fmt::format("'far' = {} in [camera], expected more than near = {}",
                                        camera.far, camera.near));
    return camera;
}

void require_schema(const Section& root) {
    if (!root.has("schema")) root.fail("schema", "no 'schema' key, expected schema = 1");
    if (root.integer("schema", 0, std::numeric_limits<int>::max()) != 1)
        root.fail("schema",
                  fmt::format("'schema' = {}, expected 1, the one that this version reads",
                              root.integer("schema", 0, std::numeric_limits<int>::max()).value()));
}

LoadedScene read_scene_file(const std::filesystem::path& path,
                            const std::vector<std::string>& overrides) {
    const toml::table table = parse_scene(path, overrides);
    return interpret(table, path.parent_path());
}

Material read_material_file(const std::filesystem::path& path) {
    const toml::table table = parse_scene(path, {});
    const Section root(table, "the material file", {"schema", "textures", "material"});
    require_schema(root);
    const std::filesystem::path directory = path.parent_path();
    return read_one_material(root, read_textures(root, directory), path);
}

LoadedScene scene_for_mesh_file(const std::filesystem::path& path) {
    LoadedMesh mesh = read_mesh_file(path);
    if (mesh.mesh.triangle_count() == 0)
        throw Error(ErrorCode::bad_input, path.string() + ": no triangle to draw");
    LoadedScene loaded;
    for (const std::string& note : mesh.report.notes())
        loaded.notes.push_back(path.string() + ": " + note);
    Scene& scene = loaded.scene;
    const float aspect = static_cast<float>(scene.width) / static_cast<float>(scene.height);
    scene.camera = framing_camera(mesh.mesh.bounds(), aspect);
    // From above and to the left of the camera, where the half vectors sweep over the front.
    Light light;
    light.position = {-0.2F, 0.9F, 0.9F};
    scene.lights.push_back(light);
    scene.ambient = glm::vec3(0.06F);
    Object object;
    object.geometry = std::move(mesh.mesh);
    object.material = std::make_shared<const Material>(brushed_steel());
    scene.objects.push_back(std::move(object));
    return loaded;
}

}  // namespace burnish
