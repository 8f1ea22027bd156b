#pragma once

#include <burnish/scene.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/camera.hpp"
#include "reference/surface_cache.hpp"
#include "reference/surface_sampler.hpp"
#include "reference/text_model.hpp"

/// The double-precision renderer: reflectance models evaluated as formulas at every sample, for
/// machines to be measured against. It shares scenes and the material layer with them, and no code
/// that shades.
namespace burnish::reference {

/// A mesh vertex; object space, uv as textures are sampled: v downward.
struct DoubleVertex {
    glm::dvec3 position, tangent, bitangent, normal;
    glm::dvec2 uv;
};

/// World space.
struct DoubleLight {
    glm::dvec3 position;  ///< or the direction towards the light, of any length
    double position_w;    ///< 1: position, 0: direction
    glm::dvec3 color;     ///< times intensity
};

struct DoubleObject {
    std::vector<DoubleVertex> vertices;
    std::vector<std::uint32_t> indices;  ///< three per triangle
    glm::dmat4 world_from_object;
    Model model;
    std::shared_ptr<const SurfaceSampler> surface;  ///< null for Model::text
    std::shared_ptr<const TextModel> text;          ///< of Model::text
    std::optional<TexelGrid> shaded_texels;  ///< FilterOrder::after, of a map that is filtered
                                             ///< within a level: where; nothing: at the sample
    DepthTest depth_test;
    bool depth_write;
    Cull cull;
};

/// What a machine snaps corners to.
struct CornerGrid {
    double steps = 256.0;    ///< a pixel
    bool downwards = false;  ///< else to the nearest
};

struct DoubleScene {
    View view;
    Viewer viewer = Viewer::local;
    TangentFrames tangent_frames = TangentFrames::mikktspace;
    TableFilter table_filter = TableFilter::point;
    double table_bias = 0.0;            ///< its steps count 2^table_bias times
    bool normalise_half_vector = true;  ///< else it is (l + v) / 2
    std::vector<DoubleLight> lights;
    glm::dvec3 ambient;
    glm::dvec4 background;
    std::vector<DoubleObject> objects;
    std::optional<CornerGrid> grid;  ///< nothing: corners are where they are
};

/// `scene` for a frame of that size, filtered in its machine's order. Materials are exact, or the
/// layer that `layer_machine` works from, texel for texel, with `machine_grid` at its coordinates
/// (not for texts). `surfaces` has exact materials of the scenes before. Throws Error{bad_program}
/// for an object that has no reflectance model or is not drawn by depth alone, Error{bad_option}
/// for a camera that sees nothing, and what material_layer throws.
DoubleScene double_scene(const Scene& scene, int width, int height,
                         const std::optional<Machine>& layer_machine = {},
                         bool machine_grid = false, SurfaceCache* surfaces = nullptr);

}  // namespace burnish::reference
