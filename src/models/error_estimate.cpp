#include "models/error_estimate.hpp"

#include <algorithm>
#include <array>
#include <burnish/framebuffer.hpp>
#include <burnish/mesh.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "core/dmath.hpp"
#include "models/local_geometry.hpp"
#include "reference/layer_formula.hpp"

namespace burnish {

namespace {

constexpr int kSide = 64;
constexpr double kPeak = 0.9;
constexpr std::array kLightDegrees{40.0, 80.0, 120.0};
/// Peaks are those of parts of the maps under one direction of the tangent. What a picture's
/// highlight meets may be the darkest; the brightest one needs little light.
constexpr std::array kPeakQuantiles{0.0, 0.5, 0.95};
constexpr int kMapParts = 4;          // along u and v
constexpr double kLeastSeen = 0.125;  // n.v that pictures show enough of to have their peak there
constexpr int kDirections = 4;

/// Which of four directions the tangent has as it is seen: along x, between, along y, between.
int direction_of(const LocalGeometry& g) {
    constexpr double kTangent = 0.41421356237309505;  // of 22.5 degrees
    const double x = std::abs(g.t.x), y = std::abs(g.t.y);
    if (y < kTangent * x) return 0;
    if (x < kTangent * y) return 2;
    return g.t.x * g.t.y > 0.0 ? 1 : 3;
}

int map_part_of(const LocalGeometry& g) {
    return static_cast<int>(g.uv.x * kMapParts) + kMapParts * static_cast<int>(g.uv.y * kMapParts);
}

double largest_of(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

/// Places under one light, and what the formula says they look like with intensity 1.
struct LitPlaces {
    glm::dvec3 light;
    std::vector<LocalGeometry> places;
    std::vector<glm::dvec3> values;
};

LitPlaces light_places(const TexelSource& source, reference::LayerFormula& formula,
                       double degrees) {
    const double angle = degrees * (dmath::kPi / 180.0);
    LitPlaces lit;
    lit.light = {dmath::sin(angle), 0.0, dmath::cos(angle)};
    const glm::dvec3 view(0.0, 0.0, 1.0), sum = lit.light + view;
    const glm::dvec3 half = sum / std::sqrt(glm::dot(sum, sum));
    for (const LocalGeometry& g : local_geometries(source, lit.light, std::size_t{kSide} * kSide)) {
        const auto local = [&](const glm::dvec3& v) {
            return glm::dvec3(glm::dot(g.t, v), glm::dot(g.b, v), glm::dot(g.n, v));
        };
        const glm::dvec3 value = formula.at(
            g.uv, {local(lit.light), local(view), local(half), glm::dot(half, lit.light)});
        if (!std::isfinite(glm::dot(value, glm::dvec3(1.0)))) continue;  // a text's 0 / 0
        lit.places.push_back(g);
        lit.values.push_back(value);
    }
    return lit;
}

/// In ascending order.
std::vector<double> peaks_of(const std::vector<LitPlaces>& all) {
    std::vector<double> peaks;
    for (const LitPlaces& lit : all) {
        std::array<double, kMapParts * kMapParts * kDirections> parts{};
        for (std::size_t i = 0; i < lit.places.size(); ++i) {
            const LocalGeometry& g = lit.places[i];
            if (g.n.z < kLeastSeen) continue;
            double& peak =
                parts[static_cast<std::size_t>(map_part_of(g) * kDirections + direction_of(g))];
            peak = std::max(peak, largest_of(lit.values[i]));
        }
        peaks.insert(peaks.end(), parts.begin(), parts.end());
    }
    std::sort(peaks.begin(), peaks.end());
    return peaks;
}

/// How far texture coordinates move with a vertex that is snapped, if a texel is as large as a
/// pixel where it is seen from the front.
glm::dvec2 snapping(const LocalGeometry& g, const Machine& machine, const TexelSource& source) {
    const double step = std::ldexp(1.0, -machine.subpixel_bits);
    const glm::dvec2 pixels = (g.jitter - (machine.snap_floor ? 0.0 : 0.5)) * step;
    const glm::dvec3 moved(pixels, -(pixels.x * g.n.x + pixels.y * g.n.y) / g.n.z);
    return glm::dvec2(glm::dot(moved, g.t), -glm::dot(moved, g.b)) /
           glm::dvec2(source.width(), source.height());
}

/// A triangle around the centre of a pixel for each of the places, row by row, in clip space.
Mesh mesh_of(const std::vector<LocalGeometry>& places, const Machine& machine,
             const TexelSource& source) {
    constexpr std::array<glm::dvec2, 3> kCorners{glm::dvec2(0.1, 0.1), glm::dvec2(0.5, 0.9),
                                                 glm::dvec2(0.9, 0.1)};
    MeshData data;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const LocalGeometry& g = places[i];
        const glm::dvec2 pixel(i % kSide, i / kSide);
        const glm::dvec2 uv = g.uv + snapping(g, machine, source);
        for (const glm::dvec2& corner : kCorners) {
            const glm::dvec2 at = (pixel + corner) * (2.0 / kSide) - 1.0;
            data.positions.emplace_back(at.x, -at.y, 0.0);
            data.normals.emplace_back(g.n);
            data.tangents.emplace_back(glm::vec3(g.t), 1.0F);
            data.uvs.emplace_back(uv.x, 1.0 - uv.y);
            data.indices.push_back(static_cast<std::uint32_t>(data.indices.size()));
        }
    }
    return Mesh(data);
}

Scene scene_of(const LitPlaces& lit, const std::shared_ptr<const Material>& material,
               const Machine& machine, const TexelSource& source) {
    Scene scene;
    scene.machine = machine;
    scene.machine.viewer = Viewer::infinite;
    scene.camera.view = glm::mat4(1.0F);
    scene.camera.projection = glm::mat4(1.0F);
    scene.lights.push_back({.position = glm::vec3(lit.light)});
    scene.objects.push_back({mesh_of(lit.places, machine, source), material, glm::mat4(1.0F), {}});
    return scene;
}

/// A place in a picture.
struct ComparedPlace {
    double value;  ///< the formula's, in its largest channel
    double weight;
    glm::dvec3 difference;
};

/// Places in one direction of the tangent, all weights together 1.
std::vector<ComparedPlace> compare(const Framebuffer& frame, const LitPlaces& lit, double intensity,
                                   int direction) {
    std::vector<ComparedPlace> compared;
    double sum = 0.0;
    for (std::size_t i = 0; i < lit.places.size(); ++i) {
        if (direction_of(lit.places[i]) != direction) continue;
        glm::vec4 pixel;
        std::memcpy(&pixel, frame.row(static_cast<int>(i / kSide)) + i % kSide * sizeof pixel,
                    sizeof pixel);
        const glm::dvec3 want = glm::clamp(lit.values[i] * intensity, 0.0, 1.0);
        compared.push_back({largest_of(lit.values[i]), lit.places[i].weight,
                            glm::abs(glm::dvec3(glm::vec3(pixel)) - want)});
        sum += lit.places[i].weight;
    }
    for (ComparedPlace& c : compared) c.weight /= sum;
    return compared;
}

/// A share s of the picture, of its brightest places, becomes sqrt(s).
void bend_one_way(std::vector<ComparedPlace>& compared) {
    std::stable_sort(
        compared.begin(), compared.end(),
        [](const ComparedPlace& a, const ComparedPlace& b) { return a.value > b.value; });
    double share = 0.0;
    for (ComparedPlace& c : compared) {
        const double before = std::sqrt(share);
        share += c.weight;
        c.weight = std::sqrt(share) - before;
    }
}

/// The places are a sample of a picture's, some thousand of them: both numbers are two standard
/// errors above what the sample has.
ErrorEstimate errors_of(const std::vector<ComparedPlace>& compared) {
    constexpr double kStandardErrors = 1.0, kBeyond = 0.01;
    const auto square = [](const ComparedPlace& c) {
        return glm::dot(c.difference, c.difference) / 3.0;
    };
    double mean = 0.0, squared_weights = 0.0;
    for (const ComparedPlace& c : compared) {
        mean += c.weight * square(c);
        squared_weights += c.weight * c.weight;
    }
    double variance = 0.0;                               // of the mean
    std::vector<std::pair<double, double>> differences;  // and weights
    for (const ComparedPlace& c : compared) {
        const double off = c.weight * (square(c) - mean);
        variance += off * off;
        for (int k = 0; k < 3; ++k) differences.emplace_back(c.difference[k], c.weight / 3.0);
    }
    ErrorEstimate errors;
    errors.rms = std::sqrt(mean + kStandardErrors * std::sqrt(variance));
    std::sort(differences.rbegin(), differences.rend());
    const double limit =
        kBeyond - kStandardErrors * std::sqrt(kBeyond * (1.0 - kBeyond) * squared_weights);
    double beyond = 0.0;
    for (const auto& [difference, weight] : differences) {
        errors.largest = difference;
        beyond += weight;
        if (beyond > limit) break;
    }
    return errors;
}

}  // namespace

ErrorEstimate estimate_error(const Material& material, const Machine& machine) {
    ErrorEstimate estimate;
    if (machine.double_precision) return estimate;
    const TexelSource source(material);
    const auto formula = reference::layer_formula(material, material_layer(material, machine));
    std::vector<LitPlaces> all;
    for (const double degrees : kLightDegrees)
        all.push_back(light_places(source, *formula, degrees));
    const std::vector<double> peaks = peaks_of(all);

    const auto shared = std::make_shared<const Material>(material);
    std::vector<Scene> scenes;
    for (const LitPlaces& lit : all) scenes.push_back(scene_of(lit, shared, machine, source));
    Renderer renderer({.threads = 1});
    Framebuffer frame(kSide, kSide, PixelFormat::rgba32f);
    for (const double quantile : kPeakQuantiles) {
        const double peak =
            peaks[static_cast<std::size_t>(quantile * static_cast<double>(peaks.size() - 1))];
        const auto intensity = static_cast<float>(peak > 0.0 ? kPeak / peak : 1.0);
        for (std::size_t i = 0; i < all.size(); ++i) {
            scenes[i].lights.front().intensity = intensity;
            renderer.render(scenes[i], frame);
            for (int direction = 0; direction < kDirections; ++direction) {
                std::vector<ComparedPlace> compared =
                    compare(frame, all[i], static_cast<double>(intensity), direction);
                bend_one_way(compared);
                const ErrorEstimate errors = errors_of(compared);
                estimate.rms = std::max(estimate.rms, errors.rms);
                estimate.largest = std::max(estimate.largest, errors.largest);
            }
        }
    }
    return estimate;
}

}  // namespace burnish
