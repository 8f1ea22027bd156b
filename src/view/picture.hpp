#pragma once

#include <burnish/renderer.hpp>
#include <burnish/trace.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/fitting_programs.hpp"
#include "view/material_program.hpp"
#include "view/pace.hpp"

/// From a scene to the picture of a window, in one or several panes.
namespace burnish::view {

/// A machine's part of the picture, in shares of the width.
struct Pane {
    Machine machine;
    float from = 0.0F, to = 1.0F;
};

/// What the window wants to see.
struct Wish {
    std::uint64_t id = 0;                ///< of the newest one: whatever is older is out of date
    std::shared_ptr<const Scene> scene;  ///< at the window's size
    std::vector<Pane> panes;             ///< from left to right
    bool heat_map = false;               ///< |pane - double| in the colours of metrics/heat_map.hpp
    float gain = 1.0F;                   ///< of the differences
    std::string bits;                    ///< of lab::set_stage_bits; empty: the machine's numbers
    std::optional<glm::ivec2> pixel;     ///< to be traced
    bool programs = false;               ///< those of models as text
    std::vector<ProgramEdit> edits;      ///< the scene's edited programs
    bool moving = false;                 ///< more wishes are to be expected
    RendererOptions renderer;
};

/// How far a picture has come.
enum class Fineness {
    within_budget,  ///< as large as the time for a frame allows, enlarged
    full,           ///< a sample in the centre of every pixel
    smooth,         ///< 4 samples
    smoothest,      ///< 16 samples
};

struct PaneReport {
    std::string machine;
    double ms = 0.0;
    double divisor = 1.0;  ///< of the sides
    int samples = 1;
    std::string error;                  ///< why there is nothing to see; empty: there is
    std::vector<ProgramError> misfits;  ///< edited programs that others stand for
};

struct Picture {
    Picture(int width, int height) : frame(width, height) {}

    std::uint64_t id = 0;  ///< of the wish
    Fineness fineness = Fineness::within_budget;
    bool is_last = false;  ///< of its wish: it gets no finer
    Framebuffer frame;     ///< rgba8, the scene's size
    std::vector<PaneReport> panes;
    FrameStats stats;  ///< of the first pane that was drawn
    double ms = 0.0;   ///< of everything
    /// Of the wish's pixel; PictureMaker makes it with fineness `full` alone, finer pictures have
    /// the same.
    std::shared_ptr<const PixelTrace> trace;
    std::string trace_error;
    std::vector<MaterialProgram> programs;  ///< if the wish asks for them
};

/// Of all its panes, each once.
std::vector<ProgramError> misfits_of(const Picture& picture);

/// Renders with `side` x `side` samples per pixel, a machine's samples averaged.
using DrawSamples =
    std::function<FrameStats(Renderer&, const Scene&, int side, Framebuffer& target)>;

/// Draws wishes, one call at a time.
class PictureMaker {
  public:
    /// `stop` as RendererOptions has it.
    PictureMaker(DrawSamples draw, double budget_ms, std::function<bool()> stop = {})
        : m_draw(std::move(draw)), m_pace(budget_ms), m_stop(std::move(stop)), m_programs(m_stop) {}

    /// What a scene or machine cannot do is told pane by pane. Throws Error{stopped} when `stop`
    /// says so.
    Picture make(const Wish& wish, Fineness fineness);

  private:
    /// rgba32f, for errors and chosen bits.
    Framebuffer draw_numbers(const Wish& wish, const Scene& scene, Picture& picture);
    /// In double precision, the same for all panes.
    const Framebuffer& truth_of(const Wish& wish, Scene scene);
    /// What a pane shows, rgba8, at the scene's size.
    Framebuffer draw_frame(const Wish& wish, const Scene& scene, int side, Picture& picture);
    /// Returns the scene with the programs that were drawn.
    Scene draw_pane(const Wish& wish, Fineness fineness, std::size_t index, Picture& picture);
    /// With the edited programs of `scene` that run, and others in place of those that do not.
    Framebuffer draw_with_edits(const Wish& wish, Scene& scene, int side, PaneReport& report,
                                Picture& picture);
    std::vector<MaterialProgram> programs_of(const Wish& wish, Fineness fineness);
    /// One for each machine of a split picture, which would forget what others compiled.
    Renderer& renderer_for(const Wish& wish, const Machine& machine);

    DrawSamples m_draw;
    Pace m_pace;
    std::function<bool()> m_stop;
    std::map<std::string, std::unique_ptr<Renderer>> m_renderers;  ///< "": of the whole picture
    RendererOptions m_options;
    MaterialPrograms m_programs;
    FittingPrograms m_fitting;
    std::optional<Framebuffer> m_truth;
    std::uint64_t m_truth_id = 0;  ///< of its wish
};

/// Whether the models of both are compiled from the same materials for the same machines.
bool are_compiled_alike(const Wish& a, const Wish& b);

/// What comes after `picture` while nothing moves. Pictures of several samples are for machines:
/// they would hide errors in a heat map, and double precision takes seconds for them.
std::optional<Fineness> finer(const Wish& wish, const Picture& picture);

}  // namespace burnish::view
