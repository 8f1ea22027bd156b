#include "lab/lobe_strip.hpp"

#include <burnish/shapes.hpp>
#include <cmath>
#include <memory>

#include "core/dmath.hpp"

namespace burnish::lab {

double abp_width(double width, double exponent) {
    return width * std::sqrt(exponent / 2.0);
}

Scene lobe_strip(double width, double exponent, std::string_view machine, HalfVector half_vector) {
    Material material;
    material.name = "lobe";
    material.model = Model::abp;
    material.alpha_x = material.alpha_y = static_cast<float>(abp_width(width, exponent));
    material.exponent = static_cast<float>(exponent);
    Scene scene;
    scene.width = 1024;
    scene.height = 8;
    scene.background = glm::vec4(0.0F);
    scene.machine = machine_profile(machine);
    scene.machine.half_vector = half_vector;
    scene.machine.multipass = scene.machine.numbers == NumberModel::nine_bit;
    // The sine of the angle at which the square's sides are seen is kStripReach.
    const double distance = 0.5 * std::sqrt(1.0 - kStripReach * kStripReach) / kStripReach;
    scene.camera.position = {0.0F, 0.0F, static_cast<float>(distance)};
    scene.camera.view_angle = static_cast<float>(
        2.0 * dmath::atan(0.5 * scene.height / scene.width / distance) * 180.0 / dmath::kPi);
    scene.lights.push_back({.position = scene.camera.position, .position_w = 1.0F});
    scene.objects.push_back({Mesh(shapes::plane(512, 1)),
                             std::make_shared<const Material>(std::move(material)),
                             glm::mat4(1.0F),
                             {}});
    return scene;
}

}  // namespace burnish::lab
