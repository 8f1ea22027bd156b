#pragma once

#include <burnish/framebuffer.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::lab {

/// The metrics that an experiment can ask for, in the order of the columns of results.
std::vector<std::string_view> measure_names();

struct Measured {
    std::string name;
    double value;  ///< NaN where it has no meaning
};

/// Those of `names` that a pair of pictures has; both are rgba32f and of one size.
std::vector<Measured> measure(const Framebuffer& test, const Framebuffer& reference,
                              const std::vector<std::string>& names);

}  // namespace burnish::lab
