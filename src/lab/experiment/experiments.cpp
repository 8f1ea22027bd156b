#include "lab/experiment/experiments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <system_error>

#include "core/nearest.hpp"
#include "core/read_text.hpp"
#include "lab/experiment/embedded.hpp"
#include "lab/experiment/report.hpp"
#include "lab/experiment/store.hpp"
#include "lab/experiment/verdicts.hpp"

namespace burnish::lab {
namespace {

namespace fs = std::filesystem;

/// "e01.toml" -> "e1", "e07_edge.toml" -> "e7_edge"; nothing for what is no experiment.
std::string name_of(std::string_view path) {
    if (!path.ends_with(".toml") || path.find('/') != std::string_view::npos) return "";
    std::string name(path.substr(0, path.size() - 5));
    if (name.size() >= 3 && name[1] == '0') name.erase(1, 1);
    return name;
}

/// Which experiment a directory is of.
struct RunRecord {
    std::string experiment;  ///< a name, or the absolute path of a file
    bool quick = false;

    friend bool operator==(const RunRecord&, const RunRecord&) = default;
};

constexpr const char* kRecordFile = "run.txt";

void write_record(const RunRecord& record, const fs::path& directory) {
    save_text(fmt::format("{}\n{}\n", record.quick ? "quick" : "full", record.experiment),
              directory / kRecordFile);
}

RunRecord read_record(const fs::path& directory) {
    const fs::path file = directory / kRecordFile;
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored))
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: is not there, expected the directory of an experiment",
                                file.string()));
    const std::string text = read_text(file);
    for (const bool quick : {false, true}) {
        const std::string_view head = quick ? "quick\n" : "full\n";
        if (text.starts_with(head) && text.ends_with('\n') && text.size() > head.size() + 1)
            return {text.substr(head.size(), text.size() - head.size() - 1), quick};
    }
    throw Error(ErrorCode::bad_input,
                fmt::format("{}:1: expected quick or full, then an experiment", file.string()));
}

void write_text_once(std::string_view text, const fs::path& file) {
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    if (fs::is_regular_file(file, ignored) && read_text(file) == text) return;
    save_text(text, file);
}

/// The file of an experiment; that of one of the program's own is put into `directory`.
fs::path file_of(const std::string& experiment, const fs::path& directory) {
    fs::path found;
    for (const EmbeddedFile& file : embedded_files()) {
        if (name_of(file.path) == experiment || name_of(file.path).empty())
            write_text_once(file.text, directory / "inputs" / file.path);
        if (name_of(file.path) == experiment) found = directory / "inputs" / file.path;
    }
    return found.empty() ? fs::path(experiment) : found;
}

/// A name as it is, a file as its absolute path.
std::string identify(const std::string& name_or_file) {
    const std::vector<std::string> names = experiment_names();
    if (std::find(names.begin(), names.end(), name_or_file) != names.end()) return name_or_file;
    std::error_code ignored;
    const fs::path file = name_or_file;
    if (fs::exists(file, ignored) || file.extension() == ".toml")
        return fs::absolute(file, ignored).lexically_normal().string();
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw Error(ErrorCode::bad_option,
                fmt::format("unknown experiment '{}', {} or a file", name_or_file,
                            expected_one_of(name_or_file, known)));
}

ExperimentOutcome finish(const Results& results, const Store& store) {
    ExperimentOutcome outcome;
    outcome.problem = write_results(results, store);
    outcome.report = store.directory() / "report.html";
    outcome.cells = results.cells.size();
    outcome.missing = results.missing();
    std::vector<Judgement> judgements;
    for (const ExperimentExpectation& each : results.experiment.expectations)
        judgements.push_back(judge(results, each));
    outcome.verdict = verdict_name(overall(judgements));
    for (const auto& each : results.found)
        if (each && !each->refusal.empty()) ++outcome.refused;
    return outcome;
}

}  // namespace

std::vector<std::string> experiment_names() {
    std::vector<std::string> names;
    for (const EmbeddedFile& file : embedded_files())
        if (std::string name = name_of(file.path); !name.empty()) names.push_back(std::move(name));
    return names;
}

ExperimentOutcome run_experiment(const std::string& name_or_file, const fs::path& directory,
                                 const RunOptions& options, const ProgressSink& progress) {
    const RunRecord record{identify(name_or_file), options.quick};
    // Before anything is written: a file that is wrong leaves nothing behind.
    if (fs::path(record.experiment).is_absolute()) open_experiment(record.experiment);
    const Store store(directory);
    Results results =
        make_results(open_experiment(file_of(record.experiment, directory)), options.quick);
    write_record(record, directory);
    find_results(results, store);
    run_cells(results, store, options, progress);
    return finish(results, store);
}

ExperimentOutcome merge_experiments(const std::vector<fs::path>& shards,
                                    const fs::path& directory) {
    const RunRecord record = read_record(shards.front());
    for (const fs::path& shard : shards) {
        const RunRecord other = read_record(shard);
        if (other != record)
            throw Error(
                ErrorCode::bad_input,
                fmt::format("{}: of {}{}, expected {}{} as in {}", shard.string(), other.experiment,
                            other.quick ? ", quick" : "", record.experiment,
                            record.quick ? ", quick" : "", shards.front().string()));
    }
    Results results =
        make_results(open_experiment(file_of(record.experiment, shards.front())), record.quick);
    for (const fs::path& shard : shards) find_results(results, Store(shard));
    if (results.missing() > 0) {
        const auto first = std::find(results.found.begin(), results.found.end(), std::nullopt);
        const auto index = static_cast<std::size_t>(first - results.found.begin());
        throw Error(
            ErrorCode::bad_input,
            fmt::format("{} of {} cells of this build are missing, the first is {}",
                        results.missing(), results.cells.size(), results.cells[index].name));
    }
    const Store store(directory);
    for (const fs::path& shard : shards) store.take(Store(shard));
    file_of(record.experiment, directory);
    write_record(record, directory);
    return finish(results, store);
}

}  // namespace burnish::lab
