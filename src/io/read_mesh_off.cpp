#include <fmt/format.h>

#include <string_view>

#include "io/mesh_text.hpp"

namespace burnish {
namespace {

/// What the letters before "OFF" promise for each vertex.
struct OffVariant {
    bool uvs = false;          ///< ST
    bool colors = false;       ///< C
    bool normals = false;      ///< N
    bool homogeneous = false;  ///< 4
};

bool take_prefix(std::string_view& word, std::string_view prefix) {
    if (!word.starts_with(prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
}

/// False if `word` is not an OFF keyword.
bool parse_keyword(std::string_view word, OffVariant& variant) {
    OffVariant found;
    found.uvs = take_prefix(word, "ST");
    found.colors = take_prefix(word, "C");
    found.normals = take_prefix(word, "N");
    found.homogeneous = take_prefix(word, "4");
    if (word != "OFF") return false;
    variant = found;
    return true;
}

class OffParser {
  public:
    explicit OffParser(const MeshText& file)
        : m_file(file), m_lines(file, LineReader::Continuation::none) {}

    MeshSoup parse() {
        parse_header();
        for (std::size_t i = 0; i < m_vertices; ++i) {
            LineWords line = next_line(fmt::format("vertex {} of {}", i, m_vertices));
            parse_vertex(line);
        }
        for (std::size_t i = 0; i < m_faces; ++i) {
            LineWords line = next_line(fmt::format("face {} of {}", i, m_faces));
            parse_face(line);
        }
        return std::move(m_soup);
    }

  private:
    /// The next line with anything but a comment.
    LineWords next_line(const std::string& what) {
        while (m_lines.next()) {
            LineWords ahead = m_lines.words();
            const std::string_view word = ahead.word();
            if (!word.empty() && word.front() != '#') return m_lines.words();
        }
        mesh_error(m_file, m_lines.line_number(), fmt::format("the file ends before {}", what));
    }

    void parse_header() {
        LineWords line = next_line("its counts");
        LineWords ahead = line;
        const std::string_view keyword = ahead.word();
        // The keyword may be missing, and the counts may stand on its line.
        if (parse_keyword(keyword, m_variant)) {
            LineWords rest = ahead;
            const std::string_view second = rest.word();
            if (second == "BINARY") ahead.fail("binary OFF, expected the text form");
            line = second.empty() || second.front() == '#' ? next_line("its counts") : ahead;
        }
        m_vertices = parse_count(line, "vertices");
        m_faces = parse_count(line, "faces");
    }

    std::size_t parse_count(LineWords& line, std::string_view what) const {
        const std::int64_t count = line.integer();
        // An element takes a digit and a line end at the least.
        const auto most = static_cast<std::int64_t>((m_file.bytes.size() + 1) / 2);
        if (count < 0 || count > most)
            line.fail(fmt::format("{} {} in a file of {} bytes", count, what, m_file.bytes.size()));
        return static_cast<std::size_t>(count);
    }

    void parse_vertex(LineWords& line) {
        glm::vec3 position;
        for (int i = 0; i < 3; ++i) position[i] = line.number();
        if (m_variant.homogeneous) position /= line.number();
        m_soup.positions.push_back(position);
        if (m_variant.normals) {
            glm::vec3 normal;
            for (int i = 0; i < 3; ++i) normal[i] = line.number();
            m_soup.normals.push_back(normal);
        }
        if (m_variant.uvs) m_soup.uvs.push_back(last_two_numbers(line));
    }

    /// Colours before the uv may have three or four components.
    [[nodiscard]] glm::vec2 last_two_numbers(LineWords& line) const {
        glm::vec2 uv;
        uv.x = line.number();
        uv.y = line.number();
        for (float value = 0.0F; m_variant.colors && line.optional_number(value);)
            uv = {uv.y, value};
        return uv;
    }

    void parse_face(LineWords& line) {
        const std::int64_t corners = line.integer();
        for (std::int64_t i = 0; i < corners; ++i) {
            const std::int64_t index = line.integer();
            if (index < 0 || index >= static_cast<std::int64_t>(m_vertices))
                line.fail(fmt::format("vertex index {}, but the file has {} vertices", index,
                                      m_vertices));
            const auto vertex = static_cast<std::uint32_t>(index);
            m_soup.corners.push_back(
                {vertex, m_variant.uvs ? vertex : kNoIndex, m_variant.normals ? vertex : kNoIndex});
        }
        if (corners < 0) line.fail(fmt::format("a face of {} corners", corners));
        m_soup.polygon_end.push_back(static_cast<std::uint32_t>(m_soup.corners.size()));
    }

    const MeshText& m_file;
    LineReader m_lines;
    OffVariant m_variant;
    std::size_t m_vertices = 0;
    std::size_t m_faces = 0;
    MeshSoup m_soup;
};

}  // namespace

bool is_off_keyword(std::string_view word) {
    OffVariant variant;
    return parse_keyword(word, variant);
}

MeshSoup parse_off(const MeshText& file) {
    return OffParser(file).parse();
}

}  // namespace burnish
