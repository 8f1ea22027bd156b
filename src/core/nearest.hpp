#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// Edits (insert, delete, replace, swap of neighbours) that turn `a` into `b`.
/// Optimal string alignment: Damerau 1964, Levenshtein 1966.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

/// The name that `word` was probably meant to be: the first of the closest, at most a third of its
/// letters (and at least one) away; empty if none is that close.
inline std::string_view nearest_name(std::string_view word,
                                     std::span<const std::string_view> names) {
    constexpr std::size_t kLongestWord = 64;
    std::string_view best;
    if (word.size() > kLongestWord) return best;
    std::size_t limit = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string_view name : names) {
        const std::size_t distance = edit_distance(word, name);
        if (distance >= limit) continue;
        limit = distance;
        best = name;
    }
    return best;
}

/// End of a message about an unknown name: "did you mean 'nv2a'?", or, where nothing is near,
/// "expected geforce256, nv2a, ideal"; "there is none" without names.
inline std::string expected_one_of(std::string_view word, std::span<const std::string_view> names) {
    if (names.empty()) return "there is none";
    const std::string_view near = nearest_name(word, names);
    if (!near.empty()) return "did you mean '" + std::string(near) + "'?";
    std::string list = "expected ";
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i != 0) list += ", ";
        list += names[i];
    }
    return list;
}

}  // namespace burnish
