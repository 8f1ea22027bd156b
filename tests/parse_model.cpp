// The language of models: what it says about wrong texts and where, how operators bind, what is
// built of a text, and that no bytes break it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <burnish/materials.hpp>
#include <cstdint>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "models/model_texts.hpp"
#include "models/parse_model.hpp"
#include "models/table_function.hpp"
#include "models/terms.hpp"

namespace burnish {
namespace {

/// "LINE:COLUMN: message" of a text that is wrong.
std::string complaint(std::string_view text) {
    ExprBuilder builder;
    const Parsed<ExprPtr> parsed = parse_model(text, builder);
    if (parsed.program) return "no error";
    EXPECT_EQ(parsed.errors.size(), 1U);
    const TextError& error = parsed.errors.front();
    return std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.message;
}

/// Value of a text of numbers, with n_dot_l = 0.5 and h_dot_l = 0.75.
double value_of(std::string_view text) {
    ExprBuilder builder;
    const Parsed<ExprPtr> parsed = parse_model(text, builder);
    EXPECT_TRUE(parsed.program.has_value()) << complaint(text);
    if (!parsed.program) return 0.0;
    const ExprPtr x = builder.leaf("n_dot_l"), y = builder.leaf("h_dot_l");
    Tape tape({parsed.program->get()}, {x.get(), y.get()});
    const std::array<glm::dvec3, 2> inputs{glm::dvec3(0.5), glm::dvec3(0.75)};
    glm::dvec3 value;
    tape.run(inputs.data(), &value);
    return value.x;
}

/// Texts whose value depends on both arguments, on one alone or on none, with every operation; of
/// more places than one block has.
TEST(TableFunctionTest, HasTheBitsOfTheTape) {
    const char* texts[] = {
        "exp(-n_dot_l / max(1e-3, h_dot_l^2)) * sqrt(n_dot_l - h_dot_l^3) + pow(n_dot_l, h_dot_l)",
        "min(n_dot_l, h_dot_l^1.5) / h_dot_l - max(0.3, 2 * n_dot_l)",
        "pow(n_dot_l - 0.5, 0 - n_dot_l)",
        "exp(h_dot_l) - 0.25",
        "0.75",
        "h_dot_l"};
    std::vector<double> along, across{0.0, 0.25, 0.7, 1.0};
    for (int i = 0; i <= 300; ++i) along.push_back(i / 300.0);
    for (const char* text : texts) {
        ExprBuilder builder;
        const ExprPtr value = *parse_model(text, builder).program;
        const ExprPtr x = builder.leaf("n_dot_l"), y = builder.leaf("h_dot_l");
        Tape tape({value.get()}, {x.get(), y.get()});
        TableFunction function(*value, {x.get(), y.get()});
        for (const std::size_t own : {std::size_t{0}, std::size_t{1}}) {
            std::size_t count = 0, wrong = 0;
            function.rows(own, along, across, [&](std::size_t j, std::span<const double> values) {
                for (std::size_t i = 0; i < values.size(); ++i, ++count) {
                    std::array<glm::dvec3, 2> at;
                    at[own] = glm::dvec3(along[i]);
                    at[1 - own] = glm::dvec3(across[j]);
                    glm::dvec3 want;
                    tape.run(at.data(), &want);
                    wrong += std::bit_cast<std::uint64_t>(values[i]) !=
                             std::bit_cast<std::uint64_t>(want.x);
                }
            });
            EXPECT_EQ(count, along.size() * across.size()) << text;
            EXPECT_EQ(wrong, 0U) << text << ", along argument " << own;
        }
    }
}

TEST(ParseModelTest, ErrorsSayWhereWhatAndWhatWasExpected) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "1:1: no value: the last line is an expression without a name"},
        {"x = 2", "1:6: no value: the last line is an expression without a name"},
        {"ks\nkd", "2:1: 'kd' after the model's value, expected nothing: the value is last"},
        {"ks $ 2", "1:4: unexpected '$'"},
        {"ks * 2\x01", "1:7: unexpected byte 0x01"},
        {"ks * .", "1:6: '.' is no number"},
        {"ks * 1e999", "1:6: '1e999', expected a number that a double can hold"},
        {"ks *", "1:5: the end, expected a name, a number or '('"},
        {"ks * (2\n + 3)", "1:8: the end of the statement, expected ')'"},
        {"ks * max(2, 3", "1:14: the end, expected ')'"},
        {"ks kd", "1:4: 'kd', expected an operator or the end of the statement"},
        {"2 = ks", "1:3: '=', expected an operator or the end of the statement"},
        {"ks = 2\nks", "1:1: 'ks' has a value already, expected a new name"},
        {"x = 2; x = 3; ks", "1:8: 'x' has a value already, expected a new name"},
        // unknown names
        {"alpha_z = 2\nks * alpha_q", "2:6: unknown name 'alpha_q', did you mean 'alpha_x'?"},
        {"rough = 2\nks * rouhg", "2:6: unknown name 'rouhg', did you mean 'rough'?"},
        {"ks * something",
         "1:6: unknown name 'something', expected n, t, b, alpha_x, alpha_y, N, ks, kd, l, v, h, "
         "n_dot_l, h_dot_l, ex, ey, ez, pi"},
        {"ks * sqr(2)", "1:6: unknown function 'sqr', did you mean 'sqrt'?"},
        {"ks * log(0)",
         "1:6: unknown function 'log', expected dot, sqrt, pow, exp, min, max, clamp, filtered, "
         "least, most"},
        {"ks * filtered(n_dot_l)",
         "1:6: 'filtered' of what varies from pixel to pixel, expected what is known at the texel"},
        {"ks * least(filtered(N))",
         "1:6: 'least' of what varies from pixel to pixel, expected what is known at the texel"},
        {"ks * most(n)", "1:6: 'most' of a vector, expected a number"},
        {"ex = 2\nks", "1:1: 'ex' has a value already, expected a new name"},
        {"ks * clamp(2, 3)", "1:6: clamp of 2 values, expected 3"},
        {"ks * sqrt(2, 3)", "1:6: sqrt of 2 values, expected 1"},
        // kinds
        {"n", "1:1: the value is a vector, expected a colour or a number"},
        {"ks + n", "1:4: '+' of a colour and a vector, expected two alike"},
        {"n - 1", "1:3: '-' of a vector and a number, expected two alike"},
        {"n * l", "1:3: a vector times a vector, expected a number on one side"},
        {"ks * n", "1:4: a colour times a vector, expected a number on one side"},
        {"1 / ks", "1:3: '/' of a colour, expected a number"},
        {"dot(n, 1)", "1:1: 'dot' of a number, expected a vector"},
        {"dot(ks, n)", "1:1: 'dot' of a colour, expected a vector"},
        {"sqrt(n)", "1:1: 'sqrt' of a vector, expected a number"},
        {"max(0, ks)", "1:1: 'max' of a colour, expected a number"},
        {"ks ^ 2", "1:4: '^' of a colour, expected a number"},
        {"2 ^ n", "1:3: '^' of a vector, expected a number"},
        // constants without a value
        {"ks / 0", "1:4: division by a constant zero, expected another divisor"},
        {"ks / (2 - 2)", "1:4: division by a constant zero, expected another divisor"},
        {"z = 3 * 0.5 - 1.5\nks / z", "2:4: division by a constant zero, expected another divisor"},
        {"ks / -0", "1:4: division by a constant zero, expected another divisor"},
        {"ks / (0 * n_dot_l)", "1:4: division by a constant zero, expected another divisor"},
        {"ks / 1e-320", "1:4: '/' of constants has no finite value, expected one"},
        {"0 ^ -1 * ks", "1:3: '^' of constants has no finite value, expected one"},
        {"exp(1000) * ks", "1:1: 'exp' of constants has no finite value, expected one"},
        {"ks * 1e300 * 1e300", "1:12: '*' of constants has no finite value, expected one"},
        {"sqrt(-1) * ks", "1:1: 'sqrt' of the constant -1, expected one of at least 0"},
        {"(2 - 5)^3 * ks", "1:8: '^' of the constant -3, expected one of at least 0"},
        {"pow(-2, 0.5) * ks", "1:1: 'pow' of the constant -2, expected one of at least 0"},
    };
    for (const auto& [text, expected] : cases) EXPECT_EQ(complaint(text), expected) << text;
}

TEST(ParseModelTest, LimitsAreErrors) {
    const auto repeated = [](std::string_view part, int times) {
        std::string text;
        for (int i = 0; i < times; ++i) text += part;
        return text;
    };
    EXPECT_EQ(complaint(repeated("(", 100) + "ks" + repeated(")", 100)), "no error");
    EXPECT_EQ(complaint(repeated("(", 101) + "ks" + repeated(")", 101)),
              "1:101: more than 100 levels of nesting, expected fewer");
    for (const char* open : {"-", "2^", "sqrt(", "max(0, "})
        EXPECT_NE(complaint(repeated(open, 100000)).find("levels of nesting"), std::string::npos);
    EXPECT_EQ(complaint("ks" + repeated(" * 2", 500)), "no error");
    EXPECT_EQ(complaint("ks" + repeated(" * 2", 501)),
              "1:2004: more than 500 operations, expected fewer");
    // Every line doubles what products of sums would give: 2^40 summands, and 2^40 factors.
    std::string sums = "c0 = ks + n_dot_l\n", squares = "x0 = n_dot_l + 1\n";
    for (int i = 0; i < 40; ++i) {
        const std::string a = std::to_string(i), b = std::to_string(i + 1);
        sums += "c" + b + " = c" + a + " * (c" + a + " + kd)\n";
        squares += "x" + b + " = x" + a + " * (x" + a + " * 0.5)\n";
    }
    EXPECT_EQ(complaint(sums + "c40"),
              "42:1: the value multiplied out has more than 500 factors, expected fewer");
    EXPECT_EQ(complaint(squares + "x40 * ks"),
              "42:1: the value multiplied out has more than 500 factors, expected fewer");
    // Names of 10,000 letters are not repeated in full, and a text's own names are no list.
    EXPECT_LT(complaint("ks * " + std::string(10000, 'q')).size(), 200U);
    std::string names;
    for (int i = 0; i < 300; ++i) names += "some_name_" + std::to_string(i) + " = 1\n";
    EXPECT_LT(complaint(names + "ks * zzz").size(), 200U);
}

// n_dot_l is 1/2 and h_dot_l 3/4.
TEST(ParseModelTest, OperatorsBindAsInMathematics) {
    const std::pair<const char*, double> cases[] = {
        {"2 + 3 * 4", 14.0},
        {"2 * 3 + 4", 10.0},
        {"10 - 4 - 3", 3.0},
        {"n_dot_l - h_dot_l - 1", -1.25},
        {"16 / 4 / 2", 2.0},
        {"16 / 4 * 2", 8.0},
        {"12 / h_dot_l / n_dot_l", 32.0},
        {"12 / h_dot_l * n_dot_l", 8.0},
        {"2 ^ 3 ^ 2", 512.0},
        {"2 * n_dot_l ^ 2", 0.5},
        {"-n_dot_l ^ 2", -0.25},
        {"(-n_dot_l) ^ 2", 0.25},
        {"2 ^ -n_dot_l ^ 2 * 4", 4.0 * std::exp2(-0.25)},
        {"2 ^ -1 * 6", 3.0},
        {"4 ^ n_dot_l", 2.0},
        {"--n_dot_l", 0.5},
        {"3 - -n_dot_l", 3.5},
        {"2 * -3", -6.0},
        {"6 / -n_dot_l", -12.0},
        {"(2 + 3) * 4", 20.0},
        {"max(n_dot_l, h_dot_l) - min(n_dot_l, h_dot_l)", 0.25},
        {"clamp(n_dot_l * 4, 0, h_dot_l)", 0.75},
        {"pow(n_dot_l, 3)", 0.125},
        {"exp(-n_dot_l) * exp(n_dot_l)", 1.0},
        {"sqrt(n_dot_l * 0.5)", 0.5},
        {"2 * pi", 6.283185307179586},
        {".5e1 + 1.5E-1", 5.15},
        {"a = n_dot_l; c = a + a # a comment ; = (\r\n\tc * 2", 2.0},
        {"\n\n;;n_dot_l\n;\n", 0.5},
        {"dot(l, v)", 2.0 * 0.5625 - 1.0},
        {"dot(h, h) + dot(l, h)", 1.75},
        // Roots and powers count what is negative as 0; squares and fourth powers are products.
        {"sqrt(-n_dot_l) + (-n_dot_l)^0.5", 0.0},
        {"(-n_dot_l)^3", 0.0},
        {"(-n_dot_l)^4", 0.0625},
        {"(n_dot_l - n_dot_l * 1)^0", 1.0},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_NEAR(value_of(text), expected, 1e-15 * std::max(1.0, expected)) << text;
}

TEST(ParseModelTest, KindsAndBindingsFollowTheirParts) {
    ExprBuilder builder;
    const auto parsed = [&](std::string_view text) {
        const Parsed<ExprPtr> result = parse_model(text, builder);
        EXPECT_TRUE(result.program.has_value()) << complaint(text);
        return *result.program;
    };
    EXPECT_EQ(parsed("ks * 2")->kind, ValueKind::color);
    EXPECT_EQ(parsed("2 * n_dot_l")->kind, ValueKind::scalar);
    EXPECT_EQ(parsed("ks + n_dot_l")->kind, ValueKind::color);
    EXPECT_EQ(parsed("ks / N")->binding, Binding::texel);
    EXPECT_EQ(parsed("ks / N * n_dot_l")->binding, Binding::pixel);
    EXPECT_EQ(parsed("1 + 2 * 3")->binding, Binding::constant);
    // What the texels know stands inside the dot product, named or not.
    EXPECT_EQ(parsed("dot(h, t) / alpha_x"), parsed("dot(h, t * (1 / alpha_x))"));
    EXPECT_EQ(parsed("2 * dot(h, t) * N"), parsed("dot(h, t * 2 * N)"));
    EXPECT_EQ(parsed("X = t / alpha_x\ndot(h, X)^2")->args[0]->args[1]->name, "X");
    // The same twice is one node, and where it stood first.
    const ExprPtr twice = parsed("ks *\t(exp(dot(n, h)) + sqrt(exp(dot(n, h))))");
    const ExprPtr sum = twice->args[1];
    EXPECT_EQ(sum->args[0], sum->args[1]->args[0]);
    EXPECT_EQ(sum->args[0]->column, 7U);
}

// One slip each in the text of a model.
TEST(ParseModelTest, TenSlips) {
    const std::string ward(model_text(Model::ward));
    ASSERT_NE(ward.find("S * (sqrt(nl)"), std::string::npos);
    const auto with = [&](std::string_view old, std::string_view now) {
        std::string text = ward;
        const std::size_t at = text.find(old);
        EXPECT_NE(at, std::string::npos) << old;
        return complaint(text.replace(at, old.size(), now));
    };
    EXPECT_EQ(with("alpha_x", "alphax"), "1:9: unknown name 'alphax', did you mean 'alpha_x'?");
    EXPECT_EQ(with("b / alpha_y", "b alpha_y"),
              "2:7: 'alpha_y', expected an operator or the end of the statement");
    EXPECT_EQ(with("ks / (4", "ks / ((4"), "3:39: the end of the statement, expected ')'");
    EXPECT_EQ(with("* alpha_y)", "* alpha_y"), "3:37: the end of the statement, expected ')'");
    EXPECT_EQ(with("dot(h, X)", "dot(h X)"), "4:11: 'X', expected ')'");
    EXPECT_EQ(with("dot(h, X)", "dot(h, 1)"), "4:5: 'dot' of a number, expected a vector");
    EXPECT_EQ(with("X)^2 +", "X)^2 + +"), "4:19: '+', expected a name, a number or '('");
    EXPECT_EQ(with("nl = max", "max(0, nl) = max"), "5:8: unknown name 'nl', did you mean 'n'?");
    EXPECT_EQ(with("q = dot(h, X)", "q = h * X"), "4:10: '^' of a vector, expected a number");
    EXPECT_EQ(with("+ kd * nl", ""), "no error");
    EXPECT_EQ(with("+ kd * nl", "+ kd * t"),
              "6:90: a colour times a vector, expected a number on one side");
}

/// Lines of `text`, as the parser counts them.
std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    for (const char c : text) {
        if (c == '\n') {
            lines.emplace_back();
        } else {
            lines.back() += c;
        }
    }
    return lines;
}

// Bytes are put in, taken out, moved and replaced, some of them by words of the language.
TEST(ParseModelTest, NoTextBreaksIt) {
    constexpr std::string_view kWords[] = {
        "ks", "n",    "(",  ")",    "^",    "-",     "1e308",  "0",      "/", "dot(",
        "\n", "=",    ";",  "#",    ",",    "sqrt(", "clamp(", "N",      "*", "l",
        "X",  "exp(", "-1", "\xff", "1e-9", "\r",    "pi",     "alpha_x"};
    std::mt19937 engine(11);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(engine()) % n; };
    std::vector<std::string> texts;
    for (const std::string_view name : model_names())
        texts.emplace_back(model_text(*model_named(name)));
    int good = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = texts[below(texts.size())];
        for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
            const std::size_t at = below(text.size() + 1);
            const std::size_t length = std::min(below(6), text.size() - at);
            const std::string_view word = kWords[below(std::size(kWords))];
            switch (below(4)) {
                case 0:
                    text.insert(at, word);
                    break;
                case 1:
                    text.erase(at, length);
                    break;
                case 2:
                    text.replace(at, length, word);
                    break;
                default:
                    text.insert(below(text.size() + 1), text.substr(at, 20));
                    break;
            }
        }
        ExprBuilder builder;
        const Parsed<ExprPtr> parsed = parse_model(text, builder);
        ASSERT_EQ(parsed.program.has_value(), parsed.errors.empty());
        if (parsed.program) {
            ++good;
            ASSERT_LT(print_expression(**parsed.program).size(), 10000U);
            continue;
        }
        const std::vector<std::string> lines = lines_of(text);
        const TextError& error = parsed.errors.front();
        ASSERT_TRUE(error.line >= 1 && error.line <= lines.size()) << text;
        ASSERT_TRUE(error.column >= 1 && error.column <= lines[error.line - 1].size() + 1)
            << error.column << " " << text;
        ASSERT_TRUE(std::all_of(error.message.begin(), error.message.end(), [](char c) {
            return c >= 0x20 && c < 0x7f;
        })) << error.message;
    }
    EXPECT_GT(good, 500);
    EXPECT_LT(good, 19000);
}

/// A text of the same value, as print_expression writes it: a line for every quantity.
std::string printed(const Expr& value) {
    std::string text;
    std::vector<const Expr*> done;
    std::set<std::string> names;  // `filtered` of a quantity is another node with its name
    const auto define = [&](const auto& self, const Expr& e) -> void {
        if (std::find(done.begin(), done.end(), &e) != done.end()) return;
        done.push_back(&e);
        for (const ExprPtr& arg : e.args) self(self, *arg);
        if (e.op == ExprOp::quantity && e.extreme == Extreme::none && names.insert(e.name).second)
            text += e.name + " = " + print_expression(*e.args.front()) + "\n";
    };
    define(define, value);
    return text + print_expression(value);
}

TEST(ParseModelTest, WhatIsPrintedIsReadAgain) {
    std::vector<std::string> texts{"-(n_dot_l ^ 2) ^ 0.5 * ks",
                                   "(-n_dot_l) ^ 0.5 + (-n_dot_l) ^ 2 - -n_dot_l",
                                   "(n_dot_l ^ 2) ^ h_dot_l",
                                   "n_dot_l ^ (h_dot_l ^ 2) ^ N",
                                   "ks - (kd - n_dot_l) / 3e-7 / h_dot_l",
                                   "2 - (3 - (n_dot_l - h_dot_l)) * -4",
                                   "(-0.5 * n_dot_l) ^ 4 ^ (1 / h_dot_l)",
                                   "0.25 ^ n_dot_l ^ -2"};
    for (const std::string_view name : model_names())
        texts.emplace_back(model_text(*model_named(name)));
    for (const std::string& text : texts) {
        ExprBuilder builder;
        const Parsed<ExprPtr> first = parse_model(text, builder);
        ASSERT_TRUE(first.program.has_value()) << complaint(text);
        const std::string once = printed(**first.program);
        const Parsed<ExprPtr> second = parse_model(once, builder);
        ASSERT_TRUE(second.program.has_value()) << once << "\n" << complaint(once);
        EXPECT_EQ(printed(**second.program), once);
        // Numbers of at most six digits come back as the same node.
        if (text.find("pi") == std::string::npos && text.find("3e-7") == std::string::npos &&
            text.find("sqrt(2)") == std::string::npos) {
            EXPECT_EQ(*first.program, *second.program) << once;
        }
    }
}

}  // namespace
}  // namespace burnish
