#pragma once

#include <burnish/view_state.hpp>
#include <filesystem>

/// States of the viewer behind files.hpp; the contract stands there.
namespace burnish {

ViewState read_view_state_file(const std::filesystem::path& path);

}  // namespace burnish
