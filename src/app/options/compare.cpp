#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <cmath>
#include <memory>

#include "app/options/groups.hpp"
#include "app/options/numbers.hpp"
#include "app/options/threshold.hpp"
#include "app/options/verbs.hpp"
#include "app/options/words.hpp"

namespace burnish::app {
namespace {

metrics::Exposures parse_exposures(const std::string& option, const std::string& text) {
    const std::vector<double> v = parse_numbers<double>(option, text, 2, 3);
    const double count = v.size() == 3 ? v[2] : std::max(2.0, std::ceil(v[1] - v[0]));
    if (v[1] < v[0] || count != std::floor(count) || count < 1.0 || count > metrics::kMostExposures)
        refuse(option, text,
               fmt::format("START,STOP[,COUNT] with START <= STOP and 1 .. {} exposures",
                           metrics::kMostExposures));
    return {v[0], v[1], static_cast<int>(count)};
}

OptionGroup image_options(CompareOptions& options) {
    return {"Input",
            {{.names = "TEST",
              .text = "Image file",
              .files = "png exr",
              .required = true,
              .set = text_to(options.test)},
             {.names = "REFERENCE",
              .text = "Image file of the same size",
              .files = "png exr",
              .required = true,
              .set = text_to(options.reference)}}};
}

OptionGroup measure_options(CompareOptions& options) {
    metrics::CompareOptions& measured = options.measured;
    return {
        "Measures",
        {{.names = "--metric",
          .value = "NAME",
          .text = fmt::format("Only these, with commas between them: {}",
                              fmt::join(metrics::metric_names(), ", ")),
          .normal = "all",
          .words = metrics::metric_names(),
          .repeated = true,
          .separator = ',',
          .set =
              [&measured, first = true](const std::string&, const std::string& name) mutable {
                  if (first) measured.metrics.clear();
                  first = false;
                  measured.metrics.push_back(*metrics::metric_named(name));
              }},
         threshold_option(options.thresholds),
         {.names = "--mask",
          .value = "WHICH",
          .text = "Pixels that count, by the reference's alpha: all, covered, or interior, "
                  "whose eight neighbours are covered, too",
          .normal = "all",
          .words = {"all", "covered", "interior"},
          .set =
              [&measured](const std::string&, const std::string& word) {
                  measured.region = word == "all"       ? metrics::Region::all
                                    : word == "covered" ? metrics::Region::covered
                                                        : metrics::Region::interior;
              }},
         {.names = "--pixels-per-degree",
          .value = "PPD",
          .text = "Of the viewer, for FLIP",
          .normal = fmt::format("{:.2f}", measured.flip.pixels_per_degree),
          .set = number_to<double>(measured.flip.pixels_per_degree, metrics::kLeastPixelsPerDegree,
                                   metrics::kMostPixelsPerDegree)},
         {.names = "--encoding",
          .value = "CODE",
          .text = "What FLIP takes numbers for: srgb, as a screen shows them; or linear",
          .normal = "srgb",
          .words = {"srgb", "linear"},
          .set =
              [&measured](const std::string&, const std::string& word) {
                  measured.flip.encoding =
                      word == "srgb" ? metrics::Encoding::srgb : metrics::Encoding::linear;
              }},
         {.names = "--exposures",
          .value = "START,STOP[,COUNT]",
          .text = "Of flip_hdr in stops",
          .normal = "those that suit the reference",
          .set = [&measured](const std::string& option, const std::string& text) {
              measured.flip.exposures = parse_exposures(option, text);
          }}}};
}

OptionGroup difference_options(CompareOptions& options) {
    return {"Output",
            {{.names = "--difference",
              .value = "FILE",
              .text = "Image of test - reference: .exr the numbers, others grey where there is "
                      "none",
              .files = "png exr",
              .set = text_to(options.difference)},
             {.names = "--absolute-difference",
              .value = "FILE",
              .text = "Image of its size, black where there is none",
              .files = "png exr",
              .set = text_to(options.absolute_difference)},
             {.names = "--gain",
              .value = "G",
              .text = "Multiplies both, but for .exr",
              .normal = fmt::format("{:g}", options.gain),
              .set = number_to(options.gain, 1e-6, 1e6)},
             {.names = "--heat-map",
              .value = "FILE",
              .text = "Image of FLIP: colours from black to light yellow, .exr the numbers; of "
                      "flip_hdr where --metric names that and not flip",
              .files = "png exr",
              .set = text_to(options.heat_map)}}};
}

}  // namespace

Verb compare_verb() {
    const auto options = std::make_shared<CompareOptions>();
    Option quiet = quiet_option(options->quiet);
    quiet.excludes = "--json";
    return {
        .name = "compare",
        .text = "Measures how an image differs from its reference",
        .groups = {image_options(*options),
                   measure_options(*options),
                   difference_options(*options),
                   {"Work", {threads_option(options->threads), json_option(options->json), quiet}}},
        .examples =
            {{"Every measure of two pictures", "burnish compare picture.png reference.png"},
             {"Exit code 1 if the root mean square error or FLIP is too large",
              "burnish compare picture.png reference.png --threshold rmse=0.05,flip=0.1 --quiet"},
             {"Where they differ, eight times as strong",
              "burnish compare picture.png reference.png --difference difference.png --gain 8"},
             {"Two measures of what the reference covers, as JSON",
              "burnish compare picture.png reference.png --metric psnr,ssim --mask covered "
              "--json"}},
        .command = [options] { return *options; }};
}

}  // namespace burnish::app
