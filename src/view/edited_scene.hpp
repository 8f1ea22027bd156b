#pragma once

#include <burnish/scene.hpp>
#include <burnish/view_state.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// From what was loaded and what was changed since to what is drawn.
namespace burnish::view {

/// A line of an edited program that is wrong.
struct ProgramError {
    std::string material;
    std::size_t line = 1, column = 1;
    std::string message;
};

/// Keeps materials that did not change, so that what the renderer prepared of them stays of use.
class EditedMaterials {
  public:
    /// Puts the state's materials and programs in place of the scene's. What is wrong with a
    /// program leaves the last right one in place and goes to `errors`.
    void apply(const ViewState& state, Scene& scene, std::vector<ProgramError>& errors);
    void forget() { m_kept.clear(); }

  private:
    /// What became of an edit.
    struct Kept {
        MaterialEdit edit;
        std::optional<MaterialMipmaps> mipmaps;
        std::shared_ptr<const Material> material;      ///< null: the loaded one
        std::optional<std::string> pipeline;           ///< the text that it was made of
        std::shared_ptr<const EditedProgram> program;  ///< of a model; null: its own
        std::vector<ProgramError> errors;
    };
    static void update(Kept& kept, const Material& loaded, const MaterialEdit& edit,
                       const std::optional<MaterialMipmaps>& mipmaps);

    std::map<const Material*, Kept> m_kept;  ///< by the loaded one
};

/// The object's material, a mesh's without one the default; null for other objects without one.
std::shared_ptr<const Material> material_of(const Object& object);

/// What is drawn: camera, light, materials and machine of the state in a copy of `loaded`, at the
/// state's size. Throws Error{bad_option} for a machine that cannot be.
Scene edited_scene(const Scene& loaded, const ViewState& state, EditedMaterials& materials,
                   std::vector<ProgramError>& errors);

/// Edits of `state` that change nothing, a line each: of a material that `loaded` has not, or of
/// the model of one that brings a program.
std::vector<std::string> idle_edits(const ViewState& state, const Scene& loaded);

/// The state's edit of the material with that name; null if nothing was changed of it.
const MaterialEdit* find_edit(const ViewState& state, const std::string& material);

/// The machine with the state's other wishes: passes where a program needs them.
Machine machine_for(const ViewState& state, const Machine& machine);

/// What the scene itself shows, as a state.
ViewState state_of(const Scene& scene, const std::filesystem::path& input);

}  // namespace burnish::view
