#include "program_text.hpp"

/// What a text is made of: header, comments, white space, numbers, words.
namespace burnish {
namespace {

constexpr std::string_view kPlain = "!!RC1.0\nout.rgb = tex0;\n";

TEST(ProgramTextLexical, HeaderIsAPrefixAndMayBeGlued) {
    const CombinerProgram plain = combiners(kPlain);
    EXPECT_EQ(plain.final_combiner.d.reg, tex(0));
    EXPECT_EQ(combiners("!!RC1.0out.rgb=tex0;"), plain);
    EXPECT_EQ(combiners("!!BRN1.0out.rgb=tex0;"), plain);
    EXPECT_EQ(texture_shader("!!TS1.0texture_2d();").units[0].operation,
              TextureOperation::texture_2d);
}

TEST(ProgramTextLexical, WhiteSpaceAndByteOrderMarkMayPrecedeTheHeader) {
    EXPECT_EQ(combiners("\r\n\t  !!RC1.0 out.rgb = tex0;"), combiners(kPlain));
    EXPECT_EQ(combiners("\xEF\xBB\xBF!!RC1.0 out.rgb = tex0;"), combiners(kPlain));
}

TEST(ProgramTextLexical, AnotherHeaderIsTheOnlyError) {
    expect_combiner_error("@", "begins with the end of the text, expected the header");
    expect_combiner_error("\n @!!TS1.0texture_2d(); \n junk", "expected the header !!RC1.0 or");
    expect_combiner_error("@out.rgb = tex0;", "begins with 'out.rgb', expected the header");
    expect_texture_error("@!!RC1.0 texture_2d();",
                         "begins with '!!RC1.0', expected the header !!TS1.0");
}

TEST(ProgramTextLexical, CommentsOfThreeKinds) {
    EXPECT_EQ(combiners("!!RC1.0 # one ; {\n// two /* \nout.rgb /* x * / ** */ = tex0;"),
              combiners(kPlain));
}

TEST(ProgramTextLexical, CarriageReturnsAreWhiteSpace) {
    EXPECT_EQ(combiners("!!RC1.0\r\nout.rgb\r\n=\r\ntex0;\r\n// end\r\n"), combiners(kPlain));
    expect_combiner_error("!!RC1.0\r\nout.rgb = tex0;\r\n\r\n  @foo;", "unrecognized token 'foo'");
}

TEST(ProgramTextLexical, NumbersWithAndWithoutPoint) {
    const CombinerProgram p =
        combiners("!!RC1.0 const0 = (.5, 1., 1, +0.25); const1 = (0, -0, 0.0, 000.75);");
    EXPECT_EQ(p.const0, glm::vec4(0.5F, 1.0F, 1.0F, 0.25F));
    EXPECT_EQ(p.const1, glm::vec4(0.0F, 0.0F, 0.0F, 0.75F));
    expect_combiner_error("!!RC1.0 const0 = (1@e0, 1, 1, 1);", "found 'e0', expected ','");
    expect_combiner_error("!!RC1.0 const0 = (0.1@.2, 1, 1, 1);", "found '.2', expected ','");
    expect_combiner_error("!!RC1.0 const0 = (@x, 1, 1, 1);", "found 'x', expected a number");
}

TEST(ProgramTextLexical, WordsAreCaseSensitive) {
    expect_combiner_error("!!RC1.0 out.rgb = @Tex0;",
                          "unrecognized token 'Tex0', did you mean 'tex0'?");
}

TEST(ProgramTextLexical, LinesCountThroughBlockComments) {
    expect_combiner_error("!!RC1.0 /* 1\n2\n3\n*/ \n  @foo;", "unrecognized token 'foo'");
}

TEST(ProgramTextLexical, OnlyAnEndlessBlockCommentIsAnError) {
    EXPECT_EQ(combiners("!!RC1.0 out.rgb = tex0; # no newline"), combiners(kPlain));
    EXPECT_EQ(combiners("!!RC1.0 out.rgb = tex0; // no newline"), combiners(kPlain));
    expect_combiner_error("!!RC1.0\nout.rgb = tex0;\n @/* open *",
                          "ends in a comment, expected '*/'");
    expect_combiner_error("!!RC1.0\n{ rgb { @/* open", "ends in a comment");
    expect_texture_error("!!TS1.0 nop(); @/*/", "ends in a comment");
}

TEST(ProgramTextLexical, UnknownBytesAreShownInAscii) {
    using namespace std::string_literals;
    expect_combiner_error("!!RC1.0 @\x00\xFF\x01 out.rgb = tex0;"s,
                          "unrecognized token '\\x00\\xff\\x01'");
    expect_combiner_error("!!RC1.0 @" + std::string(5000, '?') + ";",
                          "'????????????????????????????????...'");
}

TEST(ProgramTextLexical, AComponentIsGluedToItsRegister) {
    EXPECT_EQ(rgb("spare0 = tex0 . tex1;").ab_product, Product::dot);
    EXPECT_EQ(rgb("spare0 = tex0.tex1;").ab_product, Product::dot);
    EXPECT_EQ(rgb("spare0 = tex0.rgb.tex1.a;").b.component, Component::alpha);
    expect_combiner_error("!!RC1.0 { rgb { spare0 = tex0 . @a; } }", "unrecognized token 'a'");
}

}  // namespace
}  // namespace burnish
