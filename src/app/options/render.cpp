#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

Set samples_to(int& side) {
    return [&side](const std::string& option, const std::string& text) {
        for (side = 1; side <= 32; ++side)
            if (text == fmt::format("{}", side * side)) return;
        refuse(option, text, "a square, 1 .. 1024");
    };
}

OptionGroup output_options(RenderOptions& options) {
    return {"Output",
            {{.names = "-o,--output",
              .value = "FILE",
              .text = "Image file, PNG, EXR or other by extension; - writes PNG to standard output",
              .normal = "INPUT's name with .png",
              .files = "png exr",
              .set = text_to(options.output)},
             {.names = "--samples",
              .value = "N",
              .text = "Samples per pixel: 1, 4, 9 or 16; with profile double any square up to 1024",
              .normal = "1",
              .set = samples_to(options.samples_side)},
             {.names = "--turntable",
              .value = "N",
              .text = "Pictures of one turn about the focal point; the output name holds {frame:4}",
              .set = number_to(options.turntable, 1, 9999)},
             {.names = "--stats",
              .value = "FORMAT",
              .text = "Print counts and times of the frame: text or json",
              .words = {"text", "json"},
              .set =
                  [&options](const std::string&, const std::string& word) {
                      options.stats = word == "json" ? StatsFormat::json : StatsFormat::text;
                  }},
             shown_option(options.shown)}};
}

}  // namespace

Verb render_verb() {
    const auto options = std::make_shared<RenderOptions>();
    return {.name = "render",
            .text = "A scene or mesh file to an image",
            .groups = with_picture_options(options->picture, {output_options(*options)}),
            .examples =
                {{"The demonstration picture as PNG",
                  "burnish render meshes/brushed.toml -o steel.png"},
                 {"A bare mesh seen from above, nine samples per pixel",
                  "burnish render meshes/knot.obj --camera-elevation 30 --samples 9 -o knot.png"},
                 {"Several materials as the chip of 2001 draws them, and what was counted",
                  "burnish render meshes/ward.toml --machine nv2a --multipass --stats text "
                  "-o ward.png"},
                 {"One turn about a cube in 12 pictures",
                  "burnish render meshes/cube.obj --size 320x240 --turntable 12 -o "
                  "'turn-{frame:4}.png'"}},
            .command = [options] { return *options; }};
}

}  // namespace burnish::app
