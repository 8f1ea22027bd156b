#include <fmt/format.h>

#include <burnish/error.hpp>
#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

/// "I/N": the I-th of N parts.
Set shard_to(ExperimentOptions& options) {
    return [&options](const std::string& option, const std::string& text) {
        constexpr int kMostShards = 100000;
        glm::ivec2 part{0, 0};
        if (!parse_pair(text, '/', part) || part.x < 1 || part.x > part.y || part.y > kMostShards)
            refuse(option, text, fmt::format("I/N: part I of N, 1/1 to {0}/{0}", kMostShards));
        options.shard = part.x;
        options.shards = part.y;
    };
}

[[noreturn]] void fail(const std::string& message) {
    throw Error(ErrorCode::bad_option, message);
}

/// NAME|FILE or merge DIR...
Command what_to_run(ExperimentOptions options, const std::vector<std::string>& words) {
    if (words.front() == "merge") {
        options.merged.assign(words.begin() + 1, words.end());
        if (options.merged.empty()) fail("experiment merge: expected DIR...");
        if (options.shards > 1 || options.quick)
            fail(
                "experiment merge: the directories say which form it is, expected neither "
                "--shard nor --quick");
        return options;
    }
    options.experiment = words.front();
    if (words.size() > 1)
        fail(fmt::format("experiment {}: unexpected '{}'", options.experiment, words[1]));
    return options;
}

}  // namespace

Verb experiment_verb() {
    const auto options = std::make_shared<ExperimentOptions>();
    const auto words = std::make_shared<std::vector<std::string>>();
    return {
        .name = "experiment",
        .text = "Runs an experiment: cells, tables, plots and a report",
        .groups = {{"Input",
                    {{.names = "NAME",
                      .text = "e1 .. e12, e7_edge, or an experiment's file; merge DIR...: join the "
                              "shards in these directories",
                      .words = {"e1", "e2", "e3", "e4", "e5", "e6", "e7", "e7_edge", "e8", "e9",
                                "e10", "e11", "e12", "merge"},
                      .open_words = true,
                      .files = "toml",
                      .required = true,
                      .repeated = true,
                      .set = [words](const std::string&,
                                     const std::string& word) { words->push_back(word); }}}},
                   {"Output",
                    {{.names = "-o,--output",
                      .value = "DIR",
                      .text = "Directory, made if it is not there; what is finished in it is kept",
                      .files = "/",
                      .required = true,
                      .set = text_to(options->output)}}},
                   {"Work",
                    {{.names = "--quick",
                      .text = "Fewer values and samples",
                      .set = flag_to(options->quick)},
                     {.names = "--shard",
                      .value = "I/N",
                      .text = "Compute the I-th of N parts of the cells",
                      .set = shard_to(*options)},
                     threads_option(options->threads),
                     quiet_option(options->quiet)}}},
        .examples = {{"An experiment of one's own", "burnish experiment tiny.toml -o tiny"},
                     {"The first half of its cells, as on the first of two computers",
                      "burnish experiment tiny.toml --shard 1/2 -o half-1"},
                     {"The second half, and both joined",
                      "burnish experiment tiny.toml --shard 2/2 -o half-2 && burnish experiment "
                      "merge half-1 half-2 -o whole"},
                     {"A twelfth of a built-in experiment's quick form",
                      "burnish experiment e6 --quick --shard 1/12 -o e6-1"}},
        .command = [options, words] { return what_to_run(*options, *words); }};
}

}  // namespace burnish::app
