#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "io/mesh_text.hpp"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies");

constexpr std::size_t kHeaderBytes = 84;  // 80 of text, then the number of facets
constexpr std::size_t kFacetBytes = 50;   // normal, three corners, two bytes of attributes

std::uint32_t facet_count(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof(count), sizeof(count));
    return count;
}

void add_corner(MeshSoup& soup, const glm::vec3& position) {
    soup.corners.push_back({static_cast<std::uint32_t>(soup.positions.size()), kNoIndex, kNoIndex});
    soup.positions.push_back(position);
}

void close_polygon(MeshSoup& soup) {
    soup.polygon_end.push_back(static_cast<std::uint32_t>(soup.corners.size()));
}

MeshSoup parse_binary(const MeshText& file) {
    if (file.bytes.size() < kHeaderBytes)
        mesh_error(file, 0,
                   fmt::format("{} bytes, expected a header of {}, or text that begins "
                               "with 'solid'",
                               file.bytes.size(), kHeaderBytes));
    const std::size_t count = facet_count(file.bytes);
    if (file.bytes.size() < kHeaderBytes + count * kFacetBytes)
        mesh_error(file, 0,
                   fmt::format("{} bytes, expected {} for {} facets", file.bytes.size(),
                               kHeaderBytes + count * kFacetBytes, count));
    MeshSoup soup;
    soup.positions.reserve(3 * count);
    soup.corners.reserve(3 * count);
    soup.polygon_end.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        constexpr std::size_t kNormalBytes = 12;
        glm::vec3 corners[3];
        std::memcpy(corners, file.bytes.data() + kHeaderBytes + i * kFacetBytes + kNormalBytes,
                    sizeof(corners));
        for (const glm::vec3& corner : corners) add_corner(soup, corner);
        close_polygon(soup);
    }
    return soup;
}

MeshSoup parse_ascii(const MeshText& file) {
    MeshSoup soup;
    bool in_loop = false;
    LineReader lines(file, LineReader::Continuation::none);
    while (lines.next()) {
        LineWords line = lines.words();
        const std::string_view word = line.word();
        if (word == "vertex") {
            if (!in_loop) line.fail("a vertex outside 'outer loop' and 'endloop'");
            glm::vec3 position;
            for (int i = 0; i < 3; ++i) position[i] = line.number();
            add_corner(soup, position);
        } else if (word == "outer") {
            if (in_loop) line.fail("found 'outer', expected 'vertex' or 'endloop'");
            in_loop = true;
        } else if (word == "endloop") {
            if (!in_loop) line.fail("found 'endloop' without 'outer loop'");
            in_loop = false;
            close_polygon(soup);
        } else if (word != "facet" && word != "endfacet" && word != "solid" && word != "endsolid" &&
                   !word.empty()) {
            line.fail(
                fmt::format("found {}, expected 'facet', 'vertex' or the like", in_quotes(word)));
        }
    }
    if (in_loop) mesh_error(file, lines.line_number(), "the file ends before 'endloop'");
    return soup;
}

}  // namespace

MeshSoup parse_stl(const MeshText& file) {
    // Some binary files begin with "solid" all the same; their size gives them away.
    const bool exact_binary =
        file.bytes.size() >= kHeaderBytes &&
        file.bytes.size() == kHeaderBytes + facet_count(file.bytes) * kFacetBytes;
    return !exact_binary && file.bytes.starts_with("solid") ? parse_ascii(file)
                                                            : parse_binary(file);
}

}  // namespace burnish
