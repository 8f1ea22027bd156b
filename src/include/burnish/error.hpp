#pragma once

#include <stdexcept>
#include <string>

namespace burnish {

/// What went wrong, for callers that act on it. The message says the rest.
enum class ErrorCode {
    bad_option,  ///< an argument of a call or of the command line: unknown name, value out of range
    bad_input,   ///< the bytes of a file: truncated, malformed, inconsistent
    bad_program,  ///< a combiner program that the machine cannot run
    io,           ///< a file that cannot be opened, read, written or renamed
    limit,        ///< a size beyond what burnish handles, or memory that is not there
    stopped,      ///< the caller's own wish: RendererOptions::stop
};

/// The one exception type that leaves the library, but for std::bad_alloc out of what makes meshes,
/// textures and frames.
/// `what()` is one line: where (FILE:LINE where there is one), what was found, what was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& message) : std::runtime_error(message), m_code(code) {}
    [[nodiscard]] ErrorCode code() const noexcept { return m_code; }

  private:
    ErrorCode m_code;
};

}  // namespace burnish
