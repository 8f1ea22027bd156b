#pragma once

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <filesystem>
#include <system_error>

namespace burnish::app {

/// A directory to write into, with those above it. Throws Error{io} if it cannot be made.
inline void make_directory(const std::filesystem::path& path) {
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure)
        throw Error(ErrorCode::io, fmt::format("{}: cannot be made a directory: {}", path.string(),
                                               failure.message()));
}

}  // namespace burnish::app
