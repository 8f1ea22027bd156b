#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/materials.hpp>
#include <memory>

#include "app/options/bake.hpp"
#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

OptionGroup source_options(BakeMipsOptions& options) {
    return {"Input",
            {{.names = "MATERIAL.toml",
              .text = "Material file",
              .files = "toml",
              .set = text_to(options.material)},
             {.names = "--set",
              .value = "NAME",
              .text = fmt::format("A generated set instead: {}",
                                  fmt::join(generated_set_names(), ", ")),
              .words = generated_set_names(),
              .excludes = "MATERIAL.toml",
              .set = text_to(options.set)}}};
}

OptionGroup level_options(BakeMipsOptions& options) {
    const std::vector<std::string_view> methods = filtering_mip_methods();
    return {"Levels",
            {{.names = "--method",
              .value = "METHOD",
              .text = fmt::format("{}", fmt::join(methods, ", ")),
              .normal = "moments",
              .words = methods,
              .set =
                  [&options](const std::string&, const std::string& word) {
                      options.mipmaps.method = *mip_method_named(word);
                  }},
             {.names = "--bits",
              .value = "N",
              .text = "Bits that moments are stored in: 8, 16 or 32",
              .normal = "double precision",
              .words = {"8", "16", "32"},
              .set = number_to(options.mipmaps.bits, 8, 32)}}};
}

}  // namespace

Verb bake_mips_verb() {
    const auto options = std::make_shared<BakeMipsOptions>();
    return {.name = "mips",
            .text = "A material's maps with mip levels of its parameters",
            .groups = {source_options(*options),
                       {"Generator", generator_options(options->seed, options->size,
                                                       kMaxGeneratedSize, "--set")},
                       level_options(*options),
                       {"Output", {directory_option(options->output)}}},
            .examples =
                {{"Levels that keep the moments of the lobes",
                  "burnish bake mips meshes/materials/weave.toml -o weave-mips"},
                 {"Toksvig's method on a generated set",
                  "burnish bake mips --set cross_hatch --size 128 --method toksvig -o toksvig"},
                 {"LEAN mapping with moments in 16 bits",
                  "burnish bake mips --set sunburst --size 128 --method lean --bits 16 -o lean"},
                 {"Plain averages, to compare with",
                  "burnish bake mips --set cross_hatch --size 128 --method box -o box"}},
            .command = [options] {
                if (options->material.empty() && options->set.empty())
                    throw Error(ErrorCode::bad_option,
                                "bake mips: expected MATERIAL.toml or --set NAME");
                return *options;
            }};
}

}  // namespace burnish::app
