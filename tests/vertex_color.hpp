#pragma once

#include <burnish/scene.hpp>
#include <memory>

namespace burnish {

/// A material that passes colour 0 through: what raw vertices say is what the frame shows.
inline std::shared_ptr<Material> vertex_color() {
    using namespace combine;
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(Register::col0));
    p.out_alpha(alpha(raw(Register::col0)));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    return material;
}

}  // namespace burnish
