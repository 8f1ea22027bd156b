#include "io/png_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

namespace burnish {
namespace {

/// CRC-32 of ISO 3309, the one of PNG chunks, eight bits at a time.
constexpr std::array<std::uint32_t, 256> crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320U ^ (c >> 1) : c >> 1;
        table[i] = c;
    }
    return table;
}

std::uint32_t crc(std::uint32_t state, std::span<const char> bytes) {
    static constexpr std::array<std::uint32_t, 256> kTable = crc_table();
    for (const char byte : bytes)
        state = kTable[(state ^ static_cast<unsigned char>(byte)) & 0xff] ^ (state >> 8);
    return state;
}

std::uint32_t big_endian(std::span<const char, 4> bytes) {
    std::uint32_t value = 0;
    for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
    return value;
}

/// Reads exactly `bytes.size()` bytes; false at the end of the file.
bool read(std::ifstream& file, std::span<char> bytes) {
    return static_cast<bool>(file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())));
}

enum class Chunk { sound, last, cut_short, wrong_checksum };

Chunk check_chunk(std::ifstream& file) {
    std::array<char, 8> head{};
    if (!read(file, head)) return Chunk::cut_short;
    const std::string_view type(head.data() + 4, 4);
    std::uint32_t left = big_endian(std::span(head).first<4>());
    std::uint32_t state = crc(0xffffffffU, std::span(head).subspan(4));
    std::array<char, 16384> buffer{};
    while (left > 0) {
        const std::span<char> part =
            std::span(buffer).first(std::min<std::size_t>(left, buffer.size()));
        if (!read(file, part)) return Chunk::cut_short;
        state = crc(state, part);
        left -= static_cast<std::uint32_t>(part.size());
    }
    std::array<char, 4> expected{};
    if (!read(file, expected)) return Chunk::cut_short;
    if (big_endian(expected) != (state ^ 0xffffffffU)) return Chunk::wrong_checksum;
    return type == "IEND" ? Chunk::last : Chunk::sound;
}

}  // namespace

void require_sound_png(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 8> signature{};
    if (!read(file, signature) ||
        std::string_view(signature.data(), 8) != std::string_view("\x89PNG\r\n\x1a\n", 8))
        return;
    Chunk chunk = Chunk::sound;
    while (chunk == Chunk::sound) chunk = check_chunk(file);
    if (chunk == Chunk::cut_short)
        throw Error(
            ErrorCode::bad_input,
            fmt::format("{}: damaged image: the PNG ends before its IEND chunk", path.string()));
    if (chunk == Chunk::wrong_checksum)
        throw Error(
            ErrorCode::bad_input,
            fmt::format("{}: damaged image: a PNG chunk has the wrong checksum", path.string()));
}

}  // namespace burnish
