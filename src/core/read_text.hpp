#pragma once

#include <filesystem>
#include <string>

namespace burnish {

/// The bytes of a text file. Throws Error{io} if it cannot be read, Error{limit} beyond 16 MB:
/// programs are a few KB, and a wrong file name should not fill the memory.
std::string read_text(const std::filesystem::path& path);

}  // namespace burnish
