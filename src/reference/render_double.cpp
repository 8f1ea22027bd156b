#include "reference/render_double.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/within_memory.hpp"
#include "reference/footprint.hpp"
#include "reference/shade.hpp"
#include "reference/tangent_frame.hpp"

namespace burnish {
namespace reference {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Side of the squares of pixels that workers take. With 1024 samples a pixel it keeps what they
/// need at 9 MB.
constexpr int kTile = 16;
constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

/// An object's surface under the scene's lights, all in its own space.
class ObjectShader {
  public:
    ObjectShader(const DoubleScene& scene, const DoubleObject& object)
        : m_object(object),
          m_ambient(scene.ambient),
          m_tangent_frames(scene.tangent_frames),
          m_table_filter(scene.table_filter),
          m_steps_scale(std::exp2(scene.table_bias)),
          m_normalises_half_vector(scene.normalise_half_vector),
          m_eye_w(scene.viewer == Viewer::local ? 1.0 : 0.0),
          m_lights(scene.lights) {
        const double determinant = glm::determinant(object.world_from_object);
        if (determinant == 0.0 || !std::isfinite(determinant))
            throw Error(ErrorCode::bad_option, "object matrix has no inverse");
        const glm::dmat4 object_from_world = glm::inverse(object.world_from_object);
        m_eye = glm::dvec3(object_from_world *
                           glm::dvec4(m_eye_w == 1.0 ? scene.view.eye : scene.view.back, m_eye_w));
        for (DoubleLight& light : m_lights) {
            light.position =
                glm::dvec3(object_from_world * glm::dvec4(light.position, light.position_w));
        }
    }

    /// At a sample of triangle `number`.
    [[nodiscard]] glm::dvec3 color(std::uint32_t number, const SampleWeights& weights) const {
        SurfacePoint point{{}, weights.here};
        for (std::size_t i = 0; i < 3; ++i)
            point.corner[i] = &m_object.vertices[m_object.indices[std::size_t{3} * number + i]];
        const Place place(*this, point);
        const glm::dvec2 uv = point.mean(&DoubleVertex::uv);
        const auto step = [&](const glm::dvec3& change) {
            return SurfacePoint{point.corner, change}.mean(&DoubleVertex::uv);
        };
        const CoordinateSteps steps{step(weights.across), step(weights.down)};
        const Seen seen{point, weights, steps};
        if (!m_object.shaded_texels) return shaded(place, seen, uv);
        const LevelsSeen levels = m_object.shaded_texels->levels(steps);
        glm::dvec3 mean(0.0);
        for (int i = 0; i < levels.probes; ++i) {
            const glm::dvec2 at = uv + levels.apart * (i - 0.5 * (levels.probes - 1));
            mean += mean_of_texels(place, seen, at, levels.first, levels.linear) *
                    ((1.0 - levels.weight) / levels.probes);
            if (levels.weight > 0.0)
                mean += mean_of_texels(place, seen, at, levels.second, levels.linear) *
                        (levels.weight / levels.probes);
        }
        return mean;
    }

    [[nodiscard]] const DoubleObject& object() const { return m_object; }

  private:
    /// What directions are measured in at a point.
    struct Place {
        const ObjectShader& shader;
        TangentFrame frame;
        glm::dvec3 position, v;

        Place(const ObjectShader& of, const SurfacePoint& point)
            : shader(of),
              frame(tangent_frame(point, of.m_tangent_frames)),
              position(point.mean(&DoubleVertex::position)),
              v(normalised(of.m_eye - position * of.m_eye_w)) {}

        [[nodiscard]] Directions directions(const DoubleLight& light) const {
            const glm::dvec3 l = normalised(light.position - position * light.position_w);
            const glm::dvec3 h =
                shader.m_normalises_half_vector ? normalised(l + v) : (l + v) * 0.5;
            return {frame.components(l), frame.components(v), frame.components(h), glm::dot(h, l)};
        }
    };

    /// A sample: where it is, and what lies between it and the next ones.
    struct Seen {
        const SurfacePoint& point;
        const SampleWeights& weights;
        CoordinateSteps steps;
    };

    /// Of a level's texels around `uv`, each lit at `place`.
    [[nodiscard]] glm::dvec3 mean_of_texels(const Place& place, const Seen& seen,
                                            const glm::dvec2& uv, int level, bool linear) const {
        const TexelGrid& grid = *m_object.shaded_texels;
        const glm::ivec2& size = grid.sizes[static_cast<std::size_t>(level)];
        const Seen alone{seen.point, seen.weights, grid.steps_of(level)};
        glm::dvec3 mean(0.0);
        for (const WeightedPoint& texel :
             texel_centres(grid.coordinate(uv, level), size.x, size.y, linear))
            if (texel.weight > 0.0) mean += shaded(place, alone, texel.uv) * texel.weight;
        return mean;
    }

    /// Of what stands at `uv` in the maps, lit at `place`.
    [[nodiscard]] glm::dvec3 shaded(const Place& place, const Seen& seen,
                                    const glm::dvec2& uv) const {
        const TextModel* text = m_object.text.get();
        const TextSurface own = text != nullptr ? text->at(uv, seen.steps) : TextSurface{};
        const Surface surface = text == nullptr ? m_object.surface->at(uv, seen.steps) : Surface{};
        glm::dvec3 sum = m_ambient;
        for (const DoubleLight& light : m_lights) {
            const Directions to = place.directions(light);
            if (text != nullptr) {
                sum += light.color * text->reflected(own, to);
                continue;
            }
            const PowerFilter filter{m_table_filter, change_of_lobe(surface, to, seen, light)};
            sum += light.color * reflected(m_object.model, surface, to, filter);
        }
        return sum;
    }

    /// How much lobe_coordinate counts as changed to the next sample, to the right or below, of a
    /// surface that stays the same: what varies from texel to texel is the mip levels' business. 0
    /// where nobody asks.
    [[nodiscard]] double change_of_lobe(const Surface& surface, const Directions& here,
                                        const Seen& seen, const DoubleLight& light) const {
        if (m_table_filter == TableFilter::point) return 0.0;
        const double s = lobe_coordinate(surface, here);
        const auto change = [&](const glm::dvec3& step) {
            const SurfacePoint next{seen.point.corner, seen.point.weight + step};
            return std::abs(lobe_coordinate(surface, Place(*this, next).directions(light)) - s);
        };
        return m_steps_scale * std::max(change(seen.weights.across), change(seen.weights.down));
    }

    const DoubleObject& m_object;
    glm::dvec3 m_ambient;
    TangentFrames m_tangent_frames;
    TableFilter m_table_filter;
    double m_steps_scale;
    bool m_normalises_half_vector;
    double m_eye_w;      ///< 0: m_eye is a direction
    glm::dvec3 m_eye{};  ///< object space
    std::vector<DoubleLight> m_lights;
};

bool passes(DepthTest test, double depth, double stored) {
    switch (test) {
        case Comparison::never:
            return false;
        case Comparison::less:
            return depth < stored;
        case Comparison::equal:
            return depth == stored;
        case Comparison::lequal:
            return depth <= stored;
        case Comparison::greater:
            return depth > stored;
        case Comparison::notequal:
            return depth != stored;
        case Comparison::gequal:
            return depth >= stored;
        case Comparison::always:
            return true;
    }
    return false;
}

/// One sample of a tile.
struct Sample {
    glm::dvec2 position;
    double depth;
    std::uint32_t triangle;  ///< the last that passed, or kNothing
};

/// Everything that workers only read.
struct Frame {
    const DoubleScene& scene;
    FrameSize size;
    const SamplePattern& pattern;
    std::vector<ProjectedTriangle> triangles;
    std::vector<std::vector<std::uint32_t>> rows;  ///< of tiles: triangles, in order
    std::vector<ObjectShader> shaders;
};

void sort_into_rows(Frame& frame) {
    frame.rows.resize(static_cast<std::size_t>((frame.size.height + kTile - 1) / kTile));
    for (std::uint32_t i = 0; i < frame.triangles.size(); ++i) {
        const PixelBox& box = frame.triangles[i].box;
        for (int row = box.y0 / kTile; row <= box.y1 / kTile; ++row)
            frame.rows[static_cast<std::size_t>(row)].push_back(i);
    }
}

/// A square of pixels and their samples.
class Tile {
  public:
    Tile(const Frame& frame, int column, int row)
        : m_frame(frame),
          m_row(row),
          m_left(column * kTile),
          m_top(row * kTile),
          m_width(std::min(kTile, frame.size.width - m_left)),
          m_height(std::min(kTile, frame.size.height - m_top)) {}

    /// Which triangle each sample sees. `samples` is scratch memory.
    void find_visible(std::vector<Sample>& samples) const {
        const int count = m_frame.pattern.count();
        samples.clear();
        for (int y = 0; y < m_height; ++y) {
            for (int x = 0; x < m_width; ++x) {
                for (int s = 0; s < count; ++s)
                    samples.push_back(
                        {m_frame.pattern.position(m_left + x, m_top + y, s), 1.0, kNothing});
            }
        }
        for (const std::uint32_t i : m_frame.rows[static_cast<std::size_t>(m_row)])
            draw(i, samples);
    }

    /// Returns the number of samples that show something. A row of many samples takes milliseconds:
    /// the caller's wish is asked for before each.
    std::uint64_t shade(const std::vector<Sample>& samples, const PixelSink& sink,
                        TileWatch& watch) const {
        const auto count = static_cast<std::size_t>(m_frame.pattern.count());
        std::uint64_t shaded = 0;
        const Sample* sample = samples.data();
        for (int y = 0; y < m_height && watch.go_on(); ++y) {
            for (int x = 0; x < m_width; ++x) {
                glm::dvec4 sum(0.0);
                for (std::size_t s = 0; s < count; ++s, ++sample) {
                    sum += color(*sample);
                    if (sample->triangle != kNothing) ++shaded;
                }
                sink(m_left + x, m_top + y, sum / static_cast<double>(count));
            }
        }
        return shaded;
    }

  private:
    void draw(std::uint32_t index, std::vector<Sample>& samples) const {
        const ProjectedTriangle& triangle = m_frame.triangles[index];
        const DoubleObject& object = m_frame.scene.objects[triangle.object];
        const int count = m_frame.pattern.count();
        const int x0 = std::max(triangle.box.x0 - m_left, 0),
                  x1 = std::min(triangle.box.x1 - m_left, m_width - 1),
                  y0 = std::max(triangle.box.y0 - m_top, 0),
                  y1 = std::min(triangle.box.y1 - m_top, m_height - 1);
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                Sample* sample =
                    samples.data() + static_cast<std::ptrdiff_t>(y * m_width + x) * count;
                for (int s = 0; s < count; ++s, ++sample) {
                    const glm::dvec3 p(sample->position, 1.0);
                    if (!covers(triangle, p)) continue;
                    const double depth = glm::dot(triangle.depth, p);
                    if (!(depth >= 0.0 && depth <= 1.0)) continue;
                    if (!passes(object.depth_test, depth, sample->depth)) continue;
                    sample->triangle = index;
                    if (object.depth_write) sample->depth = depth;
                }
            }
        }
    }

    [[nodiscard]] glm::dvec4 color(const Sample& sample) const {
        if (sample.triangle == kNothing) return m_frame.scene.background;
        const ProjectedTriangle& triangle = m_frame.triangles[sample.triangle];
        const ObjectShader& shader = m_frame.shaders[triangle.object];
        return {shader.color(triangle.number,
                             weights_at(triangle, sample.position, 1.0 / m_frame.pattern.side())),
                1.0};
    }

    const Frame& m_frame;
    int m_row, m_left, m_top, m_width, m_height;
};

}  // namespace

FrameStats render(const DoubleScene& scene, FrameSize size, const SamplePattern& pattern,
                  WorkerPool& pool, const PixelSink& sink, const FrameHooks& hooks) {
    FrameStats stats;
    const Clock::time_point start = Clock::now();
    ProjectionCounts counts;
    Frame frame{scene, size, pattern, project(scene, size, counts), {}, {}};
    sort_into_rows(frame);
    for (const DoubleObject& object : scene.objects) frame.shaders.emplace_back(scene, object);
    stats.triangles = counts.submitted;
    stats.nonfinite_triangles = counts.nonfinite;
    stats.degenerate_triangles = counts.degenerate;
    stats.binned_triangles = frame.triangles.size();
    stats.geometry_ms = milliseconds_since(start);

    const Clock::time_point tiles = Clock::now();
    const int columns = (size.width + kTile - 1) / kTile;
    const auto workers = static_cast<std::size_t>(pool.size());
    std::vector<std::vector<Sample>> samples(workers);
    std::vector<std::uint64_t> shaded(workers, 0);
    stats.tiles_per_worker.resize(workers, 0);
    const std::size_t count = static_cast<std::size_t>(columns) * frame.rows.size();
    TileWatch watch(hooks, count);
    for_each_index(pool, count, 1, [&](std::size_t index, int worker) {
        const auto w = static_cast<std::size_t>(worker);
        const auto i = static_cast<int>(index);
        const Tile tile(frame, i % columns, i / columns);
        if (!watch.go_on()) return;
        tile.find_visible(samples[w]);
        shaded[w] += tile.shade(samples[w], sink, watch);
        ++stats.tiles_per_worker[w];
        watch.tile_done();
    });
    watch.require_wanted();
    for (const std::uint64_t samples_shaded : shaded) stats.shaded_pixels += samples_shaded;
    stats.tiles_ms = milliseconds_since(tiles);
    return stats;
}

}  // namespace reference

namespace {

template <class Code>
void store_codes(const glm::dvec4& color, double one, std::byte* to) {
    for (int c = 0; c < 4; ++c) {
        const double clamped = color[c] > 0.0 ? std::min(color[c], 1.0) : 0.0;  // NaN gives 0
        const auto code = static_cast<Code>(std::floor(clamped * one + 0.5));
        std::memcpy(to + static_cast<std::size_t>(c) * sizeof code, &code, sizeof code);
    }
}

void store_floats(const glm::dvec4& color, std::byte* to) {
    for (int c = 0; c < 4; ++c) {
        const float value = color[c] > 0.0 ? static_cast<float>(color[c]) : 0.0F;
        std::memcpy(to + static_cast<std::size_t>(c) * sizeof value, &value, sizeof value);
    }
}

void store(const glm::dvec4& color, PixelFormat format, std::byte* to) {
    switch (format) {
        case PixelFormat::rgba8:
            return store_codes<std::uint8_t>(color, 255.0, to);
        case PixelFormat::rgba16:
            return store_codes<std::uint16_t>(color, 65535.0, to);
        case PixelFormat::rgba32f:
            return store_floats(color, to);
        case PixelFormat::depth32f:  // refused by Renderer
            return;
    }
}

/// Root of a square up to kMaxDoubleSamples.
int side_of(int samples) {
    int side = 1;
    while (side * side < samples && side * side < kMaxDoubleSamples) ++side;
    if (samples == side * side) return side;
    throw Error(ErrorCode::bad_option, fmt::format("{} samples a pixel, expected a square, 1 .. {}",
                                                   samples, kMaxDoubleSamples));
}

}  // namespace

FrameStats render_double(const Scene& scene, Framebuffer& target, WorkerPool& pool,
                         const DoubleOptions& options) {
    const reference::SamplePattern pattern(side_of(options.samples), options.seed);
    const reference::FrameSize size{target.width(), target.height()};
    const auto shortage = [&] {
        return fmt::format("out of memory for a frame of {}x{} pixels with {} samples each",
                           size.width, size.height, options.samples);
    };
    return within_memory(shortage, [&] {
        return reference::render(
            reference::double_scene(scene, size.width, size.height, options.layer_machine,
                                    options.machine_grid, options.surfaces),
            size, pattern, pool,
            [&](int x, int y, const glm::dvec4& color) {
                store(color, target.format(),
                      target.row(y) + static_cast<std::size_t>(x) * pixel_size(target.format()));
            },
            options.hooks);
    });
}

}  // namespace burnish
