#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/program_text.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Short ways to say what a text should give.
namespace burnish {

inline std::string listed(const std::vector<TextError>& errors) {
    std::string text;
    for (const TextError& error : errors)
        text += std::to_string(error.line) + ":" + std::to_string(error.column) + ": " +
                error.message + "\n";
    return text;
}

/// The program of a text that has to be right.
inline CombinerProgram combiners(std::string_view text) {
    Parsed<CombinerProgram> parsed = parse_combiners(text);
    EXPECT_TRUE(parsed.errors.empty()) << text << "\n" << listed(parsed.errors);
    return parsed.program.value_or(CombinerProgram());
}
inline TextureShader texture_shader(std::string_view text) {
    Parsed<TextureShader> parsed = parse_texture_shader(text);
    EXPECT_TRUE(parsed.errors.empty()) << text << "\n" << listed(parsed.errors);
    return parsed.program.value_or(TextureShader());
}

/// The only general stage of `!!RC1.0 { body }`.
inline GeneralStage stage(const std::string& body) {
    const CombinerProgram program = combiners("!!RC1.0 {" + body + "}");
    EXPECT_EQ(program.stages.size(), 1U);
    return program.stages.empty() ? GeneralStage() : program.stages.front();
}
inline Portion rgb(const std::string& body) {
    return stage("rgb {" + body + "}").rgb;
}
inline Portion alpha(const std::string& body) {
    return stage("alpha {" + body + "}").alpha;
}
/// The final combiner of a text that consists of its statements.
inline FinalCombiner final_combiner(const std::string& body) {
    return combiners("!!RC1.0 " + body).final_combiner;
}

/// A text with '@' in front of the token that is wrong, and what the message should hold. The text
/// without '@' has to give exactly this error there.
template <class Program>
void expect_error(Parsed<Program> parse(std::string_view), std::string text,
                  std::string_view part) {
    const std::size_t at = text.find('@');
    ASSERT_NE(at, std::string::npos) << text;
    text.erase(at, 1);
    const auto line = static_cast<std::size_t>(std::count(
                          text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) +
                      1;
    const std::size_t line_start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = line_start == std::string::npos ? at + 1 : at - line_start;
    const Parsed<Program> parsed = parse(text);
    ASSERT_EQ(parsed.errors.size(), 1U) << text << "\n" << listed(parsed.errors);
    EXPECT_FALSE(parsed.program.has_value());
    const TextError& error = parsed.errors.front();
    EXPECT_EQ(error.line, line) << text << "\n" << error.message;
    EXPECT_EQ(error.column, column) << text << "\n" << error.message;
    EXPECT_NE(error.message.find(part), std::string::npos) << text << "\n" << error.message;
}

inline void expect_combiner_error(const std::string& text, std::string_view part) {
    expect_error(parse_combiners, text, part);
}
inline void expect_texture_error(const std::string& text, std::string_view part) {
    expect_error(parse_texture_shader, text, part);
}

}  // namespace burnish
