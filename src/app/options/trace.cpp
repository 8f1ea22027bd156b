#include <burnish/error.hpp>
#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

Set pixel_to(std::optional<glm::ivec2>& target) {
    return [&target](const std::string& option, const std::string& text) {
        glm::ivec2 pixel{0, 0};
        if (!parse_pair(text, ',', pixel))
            refuse(option, text, "X,Y: column and row, from 0,0 in the upper left corner");
        target = pixel;
    };
}

OptionGroup pixel_options(TraceOptions& options) {
    return {"What",
            {{.names = "--pixel",
              .value = "X,Y",
              .text = "Column and row of the pixel; 0,0 is the upper left corner",
              .set = pixel_to(options.pixel)},
             samples_option(options.samples_side),
             json_option(options.json)}};
}

OptionGroup by_stage_options(TraceOptions& options) {
    return {"Errors by stage",
            {{.names = "--by-stage",
              .text = "Instead of registers: how much of the picture's error, or of the pixel's, "
                      "each stage makes",
              .set = flag_to(options.by_stage)},
             {.names = "--bits",
              .value = "BITS",
              .text = "With --by-stage: bits of all stages, N, or of some, "
                      "half_vector=8,combiners=9,stage0=exact,..",
              .normal = "the machine's",
              .needs = "--by-stage",
              .set = text_to(options.bits)},
             {.names = "--rounding",
              .value = "HOW",
              .text = "With --by-stage: nearest, truncate, shift8 or stochastic",
              .normal = "the machine's",
              .words = {"nearest", "truncate", "shift8", "stochastic"},
              .needs = "--by-stage",
              .set = text_to(options.rounding)},
             {.names = "-o,--output",
              .value = "FILE.svg",
              .text = "With --by-stage: a waterfall as SVG, by gnuplot",
              .files = "svg",
              .needs = "--by-stage",
              .set = text_to(options.output)}}};
}

}  // namespace

Verb trace_verb() {
    const auto options = std::make_shared<TraceOptions>();
    return {
        .name = "trace",
        .text = "Every register after every stage at one pixel, or the picture's error by stage",
        .groups = with_picture_options(options->picture,
                                       {pixel_options(*options), by_stage_options(*options)}),
        .examples =
            {{"How the middle pixel got its colour",
              "burnish trace meshes/brushed.toml --pixel 640,360"},
             {"Four samples of another pixel, on the chip of 2001, as JSON",
              "burnish trace meshes/knot.obj --machine nv2a --multipass --pixel 640,300 "
              "--samples 4 --json"},
             {"Which stages the picture's error comes from",
              "burnish trace meshes/knot.obj --machine nv2a --size 160x120 --by-stage"},
             {"The same of one pixel with ten bits everywhere",
              "burnish trace meshes/knot.obj --size 160x120 --pixel 80,42 --by-stage --bits 10"}},
        .command = [options] {
            if (!options->pixel && !options->by_stage)
                throw Error(ErrorCode::bad_option, "trace: expected --pixel X,Y or --by-stage");
            if (options->by_stage && options->samples_side > 1)
                throw Error(ErrorCode::bad_option,
                            "--samples with --by-stage, expected one: at the centre of the pixel");
            return *options;
        }};
}

}  // namespace burnish::app
