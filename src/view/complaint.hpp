#pragma once

#include <exception>
#include <new>
#include <string>

namespace burnish::view {

/// What went wrong, in one line for the window.
inline std::string complaint(const std::exception& error) {
    return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? "out of memory" : error.what();
}

}  // namespace burnish::view
