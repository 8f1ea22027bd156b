#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/fetch_words.hpp"
#include "program/operand.hpp"
#include "program/parse_stage.hpp"

namespace burnish {
namespace {

/// Takes `register.component` or `expand(register.component)`.
FetchCoordinate take_coordinate(Reader& reader, const Dialect& dialect) {
    FetchCoordinate coordinate;
    coordinate.expand = reader.take_if("expand");
    if (coordinate.expand) reader.expect("(");
    const NamedRegister named = take_register(reader, dialect);
    if (coordinate.expand) reader.expect(")");
    coordinate.reg = named.reg;
    const std::size_t component = std::string_view("rgba").find(named.token.component);
    const bool readable = !named.one && named.reg < Register::color_sum;
    if (!readable)
        reader.complain(named.token, fmt::format("{} as a coordinate, expected another register",
                                                 quoted(named.token)));
    else if (named.token.component.size() != 1)
        reader.complain(named.token, fmt::format("{} as a coordinate, expected one component: .r, "
                                                 ".g, .b or .a",
                                                 quoted(named.token)));
    else if (named.reg == Register::fog && component == 3)
        reader.complain(named.token, "the alpha of fog, which only the final combiner has");
    else
        coordinate.component = static_cast<std::uint8_t>(component);
    return coordinate;
}

FetchTarget take_target(Reader& reader) {
    const auto* const at = std::find_if(kFetchWords.begin(), kFetchWords.end(),
                                        [&](std::string_view word) { return reader.at(word); });
    if (at == kFetchWords.end()) fail_word(reader, "a table", kFetchWords);
    reader.take();
    return static_cast<FetchTarget>(at - kFetchWords.begin());
}

void take_fetch(Reader& reader, const Dialect& dialect, std::vector<StageFetch>& fetches,
                StageLines lines) {
    StageFetch fetch;
    const Token begin = reader.peek();
    const NamedRegister named = take_register(reader, dialect);
    fetch.destination = named.reg;
    const bool texture = named.reg >= Register::tex0 && named.reg <= Register::tex15;
    const bool twice = std::any_of(fetches.begin(), fetches.end(), [&](const StageFetch& other) {
        return other.destination == named.reg;
    });
    if (!texture || !named.token.component.empty())
        reader.complain(named.token, fmt::format("{} as the target of a fetch, expected a whole "
                                                 "texture register",
                                                 quoted(named.token)));
    else if (twice)
        reader.complain(named.token,
                        fmt::format("{} is fetched twice before one stage", named.token.text));
    reader.expect("=");
    fetch.target = take_target(reader);
    reader.expect("(");
    for (int i = 0; i < coordinate_count(fetch.target); ++i) {
        if (i > 0) reader.expect(",");
        fetch.coordinates[static_cast<std::size_t>(i)] = take_coordinate(reader, dialect);
    }
    reader.expect(")");
    reader.expect_end();
    if (!texture || twice) return;
    fetches.push_back(fetch);  // at most one for each texture register
    lines.note(ProgramPlace::Part::fetches, static_cast<int>(fetches.size()), begin);
}

}  // namespace

void parse_fetches(Reader& reader, const Dialect& dialect, std::vector<StageFetch>& fetches,
                   StageLines lines) {
    const std::size_t before = fetches.size();
    const std::size_t errors = reader.error_count();
    lines.note(ProgramPlace::Part::fetches, ProgramPlace::kAll, reader.take());
    reader.expect("{");
    while (!reader.at("}") && !reader.at_end())
        reader.statement([&] { take_fetch(reader, dialect, fetches, lines); });
    if (fetches.size() == before && errors == reader.error_count() && !reader.at_end())
        reader.complain(reader.peek(), "no fetch between '{' and '}', expected a texture register");
    reader.expect("}");
}

}  // namespace burnish
