// measure_models DIRECTORY DOCUMENT: every model on every machine, to DIRECTORY/models.md and .json
// and into the section "models" of DOCUMENT. `./run models`.
#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

#include "core/parallel.hpp"
#include "lab/document_section.hpp"
#include "lab/measure_model.hpp"
#include "lab/model_tables.hpp"

namespace burnish::lab {
namespace {

struct Task {
    Model model;
    std::string_view machine;
    const ModelParameters* parameters;
};

/// Models to whose value the parameters say something new.
bool matters(Model model, const ModelParameters& p, const Material& first) {
    if (p.shift_variant) return true;
    if (p.material.alpha_x == first.alpha_x && p.material.alpha_y == first.alpha_y) return true;
    if (has_widths(model)) return has_exponent(model) || p.material.exponent == first.exponent;
    return p.material.alpha_y == p.material.alpha_x && p.material.exponent != first.exponent;
}

std::vector<ModelMeasurement> measure_all(const std::vector<ModelParameters>& parameters) {
    std::vector<Task> tasks;
    for (std::size_t model = 0; model < model_names().size(); ++model)
        for (const std::string_view machine : {"geforce256", "nv2a", "ideal"})
            for (const ModelParameters& p : parameters)
                if (matters(Model(model), p, parameters.front().material))
                    tasks.push_back({Model(model), machine, &p});
    std::vector<ModelMeasurement> measurements(tasks.size());
    WorkerPool pool(0);
    for_each_index(pool, tasks.size(), 1, [&](std::size_t i, int) {
        measurements[i] = measure_model(tasks[i].model, tasks[i].machine, *tasks[i].parameters);
    });
    return measurements;
}

}  // namespace
}  // namespace burnish::lab

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: measure_models DIRECTORY DOCUMENT\n");
        return 2;
    }
    try {
        using namespace burnish;
        const std::filesystem::path directory = argv[1];
        std::filesystem::create_directories(directory);
        const std::vector<lab::ModelParameters> parameters = lab::measured_parameters();
        const std::vector<lab::ModelMeasurement> measurements = lab::measure_all(parameters);
        const std::string tables = lab::model_tables(measurements, parameters);
        save_text(tables, directory / "models.md");
        save_text(lab::model_json(measurements), directory / "models.json");
        lab::replace_section(argv[2], "models", tables);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "measure_models: {}\n", error.what());
        return 3;
    }
}
