#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "view/program_error.hpp"

namespace burnish::view {

/// Edited programs that a machine cannot run give way, each on its own: to the last one of the same
/// material that this machine has run, or to what was loaded.
class FittingPrograms {
  public:
    /// Looks for those of `edits` that `renderer` refuses and puts others in their place in
    /// `scene`. Returns what is wrong with them; nothing where they are not what is refused.
    std::vector<ProgramError> replace_misfits(Renderer& renderer,
                                              const std::vector<ProgramEdit>& edits,
                                              Scene& scene) const;
    /// `scene` was drawn. Forgets materials that `edits` has not.
    void drawn(const std::vector<ProgramEdit>& edits, const Scene& scene);

  private:
    /// What an object had: a pipeline of its own, or a program in place of its model's.
    struct Program {
        std::shared_ptr<const Material> pipeline;
        std::shared_ptr<const EditedProgram> edited;
    };
    using Key = std::pair<std::string, std::shared_ptr<const Material>>;  ///< machine, loaded

    std::map<Key, Program> m_last;
};

}  // namespace burnish::view
