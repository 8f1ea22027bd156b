#pragma once

#include <burnish/framebuffer.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.hpp"
#include "metrics/flicker.hpp"
#include "metrics/plane.hpp"

namespace burnish::lab {

/// The metrics that an experiment can ask for: those of src/metrics by their names, over the
/// interior pixels, and
/// - `flicker`, `flip_flicker`: of a series of frames (metrics/flicker.hpp)
/// - `highlight`: number of pixels above half of the reference's peak, over the reference's own
/// - `shift_x`, `shift_y`: how far, in pixels to the right and down, the centre of gravity of these
///   pixels lies from that of the reference's.
std::vector<std::string_view> measure_names();

struct Measured {
    std::string name;
    double value;  ///< NaN where it has no meaning
};

/// What was asked for of one pair of pictures.
struct Measurement {
    std::vector<Measured> values;
    metrics::Plane flip;  ///< empty unless "flip" is asked for
};

/// Those of `names` that a pair of pictures has; both are rgba32f and of one size.
Measurement measure(const Framebuffer& test, const Framebuffer& reference,
                    const std::vector<std::string>& names, WorkerPool& pool);

/// Whether a series of frames is needed.
bool need_series(const std::vector<std::string>& names);

/// Those of `names` that a series has, from pairs that are added one by one.
class SeriesMeasurement {
  public:
    explicit SeriesMeasurement(const std::vector<std::string>& names);
    void add(const Framebuffer& test, const Framebuffer& reference, WorkerPool& pool);
    [[nodiscard]] std::vector<Measured> values() const;

  private:
    bool m_flicker, m_flip;
    metrics::Flicker m_series;
};

}  // namespace burnish::lab
