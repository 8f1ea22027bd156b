#pragma once

#include <burnish/scene.hpp>
#include <burnish/view_state.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "view/program_error.hpp"

/// From what was loaded and what was changed since to what is drawn.
namespace burnish::view {

/// Keeps materials that did not change, so that what the renderer prepared of them stays of use.
class EditedMaterials {
  public:
    /// Puts the state's materials and programs in place of the scene's. What is wrong with a
    /// program leaves the last right one in place.
    void apply(const ViewState& state, Scene& scene);
    /// Programs that the scene then had, and what is wrong with the texts of others.
    [[nodiscard]] const std::vector<ProgramEdit>& programs() const { return m_programs; }
    [[nodiscard]] const std::vector<ProgramError>& errors() const { return m_errors; }

  private:
    /// What became of an edit.
    struct Kept {
        MaterialEdit edit;
        std::optional<MaterialMipmaps> mipmaps;
        std::shared_ptr<const Material> material;      ///< null: the loaded one
        std::optional<std::string> pipeline;           ///< the text that it was made of
        std::shared_ptr<const EditedProgram> program;  ///< of a model; null: its own
        ProgramLines lines;                            ///< of the text that it has now
        std::vector<ProgramError> errors;
    };
    static void update(Kept& kept, const Material& loaded, const MaterialEdit& edit,
                       const std::optional<MaterialMipmaps>& mipmaps);

    void note(const std::shared_ptr<const Material>& loaded, std::size_t object, const Kept& kept);

    std::map<const Material*, Kept> m_kept;  ///< by the loaded one
    std::vector<ProgramEdit> m_programs;     ///< of the last call, as m_errors
    std::vector<ProgramError> m_errors;
};

/// The object's material, a mesh's without one the default; null for other objects without one.
std::shared_ptr<const Material> material_of(const Object& object);

/// What is drawn: camera, light, materials and machine of the state in a copy of `loaded`, at the
/// state's size. Throws Error{bad_option} for a machine that cannot be.
Scene edited_scene(const Scene& loaded, const ViewState& state, EditedMaterials& materials);

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
