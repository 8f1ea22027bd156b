#pragma once

#include <string>

#include "app/options/option.hpp"

namespace burnish::app {

/// burnish(1) in the language of groff's man macros.
std::string manual_page(const Verb& root);

}  // namespace burnish::app
