#include "lab/experiment/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/dmath.hpp"

namespace burnish::lab {
namespace {

constexpr double kDegree = dmath::kPi / 180.0;

using Function = double (*)(double);
constexpr std::array<std::pair<std::string_view, Function>, 5> kFunctions{
    {{"sqrt", [](double x) { return std::sqrt(x); }},
     {"sin", [](double x) { return dmath::sin(x * kDegree); }},
     {"cos", [](double x) { return dmath::cos(x * kDegree); }},
     {"log2", [](double x) { return dmath::log2(x); }},
     {"round", [](double x) { return std::floor(x + 0.5); }}}};

/// Recursive descent; each function reads what its name says from the front of what is left.
class Reader {
  public:
    Reader(std::string_view text, const std::map<std::string, double>& variables)
        : m_text(text), m_left(text), m_variables(variables) {}

    double whole() {
        const double value = sum();
        skip_space();
        if (!m_left.empty()) fail("an operator");
        if (!std::isfinite(value)) fail("a finite value");
        return value;
    }

  private:
    static constexpr int kDeepest = 64;

    [[noreturn]] void fail(std::string_view expected) const {
        throw Error(ErrorCode::bad_input,
                    fmt::format("formula '{}': expected {} before '{}'", m_text, expected, m_left));
    }
    void skip_space() {
        while (!m_left.empty() && m_left.front() == ' ') m_left.remove_prefix(1);
    }
    bool take(char c) {
        skip_space();
        if (m_left.empty() || m_left.front() != c) return false;
        m_left.remove_prefix(1);
        return true;
    }
    std::string word() {
        std::size_t length = 0;
        while (length < m_left.size() &&
               (std::isalnum(static_cast<unsigned char>(m_left[length])) != 0 ||
                m_left[length] == '_'))
            ++length;
        const std::string result(m_left.substr(0, length));
        m_left.remove_prefix(length);
        return result;
    }

    double sum() {
        if (++m_depth > kDeepest) fail("fewer brackets");
        double value = product();
        while (true) {
            if (take('+'))
                value += product();
            else if (take('-'))
                value -= product();
            else
                break;
        }
        --m_depth;
        return value;
    }
    double product() {
        double value = power();
        while (true) {
            if (take('*'))
                value *= power();
            else if (take('/'))
                value /= power();
            else
                return value;
        }
    }
    double power() {
        const bool negative = take('-');
        double value = primary();
        if (take('^')) value = dmath::pow(value, primary());
        return negative ? -value : value;
    }
    double bracket() {
        const double value = sum();
        if (!take(')')) fail("')'");
        return value;
    }
    double smaller() {
        const double first = sum();
        if (!take(',')) fail("','");
        return std::min(first, bracket());
    }
    double primary() {
        skip_space();
        if (take('(')) return bracket();
        if (take('$')) {
            const std::string name = word();
            const auto at = m_variables.find(name);
            if (at == m_variables.end())
                throw Error(
                    ErrorCode::bad_input,
                    fmt::format("formula '{}': no axis of numbers is called '{}'", m_text, name));
            return at->second;
        }
        double number = 0.0;
        const auto [end, failure] =
            std::from_chars(m_left.data(), m_left.data() + m_left.size(), number);
        if (failure == std::errc()) {
            m_left.remove_prefix(static_cast<std::size_t>(end - m_left.data()));
            return number;
        }
        const std::string name = word();
        if (name == "pi") return dmath::kPi;
        if (name == "min" && take('(')) return smaller();
        for (const auto& [known, function] : kFunctions)
            if (name == known && take('(')) return function(bracket());
        fail("a number, a function or a $NAME");
    }

    std::string_view m_text, m_left;
    const std::map<std::string, double>& m_variables;
    int m_depth = 0;
};

}  // namespace

double evaluate_formula(std::string_view text, const std::map<std::string, double>& variables) {
    return Reader(text, variables).whole();
}

std::string with_formulas(const std::string& value,
                          const std::map<std::string, double>& variables) {
    constexpr std::string_view kOpening = "\"=";
    std::string result;
    std::size_t at = 0;
    while (true) {
        const std::size_t open = value.find(kOpening, at);
        const std::size_t close =
            open == std::string::npos ? open : value.find('"', open + kOpening.size());
        if (close == std::string::npos) return result + value.substr(at);
        result += value.substr(at, open - at);
        const std::string_view formula(value.data() + open + kOpening.size(),
                                       close - open - kOpening.size());
        result += fmt::format("{}", evaluate_formula(formula, variables));
        at = close + 1;
    }
}

}  // namespace burnish::lab
