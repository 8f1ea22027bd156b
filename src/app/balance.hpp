#pragma once

#include <burnish/renderer.hpp>
#include <string>
#include <vector>

/// How evenly the tiles of a frame would keep many workers busy: simulated from the tiles' times on
/// one worker.
namespace burnish::app {

/// The frame for a number of workers, ms: transform, setup and bins divided evenly among them, what
/// is prepared by one of them, and the tiles.
struct SimulatedFrame {
    int workers = 1;
    double in_rows = 0.0;   ///< tiles row by row, the next one to whoever is free
    double as_drawn = 0.0;  ///< in the renderer's order
    double bound = 0.0;     ///< no schedule can do better: an even share, or the longest tile
};

struct Balance {
    std::vector<TileCost> tiles;  ///< the median of each over the frames
    double tiles_ms = 0.0;        ///< of all of them
    double mean_ms = 0.0;         ///< of those with fragments
    double longest_ms = 0.0;
    std::vector<SimulatedFrame> frames;  ///< 1 .. 64 workers
};

/// @param frames  of one worker, accounted for; not empty, all of the same scene
Balance simulate_balance(const std::vector<FrameStats>& frames);

/// One object, one line.
std::string balance_json(const Balance& balance);
/// Histograms and a table.
std::string balance_text(const Balance& balance);

}  // namespace burnish::app
