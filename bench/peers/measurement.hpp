#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/peers/agreement.hpp"

namespace burnish::peers {

/// One renderer's times of a scene.
struct Times {
    std::string renderer;
    std::vector<double> rounds;  ///< ms: the median frame of every process

    [[nodiscard]] double median() const;
    [[nodiscard]] double least() const;
    [[nodiscard]] double most() const;
};

/// A line of the table. The first renderer is burnish.
struct Measurement {
    std::string scene;
    int width = 0, height = 0;
    int threads = 0;
    std::string isa;         ///< that was asked for; empty: the best
    float intensity = 1.0F;  ///< of the light
    Times burnish{}, peer{};
    /// By round: line_transfer(). With one thread none.
    std::vector<double> transfers{};
    Agreement agreement{};
    bool agree = false;

    /// The peer's time over burnish's: of the medians; the least and the most of the rounds, in
    /// which the two ran one after the other.
    [[nodiscard]] double ratio() const { return peer.median() / burnish.median(); }
    [[nodiscard]] double least_ratio() const;
    [[nodiscard]] double most_ratio() const;
};

/// The rounds in which the cores were near each other and those in which they were far apart, as
/// far as there were any. A virtual machine's cores change places.
std::vector<Measurement> by_distance(const Measurement& measurement);

double median(std::vector<double> values);

/// On what and how it was measured.
struct Surroundings {
    std::string processor;
    std::string peer;       ///< its name
    bool realtime = false;  ///< priority
    int rounds = 0;
};

/// One object with all numbers, measurements as in the table.
std::string json(const std::vector<Measurement>& measurements, const Surroundings& surroundings);

/// Markdown: surroundings, then a table with a line for each and each distance of the cores.
std::string report(const std::vector<Measurement>& measurements, const Surroundings& surroundings);
std::string table_line(const Measurement& measurement);

}  // namespace burnish::peers
