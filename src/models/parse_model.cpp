#include "models/parse_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>

#include "core/dmath.hpp"
#include "core/nearest.hpp"

namespace burnish {

namespace {

/// Deeper or longer texts are nobody's model: the longest of model_texts.cpp has 70 operations.
constexpr int kDeepest = 100;
constexpr std::size_t kMostOperations = 500;
/// Factors of all summands, once products of sums are multiplied out.
constexpr double kMostFactors = 500.0;

struct Failure {
    TextError error;
};

enum class TokenKind { name, number, symbol, end_of_statement, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string_view text;
    double number = 0.0;
    std::size_t line = 1, column = 1;
};

[[noreturn]] void fail(const Token& at, std::string message) {
    throw Failure{{at.line, at.column, std::move(message)}};
}

/// In quotes, the beginning of what is long.
std::string quoted(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    if (text.size() <= kLongest) return fmt::format("'{}'", text);
    return fmt::format("'{}...'", text.substr(0, kLongest));
}

std::string shown(const Token& token) {
    if (token.kind == TokenKind::end) return "the end";
    if (token.kind == TokenKind::end_of_statement) return "the end of the statement";
    return quoted(token.text);
}

bool starts_name(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

class Lexer {
  public:
    explicit Lexer(std::string_view text) : m_text(text) {}

    Token next() {
        skip_blanks();
        Token token;
        token.line = m_line;
        token.column = m_at - m_line_start + 1;
        if (m_at == m_text.size()) return token;
        const char c = m_text[m_at];
        if (c == '\n' || c == ';') {
            token.kind = TokenKind::end_of_statement;
            token.text = m_text.substr(m_at++, 1);
            if (c == '\n') {
                ++m_line;
                m_line_start = m_at;
            }
        } else if (starts_name(c)) {
            std::size_t end = m_at;
            while (end < m_text.size() && (starts_name(m_text[end]) || is_digit(m_text[end])))
                ++end;
            token.kind = TokenKind::name;
            token.text = m_text.substr(m_at, end - m_at);
            m_at = end;
        } else if (is_digit(c) || c == '.') {
            token.kind = TokenKind::number;
            const char* first = m_text.data() + m_at;
            const auto [stop, failure] =
                std::from_chars(first, m_text.data() + m_text.size(), token.number);
            const std::size_t length =
                failure == std::errc::invalid_argument ? 1 : static_cast<std::size_t>(stop - first);
            token.text = m_text.substr(m_at, length);
            if (failure == std::errc::result_out_of_range)
                fail(token, quoted(token.text) + ", expected a number that a double can hold");
            if (failure != std::errc()) fail(token, quoted(token.text) + " is no number");
            m_at += length;
        } else if (std::string_view("+-*/^(),=").find(c) != std::string_view::npos) {
            token.kind = TokenKind::symbol;
            token.text = m_text.substr(m_at++, 1);
        } else {
            const auto byte = static_cast<unsigned char>(c);
            fail(token, byte >= 0x20 && byte < 0x7f
                            ? fmt::format("unexpected '{}'", c)
                            : fmt::format("unexpected byte 0x{:02x}", byte));
        }
        return token;
    }

  private:
    void skip_blanks() {
        while (m_at < m_text.size()) {
            const char c = m_text[m_at];
            if (c == '#') {
                while (m_at < m_text.size() && m_text[m_at] != '\n') ++m_at;
            } else if (c == ' ' || c == '\t' || c == '\r') {
                ++m_at;
            } else {
                return;
            }
        }
    }

    std::string_view m_text;
    std::size_t m_at = 0, m_line = 1, m_line_start = 0;
};

std::string_view kind_name(ValueKind kind) {
    switch (kind) {
        case ValueKind::scalar:
            return "a number";
        case ValueKind::vector:
            return "a vector";
        case ValueKind::color:
            break;
    }
    return "a colour";
}

/// How long a value gets when its products of colours are multiplied out.
struct Length {
    double summands = 1.0, factors = 1.0;
};
Length multiplied_out(const Expr& e, std::map<const Expr*, Length>& known) {
    const auto at = known.find(&e);
    if (at != known.end()) return at->second;
    Length length;
    if (e.binding == Binding::pixel && e.args.size() == 2) {
        const Length a = multiplied_out(*e.args[0], known), b = multiplied_out(*e.args[1], known);
        if (e.op == ExprOp::multiply)
            length = {a.summands * b.summands, a.factors * b.summands + b.factors * a.summands};
        if (e.op == ExprOp::add && e.kind == ValueKind::color)
            length = {a.summands + b.summands, a.factors + b.factors};
    }
    known.emplace(&e, length);
    return length;
}

bool is_finite_constant(const Expr& e) {
    return e.op != ExprOp::constant ||
           (std::isfinite(e.value.x) && std::isfinite(e.value.y) && std::isfinite(e.value.z));
}

class Parser {
  public:
    Parser(std::string_view text, ExprBuilder& builder) : m_lexer(text), m_builder(builder) {
        m_ahead = m_lexer.next();
        advance();
    }

    ExprPtr parse() {
        ExprPtr value;
        Token start;
        for (;;) {
            while (m_token.kind == TokenKind::end_of_statement) advance();
            if (m_token.kind == TokenKind::end) break;
            if (value)
                fail(m_token,
                     fmt::format("{} after the model's value, expected nothing: the value is last",
                                 shown(m_token)));
            start = m_token;
            if (m_token.kind == TokenKind::name && is_symbol(m_ahead, '=')) {
                define();
            } else {
                value = sum();
            }
            if (m_token.kind != TokenKind::end && m_token.kind != TokenKind::end_of_statement)
                fail(m_token, fmt::format("{}, expected an operator or the end of the statement",
                                          shown(m_token)));
        }
        if (!value) fail(m_token, "no value: the last line is an expression without a name");
        if (value->kind == ValueKind::vector)
            fail(start, "the value is a vector, expected a colour or a number");
        std::map<const Expr*, Length> lengths;  // looked up only
        if (!(multiplied_out(*value, lengths).factors <= kMostFactors))
            fail(start, fmt::format("the value multiplied out has more than {} factors, expected "
                                    "fewer",
                                    kMostFactors));
        return value;
    }

  private:
    void advance() {
        m_token = m_ahead;
        m_ahead = m_lexer.next();
    }
    static bool is_symbol(const Token& token, char c) {
        return token.kind == TokenKind::symbol && token.text[0] == c;
    }
    [[nodiscard]] bool is_symbol(char c) const { return is_symbol(m_token, c); }
    void expect(char c) {
        if (!is_symbol(c)) fail(m_token, fmt::format("{}, expected '{}'", shown(m_token), c));
        advance();
    }
    void count(const Token& at) {
        if (++m_operations > kMostOperations)
            fail(at, fmt::format("more than {} operations, expected fewer", kMostOperations));
        m_builder.at(at.line, at.column);
    }
    /// `e`, which `op` made: numbers that the text says alone are finite.
    static const ExprPtr& finite(const Token& op, const ExprPtr& e) {
        const bool all = is_finite_constant(*e) &&
                         std::all_of(e->args.begin(), e->args.end(),
                                     [](const ExprPtr& arg) { return is_finite_constant(*arg); });
        if (!all)
            fail(op, fmt::format("'{}' of constants has no finite value, expected one", op.text));
        return e;
    }
    /// Roots and powers of what is negative are 0; of a constant that is a mistake.
    static void require_not_negative(const Token& at, const Expr& e) {
        if (e.op == ExprOp::constant && e.value.x < 0.0)
            fail(at, fmt::format("'{}' of the constant {}, expected one of at least 0", at.text,
                                 e.value.x));
    }
    ExprPtr raised(const Token& op, const ExprPtr& base, const ExprPtr& exponent) {
        const bool is_product =
            is_number(*exponent, 1.0) || is_number(*exponent, 2.0) || is_number(*exponent, 4.0);
        if (!is_product) require_not_negative(op, *base);
        return finite(op, m_builder.power(base, exponent));
    }

    /// name = expression
    void define() {
        const Token name = m_token;
        if (m_names.contains(name.text) || name.text == "pi" || m_builder.leaf(name.text))
            fail(name, quoted(name.text) + " has a value already, expected a new name");
        advance();
        advance();
        ExprPtr value = sum();
        m_builder.at(name.line, name.column);
        if (value->binding == Binding::texel)
            value = m_builder.quantity(std::string(name.text), value);
        m_names.emplace(name.text, value);
    }

    ExprPtr sum() {
        ExprPtr e = product();
        while (is_symbol('+') || is_symbol('-')) {
            const Token op = m_token;
            advance();
            ExprPtr right = product();
            require_alike(op, e, right);
            count(op);
            if (op.text == "-") right = m_builder.negate(right);
            e = finite(op, m_builder.add(e, right));
        }
        return e;
    }

    ExprPtr product() {
        ExprPtr e = signed_factor();
        while (is_symbol('*') || is_symbol('/')) {
            const Token op = m_token;
            advance();
            const ExprPtr right = signed_factor();
            count(op);
            if (op.text == "/") {
                require(op, right, ValueKind::scalar);
                if (is_number(*right, 0.0))
                    fail(op, "division by a constant zero, expected another divisor");
                e = finite(op, m_builder.divide(e, right));
            } else {
                if (e->kind != ValueKind::scalar && right->kind != ValueKind::scalar &&
                    (e->kind != right->kind || e->kind == ValueKind::vector))
                    fail(op, fmt::format("{} times {}, expected a number on one side",
                                         kind_name(e->kind), kind_name(right->kind)));
                e = finite(op, m_builder.multiply(e, right));
            }
        }
        return e;
    }

    ExprPtr signed_factor() {
        if (!is_symbol('-')) return power();
        const Token op = m_token;
        advance();
        deeper(op);
        const ExprPtr e = signed_factor();
        --m_depth;
        count(op);
        return m_builder.negate(e);
    }

    ExprPtr power() {
        const ExprPtr base = primary();
        if (!is_symbol('^')) return base;
        const Token op = m_token;
        advance();
        deeper(op);
        const ExprPtr exponent = signed_factor();
        --m_depth;
        require(op, base, ValueKind::scalar);
        require(op, exponent, ValueKind::scalar);
        count(op);
        return raised(op, base, exponent);
    }

    ExprPtr primary() {
        const Token at = m_token;
        if (at.kind == TokenKind::number) {
            advance();
            return m_builder.number(at.number);
        }
        if (is_symbol('(')) {
            advance();
            deeper(at);
            ExprPtr e = sum();
            --m_depth;
            expect(')');
            return e;
        }
        if (at.kind != TokenKind::name)
            fail(at, fmt::format("{}, expected a name, a number or '('", shown(at)));
        advance();
        if (is_symbol('(')) return call(at);
        return named(at);
    }

    ExprPtr named(const Token& at) {
        const auto own = m_names.find(at.text);
        if (own != m_names.end()) return own->second;
        if (at.text == "pi") return m_builder.number(dmath::kPi);
        m_builder.at(at.line, at.column);
        if (ExprPtr leaf = m_builder.leaf(at.text)) return leaf;
        std::vector<std::string_view> known = ExprBuilder::leaf_names();
        for (const std::string_view axis : ExprBuilder::axis_names()) known.push_back(axis);
        known.emplace_back("pi");
        const std::size_t of_language = known.size();
        for (const auto& [name, value] : m_names) known.push_back(name);
        // Without a near one, the text's own names would make a long list.
        if (nearest_name(at.text, known).empty()) known.resize(of_language);
        fail(at,
             fmt::format("unknown name {}, {}", quoted(at.text), expected_one_of(at.text, known)));
    }

    ExprPtr call(const Token& function) {
        constexpr std::string_view kFunctions[] = {"dot", "sqrt",  "pow",      "exp",   "min",
                                                   "max", "clamp", "filtered", "least", "most"};
        constexpr std::string_view kOfTwo[] = {"dot", "pow", "min", "max"};
        const std::string_view name = function.text;
        const bool of_two =
            std::find(std::begin(kOfTwo), std::end(kOfTwo), name) != std::end(kOfTwo);
        const std::size_t expected = name == "clamp" ? 3 : of_two ? 2 : 1;
        const bool of_texel = name == "filtered" || name == "least" || name == "most";
        if (std::find(std::begin(kFunctions), std::end(kFunctions), name) == std::end(kFunctions))
            fail(function, fmt::format("unknown function {}, {}", quoted(name),
                                       expected_one_of(name, kFunctions)));
        advance();
        deeper(function);
        std::vector<ExprPtr> args{sum()};
        while (is_symbol(',')) {
            advance();
            args.push_back(sum());
        }
        --m_depth;
        expect(')');
        if (args.size() != expected)
            fail(function,
                 fmt::format("{} of {} values, expected {}", name, args.size(), expected));
        if (name == "dot") {
            for (const ExprPtr& arg : args) require(function, arg, ValueKind::vector);
        } else {
            for (const ExprPtr& arg : args) require(function, arg, ValueKind::scalar);
        }
        if (of_texel && args[0]->binding == Binding::pixel)
            fail(function, fmt::format("'{}' of what varies from pixel to pixel, expected what is "
                                       "known at the texel",
                                       name));
        count(function);
        if (name == "filtered") return m_builder.filtered(args[0]);
        if (name == "least") return m_builder.extreme(Extreme::least, args[0]);
        if (name == "most") return m_builder.extreme(Extreme::most, args[0]);
        if (name == "dot") return m_builder.dot(args[0], args[1]);
        if (name == "sqrt") {
            require_not_negative(function, *args[0]);
            return m_builder.square_root(args[0]);
        }
        if (name == "pow") return raised(function, args[0], args[1]);
        if (name == "exp") return finite(function, m_builder.exponential(args[0]));
        if (name == "min") return m_builder.minimum(args[0], args[1]);
        if (name == "max") return m_builder.maximum(args[0], args[1]);
        return m_builder.minimum(m_builder.maximum(args[0], args[1]), args[2]);
    }

    void deeper(const Token& at) {
        if (++m_depth > kDeepest)
            fail(at, fmt::format("more than {} levels of nesting, expected fewer", kDeepest));
    }
    static void require(const Token& at, const ExprPtr& e, ValueKind kind) {
        if (e->kind != kind)
            fail(at, fmt::format("'{}' of {}, expected {}", at.text, kind_name(e->kind),
                                 kind_name(kind)));
    }
    /// Numbers may meet colours, not vectors.
    static void require_alike(const Token& at, const ExprPtr& a, const ExprPtr& b) {
        const bool vectors = a->kind == ValueKind::vector || b->kind == ValueKind::vector;
        if (vectors && a->kind != b->kind)
            fail(at, fmt::format("'{}' of {} and {}, expected two alike", at.text,
                                 kind_name(a->kind), kind_name(b->kind)));
    }

    Lexer m_lexer;
    ExprBuilder& m_builder;
    Token m_token, m_ahead;
    std::map<std::string_view, ExprPtr> m_names;
    int m_depth = 0;
    std::size_t m_operations = 0;
};

}  // namespace

Parsed<ExprPtr> parse_model(std::string_view text, ExprBuilder& builder) {
    Parsed<ExprPtr> parsed;
    try {
        parsed.program = Parser(text, builder).parse();
    } catch (const Failure& failure) {
        parsed.errors.push_back(failure.error);
    }
    return parsed;
}

}  // namespace burnish
