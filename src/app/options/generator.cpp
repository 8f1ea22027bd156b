#include <fmt/format.h>

#include <limits>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/words.hpp"

namespace burnish::app {

Option directory_option(std::filesystem::path& output) {
    return {.names = "-o,--output",
            .value = "DIR",
            .text = "Directory, made if it is not there",
            .files = "/",
            .required = true,
            .set = text_to(output)};
}

std::vector<Option> generator_options(std::uint32_t& seed, int& size, int largest,
                                      const std::string& needs) {
    return {{.names = "--seed",
             .value = "N",
             .text = "Another seed gives other marks",
             .normal = fmt::format("{}", seed),
             .needs = needs,
             .set = number_to<std::uint32_t>(seed, 0, std::numeric_limits<std::uint32_t>::max())},
            {.names = "--size",
             .value = "N",
             .text = "Side of the square maps in texels",
             .normal = fmt::format("{}", size),
             .needs = needs,
             .set = number_to(size, 1, largest)}};
}

}  // namespace burnish::app
