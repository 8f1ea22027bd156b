#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <burnish/view_state.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "view/edited_scene.hpp"
#include "view/file_watch.hpp"
#include "view/orbit.hpp"
#include "view/picture.hpp"

namespace burnish::view {

using LoadScene = std::function<Scene(const std::filesystem::path&)>;

/// An input that is to be read while another one is shown.
struct LoadOrder {
    std::filesystem::path input;
    enum class Purpose {
        open,   ///< as it is
        again,  ///< camera, machine and edits stay
        step,   ///< as `open`; one that cannot be read is passed over by the next step
    } purpose = Purpose::open;
    bool operator==(const LoadOrder&) const = default;
};

/// What came of it.
struct Loaded {
    LoadOrder order;
    std::optional<Scene> scene;
    std::string error;  ///< one line, where there is no scene
    FileWatch files;    ///< of the input, from before it was read
};

/// What is looked at and how: all of the viewer but its window. What cannot be done leaves
/// everything as it was and says so in `message` or `wish_message`.
class Session {
  public:
    /// `load` reads a scene or mesh; throws Error.
    explicit Session(LoadScene load) : m_load(std::move(load)) {}

    /// Another input as it is, in the size that the window has. Throws what loading throws.
    void open(const std::filesystem::path& input);
    /// A saved state and its input. Throws likewise.
    void open(const ViewState& state);
    /// What LoadThread read, as it was ordered; a failure becomes `message`.
    void take(Loaded loaded);
    /// The camera and the light that the input has.
    void reset_camera();
    void look_from(Side side);

    void orbit(float right, float down);  ///< by shares of the window's height
    void pan(float right, float down);
    void zoom(float factor);
    void turn_light(float right, float down);

    /// What a picture of all this is made from. Nothing if it cannot be: `wish_message` says why,
    /// until one can be.
    [[nodiscard]] std::optional<Wish> wish(bool moving);

    /// The edit of the material with that name, made if need be.
    MaterialEdit& edit_of(const std::string& material);
    /// Null if nothing was changed of it.
    [[nodiscard]] const MaterialEdit* find_edit(const std::string& material) const;
    /// Forgets what was changed of it.
    void forget_edit(const std::string& material);
    /// Forgets what was changed of its program alone.
    void revert_program(const std::string& material);

    ViewState state;
    RendererOptions renderer;
    std::string message;          ///< what went wrong with the last file; empty: nothing
    std::string shot_message;     ///< and with the last screenshot of what is shown
    std::string wish_message;     ///< what went wrong with the last wish, likewise
    bool shows_programs = false;  ///< wishes ask for the programs of models
    /// A model's program that a hand is about to edit: its field keeps the text that it began with,
    /// whatever the model is compiled to since.
    struct ProgramInHand {
        std::string material, own;
    };
    std::optional<ProgramInHand> program_in_hand;
    /// What is wrong with what was changed of materials, as of the last wish, a line for each of
    /// them; of programs only while no panel shows it.
    [[nodiscard]] std::vector<std::string> edit_messages() const;
    /// Texts of the last wish that are no programs.
    [[nodiscard]] const std::vector<ProgramError>& program_errors() const {
        return m_materials.errors();
    }
    [[nodiscard]] const Scene& loaded() const { return m_loaded; }
    [[nodiscard]] const Ball& ball() const { return m_ball; }
    /// Materials of the scene, each name once, in the order of the objects. Meshes without one
    /// share the default.
    [[nodiscard]] std::vector<std::shared_ptr<const Material>> materials() const;
    [[nodiscard]] float aspect() const;

  private:
    /// Stays where it is where floats do not reach: one that is no number equals none.
    void move_to(const Camera& camera);
    void show(Scene scene, const std::filesystem::path& input);
    void show_as_it_is(Scene scene, const std::filesystem::path& input);

    LoadScene m_load;
    Scene m_loaded;
    Ball m_ball;
    EditedMaterials m_materials;
    std::uint64_t m_wishes = 0;
};

/// The machines of a split picture, from left to right.
std::vector<Machine> split_machines();

/// The next (1) or previous (-1) scene or mesh of the directory of `input`, around its end; nothing
/// where it is the only one.
std::optional<std::filesystem::path> neighbour(const std::filesystem::path& input, int direction);

/// Scenes and meshes in the directory of `input`, sorted by name, `input` among them.
std::vector<std::filesystem::path> neighbours(const std::filesystem::path& input);

}  // namespace burnish::view
