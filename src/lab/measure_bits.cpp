// measure_bits DOCUMENT: error by stage, depth and rounding of a lobe of width 0.1, into the
// sections "prototype", "depths" and "roundings" of DOCUMENT. `./run bits`.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/dmath.hpp"
#include "lab/attribution.hpp"
#include "lab/document_section.hpp"
#include "lab/lobe_strip.hpp"
#include "lab/stage_bits_text.hpp"
#include "metrics/frame_errors.hpp"

namespace burnish::lab {
namespace {

constexpr double kWidth = 0.1;
constexpr std::array<double, 3> kExponents{2.0, 16.0, 128.0};
constexpr std::array<int, 5> kDepths{8, 9, 10, 12, 16};
constexpr std::array kRoundings{BitRounding::nearest, BitRounding::truncate, BitRounding::shift8,
                                BitRounding::stochastic};

/// The lobe as a formula of h.t alone: h to 2^b - 1 steps, u = h / alpha and q = u^2 as registers,
/// the table nearest to s = 1 - q.
double lobe(double h, double exponent, const StageBits& bits, Quantiser& q) {
    h = 2.0 * q.coded_number(0.5 * h + 0.5, bits.half_vector) - 1.0;
    const double u = q.signed_number(h / abp_width(kWidth, exponent), bits.combiners);
    const double s = std::max(1.0 - q.product(u * u, bits.combiners), 0.0);
    return q.unsigned_number(dmath::pow(q.unsigned_number(s, bits.table), exponent / 2.0),
                             bits.frame);
}

struct Errors {
    double rmse = 0.0, bias = 0.0;
};

Errors formula_errors(double exponent, const StageBits& bits) {
    constexpr int kSamples = 8192;
    Quantiser exact, q(bits.rounding);
    double squares = 0.0, sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const double h = kStripReach * (2.0 * (i + 0.5) / kSamples - 1.0);
        q.begin(static_cast<std::uint32_t>(i), 0);
        const double e = lobe(h, exponent, bits, q) - lobe(h, exponent, {}, exact);
        squares += e * e;
        sum += e;
    }
    return {std::sqrt(squares / kSamples), sum / kSamples};
}

StageBits all_of(int bits, BitRounding rounding) {
    StageBits all{.rounding = rounding};
    set_stage_bits(all, fmt::format("{}", bits));
    return all;
}

std::string prototype_section() {
    std::string text =
        "| N | h, 8 bits | registers, 9 bits | table, 256 texels | all, nearest | all, truncate | "
        "all, shift8 | all, stochastic |\n|---|---|---|---|---|---|---|---|\n";
    for (const double n : kExponents) {
        text += fmt::format(
            "| {} | {:.4f} | {:.4f} | {:.4f} |", n, formula_errors(n, {.half_vector = 8}).rmse,
            formula_errors(n, {.combiners = 9}).rmse, formula_errors(n, {.table = 8}).rmse);
        for (const BitRounding rounding : kRoundings) {
            StageBits bits = all_of(8, rounding);
            bits.frame = kExactBits;
            const Errors e = formula_errors(n, bits);
            text += fmt::format(" {:.4f}, {:+.4f} |", e.rmse, e.bias);
        }
        text += "\n";
    }
    return text;
}

struct Setting {
    const char* name;
    const char* machine;
    HalfVector half_vector;
};
constexpr std::array<Setting, 3> kSettings{{
    {"ideal", "ideal", HalfVector::pixel},
    {"ideal, half vectors of the vertices", "ideal", HalfVector::vertex},
    {"nv2a, half vectors of the pixel", "nv2a", HalfVector::pixel},
}};

/// Pictures of a strip against the exact one.
class Strip {
  public:
    Strip(double exponent, const Setting& setting)
        : m_scene(lobe_strip(kWidth, exponent, setting.machine, setting.half_vector)),
          m_renderer(m_scene),
          m_exact(m_renderer.render({})) {}

    metrics::FrameErrors errors(const StageBits& bits) {
        return metrics::interior_errors(m_renderer.render(bits), m_exact);
    }

  private:
    Scene m_scene;
    BitRenderer m_renderer;
    Framebuffer m_exact;
};

/// One row a stage: it alone at every depth, then all but it.
std::string depth_table(double exponent, const Setting& setting) {
    Strip strip(exponent, setting);
    std::string text = fmt::format("\n{}, N = {}:\n\n| stage |", setting.name, exponent);
    std::string rule = "|---|";
    for (const char* kind : {"", "all but it, "}) {
        for (const int depth : kDepths) {
            text += fmt::format(" {}{} |", kind, depth);
            rule += "---|";
        }
    }
    text += "\n" + rule + "\n";
    for (const char* stage : {"half_vector", "textures", "filter", "combiners", "table", "frame"}) {
        text += fmt::format("| {} |", stage);
        for (const int depth : kDepths) {
            StageBits only;
            set_stage_bits(only, stage, fmt::format("{}", depth));
            text += fmt::format(" {:.5f} |", strip.errors(only).rmse);
        }
        for (const int depth : kDepths) {
            StageBits but = all_of(depth, BitRounding::nearest);
            but.combiners = depth;
            set_stage_bits(but, stage, "exact");
            text += fmt::format(" {:.5f} |", strip.errors(but).rmse);
        }
        text += "\n";
    }
    return text;
}

std::string rounding_table(const Setting& setting) {
    std::string text = fmt::format("\n{}:\n\n| N |", setting.name);
    std::string rule = "|---|";
    for (const BitRounding rounding : kRoundings) {
        text += fmt::format(" {} |", rounding_name(rounding));
        rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const double n : kExponents) {
        Strip strip(n, setting);
        text += fmt::format("| {} |", n);
        for (const BitRounding rounding : kRoundings) {
            const metrics::FrameErrors e = strip.errors(all_of(8, rounding));
            text += fmt::format(" {:.4f}, {:+.4f} |", e.rmse, e.bias);
        }
        text += "\n";
    }
    return text;
}

}  // namespace
}  // namespace burnish::lab

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: measure_bits DOCUMENT\n");
        return 2;
    }
    try {
        using namespace burnish::lab;
        replace_section(argv[1], "prototype", prototype_section());
        std::string depths, roundings;
        for (const Setting& setting : kSettings) {
            for (const double n : kExponents) depths += depth_table(n, setting);
            roundings += rounding_table(setting);
        }
        replace_section(argv[1], "depths", depths);
        replace_section(argv[1], "roundings", roundings);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "measure_bits: {}\n", error.what());
        return 3;
    }
}
