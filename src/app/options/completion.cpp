#include "app/options/completion.hpp"

#include <memory>

#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb completion_verb() {
    const auto shell = std::make_shared<std::string>();
    return {.name = "completion",
            .text = "Prints a script with which a shell completes words of burnish",
            .groups = {{"Input",
                        {{.names = "SHELL",
                          .text = "bash or zsh",
                          .words = {"bash", "zsh"},
                          .required = true,
                          .set = text_to(*shell)}}}},
            .examples = {{"For bash, now", "source <(burnish completion bash)"},
                         {"For bash, in every shell to come",
                          "mkdir -p ~/.local/share/bash-completion/completions && burnish "
                          "completion bash > ~/.local/share/bash-completion/completions/burnish"},
                         {"For zsh, in a directory of $fpath",
                          "mkdir -p ~/.zfunc && burnish completion zsh > ~/.zfunc/_burnish"},
                         {"What is completed", "burnish completion bash | grep bake"}},
            .command = [shell] {
                const Verb root = burnish_command();
                return PrintText{*shell == "bash" ? bash_completion(root) : zsh_completion(root)};
            }};
}

}  // namespace burnish::app
