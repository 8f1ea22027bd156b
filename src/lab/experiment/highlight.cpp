#include "lab/experiment/highlight.hpp"

#include "metrics/frame_errors.hpp"
#include "metrics/pixel.hpp"

namespace burnish::lab {
namespace {

struct Centre {
    double pixels = 0.0, weight = 0.0, x = 0.0, y = 0.0;
};

/// Of what lies above `level`.
Centre centre_above(const Framebuffer& frame, const metrics::Selection& selection, int channel,
                    double level) {
    Centre sum;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            if (!selection.contains(x, y)) continue;
            const double above = metrics::pixel(frame, x, y)[channel] - level;
            if (!(above > 0.0)) continue;
            sum.pixels += 1.0;
            sum.weight += above;
            sum.x += above * x;
            sum.y += above * y;
        }
    }
    sum.x /= sum.weight;
    sum.y /= sum.weight;
    return sum;
}

}  // namespace

HighlightChange highlight_change(const Framebuffer& test, const Framebuffer& reference,
                                 const metrics::Selection& selection) {
    const metrics::Peak peak = metrics::peak(reference, selection);
    const double level = 0.5 * peak.value;
    const Centre of_test = centre_above(test, selection, peak.channel, level);
    const Centre of_reference = centre_above(reference, selection, peak.channel, level);
    return {of_test.pixels / of_reference.pixels, of_test.x - of_reference.x,
            of_test.y - of_reference.y};
}

}  // namespace burnish::lab
