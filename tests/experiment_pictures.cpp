// The pictures that an experiment's report has: contact sheets and plots.
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <filesystem>
#include <string>

#include "lab/experiment/picture_plots.hpp"
#include "tests/float_picture.hpp"
#include "tests/tiny_experiment.hpp"

namespace burnish {
namespace {

TEST_F(ExperimentCommand, SheetsShowPicturesAndNumbers) {
    const std::string one_row = "[[sheets]]\ntitle = \"more\"\nwhere = { machine = \"ideal\" }\n";
    write_experiment(one_row);
    compute("out");
    const Framebuffer sheet = load_frame(path("out/sheets/sheet-1.exr"));
    const Framebuffer test = load_frame(path("out/images/ball-nv2a-0.3.test.exr"));
    const Framebuffer flip = load_frame(path("out/images/ball-nv2a-0.3.flip.png"));
    // Two lines of text, one above the row; 40 x 30 pixels six times as large, gaps of 6.
    constexpr int kTop = 3 * 22, kColumn = 256 + 6;
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            EXPECT_EQ(glm::vec3(get(sheet, 6 + 6 * x + 3, kTop + 6 * y + 5)),
                      glm::vec3(get(test, x, y)));
            EXPECT_EQ(get(sheet, 6 + 3 * kColumn + 6 * x, kTop + 6 * y), get(flip, x, y));
        }
    }
    EXPECT_EQ(load_image(path("out/sheets/sheet-1.png")).width, sheet.width());
    // What stands above the two rows of the second sheet differs where labels and numbers do.
    const Framebuffer rows = load_frame(path("out/sheets/sheet-2.exr"));
    int labels = 0, numbers = 0;
    for (int y = 44; y < kTop; ++y)
        for (int x = 0; x < rows.width(); ++x)
            (x < 2 * kColumn ? labels : numbers) +=
                get(rows, x, y) != get(rows, x, y + 22 + 180 + 6) ? 1 : 0;
    EXPECT_GT(labels, 10) << "0.3 and 0.6";
    EXPECT_GT(numbers, 10) << "two errors";
}

TEST_F(ExperimentCommand, EveryKindOfPlot) {
    write_experiment(R"([[plots]]
kind = "codes"
title = "codes"
where = { machine = "nv2a" }
[[plots]]
kind = "polar"
title = "polar"
panels = "machine"
[[plots]]
kind = "pareto"
title = "time"
y = "rmse"
log = ["x"]
[[plots]]
kind = "waterfall"
title = "stages"
where = { machine = "nv2a", width = 0.6 }
pixel = [22, 9]
)");
    compute("out");
    const auto has = [&](const char* name) {
        return std::filesystem::is_regular_file(path("out/plots") / name);
    };
    // Two cells, two machines, one plot, one cell.
    for (const char* name : {"plot-2-2.svg", "plot-3-2.svg", "plot-4-1.svg", "plot-5-1.svg"})
        EXPECT_TRUE(has(name)) << name;
    EXPECT_FALSE(has("plot-2-3.svg"));
    EXPECT_TRUE(has("../images/ball-ideal-0.6.test.exr")) << "no sheet has it, but a plot";
    expect_bad_file("[[plots]]\nkind = \"codes\"\ntitle = \"p\"\nx = \"width\"\n",
                    "'x' in [[plots]] is not of this kind");
    expect_bad_file("[[plots]]\nkind = \"waterfall\"\ntitle = \"p\"\n", "needs 'pixel'");
    expect_bad_file("[[plots]]\nkind = \"waterfall\"\ntitle = \"p\"\npixel = [0.5, 1]\n",
                    "two whole numbers");
    expect_bad_file("[[plots]]\nkind = \"polr\"\ntitle = \"p\"\n", "did you mean 'polar'?");
}

TEST_F(ExperimentCommand, PlotsOfKnownPictures) {
    // Bright to the right, dark to the left; the test half as bright, in two values.
    Framebuffer reference = plain(32, 32, 0.2F), test = plain(32, 32, 0.1F);
    for (int y = 0; y < 32; ++y) {
        for (int x = 16; x < 32; ++x) {
            set(reference, x, y, {0.8F, 0.8F, 0.8F, 1.0F});
            const float value = y < 16 ? 100.0F / 255.0F : 102.0F / 255.0F;
            set(test, x, y, {value, value, value, 1.0F});
        }
    }
    const lab::Store store(path("store"));
    save_image(test, store.images() / "c.test.exr");
    save_image(reference, store.images() / "c.reference.exr");
    lab::Results results;
    results.experiment.axes = {{"scene", false, {{"s", {}, true}}}};
    results.cells.push_back({{0}, {}, {}, "c"});
    results.found.emplace_back(lab::CellResult{});
    // Interior pixels: all but the border.
    const std::string codes = lab::codes_commands(results, 0, store).value();
    EXPECT_SAYS(codes, "$test << END\n100 225\n102 225\nEND\n");
    EXPECT_SAYS(codes, "$reference << END\n204 450\nEND\n");
    const std::string polar = lab::polar_commands(results, {}, "", store).value();
    const auto at = [&](const char* block, const char* angle) {
        const std::size_t begin = polar.find(block);
        const std::size_t line = polar.find(std::string("\n") + angle + " ", begin);
        return std::stod(polar.substr(line + std::string(angle).size() + 2));
    };
    // The first of 16 steps lies between both sides.
    EXPECT_NEAR(at("$reference", "0"), (15 * 0.8 + 0.5) / 16, 1e-6);
    EXPECT_NEAR(at("$reference", "180"), (15 * 0.2 + 0.5) / 16, 1e-6);
    EXPECT_NEAR(at("$reference", "90"), 0.5, 1e-6);
    EXPECT_GT(at("$cell0", "315"), at("$cell0", "45"));
    results.cells.front().name = "nowhere";
    EXPECT_FALSE(lab::codes_commands(results, 0, store));
}

}  // namespace
}  // namespace burnish
