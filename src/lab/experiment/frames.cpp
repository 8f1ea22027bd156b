#include "lab/experiment/frames.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <string>
#include <vector>

#include "geometry/camera.hpp"
#include "lab/experiment/bits_settings.hpp"
#include "metrics/frame_errors.hpp"

namespace burnish::lab {
namespace {

bool is_of_bits(const ExperimentSetting& setting) {
    return setting.key.starts_with("bits.");
}

/// Vertices that no camera looks at.
void move_vertices(RawVertices& raw, const Scene& scene, const glm::dvec2& pixels) {
    if (raw.space == Space::object) return;
    const bool window = raw.space == Space::window;
    const glm::vec2 step =
        window ? glm::vec2(pixels)
               : glm::vec2(2.0 * pixels.x / scene.width, -2.0 * pixels.y / scene.height);
    for (RawVertex& vertex : raw.vertices) {
        const float weight = window ? 1.0F : vertex.position.w;
        vertex.position.x += step.x * weight;
        vertex.position.y += step.y * weight;
    }
}

}  // namespace

Scene load_picture(const std::filesystem::path& file, const PictureSettings& picture) {
    std::vector<std::string> overrides;
    for (const ExperimentSetting& setting : picture.settings)
        if (!is_of_bits(setting)) overrides.push_back(setting.key + "=" + setting.value);
    Scene scene = load_scene(file, overrides).scene;
    scene.format = PixelFormat::rgba32f;
    return scene;
}

Scene moved(const Scene& scene, const glm::dvec2& pixels) {
    Scene result = scene;
    glm::dmat4 shift(1.0);
    shift[3][0] = 2.0 * pixels.x / scene.width;
    shift[3][1] = -2.0 * pixels.y / scene.height;
    const glm::dmat4 projection = projection_matrix(scene.camera, scene.width, scene.height);
    result.camera.projection = glm::mat4(shift * projection);
    for (Object& object : result.objects)
        if (auto* raw = std::get_if<RawVertices>(&object.geometry))
            move_vertices(*raw, scene, pixels);
    return result;
}

double exposure(const Scene& reference, double peak, int threads) {
    Scene scene = reference;
    scene.machine = machine_profile("double");
    scene.machine.viewer = reference.machine.viewer;
    RendererOptions options;
    options.threads = threads;
    Renderer renderer(options);
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    renderer.render(scene, frame);
    const double found = metrics::interior_peak(frame);
    if (!(found > 0.0))
        throw Error(ErrorCode::bad_input, "a picture to expose is black, expected light in it");
    return peak / found;
}

void scale_lights(Scene& scene, double factor) {
    for (Light& light : scene.lights)
        light.intensity = static_cast<float>(static_cast<double>(light.intensity) * factor);
}

Painter::Painter(const PictureSettings& picture, int samples, int threads)
    : m_bits(bits_of(picture.settings)),
      m_threads(threads),
      m_renderer({.threads = threads, .double_samples = samples}) {}

Framebuffer Painter::draw(const Scene& scene) {
    if (m_bits) return render_with_bits(scene, *m_bits, m_threads);
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    m_renderer.render(scene, frame);
    return frame;
}

}  // namespace burnish::lab
