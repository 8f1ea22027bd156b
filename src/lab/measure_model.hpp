#pragma once

#include <burnish/scene.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/frame_errors.hpp"
#include "models/error_estimate.hpp"

/// Reflectance models on machines against the same formulas in double precision. What is measured
/// and how: docs/models.md, "What machines make of them".
namespace burnish::lab {

/// A material whose model is still open.
struct ModelParameters {
    std::string name;
    Material material;
    bool shift_variant = false;  ///< maps say them, texel by texel
};

/// The same everywhere: kd (0.1, 0.12, 0.2), ks (0.8, 0.7, 0.6). The name is "0.15, 0.5, N 16".
ModelParameters constant_parameters(float alpha_x, float alpha_y, float exponent);

/// The generated set of that name, 256 x 256 texels, seed 1.
ModelParameters shift_variant_parameters(std::string_view set);

/// What docs/models.md tabulates: constants first.
std::vector<ModelParameters> measured_parameters();

/// Whether widths and exponent enter the value of `model`.
bool has_widths(Model model);
bool has_exponent(Model model);

/// A sphere that fills most of a 256 x 256 frame, lit by one directional light of intensity 1 from
/// the upper right; no ambient light, a background of zeros. Several passes are allowed.
Scene measured_scene(const Material& material, std::string_view machine);

/// Sets the light's intensity to what makes the largest channel 0.9 in double precision, for a
/// machine in double precision or with the texels of `scene.machine`. Throws what the renderer
/// does.
void expose(Scene& scene);

/// What a model needs of a machine, and how far its picture is from that in double precision.
struct ModelMeasurement {
    Model model = Model::abp_modified;
    std::string machine;
    std::string parameters;
    std::string refusal;  ///< why the machine cannot; empty if it can, else nothing below counts
    int passes = 0;
    int units = 0;   ///< textures: those of the material layer and tables
    int stages = 0;  ///< general stages, before they are split into passes
    metrics::FrameErrors errors;
    /// Against the double picture with the machine's corners and texel coordinates; of parameters
    /// that vary, on wide machines.
    std::optional<metrics::FrameErrors> on_its_grid;
    ErrorEstimate estimate;  ///< without the picture
};

/// One cell of the table; on this thread alone.
ModelMeasurement measure_model(Model model, std::string_view machine,
                               const ModelParameters& parameters);

}  // namespace burnish::lab
