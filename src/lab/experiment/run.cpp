#include "lab/experiment/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/scene.hpp>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>

#include "core/nearest.hpp"
#include "core/parallel.hpp"
#include "lab/experiment/fingerprint.hpp"
#include "lab/experiment/frames.hpp"
#include "lab/experiment/pictures.hpp"

namespace burnish::lab {
namespace {

/// Cells with one reference.
using Group = std::vector<std::size_t>;

std::string key_of(const PictureSettings& picture) {
    std::string key = fmt::format("{} {}\n", picture.scene, picture.samples);
    for (const ExperimentSetting& setting : picture.settings)
        key += setting.key + "=" + setting.value + "\n";
    return key;
}

/// In the order of their first cells.
std::vector<Group> groups_of(const Results& results) {
    std::vector<Group> groups;
    std::map<std::string, std::size_t> known;
    for (std::size_t cell = 0; cell < results.cells.size(); ++cell) {
        const auto [at, is_new] =
            known.emplace(key_of(results.cells[cell].reference), groups.size());
        if (is_new) groups.emplace_back();
        groups[at->second].push_back(cell);
    }
    return groups;
}

/// The groups' cells that shard I of N has and that are not there yet: consecutive ones, so that
/// few references are drawn twice.
std::vector<Group> work_of(const Results& results, const RunOptions& options) {
    std::vector<Group> work;
    const std::size_t count = results.cells.size();
    const auto shards = static_cast<std::size_t>(options.shards);
    const std::size_t begin = count * static_cast<std::size_t>(options.shard - 1) / shards;
    const std::size_t end = count * static_cast<std::size_t>(options.shard) / shards;
    std::size_t place = 0;
    for (const Group& group : groups_of(results)) {
        Group part;
        for (const std::size_t cell : group) {
            if (place >= begin && place < end && !results.found[cell]) part.push_back(cell);
            ++place;
        }
        if (!part.empty()) work.push_back(std::move(part));
    }
    return work;
}

std::string inputs_fingerprint(const Experiment& experiment) {
    Fingerprint all;
    // The experiment's own file says which cells there are, not what is in them.
    for (std::size_t i = 1; i < experiment.inputs.size(); ++i)
        all.add(file_fingerprint(experiment.inputs[i]));
    return all.text();
}

/// A sheet's captions have RMSE and FLIP, whatever the experiment asks for.
std::vector<std::string> asked_metrics(const Experiment& experiment, bool with_pictures) {
    std::vector<std::string> names = experiment.metrics;
    for (const char* caption : {"rmse", "flip"})
        if (with_pictures && std::find(names.begin(), names.end(), caption) == names.end())
            names.emplace_back(caption);
    return names;
}

/// What the cells of a group have in common.
struct Reference {
    double light = 1.0;  ///< factor of all lights
    Framebuffer frame;
    std::vector<Framebuffer> series;  ///< of the pan; empty if nobody asks
};

class Runner {
  public:
    Runner(Results& results, const Store& store, const RunOptions& options,
           const ProgressSink& progress)
        : m_results(results), m_store(store), m_progress(progress), m_pool(options.threads) {}

    void run(const std::vector<Group>& work) {
        for (const Group& group : work) m_total += group.size();
        for (const Group& group : work) run_group(group);
    }

  private:
    const Experiment& experiment() const { return m_results.experiment; }

    Scene load(std::size_t cell, const PictureSettings& picture) const {
        try {
            return load_picture(experiment().scenes[picture.scene], picture);
        } catch (const Error& error) {
            // An option that a file sets is the file's mistake, not the command line's.
            const bool is_option = error.code() == ErrorCode::bad_option;
            throw Error(is_option ? ErrorCode::bad_input : error.code(),
                        fmt::format("{} (cell {} of {})", error.what(), m_results.cells[cell].name,
                                    experiment().name));
        }
    }

    /// How far the picture has moved at a frame of the pan.
    glm::dvec2 way(int frame) const {
        const ExperimentPan& pan = experiment().pan;
        const double part = static_cast<double>(frame) / series_length();
        return {part * pan.pixels[0], part * pan.pixels[1]};
    }
    int series_length() const {
        if (!need_series(experiment().metrics)) return 0;
        const ExperimentPan& pan = experiment().pan;
        return m_results.quick ? pan.quick_frames : pan.frames;
    }

    Reference draw_reference(std::size_t cell) {
        const PictureSettings& picture = m_results.cells[cell].reference;
        Scene scene = load(cell, picture);
        double light = 1.0;
        if (experiment().expose > 0.0F) {
            light = exposure(scene, static_cast<double>(experiment().expose), m_pool.size());
            scale_lights(scene, light);
        }
        Reference reference{
            light, Painter(picture, picture.samples, m_pool.size()).draw(scene), {}};
        Painter moving(picture, experiment().pan.samples, m_pool.size());
        for (int i = 0; i < series_length(); ++i)
            reference.series.push_back(moving.draw(moved(scene, way(i))));
        return reference;
    }

    void run_group(const Group& group) {
        const Reference reference = draw_reference(group.front());
        for_each_index(m_pool, group.size(), 1,
                       [&](std::size_t i, int) { run_cell(group[i], reference); });
    }

    void run_cell(std::size_t index, const Reference& reference) {
        const Cell& cell = m_results.cells[index];
        Scene scene = load(index, cell.test);
        scale_lights(scene, reference.light);
        CellResult result;
        try {
            result = draw_and_measure(index, scene, reference);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::bad_program && error.code() != ErrorCode::bad_option)
                throw;
            result = {};
            result.refusal = error.what();
        }
        m_store.keep(m_results.descriptions[index], result);
        const std::lock_guard lock(m_mutex);
        m_results.found[index] = std::move(result);
        if (m_progress) m_progress(++m_done, m_total);
    }

    Framebuffer time_picture(Painter& painter, const Scene& scene, CellResult& result) const {
        const int repeats = m_results.quick ? 1 : experiment().repeats;
        if (repeats > 1) painter.draw(scene);  // programs are compiled
        std::optional<Framebuffer> frame;
        std::vector<double> times;
        for (int i = 0; i < repeats; ++i) {
            const auto start = std::chrono::steady_clock::now();
            frame.emplace(painter.draw(scene));
            const std::chrono::duration<double, std::milli> time =
                std::chrono::steady_clock::now() - start;
            times.push_back(time.count());
        }
        std::sort(times.begin(), times.end());
        result.ms_low = times.front();
        result.ms = times[times.size() / 2];
        result.ms_high = times.back();
        return std::move(*frame);
    }

    CellResult draw_and_measure(std::size_t index, const Scene& scene,
                                const Reference& reference) const {
        const Cell& cell = m_results.cells[index];
        const std::optional<float> gain = m_results.pictures_of(index);
        WorkerPool one(1);
        CellResult result;
        Painter painter(cell.test, cell.test.samples, 1);
        const Framebuffer test = time_picture(painter, scene, result);
        Measurement measured =
            measure(test, reference.frame, asked_metrics(experiment(), gain.has_value()), one);
        result.values = std::move(measured.values);
        if (gain)
            save_pictures(test, reference.frame, measured.flip, *gain,
                          {m_store.images(), cell.name});
        SeriesMeasurement series(experiment().metrics);
        for (int i = 0; i < series_length(); ++i)
            series.add(painter.draw(moved(scene, way(i))),
                       reference.series[static_cast<std::size_t>(i)], one);
        for (Measured& each : series.values()) result.values.push_back(std::move(each));
        return result;
    }

    Results& m_results;
    const Store& m_store;
    const ProgressSink& m_progress;
    WorkerPool m_pool;
    std::mutex m_mutex;
    std::size_t m_done = 0, m_total = 0;
};

void check_metrics(Experiment& experiment) {
    const std::vector<std::string_view> known = measure_names();
    if (experiment.metrics.empty()) {
        for (const std::string_view name : known)
            if (experiment.pan.frames > 0 || !need_series({std::string(name)}))
                experiment.metrics.emplace_back(name);
    }
    const auto check = [&](const std::string& metric, const std::vector<std::string_view>& names,
                           const char* where) {
        if (std::find(names.begin(), names.end(), metric) != names.end()) return;
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: unknown metric '{}' in {}, {}", experiment.file.string(),
                                metric, where, expected_one_of(metric, names)));
    };
    for (const std::string& metric : experiment.metrics) check(metric, known, "'metrics'");
    if (need_series(experiment.metrics) && experiment.pan.frames == 0)
        throw Error(ErrorCode::bad_input,
                    fmt::format("{}: flicker without [pan]", experiment.file.string()));
    const std::vector<std::string_view> asked(experiment.metrics.begin(), experiment.metrics.end());
    for (const ExperimentPlot& plot : experiment.plots)
        if (!plot.y.empty()) check(plot.y, asked, "[[plots]]");
    for (const ExperimentExpectation& each : experiment.expectations)
        check(each.metric, asked, "[[expect]]");
}

}  // namespace

std::size_t Results::missing() const {
    return static_cast<std::size_t>(
        std::count_if(found.begin(), found.end(), [](const auto& each) { return !each; }));
}

std::optional<double> Results::value(std::size_t cell, const std::string& metric) const {
    if (!found[cell]) return std::nullopt;
    for (const Measured& each : found[cell]->values)
        if (each.name == metric && !std::isnan(each.value)) return each.value;
    return std::nullopt;
}

std::optional<float> Results::pictures_of(std::size_t cell) const {
    for (const ExperimentSheet& sheet : experiment.sheets)
        if (matches(experiment, cells[cell], sheet.where)) return sheet.gain;
    for (const ExperimentPlot& plot : experiment.plots)
        if (plot.shows_pictures() && matches(experiment, cells[cell], plot.where))
            return ExperimentSheet{}.gain;
    return std::nullopt;
}

Experiment open_experiment(const std::filesystem::path& file) {
    Experiment experiment = load_experiment(file);
    check_metrics(experiment);
    return experiment;
}

Results make_results(Experiment experiment, bool quick) {
    Results results{std::move(experiment), quick, {}, {}, {}};
    results.cells = make_cells(results.experiment, quick);
    results.found.resize(results.cells.size());
    const std::string inputs = inputs_fingerprint(results.experiment);
    for (std::size_t i = 0; i < results.cells.size(); ++i)
        results.descriptions.push_back(
            describe(results.experiment, results.cells[i], quick, inputs, results.pictures_of(i)));
    return results;
}

void find_results(Results& results, const Store& store) {
    for (std::size_t i = 0; i < results.cells.size(); ++i)
        if (!results.found[i]) results.found[i] = store.find(results.descriptions[i]);
}

void run_cells(Results& results, const Store& store, const RunOptions& options,
               const ProgressSink& progress) {
    Runner(results, store, options, progress).run(work_of(results, options));
}

}  // namespace burnish::lab
