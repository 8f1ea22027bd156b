#pragma once

#include <burnish/framebuffer.hpp>

#include "core/parallel.hpp"
#include "metrics/plane.hpp"
#include "metrics/selection.hpp"

namespace burnish::metrics {

/// Structural similarity of every pixel, the mean of r, g and b: 1 where the pictures are the same,
/// at least -1. Windows of 11 x 11 with Gaussian weights, sigma 1.5, K1 = 0.01, K2 = 0.03, range 1.
/// What lies outside the picture is like its border; pixels that are not finite in one picture are
/// black in both. Both frames are rgba32f and of one size.
///
/// Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image Quality Assessment: From Error
/// Visibility to Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004,
/// equation 13.
Plane ssim(const Framebuffer& test, const Framebuffer& reference, WorkerPool& pool);

/// Mean of a map of `ssim` over the selected pixels whose window lies in the picture, as in the
/// authors' program; over all selected ones where a side of the picture is less than 11. NaN
/// without any.
double mean_ssim(const Plane& map, const Selection& selection);

}  // namespace burnish::metrics
