#include <fmt/format.h>

#include <array>
#include <bit>

#include "io/mesh_ply_header.hpp"
#include "io/mesh_text.hpp"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "BinaryValues swaps big-endian files");

/// The values after an ASCII header, one by one; line ends do not matter.
class AsciiValues {
  public:
    AsciiValues(const MeshText& file, const PlyHeader& header)
        : m_file(file),
          m_rest(file.bytes.substr(header.body_offset)),
          m_line(header.line_count + 1) {}

    double read(PlyType type) {
        skip_blanks();
        std::string_view rest = m_rest;
        double value = 0.0;
        if (is_float(type)) {
            float x = 0.0F;
            if (!take_float(rest, x) || !at_end_of_word(rest)) fail_expected("a number");
            value = static_cast<double>(x);
        } else {
            std::int64_t x = 0;
            if (!take_integer(rest, x) || !at_end_of_word(rest)) fail_expected("a whole number");
            value = static_cast<double>(x);
        }
        m_rest = rest;
        return value;
    }
    /// Whether `count` more values can be there.
    [[nodiscard]] bool can_hold(double count, PlyType) const {
        return 2.0 * count <= static_cast<double>(m_rest.size()) + 1.0;
    }
    [[noreturn]] void fail(const std::string& message) const {
        mesh_error(m_file, m_line, message);
    }

  private:
    static bool at_end_of_word(std::string_view rest) {
        return rest.empty() || is_blank(rest.front()) || rest.front() == '\n';
    }
    void skip_blanks() {
        while (!m_rest.empty() && (is_blank(m_rest.front()) || m_rest.front() == '\n')) {
            if (m_rest.front() == '\n') ++m_line;
            m_rest.remove_prefix(1);
        }
    }
    [[noreturn]] void fail_expected(std::string_view what) const {
        if (m_rest.empty()) fail(fmt::format("found the end of the file, expected {}", what));
        const std::string_view word = m_rest.substr(0, m_rest.find_first_of(" \t\r\n"));
        fail(fmt::format("found {}, expected {}", in_quotes(word), what));
    }

    const MeshText& m_file;
    std::string_view m_rest;
    std::size_t m_line;
};

/// The values after a binary header.
template <std::endian kOrder>
class BinaryValues {
  public:
    BinaryValues(const MeshText& file, const PlyHeader& header)
        : m_file(file), m_rest(file.bytes.substr(header.body_offset)) {}

    double read(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t>();
            case PlyType::uint8:
                return take<std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t>();
            case PlyType::uint16:
                return take<std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t>();
            case PlyType::uint32:
                return take<std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(take<float>());
            case PlyType::float64:
                return take<double>();
        }
        return 0.0;
    }
    [[nodiscard]] bool can_hold(double count, PlyType type) const {
        return count * static_cast<double>(ply_size(type)) <= static_cast<double>(m_rest.size());
    }
    [[noreturn]] void fail(const std::string& message) const { mesh_error(m_file, 0, message); }

  private:
    template <class T>
    T take() {
        if (m_rest.size() < sizeof(T)) fail("the file ends before its last element");
        std::array<char, sizeof(T)> bytes;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bytes[i] = m_rest[kOrder == std::endian::little ? i : sizeof(T) - 1 - i];
        m_rest.remove_prefix(sizeof(T));
        return std::bit_cast<T>(bytes);
    }

    const MeshText& m_file;
    std::string_view m_rest;
};

template <class Values>
class BodyParser {
  public:
    BodyParser(const PlyHeader& header, Values values) : m_values(values) {
        const PlyElement& vertex = *header.find("vertex");
        m_vertex_count = vertex.count;
        m_has_normals =
            vertex.has(PlyRole::nx) && vertex.has(PlyRole::ny) && vertex.has(PlyRole::nz);
        m_has_uvs = vertex.has(PlyRole::u) && vertex.has(PlyRole::v);
        // Uvs of faces come after those of vertices, also where the file has its faces first.
        if (m_has_uvs) m_soup.uvs.resize(m_vertex_count);
    }

    void parse(const PlyElement& element) {
        if (element.properties.empty()) return;
        if (element.name == "vertex")
            parse_vertices(element);
        else if (element.name == "face")
            parse_faces(element);
        else
            for (std::uint64_t i = 0; i < element.count; ++i) parse_row(element, i);
    }
    MeshSoup take_soup() { return std::move(m_soup); }

  private:
    /// One element: scalars go to m_scalars, the two lists that matter to m_indices and
    /// m_texcoords.
    void parse_row(const PlyElement& element, std::uint64_t row) {
        m_indices.clear();
        m_texcoords.clear();
        for (const PlyProperty& property : element.properties) {
            if (!property.is_list) {
                m_scalars[static_cast<std::size_t>(property.role)] = m_values.read(property.type);
                continue;
            }
            const double count = m_values.read(property.count_type);
            if (count < 0.0 || !m_values.can_hold(count, property.type))
                m_values.fail(fmt::format("{} {}: a list of {}, which the file is too short for",
                                          element.name, row, count));
            for (double i = 0.0; i < count; ++i) add(property, m_values.read(property.type));
        }
    }

    void add(const PlyProperty& property, double value) {
        if (property.role == PlyRole::vertex_indices) m_indices.push_back(value);
        if (property.role == PlyRole::texcoord) m_texcoords.push_back(static_cast<float>(value));
    }

    [[nodiscard]] float scalar(PlyRole role) const {
        return static_cast<float>(m_scalars[static_cast<std::size_t>(role)]);
    }

    void parse_vertices(const PlyElement& element) {
        m_soup.positions.reserve(element.count);
        if (m_has_normals) m_soup.normals.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            parse_row(element, i);
            m_soup.positions.emplace_back(scalar(PlyRole::x), scalar(PlyRole::y),
                                          scalar(PlyRole::z));
            if (m_has_normals)
                m_soup.normals.emplace_back(scalar(PlyRole::nx), scalar(PlyRole::ny),
                                            scalar(PlyRole::nz));
            if (m_has_uvs) m_soup.uvs[i] = {scalar(PlyRole::u), scalar(PlyRole::v)};
        }
    }

    void parse_faces(const PlyElement& element) {
        m_soup.polygon_end.reserve(element.count);
        m_soup.corners.reserve(3 * element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            parse_row(element, i);
            if (!m_texcoords.empty() && m_texcoords.size() != 2 * m_indices.size())
                m_values.fail(fmt::format("face {}: {} values in texcoord, expected {}", i,
                                          m_texcoords.size(), 2 * m_indices.size()));
            for (std::size_t k = 0; k < m_indices.size(); ++k) add_corner(i, k);
            m_soup.polygon_end.push_back(static_cast<std::uint32_t>(m_soup.corners.size()));
        }
    }

    void add_corner(std::uint64_t face, std::size_t k) {
        const double index = m_indices[k];
        if (index < 0.0 || index >= static_cast<double>(m_vertex_count))
            m_values.fail(fmt::format("face {}: vertex index {}, but the file has {} vertices",
                                      face, index, m_vertex_count));
        const auto vertex = static_cast<std::uint32_t>(index);
        SoupCorner corner{vertex, m_has_uvs ? vertex : kNoIndex, m_has_normals ? vertex : kNoIndex};
        if (!m_texcoords.empty()) {
            corner.uv = static_cast<std::uint32_t>(m_soup.uvs.size());
            m_soup.uvs.emplace_back(m_texcoords[2 * k], m_texcoords[2 * k + 1]);
        }
        m_soup.corners.push_back(corner);
    }

    Values m_values;
    std::uint64_t m_vertex_count = 0;
    bool m_has_normals = false;
    bool m_has_uvs = false;
    std::array<double, static_cast<std::size_t>(PlyRole::ignored) + 1> m_scalars{};
    std::vector<double> m_indices;
    std::vector<float> m_texcoords;
    MeshSoup m_soup;
};

template <class Values>
MeshSoup parse_body(const MeshText& file, const PlyHeader& header) {
    BodyParser<Values> body(header, Values(file, header));
    for (const PlyElement& element : header.elements) body.parse(element);
    return body.take_soup();
}

}  // namespace

MeshSoup parse_ply(const MeshText& file) {
    const PlyHeader header = parse_ply_header(file);
    switch (header.format) {
        case PlyFormat::ascii:
            return parse_body<AsciiValues>(file, header);
        case PlyFormat::binary_little_endian:
            return parse_body<BinaryValues<std::endian::little>>(file, header);
        case PlyFormat::binary_big_endian:
            return parse_body<BinaryValues<std::endian::big>>(file, header);
    }
    return {};
}

}  // namespace burnish
