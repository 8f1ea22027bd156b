#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/texture.hpp>
#include <filesystem>
#include <string>

#include "metrics/plane.hpp"

namespace burnish::lab {

/// Names of a cell's pictures.
struct PictureFiles {
    std::filesystem::path directory;
    std::string name;

    /// `what` is test, reference, error or flip.
    [[nodiscard]] std::filesystem::path png(const std::string& what) const {
        return directory / (name + "." + what + ".png");
    }
    [[nodiscard]] std::filesystem::path exr(const std::string& what) const {
        return directory / (name + "." + what + ".exr");
    }
};

/// Colours of an rgba32f frame as they are, to the nearest byte and opaque.
Image8 shown(const Framebuffer& frame);

/// Test and reference as EXR and PNG; their signed difference times `gain` and the map of FLIP as
/// PNG (metrics/heat_map.hpp).
void save_pictures(const Framebuffer& test, const Framebuffer& reference,
                   const metrics::Plane& flip, float gain, const PictureFiles& files);

}  // namespace burnish::lab
