#include "view/fitting_programs.hpp"

#include <algorithm>
#include <burnish/error.hpp>
#include <optional>
#include <string_view>

namespace burnish::view {
namespace {

/// What the machine says to one of the objects; nothing where it draws them all.
std::optional<ProgramError> refusal(Renderer& renderer, const ProgramEdit& edit,
                                    const Scene& scene) {
    const auto error = [&](const Error& from) {
        std::string message = from.what();
        const std::string name = fmt::format("material '{}': ", edit.loaded->name);
        if (message.starts_with(name)) message.erase(0, name.size());
        return ProgramError{edit.loaded->name, 0, 0, std::move(message)};
    };
    try {
        for (const std::size_t object : edit.objects) renderer.check(scene, object);
        return std::nullopt;
    } catch (const ProgramFault& fault) {
        ProgramError found = error(fault);
        found.line = line_of(fault.place(), edit.lines).value_or(0);
        return found;
    } catch (const Error& fault) {
        if (fault.code() == ErrorCode::stopped) throw;
        return error(fault);
    }
}

}  // namespace

std::vector<ProgramError> FittingPrograms::replace_misfits(Renderer& renderer,
                                                           const std::vector<ProgramEdit>& edits,
                                                           Scene& scene) const {
    std::vector<ProgramError> errors;
    if (scene.machine.double_precision) return errors;  // runs none
    for (const ProgramEdit& edit : edits) {
        std::optional<ProgramError> error = refusal(renderer, edit, scene);
        if (!error) continue;
        const auto put = [&](const Program& program) {
            for (const std::size_t object : edit.objects) {
                if (edit.loaded->program) scene.objects[object].material = program.pipeline;
                scene.objects[object].edited = program.edited;
            }
        };
        std::string_view instead = "the last text that runs is drawn";
        const auto last = m_last.find({scene.machine.name, edit.loaded});
        if (last != m_last.end()) put(last->second);
        if (last == m_last.end() || refusal(renderer, edit, scene)) {
            instead =
                edit.loaded->program ? "what was loaded is drawn" : "the model's own is drawn";
            put({edit.loaded, nullptr});
        }
        error->message += fmt::format("; {}", instead);
        errors.push_back(*std::move(error));
    }
    return errors;
}

void FittingPrograms::drawn(const std::vector<ProgramEdit>& edits, const Scene& scene) {
    std::erase_if(m_last, [&](const auto& last) {
        return std::none_of(edits.begin(), edits.end(), [&](const ProgramEdit& edit) {
            return edit.loaded == last.first.second;
        });
    });
    if (scene.machine.double_precision) return;
    for (const ProgramEdit& edit : edits) {
        const Object& object = scene.objects[edit.objects.front()];
        const bool is_edited =
            edit.loaded->program ? object.material != edit.loaded : object.edited != nullptr;
        if (is_edited) m_last[{scene.machine.name, edit.loaded}] = {object.material, object.edited};
    }
}

}  // namespace burnish::view
