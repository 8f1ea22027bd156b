#include "lab/document_section.hpp"

#include <fmt/format.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <string>

#include "core/read_text.hpp"

namespace burnish::lab {

void replace_section(const std::filesystem::path& file, std::string_view name,
                     std::string_view text) {
    const std::string old = read_text(file);
    const std::string begin = fmt::format("<!-- begin {} -->\n", name);
    const std::string end = fmt::format("<!-- end {} -->\n", name);
    const std::size_t from = old.find(begin);
    const std::size_t to = from == std::string::npos ? from : old.find(end, from);
    if (to == std::string::npos) {
        throw Error(ErrorCode::bad_input, fmt::format("{}: expected the lines '<!-- begin {} -->' "
                                                      "and '<!-- end {} -->'",
                                                      file.string(), name, name));
    }
    save_text(old.substr(0, from + begin.size()) + std::string(text) + old.substr(to), file);
}

}  // namespace burnish::lab
