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
    std::string isa;  ///< that was asked for; empty: the best
    Times burnish, peer;
    Agreement agreement;
    bool agree = false;

    /// The peer's time over burnish's: of the medians, and the least and most of the rounds, which
    /// ran in pairs.
    [[nodiscard]] double ratio() const { return peer.median() / burnish.median(); }
    [[nodiscard]] double least_ratio() const;
    [[nodiscard]] double most_ratio() const;
};

double median(std::vector<double> values);

/// One object: what was measured on what, and all numbers.
std::string json(const std::vector<Measurement>& measurements, const std::string& processor);

/// Markdown, a line for each.
std::string table(const std::vector<Measurement>& measurements);
std::string table_line(const Measurement& measurement);

}  // namespace burnish::peers
