#pragma once

#include <burnish/combiner.hpp>
#include <string_view>

#include "program/dialect.hpp"
#include "program/reader.hpp"

/// Registers with their mappings and components, as they stand on both sides of '='.
namespace burnish {

/// Where an operand stands decides its default mapping and component, and what it may read.
enum class Place { rgb, alpha, final_rgb, final_alpha };

constexpr bool is_final(Place place) {
    return place == Place::final_rgb || place == Place::final_alpha;
}
constexpr bool is_scalar(Place place) {
    return place == Place::alpha || place == Place::final_alpha;
}

struct Operand {
    Input input;
    Token token;  ///< the register, for errors
};

/// A register as a word; `one` is read as zero, and said to be.
struct NamedRegister {
    Register reg = Register::zero;
    bool one = false;
    Token token;
};

/// Takes a register of any kind, or fails. Complains about units that the language does not have.
NamedRegister take_register(Reader& reader, const Dialect& dialect);

/// Takes `[-] [mapping (] register[.component] [)]`. Complains about what `place` cannot read.
/// `one` becomes zero behind another mapping; zero has the place's default component.
Operand take_operand(Reader& reader, const Dialect& dialect, Place place);

/// Takes the register that an operation of a portion writes; complains if it cannot be written.
Register take_destination(Reader& reader, const Dialect& dialect, Place place);

/// Fails: the next token should have been `expected`, of which `words` are the words.
[[noreturn]] void fail_word(Reader& reader, std::string_view expected,
                            std::span<const std::string_view> words);

}  // namespace burnish
