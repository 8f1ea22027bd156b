#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "io/mesh_text.hpp"

namespace burnish {
namespace {

/// How many elements of each kind a file has, or has had so far.
struct Counts {
    std::size_t positions = 0;
    std::size_t uvs = 0;
    std::size_t normals = 0;
    std::size_t faces = 0;
};

Counts count_elements(const MeshText& file) {
    Counts counts;
    LineReader lines(file, LineReader::Continuation::backslash);
    while (lines.next()) {
        const std::string_view kind = lines.words().word();
        if (kind == "v")
            ++counts.positions;
        else if (kind == "vt")
            ++counts.uvs;
        else if (kind == "vn")
            ++counts.normals;
        else if (kind == "f")
            ++counts.faces;
    }
    return counts;
}

/// Zero-based index of element `index` (1 = first, -1 = last so far).
std::uint32_t resolve(const LineWords& line, std::string_view kind, std::int64_t index,
                      std::size_t so_far, std::size_t total) {
    const auto last = static_cast<std::int64_t>(total);
    const auto back = static_cast<std::int64_t>(so_far);
    if (index >= 1 && index <= last) return static_cast<std::uint32_t>(index - 1);
    if (index < 0 && index >= -back) return static_cast<std::uint32_t>(back + index);
    if (total == 0)
        line.fail(fmt::format("{} index {}, but the file has no {}", kind, index, kind));
    if (index < 0)
        line.fail(fmt::format("{} index {}, expected at least -{}", kind, index, so_far));
    line.fail(fmt::format("{} index {}, expected 1 to {}", kind, index, total));
}

/// Reads corners of the forms 1, 1/2, 1//3 and 1/2/3.
class FaceParser {
  public:
    explicit FaceParser(const Counts& total) : m_total(total) {}

    void parse(LineWords& line, const MeshSoup& so_far, std::vector<SoupCorner>& corners) const {
        for (std::string_view word = line.word(); !word.empty() && word.front() != '#';
             word = line.word())
            corners.push_back(corner(line, word, so_far));
    }

  private:
    [[nodiscard]] SoupCorner corner(const LineWords& line, std::string_view word,
                                    const MeshSoup& so_far) const {
        std::string_view rest = word;
        SoupCorner result{kNoIndex, kNoIndex, kNoIndex};
        std::int64_t index = 0;
        if (!take_integer(rest, index)) fail(line, word);
        result.position =
            resolve(line, "vertex", index, so_far.positions.size(), m_total.positions);
        if (take_slash(rest) && take_integer(rest, index))
            result.uv = resolve(line, "uv", index, so_far.uvs.size(), m_total.uvs);
        if (take_slash(rest) && take_integer(rest, index))
            result.normal = resolve(line, "normal", index, so_far.normals.size(), m_total.normals);
        if (!rest.empty()) fail(line, word);
        return result;
    }
    static bool take_slash(std::string_view& rest) {
        if (rest.empty() || rest.front() != '/') return false;
        rest.remove_prefix(1);
        return true;
    }
    [[noreturn]] static void fail(const LineWords& line, std::string_view word) {
        line.fail(fmt::format("found {}, expected a corner such as 1, 1/2, 1//3 or 1/2/3",
                              in_quotes(word)));
    }

    Counts m_total;
};

glm::vec3 three_numbers(LineWords& line) {
    const float x = line.number();
    const float y = line.number();
    return {x, y, line.number()};
}

/// A uv may have one, two or three numbers.
glm::vec2 uv_numbers(LineWords& line) {
    glm::vec2 uv(line.number(), 0.0F);
    line.optional_number(uv.y);
    return uv;
}

}  // namespace

MeshSoup parse_obj(const MeshText& file) {
    const Counts total = count_elements(file);
    const FaceParser faces(total);
    MeshSoup soup;
    soup.positions.reserve(total.positions);
    soup.uvs.reserve(total.uvs);
    soup.normals.reserve(total.normals);
    soup.polygon_end.reserve(total.faces);
    soup.corners.reserve(3 * total.faces);
    LineReader lines(file, LineReader::Continuation::backslash);
    while (lines.next()) {
        LineWords line = lines.words();
        const std::string_view kind = line.word();
        if (kind == "v") {
            soup.positions.push_back(three_numbers(line));
        } else if (kind == "vt") {
            soup.uvs.push_back(uv_numbers(line));
        } else if (kind == "vn") {
            soup.normals.push_back(three_numbers(line));
        } else if (kind == "f") {
            faces.parse(line, soup, soup.corners);
            soup.polygon_end.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        }
    }
    return soup;
}

}  // namespace burnish
