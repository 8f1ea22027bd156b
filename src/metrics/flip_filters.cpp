#include "metrics/flip_filters.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace burnish::metrics {
namespace {

constexpr double kPi = std::numbers::pi;

/// A Gaussian of a contrast sensitivity function, a sqrt(pi / b) exp(-pi^2 d^2 / b) with d in
/// degrees (HPG 2020, table 1).
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity kY{1.0, 0.0047};
constexpr Sensitivity kCx{1.0, 0.0053};
constexpr Sensitivity kCzWide{34.1, 0.04};
constexpr Sensitivity kCzNarrow{13.5, 0.025};
/// Width of the eye's edge detector in degrees (HPG 2020, section 4.2).
constexpr double kFeatureWidth = 0.082;

double sigma(const Sensitivity& s, double pixels_per_degree) {
    return std::sqrt(s.b / (2.0 * kPi * kPi)) * pixels_per_degree;
}

int three_sigmas(double sigma_pixels) {
    return static_cast<int>(std::ceil(3.0 * sigma_pixels));
}

/// One Gaussian of two dimensions along rows and along columns; `rows` has the weight of the whole.
struct Separated {
    Taps rows, columns;
};

/// `share`: the sum of all its weights.
Separated spread(const Sensitivity& s, double pixels_per_degree, int radius, double share) {
    const Taps taps = gaussian(sigma(s, pixels_per_degree), radius);
    return {scaled(taps, share / sum(taps)), scaled(taps, 1.0 / sum(taps))};
}

/// Sum of the weights of two dimensions before they are normalised.
double volume(const Sensitivity& s, double pixels_per_degree, int radius) {
    const double side = sum(gaussian(sigma(s, pixels_per_degree), radius));
    return s.a * std::sqrt(kPi / s.b) * side * side;
}

/// -x g(x), its positive weights normalised to 1 and the negative ones to -1.
Taps first_derivative(const Taps& g) {
    Taps taps{g.weights, true};
    double positive = 0.0;
    for (std::size_t x = 0; x < taps.weights.size(); ++x) {
        taps.weights[x] *= -static_cast<double>(x);
        positive -= taps.weights[x];
    }
    return scaled(taps, 1.0 / positive);
}

/// (x^2 / sigma^2 - 1) g(x), normalised in the same way.
Taps second_derivative(const Taps& g, double sigma_pixels) {
    Taps taps = g;
    double positive = 0.0, negative = 0.0;
    for (std::size_t x = 0; x < taps.weights.size(); ++x) {
        const double s = static_cast<double>(x) / sigma_pixels;
        taps.weights[x] *= s * s - 1.0;
        const double both = (x == 0 ? 1.0 : 2.0) * taps.weights[x];
        (both > 0.0 ? positive : negative) += both;
    }
    for (double& weight : taps.weights) weight /= weight > 0.0 ? positive : -negative;
    return taps;
}

/// Filters of three planes that begin at `first_plane`.
void add_picture(FilterBank& bank, int first_plane, double ppd) {
    const int radius = three_sigmas(sigma(kCzWide, ppd));
    const double wide = volume(kCzWide, ppd, radius);
    const double narrow = volume(kCzNarrow, ppd, radius);
    const int y_plane = first_plane, cx_plane = first_plane + 1, cz_plane = first_plane + 2;
    const auto add = [&bank](int plane, const Taps& rows, const Taps& columns) {
        bank.rows.push_back({plane, rows});
        bank.columns.push_back({static_cast<int>(bank.rows.size()) - 1, columns});
    };
    const auto add_spread = [&](int plane, const Sensitivity& s, double share) {
        const Separated separated = spread(s, ppd, radius, share);
        add(plane, separated.rows, separated.columns);
    };
    add_spread(y_plane, kY, 1.0);
    add_spread(cx_plane, kCx, 1.0);
    add_spread(cz_plane, kCzNarrow, narrow / (wide + narrow));
    add_spread(cz_plane, kCzWide, wide / (wide + narrow));

    // (Y + 16) / 116 has the derivatives of Y / 116: their weights add up to nothing.
    const double feature_sigma = 0.5 * kFeatureWidth * ppd;
    const Taps g = gaussian(feature_sigma, three_sigmas(feature_sigma));
    const Taps across = scaled(g, 1.0 / sum(g));
    const Taps along = scaled(across, 1.0 / 116.0);
    const Taps first = first_derivative(g);
    const Taps second = second_derivative(g, feature_sigma);
    add(y_plane, scaled(first, 1.0 / 116.0), across);
    bank.rows.push_back({y_plane, along});
    const int smooth = static_cast<int>(bank.rows.size()) - 1;
    bank.columns.push_back({smooth, first});
    add(y_plane, scaled(second, 1.0 / 116.0), across);
    bank.columns.push_back({smooth, second});
}

}  // namespace

FilterBank flip_bank(double pixels_per_degree) {
    FilterBank bank;
    bank.planes = 6;
    add_picture(bank, 0, pixels_per_degree);
    add_picture(bank, 3, pixels_per_degree);
    return bank;
}

}  // namespace burnish::metrics
