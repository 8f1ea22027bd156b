#include "app/options/option.hpp"

#include <algorithm>
#include <cctype>

namespace burnish::app {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(separator), text.size());
        parts.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parts;
}

void add_working_verbs(const VerbPath& path, std::vector<VerbPath>& found) {
    const std::vector<Verb>& verbs = path.back()->verbs;
    if (verbs.empty()) found.push_back(path);
    for (const Verb& verb : verbs) {
        VerbPath longer = path;
        longer.push_back(&verb);
        add_working_verbs(longer, found);
    }
}

}  // namespace

std::vector<std::string> Option::all_names() const {
    return split(names, ',');
}

std::string Option::label() const {
    if (!is_argument()) return all_names().back();
    std::string name = names;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

bool Option::goes_on() const {
    return std::any_of(words.begin(), words.end(), [](std::string_view word) {
        return word.ends_with(':') || word.ends_with('=');
    });
}

std::vector<std::string> Option::extensions() const {
    return files == "/" || files == "*" ? std::vector<std::string>{} : split(files, ' ');
}

std::string whole_name(const VerbPath& path) {
    std::string name;
    for (const Verb* verb : path) name += (name.empty() ? "" : " ") + verb->name;
    return name;
}

std::vector<VerbPath> working_verbs(const Verb& root) {
    std::vector<VerbPath> found;
    add_working_verbs({&root}, found);
    return found;
}

}  // namespace burnish::app
