#include "lab/experiment/measures.hpp"

#include <algorithm>

#include "lab/frame_errors.hpp"

namespace burnish::lab {

std::vector<std::string_view> measure_names() {
    return {"rmse", "max", "p99", "bias", "step_excess"};
}

std::vector<Measured> measure(const Framebuffer& test, const Framebuffer& reference,
                              const std::vector<std::string>& names) {
    const FrameErrors errors = frame_errors(test, reference);
    std::vector<Measured> all{{"rmse", errors.rmse},
                              {"max", errors.largest},
                              {"p99", errors.p99},
                              {"bias", errors.bias},
                              {"step_excess", errors.step_excess}};
    std::erase_if(all, [&](const Measured& each) {
        return std::find(names.begin(), names.end(), each.name) == names.end();
    });
    return all;
}

}  // namespace burnish::lab
