#pragma once

#include <burnish/error.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace burnish {

/// A part of a combiner program: what a machine complains about, and what stands at a line of a
/// text.
struct ProgramPlace {
    enum class Part : std::uint8_t {
        stage,      ///< a general stage as a whole
        constants,  ///< its own ones
        fetches,    ///< those before it
        rgb,        ///< its rgb portion
        alpha,      ///< its alpha portion
        final_combiner,
    };
    /// Statements of a portion; of fetches it is their number, from 1; 0: all of the part.
    enum : std::uint8_t { kAll = 0, kAb = 1, kCd, kThird, kScale };
    /// Statements of the final combiner.
    enum : std::uint8_t { kOutRgb = 1, kOutAlpha, kFinalProduct };

    Part part = Part::stage;
    std::size_t stage = 0;  ///< its number, from 0; 0 in the final combiner
    std::uint8_t statement = kAll;

    friend auto operator<=>(const ProgramPlace&, const ProgramPlace&) = default;
};

/// The line, from 1, at which each part of a program begins in its text.
using ProgramLines = std::map<ProgramPlace, std::size_t>;

/// The line of `place`, or of what it is a statement or a part of; nothing where `lines` has none.
std::optional<std::size_t> line_of(const ProgramPlace& place, const ProgramLines& lines);

/// Error{bad_program} about one part of the program.
class ProgramFault : public Error {
  public:
    ProgramFault(const ProgramPlace& place, const std::string& message)
        : Error(ErrorCode::bad_program, message), m_place(place) {}
    [[nodiscard]] const ProgramPlace& place() const noexcept { return m_place; }

  private:
    ProgramPlace m_place;
};

}  // namespace burnish
