#pragma once

#include <burnish/framebuffer.hpp>
#include <cstddef>
#include <optional>

#include "bench/peers/contender.hpp"
#include "bench/peers/peer_scene.hpp"

namespace burnish::peers {

/// A frame as floats r, g, b, coverage of 0 or 1: what metrics::interior_errors compares. Depths
/// stand in r, g and b. Without a background (Shading::layer) every pixel is covered; else those
/// are whose alpha, or depth, is not what it was cleared to.
Framebuffer picture_of(const PeerScene& scene, const FrameBytes& bytes);

/// Two pictures of one scene beside each other, and beside the one in double precision.
struct Agreement {
    std::size_t covered = 0;        ///< pixels of the first
    std::size_t silhouette = 0;     ///< of these, those beside pixels that are not
    std::size_t edge_pixels = 0;    ///< covered in one only, within a pixel of both silhouettes
    std::size_t stray_pixels = 0;   ///< covered in one only, farther in or out
    double rmse = 0.0, bias = 0.0;  ///< first against second, over interior pixels
    std::optional<double> first_rmse, second_rmse;  ///< against the double-precision picture

    /// Same coverage but for edge pixels, a tenth of the silhouette at most, since half a pixel
    /// aside would be a quarter; and an RMSE within `largest_rmse`.
    [[nodiscard]] bool holds(double largest_rmse) const {
        return covered > 0 && stray_pixels == 0 && 10 * edge_pixels <= silhouette &&
               rmse <= largest_rmse;
    }
};

/// @param truth  null: there is none
Agreement compare(const Framebuffer& first, const Framebuffer& second, const Framebuffer* truth);

}  // namespace burnish::peers
