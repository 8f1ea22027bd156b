#pragma once

#include <string>
#include <vector>

#include "app/compile.hpp"
#include "models/compile_model.hpp"
#include "models/error_estimate.hpp"

/// What `burnish compile --model` has found out, as text for people and for programs.
namespace burnish::app {

struct ModelReport {
    std::string model;  ///< its name, or "model_text"
    Material material;
    std::string material_file;  ///< empty: the default material
    std::string machine;
    CompiledModel compiled;
    ErrorEstimate estimate;
    std::vector<ProfileVerdict> profiles;
};

/// The budget, inputs, units, tables, passes and machines as tables, then the program.
std::string model_report_text(const ModelReport& report);
/// One object, one line.
std::string model_report_json(const ModelReport& report);

/// Passes that the machine takes.
int pass_count(const CompiledModel& compiled);
/// Texture units that hold quantities of the material.
int map_count(const ModelNeeds& needs);
/// The registers that a pass leaves in its frame: "spare0.rgb".
std::vector<std::string> registers_left(const ProgramPass& pass);
/// What the units of a pass read: "tex1 = the frame of pass 2". Passes count from 1.
std::vector<std::string> units_read(const ProgramPass& pass);

}  // namespace burnish::app
