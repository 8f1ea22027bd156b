#pragma once

#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/aligned.hpp"
#include "core/parallel.hpp"
#include "geometry/camera.hpp"
#include "geometry/triangle.hpp"
#include "models/abp_modified.hpp"
#include "raster/setup.hpp"
#include "raster/tile.hpp"
#include "shade/output.hpp"
#include "shade/shading.hpp"
#include "shade/shown.hpp"

namespace burnish {

/// One object of the scene on its way to the tiles. Its memory is kept for the next frame.
struct Draw {
    AlignedVector<ScreenVertex> screen;
    AlignedVector<HomogeneousVertex> homogeneous;
    std::vector<std::uint32_t> own_indices;  ///< of raw vertices; a mesh brings its own
    std::span<const std::uint32_t> indices;
    Shading shading;
    Facing facing = Facing::any;
    DepthRule depth{};  ///< before shading
    FragmentOutput output;
    bool ordered = false;              ///< fragments must be shaded in the order of submission
    bool shaded = true;                ///< fragments run the program; else they leave depths alone
    std::optional<ShownValues> shown;  ///< instead of colours

    [[nodiscard]] std::size_t triangle_count() const { return indices.size() / 3; }
    [[nodiscard]] ScreenMesh mesh() const { return {screen, homogeneous, indices}; }
};

/// What the objects of a frame have in common.
struct FrameView {
    const Scene* scene;
    View view;
    Viewport viewport;
    std::optional<ShownRegister> shown = {};
    std::optional<Aov> aov = {};
    PixelFormat format = PixelFormat::rgba8;
    TexturePtr half_cube = {};  ///< of HalfVectorCube
};

/// What draws `object` in the light number `light`: its program, or its model as a program for the
/// scene's machine; the first light's has the ambient light. A scene without lights has one that is
/// dark. Throws Error{bad_program} or {bad_option} for what cannot be drawn.
ProgramMaterial program_of(const Object& object, const Scene& scene, std::size_t light,
                           DerivedMaps& maps);

/// Inputs, indices and raster state of `object` under `programs`, those of the lights from number
/// `first_light` on; no vertex is touched yet. Throws as program_of does.
void prepare_draw(Draw& draw, const FrameView& frame, const Object& object,
                  std::span<const ProgramMaterial> programs, std::size_t first_light,
                  const Wanted& wanted);

/// The same with the object's own programs and what the frame shows of it. The sum of all lights
/// is drawn; a program that no light enters runs once.
void prepare_draw(Draw& draw, const FrameView& frame, const Object& object, DerivedMaps& maps);

/// Depth test, alpha test and blending, as draw.shading, which is planned, calls for them.
void plan_fragments(Draw& draw, const FrameView& frame, const Object& object);

/// Vertices to the screen and, if fragments are shaded, what they hand to the interpolators.
void transform_draw(Draw& draw, const FrameView& frame, const Object& object,
                    const KernelTable& kernels, WorkerPool& pool);

}  // namespace burnish
