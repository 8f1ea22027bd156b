#pragma once

#include <map>
#include <string>

namespace burnish::view {

/// How large a picture fits into the time for a frame, from how long the last ones took.
class Pace {
  public:
    /// Milliseconds that a picture may take while things move.
    explicit Pace(double budget_ms) : m_budget_ms(budget_ms) {}

    /// `machine` took `ms` for so many pixels, `fixed_ms` of it for what no size makes shorter.
    void took(const std::string& machine, double pixels, double ms, double fixed_ms);
    /// What a frame of `pixels` is divided by, in width and height: 1 .. 16 in steps of an eighth.
    /// `shares`: how many pictures have to fit into the budget. Before anything was measured
    /// `guess_ns` a pixel count.
    [[nodiscard]] double divisor(const std::string& machine, double pixels, int shares,
                                 double guess_ns = kMachineNs) const;
    /// Guesses, on the slow side: a long first picture cannot be taken back.
    static constexpr double kMachineNs = 60.0, kDoubleNs = 2000.0;

  private:
    double m_budget_ms;
    struct Cost {
        double fixed_ms;
        double ns_per_pixel;
    };
    std::map<std::string, Cost> m_costs;
};

}  // namespace burnish::view
