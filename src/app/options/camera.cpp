#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"

namespace burnish::app {
namespace {

Set vec3_to(std::optional<glm::vec3>& target) {
    return [&target](const std::string& option, const std::string& text) {
        target = parse_vec3(option, text);
    };
}

}  // namespace

OptionGroup camera_options(CameraOptions& camera) {
    return {"Camera",
            {{.names = "--camera-position",
              .value = "X,Y,Z",
              .text = "Where the camera stands",
              .normal = "the scene's",
              .set = vec3_to(camera.position)},
             {.names = "--camera-focal-point",
              .value = "X,Y,Z",
              .text = "What it looks at",
              .normal = "the scene's",
              .set = vec3_to(camera.focal_point)},
             {.names = "--camera-view-up",
              .value = "X,Y,Z",
              .text = "What is up in the picture",
              .normal = "the scene's",
              .set = vec3_to(camera.view_up)},
             {.names = "--camera-view-angle",
              .value = "DEG",
              .text = "Vertical angle of view in degrees",
              .normal = "the scene's",
              .set = number_to(camera.view_angle, 0.001F, 179.9F)},
             {.names = "--camera-azimuth",
              .value = "DEG",
              .text = "Turns the camera about the focal point",
              .normal = "0",
              .set = number_to(camera.azimuth, -1e6F, 1e6F)},
             {.names = "--camera-elevation",
              .value = "DEG",
              .text = "Raises it, looking at the focal point",
              .normal = "0",
              .set = number_to(camera.elevation, -1e6F, 1e6F)},
             {.names = "--camera-zoom",
              .value = "FACTOR",
              .text = "Divides the angle of view",
              .normal = "1",
              .set = number_to(camera.zoom, 0.001F, 1e6F)}}};
}

}  // namespace burnish::app
