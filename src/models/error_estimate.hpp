#pragma once

#include <burnish/machine.hpp>
#include <burnish/scene.hpp>

namespace burnish {

/// How far a machine's pictures of a reflectance model are from its formula in double precision, as
/// numbers of the frame's 0 .. 1 under a light that makes the picture's peak 0.9.
///
/// Contained is what the machine does with a texel of the material layer: 8-bit weights of the
/// filter, vectors and cosines as codes, tables and what lies between their texels, the rounding
/// of every stage and pass, the light's colour as a constant, and vertices that are snapped where a
/// texel is as large as a pixel. Not contained: the coding of the maps as layer, how attributes
/// vary between vertices, mip levels, several lights, ambient light.
struct ErrorEstimate {
    double rms = 0.0;      ///< root of the mean square difference
    double largest = 0.0;  ///< what 99 of 100 differences stay within
};

/// Draws places of surfaces with the machine and compares. Both numbers are the largest of
/// several pictures: three angles of the light, four directions of the tangent, three
/// intensities. In each a part of the brightest places that a sphere shows counts as the
/// square root of it, that is as if the surface were bent one way only, as a cylinder's; and since
/// they are samples, a standard error is added. A picture that shows a narrow highlight and
/// nothing else exceeds them. docs/models.md has the ratios to what is measured.
///
/// The same bits everywhere but for the formula's own. 0 for a machine in double precision.
/// Throws what compile_model throws.
ErrorEstimate estimate_error(const Material& material, const Machine& machine);

}  // namespace burnish
