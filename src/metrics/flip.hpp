#pragma once

#include <burnish/framebuffer.hpp>
#include <cstdint>
#include <numbers>
#include <optional>

#include "core/parallel.hpp"
#include "metrics/plane.hpp"

/// FLIP, what a person sees who flips between two pictures on one screen: 0 (nothing) .. 1.
///
/// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D. Fairchild, "FLIP:
/// A Difference Evaluator for Alternating Images", HPG 2020; for high dynamic range P. Andersson,
/// J. Nilsson, P. Shirley, T. Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range
/// Images", Eurographics 2021. Constants as in the authors' program (github.com/NVlabs/flip),
/// computed in double precision here.
namespace burnish::metrics {

/// What the numbers of a picture are. A frame has no transfer function; on a screen of today it is
/// taken for sRGB, and in 2000 it went to a tube that was much the same.
enum class Encoding : std::uint8_t {
    srgb,    ///< sent to the screen as they are
    linear,  ///< proportional to light
};

/// Of 0.7 m to a screen 0.7 m wide of 3840 pixels: 0.7 * 3840 / 0.7 * pi / 180.
inline constexpr double kPixelsPerDegree = 3840.0 * std::numbers::pi / 180.0;
inline constexpr double kLeastPixelsPerDegree = 1.0;
/// Filters are hundreds of pixels wide beyond.
inline constexpr double kMostPixelsPerDegree = 1000.0;

/// Exposures of flip_hdr in stops, at equal distances from `start` to `stop`.
struct Exposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;  ///< 1 .. kMostExposures; 1: `start` alone
};
inline constexpr int kMostExposures = 64;

struct FlipOptions {
    double pixels_per_degree = kPixelsPerDegree;  ///< kLeast.. to kMostPixelsPerDegree
    Encoding encoding = Encoding::srgb;           ///< of flip; flip_hdr takes all for linear
    std::optional<Exposures> exposures;           ///< of flip_hdr; else those of `exposures_for`
};

/// FLIP of every pixel. r, g, b outside 0 .. 1 count as 0 or 1; pixels that are not finite in one
/// picture are black in both. What lies outside the picture is like its border.
/// Both frames are rgba32f and of one size; throws Error{bad_option} for options out of range.
Plane flip(const Framebuffer& test, const Framebuffer& reference, const FlipOptions& options,
           WorkerPool& pool);

/// Per pixel the largest FLIP over the exposures, tone-mapped with the ACES fit of Narkowicz 2016.
/// Numbers are linear, below 0 is 0. Of a reference without light only the exposure 0 is looked at.
Plane flip_hdr(const Framebuffer& test, const Framebuffer& reference, const FlipOptions& options,
               WorkerPool& pool);

/// From the exposure that maps the reference's brightest luminance to 0.85 to the one that maps its
/// median there, one per stop and at least two (Eurographics 2021, section 3.2). Where more than
/// half of the picture is black, the median of what is not.
Exposures exposures_for(const Framebuffer& reference);

}  // namespace burnish::metrics
