// Which 16-bit format should the wide registers have? Runs the same pipelines in both candidates
// and in double and prints the errors as tables; docs/numbers.md has them with what follows.
//   2^14: 1 = 16384, registers in [-2, 2), product (a b + 2^13) >> 14
//   2^15: 1 = 32767 by decree, registers in [-1, 1], product (a b + 2^14) >> 15, which is the
//         vector units' own, additions saturate
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace {

struct Q14 {
    static constexpr const char* kName = "2^14";
    static constexpr int kOne = 16384, kHalf = 8192;
    static int product(int a, int b) { return (a * b + 8192) >> 14; }
    /// Sums are kept in 32 bits until the stage's result is clamped.
    static int add(int a, int b) { return a + b; }
};

struct Q15 {
    static constexpr const char* kName = "2^15";
    static constexpr int kOne = 32767, kHalf = 16384;
    static int product(int a, int b) { return (a * b + 16384) >> 15; }
    static int add(int a, int b) { return std::clamp(a + b, -32768, 32767); }
};

template <class F>
int code(double x) {
    const double c = std::floor(x * F::kOne + 0.5);
    return static_cast<int>(std::clamp(c, -32768.0, 32767.0));
}
template <class F>
double value(int code) {
    return static_cast<double>(code) / F::kOne;
}
int saturate(int x) {
    return std::clamp(x, -32768, 32767);
}
/// What a general stage leaves unless its portion is wide: [-1, 1].
template <class F>
int stage(int x) {
    return std::clamp(x, -F::kOne, F::kOne);
}
/// 2 x - 1 as x + (x - 1), which no 16-bit step overflows and which maps 1 to 1 in both formats.
template <class F>
int expand(int x) {
    return x + (x - F::kOne);
}

using Vector = std::array<double, 3>;
using Codes = std::array<int, 3>;

/// How a vector in [-1, 1]^3 comes into a register.
enum class Encoding { signed_map, colour };

template <class F>
Codes load(const Vector& v, double scale, Encoding encoding) {
    Codes out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double x = v[c] * scale;
        out[c] = encoding == Encoding::colour ? expand<F>(code<F>(0.5 * x + 0.5)) : code<F>(x);
    }
    return out;
}
template <class F>
int dot(const Codes& a, const Codes& b) {
    return F::add(F::add(F::product(a[0], b[0]), F::product(a[1], b[1])), F::product(a[2], b[2]));
}

/// A tangent frame and a half vector in one space, the widths of the lobe and ks.
/// u = h.t / alpha_x and v = h.b / alpha_y lie in the disc of radius 2.5.
struct Sample {
    Vector t, b, n, h;
    double u, v, h_n, alpha_x, alpha_y, ks;
};

/// h.axis / (alpha unit), from a map of axis m / (alpha unit), m a power of two that keeps the map
/// within [-1, 1] and that the stage's scale takes back.
template <class F>
int scaled_dot(const Vector& axis, double alpha, const Vector& h, double unit, Encoding encoding) {
    int shift = 0;
    while (alpha * unit * (1 << shift) < 1.0) ++shift;
    const Codes map = load<F>(axis, 1.0 / (alpha * unit * (1 << shift)), encoding);
    return dot<F>(map, load<F>(h, 1.0, encoding)) * (1 << shift);
}

struct Lobe {
    double s;       ///< 1 - q, clamped at 0
    double colour;  ///< ks s
};

Lobe exact_lobe(const Sample& x) {
    const double s = std::max(0.0, 1.0 - x.u * x.u - x.v * x.v);
    return {s, x.ks * s};
}
template <class F>
Lobe machine_lobe(const Sample& x, Encoding encoding) {
    const int u = stage<F>(scaled_dot<F>(x.t, x.alpha_x, x.h, 1.0, encoding));
    const int v = stage<F>(scaled_dot<F>(x.b, x.alpha_y, x.h, 1.0, encoding));
    const int s = F::kOne - stage<F>(F::add(F::product(u, u), F::product(v, v)));
    return {value<F>(s), value<F>(F::product(s, code<F>(x.ks)))};
}

/// exp(-2 q / (1 + h.n)) by a table without error of its own, so that only its arguments' counts.
double exact_ward(const Sample& x) {
    return std::exp(-2.0 * (x.u * x.u + x.v * x.v) / (1.0 + x.h_n));
}
/// The registers hold u / unit, v / unit and q / unit^2; the table's axis knows the unit.
template <class F>
double machine_ward(const Sample& x, double unit) {
    const auto encoding = Encoding::signed_map;
    const int u = saturate(scaled_dot<F>(x.t, x.alpha_x, x.h, unit, encoding));
    const int v = saturate(scaled_dot<F>(x.b, x.alpha_y, x.h, unit, encoding));
    const int q = saturate(F::add(F::product(u, u), F::product(v, v)));
    const int h_n = stage<F>(dot<F>(load<F>(x.n, 1.0, encoding), load<F>(x.h, 1.0, encoding)));
    return std::exp(-2.0 * value<F>(q) * unit * unit / (1.0 + value<F>(h_n)));
}

class Errors {
  public:
    void add(double got, double want) {
        const double error = got - want;
        m_worst = std::max(m_worst, std::abs(error));
        m_squares += error * error;
        m_sum += error;
        const auto byte = [](double x) {
            return std::floor(std::clamp(x, 0.0, 1.0) * 255.0 + 0.5);
        };
        m_different += byte(got) != byte(want) ? 1 : 0;
        m_count += 1;
    }
    void print(const std::string& what, const char* format) const {
        const double rms = std::sqrt(m_squares / m_count);
        fmt::print("| {} | {} | {:.3f} | {:.4f} | {:+.4f} | {:.1f} | {:.2f} | {:.2f} % |\n", what,
                   format, m_worst * 255.0, rms * 255.0, m_sum / m_count * 255.0, m_worst * 65535.0,
                   rms * 65535.0, 100.0 * m_different / m_count);
    }

  private:
    double m_worst = 0.0, m_squares = 0.0, m_sum = 0.0, m_different = 0.0, m_count = 0.0;
};

class Sampler {
  public:
    Sample operator()() {
        Sample x{};
        x.t = direction();
        const Vector other = direction();
        x.n = normalized(cross(x.t, other));
        x.b = cross(x.n, x.t);
        x.ks = number();
        double h_t = 0.0, h_b = 0.0;
        do {  // The widest lobes reach beyond the hemisphere.
            x.alpha_x = 0.05 + 0.45 * number();
            x.alpha_y = 0.05 + 0.45 * number();
            x.u = 2.5 * (2.0 * number() - 1.0);
            x.v = 2.5 * (2.0 * number() - 1.0);
            h_t = x.u * x.alpha_x;
            h_b = x.v * x.alpha_y;
        } while (x.u * x.u + x.v * x.v > 6.25 || h_t * h_t + h_b * h_b > 1.0);
        x.h_n = std::sqrt(1.0 - h_t * h_t - h_b * h_b);
        for (std::size_t c = 0; c < 3; ++c) x.h[c] = h_t * x.t[c] + h_b * x.b[c] + x.h_n * x.n[c];
        return x;
    }

  private:
    double number() { return static_cast<double>(m_engine() >> 11) / 9007199254740992.0; }
    Vector direction() {
        Vector v{};
        double squares = 0.0;
        do {
            for (double& c : v) c = 2.0 * number() - 1.0;
            squares = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        } while (squares > 1.0 || squares < 0.01);
        return normalized(v);
    }
    static Vector cross(const Vector& a, const Vector& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Vector normalized(const Vector& v) {
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        return {v[0] / length, v[1] / length, v[2] / length};
    }
    std::mt19937_64 m_engine{1};
};

/// wards: the unit of u, a power of two, and the smallest that reaches q = 6.25.
template <class F>
void pipelines(const std::array<double, 2>& wards) {
    constexpr int kSamples = 2000000;
    constexpr std::array<int, 3> kExponents{4, 16, 64};
    Sampler next;
    Errors signed_maps, colours;
    std::array<Errors, 3> powers;
    std::array<Errors, 2> ward;
    for (int i = 0; i < kSamples; ++i) {
        const Sample x = next();
        const Lobe want = exact_lobe(x), got = machine_lobe<F>(x, Encoding::signed_map);
        if (want.s > 0.0 || got.s > 0.0) {
            signed_maps.add(got.colour, want.colour);
            colours.add(machine_lobe<F>(x, Encoding::colour).colour, want.colour);
            for (std::size_t k = 0; k < powers.size(); ++k) {
                powers[k].add(std::pow(got.s, kExponents[k] / 2),
                              std::pow(want.s, kExponents[k] / 2));
            }
        }
        for (std::size_t k = 0; k < ward.size(); ++k) {
            ward[k].add(machine_ward<F>(x, wards[k]), exact_ward(x));
        }
    }
    signed_maps.print("ks (1 - q), signed maps", F::kName);
    colours.print("ks (1 - q), maps and h as colours", F::kName);
    for (std::size_t k = 0; k < powers.size(); ++k) {
        powers[k].print(fmt::format("s^(N/2), N = {}", kExponents[k]), F::kName);
    }
    for (std::size_t k = 0; k < ward.size(); ++k) {
        ward[k].print(fmt::format("Ward, u/{:.4g}, q/{:.4g}", wards[k], wards[k] * wards[k]),
                      F::kName);
    }
}

/// How many of the texels n / last come out of a register as they went in, after a product with
/// 1 or without.
template <class F>
int texels_kept(int last, bool times_one) {
    int kept = 0;
    for (int n = 0; n <= last; ++n) {
        const int in = code<F>(static_cast<double>(n) / last);
        const int v = times_one ? F::product(in, F::kOne) : in;
        kept += std::floor(value<F>(v) * last + 0.5) == n ? 1 : 0;
    }
    return kept;
}

template <class F>
void identities() {
    int times_one = 0, inverted_twice = 0;
    double expand_error = 0.0, half_bias_error = 0.0;
    for (int v = -F::kOne; v <= F::kOne; ++v) times_one += F::product(v, F::kOne) == v ? 1 : 0;
    for (int v = 0; v <= F::kOne; ++v) inverted_twice += F::kOne - (F::kOne - v) == v ? 1 : 0;
    for (int n = 0; n <= 65535; ++n) {
        const double x = n / 65535.0;
        const int v = code<F>(x);
        expand_error = std::max(expand_error, std::abs(value<F>(expand<F>(v)) - (2.0 * x - 1.0)));
        half_bias_error = std::max(half_bias_error, std::abs(value<F>(v - F::kHalf) - (x - 0.5)));
    }
    const auto row = [](const char* what, const std::string& result) {
        fmt::print("| {} | {} | {} |\n", what, F::kName, result);
    };
    row("x 1 = x, x in [-1, 1]", fmt::format("{} of {}", times_one, 2 * F::kOne + 1));
    row("1 times 1", fmt::format("{} of {}", F::product(F::kOne, F::kOne), F::kOne));
    row("1 - (1 - x) = x, x in [0, 1]", fmt::format("{} of {}", inverted_twice, F::kOne + 1));
    row("code of 1/2", 2 * F::kHalf == F::kOne ? "exact" : "half a code off");
    row("bytes in and out", fmt::format("{} of 256", texels_kept<F>(255, false)));
    row("the same, times 1", fmt::format("{} of 256", texels_kept<F>(255, true)));
    row("16-bit texels in and out", fmt::format("{} of 65536", texels_kept<F>(65535, false)));
    row("the same, times 1", fmt::format("{} of 65536", texels_kept<F>(65535, true)));
    row("expand of a 16-bit texel, worst", fmt::format("{:.2f} / 65535", expand_error * 65535.0));
    row("half_bias of it, worst", fmt::format("{:.2f} / 65535", half_bias_error * 65535.0));
}

}  // namespace

int main() {
    fmt::print(
        "| pipeline | 1 is | worst, 1/255 | RMS | bias | worst, 1/65535 | RMS | other byte |\n"
        "|---|---|---|---|---|---|---|---|\n");
    // The largest q is 2 units on 2^14 and 1 unit on 2^15.
    pipelines<Q14>({2.0, std::sqrt(3.125)});
    pipelines<Q15>({4.0, 2.5});
    fmt::print("\n| what | 1 is | |\n|---|---|---|\n");
    identities<Q14>();
    identities<Q15>();
    return 0;
}
