#include "bench/peers/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bench/peers/cores.hpp"

namespace burnish::peers {

namespace {

/// Ratios round by round.
std::vector<double> ratios(const Measurement& m) {
    std::vector<double> all;
    for (std::size_t i = 0; i < std::min(m.peer.rounds.size(), m.burnish.rounds.size()); ++i)
        all.push_back(m.peer.rounds[i] / m.burnish.rounds[i]);
    return all;
}

std::string optional_number(const std::optional<double>& number, const char* none) {
    return number ? fmt::format("{:.4f}", *number) : none;
}

std::string numbers_json(const std::vector<double>& numbers) {
    return fmt::format("[{:.4f}]", fmt::join(numbers, ", "));
}

std::string times_json(const Times& times) {
    return fmt::format("{{\"renderer\": \"{}\", \"median_ms\": {:.4f}, \"rounds_ms\": {}}}",
                       times.renderer, times.median(), numbers_json(times.rounds));
}

std::string json(const Measurement& m) {
    const Agreement& a = m.agreement;
    std::string ratio = "null";
    if (m.agree) {
        ratio = fmt::format("{{\"medians\": {:.3f}, \"least\": {:.3f}, \"most\": {:.3f}}}",
                            m.ratio(), m.least_ratio(), m.most_ratio());
    }
    return fmt::format(
        "{{\"scene\": \"{}\", \"width\": {}, \"height\": {}, \"threads\": {}, \"isa\": \"{}\", "
        "\"intensity\": {},\n"
        "   \"burnish\": {},\n   \"peer\": {},\n"
        "   \"line_transfer_ns\": {}, \"ratio\": {}, \"covered\": {}, \"silhouette\": {}, "
        "\"edge_pixels\": {}, "
        "\"stray_pixels\": {}, "
        "\"rmse\": {:.6f}, \"bias\": {:.6f}, \"burnish_rmse_double\": {}, "
        "\"peer_rmse_double\": {}}}",
        m.scene, m.width, m.height, m.threads, m.isa, m.intensity, times_json(m.burnish),
        times_json(m.peer), numbers_json(m.transfers), ratio, a.covered, a.silhouette,
        a.edge_pixels, a.stray_pixels, a.rmse, a.bias, optional_number(a.first_rmse, "null"),
        optional_number(a.second_rmse, "null"));
}

std::string times_cell(const Times& times) {
    return fmt::format("{:.2f} ({:.2f} .. {:.2f})", times.median(), times.least(), times.most());
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double Times::median() const {
    return peers::median(rounds);
}
double Times::least() const {
    return *std::ranges::min_element(rounds);
}
double Times::most() const {
    return *std::ranges::max_element(rounds);
}

double Measurement::least_ratio() const {
    return std::ranges::min(ratios(*this));
}
double Measurement::most_ratio() const {
    return std::ranges::max(ratios(*this));
}

std::vector<Measurement> by_distance(const Measurement& measurement) {
    if (measurement.transfers.empty()) return {measurement};
    std::vector<Measurement> parts;
    for (const bool far : {false, true}) {
        Measurement part = measurement;
        part.transfers.clear();
        part.burnish.rounds.clear();
        part.peer.rounds.clear();
        for (std::size_t i = 0; i < measurement.transfers.size(); ++i) {
            if ((measurement.transfers[i] > kFarApart) != far) continue;
            part.transfers.push_back(measurement.transfers[i]);
            part.burnish.rounds.push_back(measurement.burnish.rounds[i]);
            part.peer.rounds.push_back(measurement.peer.rounds[i]);
        }
        if (!part.transfers.empty()) parts.push_back(std::move(part));
    }
    return parts;
}

std::string json(const std::vector<Measurement>& measurements, const Surroundings& surroundings) {
    std::string list;
    for (const Measurement& all : measurements)
        for (const Measurement& m : by_distance(all))
            list += (list.empty() ? "" : ",\n  ") + json(m);
    return fmt::format(
        "{{\"processor\": \"{}\", \"peer\": \"{}\", \"realtime\": {}, \"rounds\": {},\n "
        "\"measurements\": [\n  "
        "{}\n ]}}\n",
        surroundings.processor, surroundings.peer, surroundings.realtime, surroundings.rounds,
        list);
}

std::string table_line(const Measurement& m) {
    const std::string ratio = m.agree
                                  ? fmt::format("**{:.2f}** ({:.2f} .. {:.2f})", m.ratio(),
                                                m.least_ratio(), m.most_ratio())
                                  : fmt::format("pictures differ: {} edge pixels, {} stray",
                                                m.agreement.edge_pixels, m.agreement.stray_pixels);
    const std::string cores = m.transfers.empty() ? "" : fmt::format("{:.0f}", median(m.transfers));
    return fmt::format("| {}{} | {} x {} | {} | {} | {} | {} | {} | {:.5f} | {} | {} |\n", m.scene,
                       m.isa.empty() ? "" : ", " + m.isa, m.width, m.height, m.threads, cores,
                       times_cell(m.burnish), times_cell(m.peer), ratio, m.agreement.rmse,
                       optional_number(m.agreement.first_rmse, ""),
                       optional_number(m.agreement.second_rmse, ""));
}

std::string report(const std::vector<Measurement>& measurements, const Surroundings& surroundings) {
    std::set<std::string> renderers;
    for (const Measurement& m : measurements)
        renderers.insert({m.burnish.renderer, m.peer.renderer});
    std::string text = fmt::format("{}, {} priority, rounds: {}. {}.\n\n", surroundings.processor,
                                   surroundings.realtime ? "real-time" : "ordinary",
                                   surroundings.rounds, fmt::join(renderers, "; "));
    text += fmt::format(
        "| scene | size | threads | core to core, ns | burnish, ms | {0}, ms | ratio | RMSE "
        "between | burnish to double | {0} to double |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        surroundings.peer);
    for (const Measurement& all : measurements)
        for (const Measurement& m : by_distance(all)) text += table_line(m);
    return text;
}

}  // namespace burnish::peers
