#include "app/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/work_order.hpp"

namespace burnish::app {
namespace {

/// Each tile with its median time.
std::vector<TileCost> typical_tiles(const std::vector<FrameStats>& frames) {
    std::vector<TileCost> tiles = frames.front().tile_costs;
    std::vector<double> times(frames.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        for (std::size_t f = 0; f < frames.size(); ++f) times[f] = frames[f].tile_costs[i].ms;
        const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
        std::nth_element(times.begin(), middle, times.end());
        tiles[i].ms = *middle;
    }
    return tiles;
}

double stage_ms(const std::vector<FrameStats>& frames, std::string_view name) {
    double sum = 0.0;
    for (const FrameStats& frame : frames)
        for (const StageCost& stage : frame.stages)
            if (stage.name == name) sum += stage.ms;
    return sum / static_cast<double>(frames.size());
}

SimulatedFrame simulate(const Balance& balance, double alone_ms, double divided_ms, int workers) {
    std::vector<double> cost;
    std::vector<PieceOutlook> outlook;
    for (std::size_t i = 0; i < balance.tiles.size(); ++i) {
        const TileCost& tile = balance.tiles[i];
        cost.push_back(tile.ms);
        const auto owner = i * static_cast<std::size_t>(workers) / balance.tiles.size();
        outlook.push_back({tile.weight, static_cast<std::uint32_t>(owner)});
    }
    WorkOrder rows;
    rows.pieces.resize(cost.size());
    std::iota(rows.pieces.begin(), rows.pieces.end(), 0U);
    rows.shared = cost.size();
    rows.ends.assign(static_cast<std::size_t>(workers), cost.size());
    WorkOrder drawn;
    order_work(outlook, workers, drawn);
    const double before = alone_ms + divided_ms / workers;
    return {workers, before + finishing_time(cost, rows), before + finishing_time(cost, drawn),
            before + std::max(balance.tiles_ms / workers, balance.longest_ms)};
}

/// Lower ends of the classes of a value: 0, then the powers of `base`.
double class_of(double value, double base) {
    if (value <= 0.0) return 0.0;
    double lower = 1.0;
    while (lower > value) lower /= base;
    while (lower * base <= value) lower *= base;
    return lower;
}

/// Tiles and their time by classes of `value`.
struct Class {
    int tiles = 0;
    double ms = 0.0;
};
template <class Value>
std::map<double, Class> histogram(const Balance& balance, double base, Value&& value) {
    std::map<double, Class> classes;
    for (const TileCost& tile : balance.tiles) {
        Class& entry = classes[class_of(value(tile), base)];
        ++entry.tiles;
        entry.ms += tile.ms;
    }
    return classes;
}
std::map<double, Class> by_time(const Balance& balance) {
    return histogram(balance, 2.0, [](const TileCost& tile) { return 1000.0 * tile.ms; });
}
std::map<double, Class> by_fragments(const Balance& balance) {
    return histogram(balance, 4.0,
                     [](const TileCost& tile) { return static_cast<double>(tile.fragments); });
}

std::string histogram_json(const std::map<double, Class>& classes) {
    std::string json;
    for (const auto& [from, entry] : classes)
        json += fmt::format("{}{{\"from\": {:g}, \"tiles\": {}, \"ms\": {:.4f}}}",
                            json.empty() ? "" : ", ", from, entry.tiles, entry.ms);
    return "[" + json + "]";
}

std::string histogram_text(const Balance& balance, const std::map<double, Class>& classes) {
    std::string text;
    for (const auto& [from, entry] : classes) {
        const double share = entry.ms / balance.tiles_ms;
        text += fmt::format("{:>10g} {:>6} tiles {:>8.3f} ms  {:#<{}}\n", from, entry.tiles,
                            entry.ms, "", static_cast<int>(std::lround(40.0 * share)));
    }
    return text;
}

}  // namespace

Balance simulate_balance(const std::vector<FrameStats>& frames) {
    Balance balance;
    balance.tiles = typical_tiles(frames);
    std::size_t drawn = 0;
    double drawn_ms = 0.0;
    for (const TileCost& tile : balance.tiles) {
        balance.tiles_ms += tile.ms;
        balance.longest_ms = std::max(balance.longest_ms, tile.ms);
        if (tile.fragments == 0) continue;
        ++drawn;
        drawn_ms += tile.ms;
    }
    balance.mean_ms = drawn > 0 ? drawn_ms / static_cast<double>(drawn) : 0.0;
    const double divided =
        stage_ms(frames, "transform") + stage_ms(frames, "setup") + stage_ms(frames, "bin");
    for (const int workers : {1, 2, 4, 8, 16, 32, 64})
        balance.frames.push_back(simulate(balance, stage_ms(frames, "prepare"), divided, workers));
    return balance;
}

std::string balance_json(const Balance& balance) {
    std::string frames;
    for (const SimulatedFrame& frame : balance.frames)
        frames += fmt::format(
            "{}{{\"workers\": {}, \"in_rows_ms\": {:.4f}, \"as_drawn_ms\": {:.4f}, \"bound_ms\": "
            "{:.4f}}}",
            frames.empty() ? "" : ", ", frame.workers, frame.in_rows, frame.as_drawn, frame.bound);
    return fmt::format(
        "{{\"tiles\": {}, \"tiles_ms\": {:.4f}, \"mean_ms\": {:.5f}, \"longest_ms\": {:.5f}, "
        "\"by_microseconds\": {}, \"by_fragments\": {}, \"frames\": [{}]}}",
        balance.tiles.size(), balance.tiles_ms, balance.mean_ms, balance.longest_ms,
        histogram_json(by_time(balance)), histogram_json(by_fragments(balance)), frames);
}

std::string balance_text(const Balance& balance) {
    std::string text = fmt::format(
        "tiles     {} in {:.3f} ms; with fragments {:.4f} ms in the mean, the longest {:.4f}, "
        "{:.1f} times that\n",
        balance.tiles.size(), balance.tiles_ms, balance.mean_ms, balance.longest_ms,
        balance.mean_ms > 0.0 ? balance.longest_ms / balance.mean_ms : 0.0);
    text += "by time, from so many microseconds:\n" + histogram_text(balance, by_time(balance));
    text += "by fragments, from so many:\n" + histogram_text(balance, by_fragments(balance));
    text += "workers    tiles in rows, ms    as drawn, ms    bound, ms    speed-up\n";
    for (const SimulatedFrame& frame : balance.frames)
        text += fmt::format("{:>7} {:>20.3f} {:>15.3f} {:>12.3f} {:>11.1f}\n", frame.workers,
                            frame.in_rows, frame.as_drawn, frame.bound,
                            balance.frames.front().as_drawn / frame.as_drawn);
    return text;
}

}  // namespace burnish::app
