#pragma once

#include <burnish/combiner.hpp>
#include <vector>

#include "program/dialect.hpp"
#include "program/reader.hpp"

namespace burnish {

/// The next token is const0 or const1: takes `const0 = (n, n, n, n);`. Complains, at the name, if
/// `taken`; returns the numbers, each in [0, 1] unless there was an error.
glm::vec4 parse_constant(Reader& reader, bool taken);

/// The next token is '{': takes a general stage up to its '}'.
GeneralStage parse_stage(Reader& reader, const Dialect& dialect);

/// The next token is `fetch`: takes the block and adds its fetches to `fetches`.
void parse_fetches(Reader& reader, const Dialect& dialect, std::vector<StageFetch>& fetches);

}  // namespace burnish
