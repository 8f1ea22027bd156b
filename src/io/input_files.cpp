#include "io/input_files.hpp"

#include <algorithm>
#include <string>

#include "io/scene_io_toml.hpp"

namespace burnish {
namespace {

/// Adds the files that texts of `node` name, relative to `directory`, and those that these name if
/// they are TOML. Throws Error for one of those that cannot be parsed.
void collect_files(const toml::node& node, const std::filesystem::path& directory,
                   std::vector<std::filesystem::path>& found);

void collect_file(const std::filesystem::path& file, std::vector<std::filesystem::path>& found) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return;
    if (std::find(found.begin(), found.end(), file) != found.end()) return;
    found.push_back(file);
    if (file.extension() == ".toml")
        collect_files(parse_scene(file, {}), file.parent_path(), found);
}

void collect_files(const toml::node& node, const std::filesystem::path& directory,
                   std::vector<std::filesystem::path>& found) {
    constexpr std::size_t kLongestName = 4096;
    if (const toml::table* table = node.as_table()) {
        for (const auto& [key, each] : *table) collect_files(each, directory, found);
    } else if (const toml::array* array = node.as_array()) {
        for (const toml::node& each : *array) collect_files(each, directory, found);
    } else if (node.is_string()) {
        const std::string& text = node.as_string()->get();
        if (text.empty() || text.size() > kLongestName || text.find('\0') != std::string::npos)
            return;
        collect_file(directory / text, found);
    }
}

}  // namespace

std::vector<std::filesystem::path> find_input_files(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> found{path};
    if (path.extension() == ".toml")
        collect_files(parse_scene(path, {}), path.parent_path(), found);
    return found;
}

}  // namespace burnish
