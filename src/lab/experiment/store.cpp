#include "lab/experiment/store.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <charconv>
#include <sstream>
#include <system_error>

#include "core/read_text.hpp"
#include "lab/experiment/fingerprint.hpp"

namespace burnish::lab {
namespace {

constexpr std::string_view kHead = "burnish cell 1\n";
constexpr std::string_view kResults = "results\n";

std::string text_of(const char* side, const PictureSettings& picture) {
    std::string text = fmt::format("{}: {} samples\n", side, picture.samples);
    for (const ExperimentSetting& setting : picture.settings)
        text += fmt::format("  {} = {}\n", setting.key, setting.value);
    return text;
}

/// "ms 1.5", "refused WHY" or "METRIC VALUE"; false for anything else.
bool read_line(const std::string& line, CellResult& result) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos || space == 0) return false;
    const std::string name = line.substr(0, space);
    if (name == "refused") {
        result.refusal = line.substr(space + 1);
        return !result.refusal.empty();
    }
    double value = 0.0;
    const char* const end = line.data() + line.size();
    const auto [stop, failure] = std::from_chars(line.data() + space + 1, end, value);
    if (failure != std::errc() || stop != end) return false;
    if (name == "ms")
        result.ms = value;
    else if (name == "ms_low")
        result.ms_low = value;
    else if (name == "ms_high")
        result.ms_high = value;
    else
        result.values.push_back({name, value});
    return true;
}

void make_directory(const std::filesystem::path& path) {
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be made a directory: {}", path.string(),
                                               failure.message()));
}

}  // namespace

std::string describe(const Experiment& experiment, const Cell& cell, bool quick,
                     const std::string& inputs, std::optional<float> gain) {
    std::string text = fmt::format("build {}\ninputs {}\nscene {}\n", build_fingerprint(), inputs,
                                   experiment.scenes[cell.test.scene].filename().string());
    text += text_of("test", cell.test) + text_of("reference", cell.reference);
    text += fmt::format("expose {}\n", experiment.expose);
    const ExperimentPan& pan = experiment.pan;
    if (pan.frames > 0)
        text += fmt::format("pan {} frames, {} samples, {} x {} pixels\n",
                            quick ? pan.quick_frames : pan.frames, pan.samples, pan.pixels[0],
                            pan.pixels[1]);
    text += "metrics";
    for (const std::string& name : experiment.metrics) text += " " + name;
    return text + (gain ? fmt::format("\npictures, errors times {}\n", *gain) : "\n");
}

Store::Store(std::filesystem::path directory) : m_directory(std::move(directory)) {
    make_directory(m_directory / "cells");
    make_directory(images());
}

std::filesystem::path Store::file_of(const std::string& description) const {
    return m_directory / "cells" / (fingerprint(description) + ".txt");
}

std::optional<CellResult> Store::find(const std::string& description) const {
    std::error_code ignored;
    const std::filesystem::path file = file_of(description);
    if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
    const std::string text = read_text(file);
    const std::string head = std::string(kHead) + description + std::string(kResults);
    if (!text.starts_with(head) || !text.ends_with("end\n")) return std::nullopt;
    std::istringstream lines(text.substr(head.size(), text.size() - head.size() - 4));
    CellResult result;
    for (std::string line; std::getline(lines, line);)
        if (!read_line(line, result)) return std::nullopt;
    return result;
}

void Store::keep(const std::string& description, const CellResult& result) const {
    std::string text = std::string(kHead) + description + std::string(kResults);
    for (const Measured& each : result.values)
        text += fmt::format("{} {}\n", each.name, each.value);
    if (!result.refusal.empty()) text += fmt::format("refused {}\n", result.refusal);
    save_text(text + fmt::format("ms {}\nms_low {}\nms_high {}\nend\n", result.ms, result.ms_low,
                                 result.ms_high),
              file_of(description));
}

void Store::take(const Store& other) const {
    for (const char* part : {"cells", "images"}) {
        for (const auto& entry : std::filesystem::directory_iterator(other.m_directory / part)) {
            if (!entry.is_regular_file()) continue;
            std::error_code failure;
            std::filesystem::copy_file(entry.path(), m_directory / part / entry.path().filename(),
                                       std::filesystem::copy_options::skip_existing, failure);
            if (failure)
                throw Error(ErrorCode::io, fmt::format("{}: cannot be copied: {}",
                                                       entry.path().string(), failure.message()));
        }
    }
}

}  // namespace burnish::lab
