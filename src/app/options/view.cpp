#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb view_verb() {
    const auto options = std::make_shared<ViewOptions>();
    const OptionGroup states{
        "State",
        {{.names = "--load-state",
          .value = "FILE",
          .text = "A state that was saved, or a screenshot: its input, seen in the same way",
          .files = "toml png",
          .excludes = "INPUT",
          .set = text_to(options->load_state)},
         {.names = "--save-state",
          .value = "FILE",
          .text = "Written when the window closes",
          .files = "toml",
          .set = text_to(options->save_state)}}};
    std::vector<OptionGroup> groups = with_picture_options(options->picture, {states});
    groups.front().options.front().required = false;  // a state names it
    return {.name = "view",
            .text = "A scene or mesh file in a window",
            .groups = std::move(groups),
            .examples = {{"Brushed steel: drag to orbit, H lists the keys",
                          "burnish view meshes/brushed.toml"},
                         {"A bare mesh on the machine of 1999, in a small window",
                          "burnish view meshes/knot.obj --machine geforce256 --size 640x480"},
                         {"Go on where a window was closed",
                          "burnish view --load-state end.toml --save-state end.toml"},
                         {"Times of all frames on standard output when it closes",
                          "burnish view meshes/ward.toml --threads 2 -v"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
