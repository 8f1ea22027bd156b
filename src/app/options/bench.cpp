#include <fmt/format.h>

#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Verb bench_verb() {
    const auto options = std::make_shared<BenchOptions>();
    OptionGroup measured{
        "What",
        {{.names = "--frames",
          .value = "N",
          .text = "Frames to time, after two that are not",
          .normal = fmt::format("{}", options->frames),
          .set = number_to(options->frames, 1, 1000000)},
         {.names = "--balance",
          .text = "Instead of the times: how evenly tiles would keep 1 .. 64 workers busy",
          .set = flag_to(options->balance)},
         samples_option(options->samples_side),
         json_option(options->json),
         shown_option(options->shown)}};
    return {.name = "bench",
            .text = "Times whole frames of a scene",
            .groups = with_picture_options(options->picture, {measured}),
            .examples = {{"Time of a frame: median and spread",
                          "burnish bench meshes/brushed.toml --size 640x360"},
                         {"Three frames on one thread, with the time of every stage",
                          "burnish bench meshes/brushed.toml --frames 3 --threads 1 -v"},
                         {"The same numbers for a script",
                          "burnish bench meshes/ward.toml --size 640x360 --frames 5 --json"},
                         {"Would 64 workers be busy?", "burnish bench meshes/knot.obj --balance"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
