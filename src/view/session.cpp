#include "view/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <string_view>

namespace burnish::view {
namespace {

constexpr std::array<std::string_view, 5> kKnownEndings{".toml", ".obj", ".ply", ".off", ".stl"};

/// A drag over the window's height turns by so many degrees.
constexpr float kOrbitDegrees = 180.0F;

}  // namespace

void Session::show(Scene scene, const std::filesystem::path& input) {
    m_materials = {};
    m_loaded = std::move(scene);
    m_ball = ball_around(m_loaded);
    state.input = input;
    message.clear();
    shot_message.clear();
}

void Session::show_as_it_is(Scene scene, const std::filesystem::path& input) {
    const int width = state.width;
    const int height = state.height;
    state = state_of(scene, input);
    state.width = width;
    state.height = height;
    show(std::move(scene), input);
}

void Session::open(const std::filesystem::path& input) {
    show_as_it_is(m_load(input), input);
}

void Session::open(const ViewState& saved) {
    Scene scene = m_load(saved.input);
    state = saved;
    show(std::move(scene), saved.input);
}

void Session::take(Loaded loaded) {
    const std::filesystem::path& input = loaded.order.input;
    if (loaded.scene && loaded.order.purpose == LoadOrder::Purpose::again) {
        show(std::move(*loaded.scene), input);
    } else if (loaded.scene) {
        show_as_it_is(std::move(*loaded.scene), input);
    } else {
        message = loaded.error;
        if (loaded.order.purpose == LoadOrder::Purpose::step) state.input = input;
    }
}

void Session::move_to(const Camera& camera) {
    if (has_direction(camera)) state.camera = camera;
}

void Session::reset_camera() {
    state.camera = state_of(m_loaded, state.input).camera;
    state.light.reset();
}

void Session::look_from(Side side) {
    move_to(seen_from(side, state.camera, m_ball, aspect()));
}

void Session::orbit(float right, float down) {
    move_to(orbited(state.camera, kOrbitDegrees * right, kOrbitDegrees * down));
}

void Session::pan(float right, float down) {
    move_to(panned(state.camera, right, down));
}

void Session::zoom(float factor) {
    move_to(zoomed(state.camera, factor, m_ball));
}

void Session::turn_light(float right, float down) {
    glm::vec3 towards(0.0F, 0.0F, 1.0F);
    if (state.light) {
        towards = *state.light;
    } else if (!m_loaded.lights.empty()) {
        const Light& first = m_loaded.lights.front();
        towards = first.position_w == 0.0F ? first.position : first.position - m_ball.centre;
    }
    if (towards == glm::vec3(0.0F)) towards.z = 1.0F;
    const glm::vec3 turned = turned_light(glm::normalize(towards), state.camera,
                                          kOrbitDegrees * right, kOrbitDegrees * down);
    if (is_finite(turned)) state.light = turned;
}

std::optional<Wish> Session::wish(bool moving) {
    Wish wish;
    try {
        wish.scene = std::make_shared<const Scene>(edited_scene(m_loaded, state, m_materials));
    } catch (const Error& error) {
        wish_message = error.what();
        return std::nullopt;
    }
    wish_message.clear();
    wish.id = ++m_wishes;
    if (state.split) {
        const std::vector<Machine> machines = split_machines();
        const std::array<float, 5> edges{0.0F, state.lines[0], state.lines[1], state.lines[2],
                                         1.0F};
        for (std::size_t i = 0; i < machines.size(); ++i)
            wish.panes.push_back({machine_for(state, machines[i]), edges[i], edges[i + 1]});
    } else {
        wish.panes.push_back({wish.scene->machine, 0.0F, 1.0F});
    }
    wish.heat_map = state.heat_map;
    wish.gain = state.gain;
    wish.bits = state.bits;
    wish.pixel = state.pixel;
    if (wish.pixel && (wish.pixel->x >= state.width || wish.pixel->y >= state.height))
        wish.pixel.reset();
    wish.programs = shows_programs;
    wish.edits = m_materials.programs();
    wish.moving = moving;
    wish.renderer = renderer;
    return wish;
}

std::vector<std::string> Session::edit_messages() const {
    std::vector<std::string> lines = idle_edits(state, m_loaded);
    if (shows_programs) return lines;
    const std::string* last = nullptr;
    for (const ProgramError& error : program_errors()) {
        if (last == nullptr || *last != error.material) lines.push_back(of_material(error));
        last = &error.material;
    }
    return lines;
}

MaterialEdit& Session::edit_of(const std::string& material) {
    if (const MaterialEdit* edit = find_edit(material))
        return state.materials[static_cast<std::size_t>(edit - state.materials.data())];
    return state.materials.emplace_back(MaterialEdit{.name = material});
}

const MaterialEdit* Session::find_edit(const std::string& material) const {
    return view::find_edit(state, material);
}

void Session::revert_program(const std::string& material) {
    MaterialEdit& edit = edit_of(material);
    edit.combiners.reset();
    edit.compiled.reset();
    if (edit == MaterialEdit{.name = material}) forget_edit(material);
}

void Session::forget_edit(const std::string& material) {
    std::erase_if(state.materials, [&](const MaterialEdit& edit) { return edit.name == material; });
}

std::vector<std::shared_ptr<const Material>> Session::materials() const {
    std::vector<std::shared_ptr<const Material>> found;
    for (const Object& object : m_loaded.objects) {
        const std::shared_ptr<const Material> material = material_of(object);
        if (!material) continue;
        const bool seen = std::any_of(found.begin(), found.end(), [&](const auto& each) {
            return each->name == material->name;
        });
        if (!seen) found.push_back(material);
    }
    return found;
}

float Session::aspect() const {
    return static_cast<float>(state.width) / static_cast<float>(state.height);
}

std::vector<Machine> split_machines() {
    std::vector<Machine> machines;
    for (const std::string_view name : machine_profile_names()) {
        machines.push_back(machine_profile(name));
        machines.back().multipass = !machines.back().double_precision;
    }
    return machines;
}

std::optional<std::filesystem::path> neighbour(const std::filesystem::path& input, int direction) {
    const std::vector<std::filesystem::path> files = neighbours(input);
    const auto here = std::find(files.begin(), files.end(), input);
    if (files.size() < 2 || here == files.end()) return std::nullopt;
    const auto count = static_cast<std::ptrdiff_t>(files.size());
    return files[static_cast<std::size_t>((here - files.begin() + direction + count) % count)];
}

std::vector<std::filesystem::path> neighbours(const std::filesystem::path& input) {
    std::vector<std::filesystem::path> files;
    std::error_code failure;
    const std::filesystem::path directory =
        input.has_parent_path() ? input.parent_path() : std::filesystem::path(".");
    for (const auto& entry : std::filesystem::directory_iterator(directory, failure)) {
        const std::string ending = entry.path().extension().string();
        if (std::find(kKnownEndings.begin(), kKnownEndings.end(), ending) == kKnownEndings.end())
            continue;
        if (entry.is_regular_file(failure))
            files.push_back(input.has_parent_path() ? entry.path() : entry.path().filename());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace burnish::view
