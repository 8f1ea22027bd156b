#pragma once

#include <burnish/combiner.hpp>
#include <burnish/program_place.hpp>
#include <burnish/texture_shader.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Programs as text: `!!RC1.0` and `!!TS1.0`, the languages of NVIDIA's nvparse, and `!!BRN1.0`,
/// RC1.0 without its limits. docs/programs.md says what the languages are.
///
/// Any bytes can be parsed: the result is a program or a list of errors, in time proportional to
/// the text and without a copy of it. Safe from several threads.
namespace burnish {

/// What is wrong with a text, and where. The message is one printable line.
struct TextError {
    std::size_t line = 1;    ///< from 1
    std::size_t column = 1;  ///< from 1, in bytes
    std::string message;     ///< what was found, what was expected
};

/// Parsing stops at this many errors.
inline constexpr std::size_t kMaxTextErrors = 32;

/// A program, or the reasons why there is none in the order of the text.
template <class Program>
struct Parsed {
    std::optional<Program> program;  ///< present if and only if `errors` is empty
    std::vector<TextError> errors;
    ProgramLines lines;  ///< of a combiner program
};

/// `!!RC1.0` or `!!BRN1.0`. The program runs on some machine, not on every one:
/// CombinerProgram::validate says on which. A text without general stages gives one idle stage,
/// which the hardware needs.
Parsed<CombinerProgram> parse_combiners(std::string_view text);

/// `!!TS1.0` with our names for the operations of NV_texture_shader3 and for the NV2A's BRDF mode.
Parsed<TextureShader> parse_texture_shader(std::string_view text);

/// Canonical text in `!!RC1.0`, or in `!!BRN1.0` if the program needs it. parse_combiners turns it
/// into the same program again, up to what makes no difference: the component that an input names
/// of zero, and constants beyond [0, 1], which are clamped; a program without general stages comes
/// back with one that is idle. Numbers in it have as many digits as a float needs.
/// Throws Error{bad_program} for a program that no machine can run or no text can say: a fog colour
/// and switches that OpenGL never had (mux_bit, blue to alpha, complements) belong to the material.
std::string print_combiners(const CombinerProgram& program);

/// Canonical `!!TS1.0` text with four statements. Throws Error{bad_program} for what no text can
/// say: dot products that do not lead to an operation, references to tex3 or to later units, fields
/// that the operation has no use for and that are not at their initial value.
std::string print_texture_shader(const TextureShader& shader);

/// The braces of one general stage, with its constants but without fetches before it; switches that
/// no text can say are left out.
std::string print_stage(const GeneralStage& stage);

/// The statements of the final combiner, likewise.
std::string print_final(const FinalCombiner& final);

/// One input as programs write it, with its component: "expand(tex0.rgb)", "-spare0.a", "one".
std::string print_input(const Input& input);

/// "tex4 = table_2d(spare0.r, expand(spare0.a))"
std::string print_fetch(const StageFetch& fetch);

/// The statement for unit 0 .. 3 as print_texture_shader has it: "dependent_gb(tex0)". Throws
/// Error{bad_program} for a shader without words for each of its operations.
std::string print_texture_unit(const TextureShader& shader, int unit);

}  // namespace burnish
