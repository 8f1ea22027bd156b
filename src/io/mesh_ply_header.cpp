#include "io/mesh_ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/mesh_text.hpp"

namespace burnish {
namespace {

PlyType parse_type(LineWords& line) {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
        {"char", PlyType::int8},
        {"int8", PlyType::int8},
        {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},
        {"short", PlyType::int16},
        {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},
        {"uint16", PlyType::uint16},
        {"int", PlyType::int32},
        {"int32", PlyType::int32},
        {"uint", PlyType::uint32},
        {"uint32", PlyType::uint32},
        {"float", PlyType::float32},
        {"float32", PlyType::float32},
        {"double", PlyType::float64},
        {"float64", PlyType::float64},
    }};
    const std::string_view word = line.word();
    for (const auto& [name, type] : kNames)
        if (name == word) return type;
    line.fail(fmt::format("found {}, expected a type such as float or int", in_quotes(word)));
}

PlyRole vertex_role(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, PlyRole>, 14> kNames{{
        {"x", PlyRole::x},
        {"y", PlyRole::y},
        {"z", PlyRole::z},
        {"nx", PlyRole::nx},
        {"ny", PlyRole::ny},
        {"nz", PlyRole::nz},
        {"u", PlyRole::u},
        {"s", PlyRole::u},
        {"texture_u", PlyRole::u},
        {"texture_s", PlyRole::u},
        {"v", PlyRole::v},
        {"t", PlyRole::v},
        {"texture_v", PlyRole::v},
        {"texture_t", PlyRole::v},
    }};
    for (const auto& [known, role] : kNames)
        if (known == name) return role;
    return PlyRole::ignored;
}

PlyRole face_role(std::string_view name) {
    if (name == "vertex_indices" || name == "vertex_index") return PlyRole::vertex_indices;
    return name == "texcoord" ? PlyRole::texcoord : PlyRole::ignored;
}

PlyFormat parse_format(LineWords& line) {
    const std::string_view word = line.word();
    if (word == "ascii") return PlyFormat::ascii;
    if (word == "binary_little_endian") return PlyFormat::binary_little_endian;
    if (word == "binary_big_endian") return PlyFormat::binary_big_endian;
    line.fail(fmt::format("found {}, expected ascii, binary_little_endian or binary_big_endian",
                          in_quotes(word)));
}

PlyElement parse_element(LineWords& line) {
    PlyElement element;
    element.name = line.word();
    element.line = line.line_number();
    const std::int64_t count = line.integer();
    if (count < 0) line.fail(fmt::format("{} elements, expected 0 or more", count));
    element.count = static_cast<std::uint64_t>(count);
    return element;
}

PlyProperty parse_property(LineWords& line, std::string_view element) {
    PlyProperty property;
    LineWords ahead = line;
    if (ahead.word() == "list") {
        line = ahead;
        property.is_list = true;
        property.count_type = parse_type(line);
        if (is_float(property.count_type)) line.fail("list counts are not whole numbers");
    }
    property.type = parse_type(line);
    const std::string_view name = line.word();
    if (element == "vertex" && !property.is_list) property.role = vertex_role(name);
    if (element == "face" && property.is_list) property.role = face_role(name);
    if (property.role == PlyRole::vertex_indices && is_float(property.type))
        line.fail("vertex indices are not whole numbers");
    return property;
}

/// Every element takes some bytes, so that a count beyond the file is found before it is believed.
void check_counts(const MeshText& file, const PlyHeader& header) {
    const bool ascii = header.format == PlyFormat::ascii;
    const std::uint64_t left = file.bytes.size() - header.body_offset;
    for (const PlyElement& element : header.elements) {
        std::uint64_t least = 0;
        for (const PlyProperty& property : element.properties) {
            constexpr std::size_t kDigitAndBlank = 2;
            least += ascii ? kDigitAndBlank
                           : ply_size(property.is_list ? property.count_type : property.type);
        }
        // The last value of an ASCII file may lack its blank.
        if (least != 0 && element.count > (left + (ascii ? 1 : 0)) / least)
            mesh_error(file, element.line,
                       fmt::format("{} elements '{}', but only {} bytes follow the header",
                                   element.count, element.name, left));
    }
}

void check_positions(const MeshText& file, const PlyHeader& header) {
    const PlyElement* vertices = header.find("vertex");
    if (vertices == nullptr) mesh_error(file, 0, "no element 'vertex' in the header");
    for (const auto& [role, name] :
         {std::pair{PlyRole::x, "x"}, std::pair{PlyRole::y, "y"}, std::pair{PlyRole::z, "z"}})
        if (!vertices->has(role))
            mesh_error(file, vertices->line,
                       fmt::format("element 'vertex' lacks the property '{}'", name));
}

}  // namespace

std::size_t ply_size(PlyType type) {
    static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

bool PlyElement::has(PlyRole role) const {
    return std::any_of(properties.begin(), properties.end(),
                       [&](const PlyProperty& property) { return property.role == role; });
}

const PlyElement* PlyHeader::find(std::string_view name) const {
    const auto found =
        std::find_if(elements.begin(), elements.end(),
                     [&](const PlyElement& element) { return element.name == name; });
    return found != elements.end() ? &*found : nullptr;
}

PlyHeader parse_ply_header(const MeshText& file) {
    PlyHeader header;
    bool has_format = false;
    LineReader lines(file, LineReader::Continuation::none);
    if (!lines.next() || lines.words().word() != "ply")
        mesh_error(file, 1, "expected 'ply' on the first line");
    while (true) {
        if (!lines.next())
            mesh_error(file, lines.line_number(), "the file ends before 'end_header'");
        LineWords line = lines.words();
        const std::string_view word = line.word();
        if (word == "end_header") break;
        if (word == "format") {
            header.format = parse_format(line);
            has_format = true;
        } else if (word == "element") {
            PlyElement element = parse_element(line);
            if (header.find(element.name) != nullptr)
                line.fail(fmt::format("element {} for the second time", in_quotes(element.name)));
            header.elements.push_back(std::move(element));
        } else if (word == "property") {
            if (header.elements.empty()) line.fail("a property before any element");
            PlyElement& element = header.elements.back();
            element.properties.push_back(parse_property(line, element.name));
        } else if (word != "comment" && word != "obj_info" && !word.empty()) {
            line.fail(
                fmt::format("found {}, expected a header line such as 'element' or 'property'",
                            in_quotes(word)));
        }
    }
    if (!has_format) mesh_error(file, lines.line_number(), "the header lacks a 'format' line");
    header.line_count = lines.line_number();
    header.body_offset = lines.offset();
    check_positions(file, header);
    check_counts(file, header);
    return header;
}

}  // namespace burnish
