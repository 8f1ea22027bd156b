#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace burnish::lab {

/// FNV-1a of 64 bits (Fowler, Noll, Vo 1991; RFC 9923): tells files and descriptions apart, against
/// accidents and not against attackers.
class Fingerprint {
  public:
    void add(std::string_view bytes) {
        for (const char c : bytes) {
            m_value ^= static_cast<unsigned char>(c);
            m_value *= 0x100000001b3U;
        }
    }
    /// 16 hexadecimal digits.
    [[nodiscard]] std::string text() const;

  private:
    std::uint64_t m_value = 0xcbf29ce484222325U;
};

std::string fingerprint(std::string_view bytes);

/// Of a whole file. Throws Error{io} if it cannot be read.
std::string file_fingerprint(const std::filesystem::path& file);

/// Of the running program and the library that draws. Another build may draw other bits, so
/// results of one are none of the other.
const std::string& build_fingerprint();

}  // namespace burnish::lab
