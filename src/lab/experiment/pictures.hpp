#pragma once

#include <burnish/experiment.hpp>
#include <burnish/framebuffer.hpp>
#include <filesystem>
#include <string>

namespace burnish::lab {

/// Whether a cell's pictures are kept: those that a sheet shows.
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

/// Test and reference as EXR and PNG; as PNG the difference of their means over r, g, b times
/// `gain`, orange where the test is brighter and blue where it is darker, and the FLIP map.
void save_pictures(const Framebuffer& test, const Framebuffer& reference, float gain,
                   const PictureFiles& files);

}  // namespace burnish::lab
