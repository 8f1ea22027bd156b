#include <array>
#include <chrono>
#include <cstdlib>

#include "program_text.hpp"
#include "random_program.hpp"

/// Texts that nobody wrote: whatever the bytes are, there is a program or there are errors.
namespace burnish {
namespace {

constexpr std::array<std::string_view, 5> kSeeds{
    "!!RC1.0\nconst0 = (0.1, .5, 1., 1);\n{ const1 = (1, 0, 0, 1); rgb { spare0 = expand(tex0) . "
    "-half_bias(col0.a); spare1 = unsigned_invert(tex1) * fog; } alpha { discard = -tex0.b; "
    "discard = one; spare0 = mux(); scale_by_two(); } }\n{ rgb { discard = tex1; } } // end\n"
    "clamp_color_sum();\nfinal_product = fog.a * spare1;\nout.rgb = lerp(spare0, color_sum, "
    "final_product) + const0;\nout.a = spare0.b;\n",
    "!!BRN1.0\n{ wide rgb { discard = tex15 . tex7; discard = zero; spare0 = sum(); } }\n/* x */\n"
    "fetch { tex4 = table_2d(spare0.r, expand(spare0.a)); tex5 = table_3d(tex4.r, tex4.g, "
    "tex4.b); }\nout.rgb = tex5 + tex4; # end",
    "!!TS1.0\ntexture_2d();\ndot_product_2d_1of2(expand(tex0));\ndot_product_2d_2of2(tex0);\n"
    "offset_2d_scale(tex2, 1, -0.5, 0.25, 1, 2, 0.125);\n",
    "!!TS1.0texture_cube_map();\r\ndot_product_reflect_cube_map_const_eye_1of3(tex0, 0, 0, "
    "-1);\r\ndot_product_reflect_cube_map_const_eye_2of3(force_blue_to_one(tex0));\r\n"
    "dot_product_reflect_cube_map_const_eye_3of3(tex0);\r\n",
    "!!TS1.0 cull_fragment(GEQUAL_TO_ZERO, LESS_THAN_ZERO, LESS_THAN_ZERO, LESS_THAN_ZERO); "
    "pass_through(); dependent_gb(tex1); nop();"};

/// Pieces that the languages know.
constexpr std::array<std::string_view, 40> kPieces{
    "{",      "}",       "(",    ")",        ";",         ",",      ".",       "*",
    "+",      "-",       "=",    "/*",       "*/",        "//",     "#",       "\n",
    "\r\n",   " ",       "rgb",  "alpha",    "wide",      "fetch",  "tex0",    "tex15",
    "spare0", "discard", ".rgb", ".a",       ".b",        "sum()",  "mux()",   "lerp(",
    "one",    "expand(", "0.5",  "99999999", "color_sum", "const0", "out.rgb", "nop();"};

std::string mutated(Random& random, std::string text) {
    const int edits = random.between(1, 3);
    for (int i = 0; i < edits && !text.empty(); ++i) {
        const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
        const auto length = static_cast<std::size_t>(random.between(1, 20));
        switch (random.below(7)) {
            case 0:
                text[at] = static_cast<char>(random.below(256));
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, random.pick(kPieces));
                break;
            case 3:
                text.insert(at, text.substr(static_cast<std::size_t>(
                                                random.below(static_cast<int>(text.size()))),
                                            length));
                break;
            case 4:
                text.resize(at);
                break;
            case 5:
                text.replace(at, 1, random.pick(kPieces));
                break;
            default:
                text.insert(at, std::string(length, text[at]));
                break;
        }
    }
    return text;
}

template <class Program>
void expect_sane_errors(const Parsed<Program>& parsed, const std::string& text) {
    ASSERT_NE(parsed.program.has_value(), !parsed.errors.empty()) << text;
    ASSERT_LE(parsed.errors.size(), kMaxTextErrors);
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    std::pair<std::size_t, std::size_t> before{0, 0};
    for (const TextError& error : parsed.errors) {
        ASSERT_GE(std::pair(error.line, error.column), before) << text;
        before = {error.line, error.column};
        ASSERT_LE(error.line, lines) << text;
        ASSERT_LE(error.column, text.size() + 1) << text;
        ASSERT_GT(error.message.size(), 5U);
        ASSERT_LT(error.message.size(), 300U) << error.message;
        for (const char c : error.message) ASSERT_TRUE(c >= 0x20 && c < 0x7F) << error.message;
    }
}

/// True for a program, which some machine runs and which survives printing.
bool check(const std::string& text) {
    const Parsed<CombinerProgram> combiners = parse_combiners(text);
    expect_sane_errors(combiners, text);
    if (combiners.program) {
        EXPECT_NO_THROW(combiners.program->validate(Machine())) << text;
        EXPECT_EQ(parse_combiners(print_combiners(*combiners.program)).program, combiners.program)
            << text;
    }
    const Parsed<TextureShader> shader = parse_texture_shader(text);
    expect_sane_errors(shader, text);
    if (shader.program) {
        EXPECT_EQ(parse_texture_shader(print_texture_shader(*shader.program)).program,
                  shader.program)
            << text;
    }
    return combiners.program || shader.program;
}

/// BURNISH_MUTATIONS asks for more. The sanitizers are ten times slower.
int mutation_count() {
#ifdef BURNISH_SANITIZED
    constexpr int kUsual = 10000;
#else
    constexpr int kUsual = 100000;
#endif
    const char* const asked = std::getenv("BURNISH_MUTATIONS");
    return asked != nullptr ? std::atoi(asked) : kUsual;
}

TEST(ProgramTextMutations, ProgramOrErrors) {
    int programs = 0;
    const int count = mutation_count();
    for (int i = 0; i < count; ++i) {
        Random random(static_cast<unsigned>(i));
        const std::string text = mutated(random, std::string(random.pick(kSeeds)));
        if (check(text)) ++programs;
        ASSERT_FALSE(HasFailure()) << "mutation " << i;
    }
    RecordProperty("programs", programs);
    EXPECT_GT(programs, count / 100);
    EXPECT_LT(programs, count / 2);
}

TEST(ProgramTextMutations, RandomBytes) {
    for (unsigned seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        std::string text(random.pick(std::array{"!!RC1.0", "!!BRN1.0", "!!TS1.0", ""}));
        for (int i = random.below(400); i > 0; --i) text += static_cast<char>(random.below(256));
        check(text);
        ASSERT_FALSE(HasFailure()) << "seed " << seed;
    }
}

/// Every prefix of a right text ends somewhere in a statement.
TEST(ProgramTextMutations, Prefixes) {
    for (const std::string_view seed : kSeeds) {
        for (std::size_t length = 0; length <= seed.size(); ++length)
            check(std::string(seed.substr(0, length)));
    }
}

/// Megabytes of whatever might nest, accumulate or backtrack.
TEST(ProgramTextMutations, LongTexts) {
    constexpr std::size_t kSize = 1 << 20;
    for (const char* header : {"!!RC1.0 ", "!!BRN1.0 ", "!!TS1.0 "}) {
        for (const std::string piece : {"{",
                                        "}",
                                        "(",
                                        "{rgb{",
                                        "{rgb{spare0=tex0;}}",
                                        "fetch{tex0=table_1d(tex0.r);}",
                                        "/*",
                                        "/",
                                        "#",
                                        "#\n",
                                        "9",
                                        "9.",
                                        ".",
                                        "a",
                                        "a ",
                                        "-",
                                        "const0=(",
                                        "out.rgb=",
                                        "nop();",
                                        "const0=(1,1,1,1);",
                                        "\n",
                                        "?",
                                        "expand(",
                                        "* / *",
                                        "{rgb{spare0=sum();"}) {
            std::string text = header;
            while (text.size() < kSize) text += piece;
            check(text);
            ASSERT_FALSE(HasFailure()) << header << piece;
        }
        check(header + std::string(kSize, '\0'));
        check(header + ("const0 = (" + std::string(kSize, '9')) + ", 0, 0, 0);");
        check(header + ("const0 = (0." + std::string(kSize, '0')) + "1, 0, 0, 0);");
    }
}

}  // namespace
}  // namespace burnish
