#include "core/near_file.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/nearest.hpp"

namespace burnish {
namespace {

namespace fs = std::filesystem;

/// Sorted, as a directory has no order of its own; empty if there are too many.
std::vector<std::string> names_beside(const fs::path& path) {
    constexpr std::size_t kMost = 10000;
    std::error_code failure;
    const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::vector<std::string> names;
    for (fs::directory_iterator at(directory, failure), end; !failure && at != end;
         at.increment(failure)) {
        if (names.size() == kMost) return {};
        names.push_back(at->path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

std::string near_file(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(path, ignored))) return {};
    const std::vector<std::string> owned = names_beside(path);
    const std::vector<std::string_view> names(owned.begin(), owned.end());
    const std::string wanted = path.filename().string();
    const std::string_view near = nearest_name(wanted, names);
    // "a.png" is not "b.png": something of the name has to be left.
    if (near.empty() || edit_distance(wanted, near) >= path.stem().string().size()) return {};
    return ", did you mean '" + (path.parent_path() / near).string() + "'?";
}

}  // namespace burnish
