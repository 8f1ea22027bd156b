// Which 16-bit format should the wide registers have? Runs the same pipelines in both candidates
// and in double and prints the errors as a table, which stands in docs/numbers.md with what
// follows.
//   Q14: 1 = 2^14, registers in [-2, 2), product (a b + 2^13) >> 14
//   Q15: 1 = 32767 by decree, registers in [-1, 1], product (a b + 2^14) >> 15, additions saturate
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace {

struct Q14 {
    static constexpr const char* kName = "2^14";
    static constexpr int kOne = 16384, kLow = -32768, kHigh = 32767;
    static constexpr double kUnit = 16384.0;
    static int product(int a, int b) { return (a * b + 8192) >> 14; }
    /// Ward's u reaches 2.5: kept as u / 2, and q / 8 of the squares of that.
    static constexpr int kWardShift = 1;
};

struct Q15 {
    static constexpr const char* kName = "2^15";
    static constexpr int kOne = 32767, kLow = -32767, kHigh = 32767;
    static constexpr double kUnit = 32767.0;
    static int product(int a, int b) { return (a * b + 16384) >> 15; }
    /// Nothing above 1 exists: u / 4, and q / 16.
    static constexpr int kWardShift = 2;
};

template <class F>
int code(double x) {
    const double c = std::floor(x * F::kUnit + 0.5);
    return static_cast<int>(
        std::clamp(c, static_cast<double>(F::kLow), static_cast<double>(F::kHigh)));
}
template <class F>
double value(int code) {
    return code / F::kUnit;
}
/// What a general stage leaves: [-1, 1].
template <class F>
int stage(int x) {
    return std::clamp(x, -F::kOne, F::kOne);
}
template <class F>
int dot(const int (&a)[3], const int (&b)[3]) {
    return F::product(a[0], b[0]) + F::product(a[1], b[1]) + F::product(a[2], b[2]);
}

/// Half vector in the frame of t, b, n, the widths of the lobe and ks.
struct Sample {
    double h[3], alpha_x, alpha_y, ks;
};

struct Lobe {
    double s;      ///< 1 - q, clamped at 0
    double color;  ///< ks s
};

Lobe exact_lobe(const Sample& x) {
    const double u = x.h[0] / x.alpha_x, v = x.h[1] / x.alpha_y;
    const double s = std::max(0.0, 1.0 - u * u - v * v);
    return {s, x.ks * s};
}

/// The modified model: maps of t m / alpha_x and b m / alpha_y, dots times 1/m, squares, 1 - q, ks.
template <class F>
Lobe machine_lobe(const Sample& x) {
    int shift = 0;
    while (std::min(x.alpha_x, x.alpha_y) * (1 << shift) < 1.0) ++shift;
    const double m = 1.0 / (1 << shift);
    const int t[3] = {code<F>(m / x.alpha_x), 0, 0}, b[3] = {0, code<F>(m / x.alpha_y), 0};
    const int h[3] = {code<F>(x.h[0]), code<F>(x.h[1]), code<F>(x.h[2])};
    const int u = stage<F>(dot<F>(t, h) * (1 << shift)), v = stage<F>(dot<F>(b, h) * (1 << shift));
    const int q = stage<F>(F::product(u, u) + F::product(v, v));
    const int s = F::kOne - q;
    return {value<F>(s), value<F>(F::product(s, code<F>(x.ks)))};
}

/// exp(-2 q / (1 + h.n)) by a table without error of its own, so that only its arguments' counts.
double exact_ward(const Sample& x) {
    const double u = x.h[0] / x.alpha_x, v = x.h[1] / x.alpha_y;
    return std::exp(-2.0 * (u * u + v * v) / (1.0 + x.h[2]));
}
template <class F>
double machine_ward(const Sample& x) {
    const double unit = 1 << F::kWardShift;
    const auto axis = [&](double h, double alpha) {
        // The dot is of a map in [-1, 1] with h; its scale back to u / unit is a power of two.
        int shift = 0;
        while (alpha * unit * (1 << shift) < 1.0) ++shift;
        const int dot = F::product(code<F>(1.0 / (alpha * unit * (1 << shift))), code<F>(h));
        return std::clamp(dot * (1 << shift), F::kLow, F::kHigh);
    };
    const int u = axis(x.h[0], x.alpha_x), v = axis(x.h[1], x.alpha_y);
    const int half_sum = (F::product(u, u) + F::product(v, v) + 1) >> 1;
    const int q = std::clamp(half_sum, F::kLow, F::kHigh);
    return std::exp(-2.0 * value<F>(q) * 2.0 * unit * unit / (1.0 + value<F>(code<F>(x.h[2]))));
}

/// Errors in units of 1/255, and how many 8-bit results differ.
struct Errors {
    double worst = 0.0, squares = 0.0, sum = 0.0;
    std::uint64_t different = 0, count = 0;

    void add(double got, double want) {
        const double error = (got - want) * 255.0;
        worst = std::max(worst, std::abs(error));
        squares += error * error;
        sum += error;
        const auto byte = [](double x) {
            return std::floor(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5);
        };
        different += byte(got) != byte(want) ? 1 : 0;
        ++count;
    }
    void print(const char* what, const char* format) const {
        const auto n = static_cast<double>(count);
        fmt::print("| {} | {} | {:.4f} | {:.4f} | {:+.4f} | {:.2f} % |\n", what, format, worst,
                   std::sqrt(squares / n), sum / n, 100.0 * static_cast<double>(different) / n);
    }
};

Sample random_sample(std::mt19937_64& engine) {
    const auto number = [&] { return static_cast<double>(engine() >> 11) / 9007199254740992.0; };
    Sample x{};
    x.alpha_x = 0.05 + 0.45 * number();
    x.alpha_y = 0.05 + 0.45 * number();
    x.ks = number();
    // Where the lobes are: u and v up to 1.25 (2.5 for Ward) widths from the middle.
    const double u = (2.0 * number() - 1.0) * 2.5, v = (2.0 * number() - 1.0) * 2.5;
    x.h[0] = std::clamp(u * x.alpha_x, -0.7, 0.7);
    x.h[1] = std::clamp(v * x.alpha_y, -0.7, 0.7);
    x.h[2] = std::sqrt(1.0 - x.h[0] * x.h[0] - x.h[1] * x.h[1]);
    return x;
}

template <class F>
void pipelines() {
    constexpr int kSamples = 2000000;
    std::mt19937_64 engine(1);
    Errors lobe, narrow[3], ward;
    constexpr int kExponents[3] = {4, 16, 64};
    for (int i = 0; i < kSamples; ++i) {
        const Sample x = random_sample(engine);
        const Lobe got = machine_lobe<F>(x), want = exact_lobe(x);
        if (want.s > 0.0 || got.s > 0.0) {
            lobe.add(got.color, want.color);
            for (int k = 0; k < 3; ++k) {
                narrow[k].add(std::pow(got.s, kExponents[k] / 2),
                              std::pow(want.s, kExponents[k] / 2));
            }
        }
        ward.add(machine_ward<F>(x), exact_ward(x));
    }
    lobe.print("modified model, ks (1 - q)", F::kName);
    narrow[0].print("s^(N/2), N = 4", F::kName);
    narrow[1].print("s^(N/2), N = 16", F::kName);
    narrow[2].print("s^(N/2), N = 64", F::kName);
    ward.print("Ward exponential, \\|u\\| to 2.5", F::kName);
}

/// Identities that programs rely on: how many of all register values keep them.
template <class F>
void identities() {
    int one = 0, half = 0, bytes = 0, expanded = 0, values = 0;
    for (int v = -F::kOne; v <= F::kOne; ++v, ++values) {
        one += F::product(v, F::kOne) == v ? 1 : 0;
        half +=
            F::product(v, code<F>(0.5)) * 2 - v >= -1 && F::product(v, code<F>(0.5)) * 2 - v <= 1
                ? 1
                : 0;
    }
    for (int n = 0; n < 256; ++n) {
        const int v = code<F>(n / 255.0);
        bytes += std::floor(value<F>(v) * 255.0 + 0.5) == n ? 1 : 0;
        // A normal map's 0, 128/255, should expand to 1/255 and 255/255 to 1.
        expanded +=
            std::abs(value<F>(2 * v - F::kOne) - (2.0 * n / 255.0 - 1.0)) * 65535.0 <= 4.0 ? 1 : 0;
    }
    fmt::print("| {} | {} of {} | {} of {} | {} of 256 | {} of 256 | {} |\n", F::kName, one, values,
               half, values, bytes, expanded, F::kOne % 2 == 0 ? "exact" : "between two codes");
}

}  // namespace

int main() {
    fmt::print(
        "| pipeline | 1 is | worst | RMS | bias | other 8-bit result "
        "|\n|---|---|---|---|---|---|\n");
    pipelines<Q14>();
    pipelines<Q15>();
    fmt::print(
        "\n| 1 is | x 1 = x | x / 2 within half a code | bytes in and out | expand within 4/65535 "
        "| 1/2 |\n"
        "|---|---|---|---|---|---|\n");
    identities<Q14>();
    identities<Q15>();
    return 0;
}
