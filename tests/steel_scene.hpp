#pragma once

#include <fmt/format.h>

#include <string>

namespace burnish {

/// A scene file without its "schema = 1": a sphere of the material "steel", whose model is the
/// default one, in one light. What is added behind it first adds to the light.
inline std::string steel_sphere(int width, int height,
                                const std::string& towards_light = "[0.3, 0.8, 0.5]") {
    return fmt::format(
        "[output]\nwidth = {}\nheight = {}\n"
        "[[materials]]\nname = \"steel\"\nkd = [0.3, 0.2, 0.1]\n"
        "[[objects]]\nshape = \"sphere\"\nmaterial = \"steel\"\n"
        "[[lights]]\ndirection = {}\n",
        width, height, towards_light);
}

}  // namespace burnish
