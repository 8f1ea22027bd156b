#include <fmt/format.h>

#include <burnish/error.hpp>
#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/threshold.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

/// "A-B" or "A"
Set frames_to(std::optional<FrameRange>& target) {
    return [&target](const std::string& option, const std::string& text) {
        glm::ivec2 range{0, 0};
        const bool one = text.find('-') == std::string::npos;
        if (!parse_pair(one ? text + '-' + text : text, '-', range) || range.x > range.y)
            refuse(option, text, "A-B: from frame A to frame B, as 0-11, or one frame");
        target = FrameRange{range.x, range.y};
    };
}

OptionGroup output_options(RenderOptions& options) {
    return {
        "Output",
        {{.names = "-o,--output",
          .value = "FILE",
          .text = "Image file, PNG, EXR or other by extension; - writes PNG to standard output",
          .normal = "INPUT's name with .png",
          .files = "png exr",
          .set = text_to(options.output)},
         samples_option(options.samples_side),
         {.names = "--turntable",
          .value = "N",
          .text = "Pictures of one turn about the focal point; the output name holds {frame:4}",
          .set = number_to(options.turntable, 1, 9999)},
         {.names = "--frames",
          .value = "A-B",
          .text = "Only these of the turn's pictures, from 0, or one, so that several computers "
                  "can share it",
          .normal = "all",
          .needs = "--turntable",
          .set = frames_to(options.frames)},
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

OptionGroup check_options(RenderOptions& options) {
    return {"Check",
            {{.names = "--reference",
              .value = "FILE",
              .text = "Image that the written file is compared with; exit code 1 if it differs; "
                      "with --turntable the name may hold {frame:4}",
              .files = "png exr",
              .set = text_to(options.reference)},
             reference_threshold_option(options.limits)}};
}

}  // namespace

Verb render_verb() {
    const auto options = std::make_shared<RenderOptions>();
    return {.name = "render",
            .text = "A scene or mesh file to an image",
            .groups = with_picture_options(options->picture,
                                           {output_options(*options), check_options(*options)}),
            .examples = {{"The demonstration picture as PNG",
                          "burnish render meshes/brushed.toml -o steel.png"},
                         {"A bare mesh seen from above, nine samples per pixel",
                          "burnish render meshes/knot.obj --camera-elevation 30 --samples 9 -o "
                          "knot.png"},
                         {"Six of the 12 pictures of a turn about a cube",
                          "burnish render meshes/cube.obj --size 320x240 --turntable 12 --frames "
                          "0-5 -o 'turn-{frame:4}.png'"},
                         {"A test: exit code 1 if the picture is not what it was",
                          "burnish render ball.toml --reference reference.png "
                          "--reference-threshold rmse=0.01"}},
            .command = [options] {
                const auto& frames = options->frames;
                if (frames && frames->last >= options->turntable)
                    throw Error(ErrorCode::bad_option,
                                fmt::format("--frames {}-{}, expected some of 0 .. {}",
                                            frames->first, frames->last, options->turntable - 1));
                if (!options->reference.empty() && options->output == "-")
                    throw Error(ErrorCode::bad_option,
                                "--reference with -o -, expected a file to be compared");
                return *options;
            }};
}

}  // namespace burnish::app
