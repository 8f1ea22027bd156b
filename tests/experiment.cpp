#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/experiment.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "lab/experiment/formula.hpp"
#include "lab/experiment/verdicts.hpp"
#include "tests/json.hpp"
#include "tests/tiny_experiment.hpp"

namespace burnish {
namespace {

TEST_F(ExperimentCommand, WritesEveryDocument) {
    const Result result = run("experiment tiny.toml -o out");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "out/report.html: 4 cells, confirmed\n");
    const Json results = Json::parse(read(path("out/results.json")));
    EXPECT_EQ(results["cells"].list.size(), 4U);
    EXPECT_EQ(results["verdict"].text, "confirmed");
    EXPECT_GT(results["cells"][0]["rmse"].number, results["cells"][2]["rmse"].number);
    const Json manifest = Json::parse(read(path("out/manifest.json")));
    EXPECT_EQ(manifest["inputs"].object.size(), 2U);
    EXPECT_EQ(manifest["cells"][1]["test"]["materials.metal.alpha_x"].text, "0.6");
    // The reference does not see which machine is tested, but which material.
    EXPECT_EQ(manifest["cells"][1]["reference"]["machine.profile"].text, "\"double\"");
    EXPECT_EQ(manifest["cells"][1]["reference"]["materials.metal.alpha_x"].text, "0.6");
    const std::string report = read(path("out/report.html"));
    EXPECT_SAYS(report, "Tiny &amp; small");
    EXPECT_SAYS(report, "data:image/png;base64,iVBORw0KGgo");
    EXPECT_EQ(report.find("http"), report.find("http://www.w3.org")) << "a file of another place";
    for (const char* what :
         {"test.exr", "reference.exr", "test.png", "reference.png", "error.png", "flip.png"})
        EXPECT_TRUE(std::filesystem::exists(path("out/images/ball-nv2a-0.3.") += what)) << what;
}

TEST_F(ExperimentCommand, GoesOnWhereItStopped) {
    compute("whole", {.threads = 1});
    const std::string whole = csv("whole");
    EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 5) << whole;
    // The first half, then all that is left; finished cells stay as they are.
    EXPECT_EQ(compute("part", {.shard = 1, .shards = 2}).missing, 2U);
    EXPECT_NE(csv("part"), whole);
    const auto kept = std::filesystem::directory_iterator(path("part/cells"))->path();
    const auto written = std::filesystem::last_write_time(kept);
    EXPECT_EQ(compute("part", {.threads = 3}).missing, 0U);
    EXPECT_EQ(csv("part"), whole);
    EXPECT_EQ(std::filesystem::last_write_time(kept), written);
}

TEST_F(ExperimentCommand, ShardsMergeToTheWhole) {
    compute("whole");
    for (const int shard : {1, 2, 3})
        compute("s" + std::to_string(shard), {.shard = shard, .shards = 3});
    expect_error("1 of 4 cells", [&] { merge({"s1", "s3"}, "joined"); });
    EXPECT_EQ(merge({"s1", "s2", "s3"}, "joined").verdict, "confirmed");
    EXPECT_EQ(csv("joined"), csv("whole"));
    compute("quick", {.quick = true});
    expect_error("tiny.toml, quick", [&] { merge({"s1", "quick"}, "other"); });
    expect_error("nowhere/run.txt", [&] { merge({"s1", "nowhere"}, "other"); });
}

TEST_F(ExperimentCommand, ADamagedCellIsComputedAgain) {
    compute("out");
    const std::string whole = csv("out");
    const auto cell = std::filesystem::directory_iterator(path("out/cells"))->path();
    const std::string text = read(cell);
    for (const std::string& bytes :
         {std::string(), text.substr(0, text.size() - 5), "x" + text, text + "rmse 1\nend\n",
          text.substr(0, text.find("\nrmse ")) + "\nrmse one\nms 1\nend\n"}) {
        write(cell, bytes);
        compute("out");
        EXPECT_EQ(csv("out"), whole) << bytes;
    }
}

TEST_F(ExperimentCommand, TheQuickFormHasFewerCells) {
    const lab::ExperimentOutcome outcome = compute("out", {.quick = true});
    EXPECT_EQ(outcome.cells, 2U);
    EXPECT_EQ(outcome.verdict, "open");
}

TEST_F(ExperimentCommand, RefusalsAreResults) {
    write_experiment("[set]\n\"materials.metal.model\" = \"ward\"\n");
    EXPECT_EQ(compute("out").refused, 2U);
    EXPECT_SAYS(csv("out"), "ward on 'nv2a'");
}

TEST_F(ExperimentCommand, BadInputIsOneLine) {
    expect_failure("experiment missing.toml -o out", 3, "missing.toml");
    expect_failure("experiment e99 -o out", 2, "unknown experiment 'e99'");
    expect_failure("experiment tiny.toml -o out --shard 3/2", 2, "--shard 3/2");
    expect_failure("experiment tiny.toml tiny.toml -o out", 2, "unexpected 'tiny.toml'");
    expect_failure("experiment merge -o out", 2, "expected DIR");
}

TEST_F(ExperimentCommand, BadFilesNameTheLine) {
    expect_bad_file("metrix = 1\n", "tiny.toml:39: unknown key 'metrix' in [[expect]]");
    expect_bad_file("[tests]\n", "did you mean 'test'?");
    expect_bad_file("[[plots]]\ntitle = \"p\"\nx = \"machin\"\ny = \"rmse\"\n",
                    "no axis 'machin', did you mean 'machine'?");
    expect_bad_file("[[sheets]]\ntitle = \"s\"\nwhere = { machine = \"nv2\" }\n",
                    "'machine' has no value 'nv2', did you mean 'nv2a'?");
    expect_bad_file("[[plots]]\ntitle = \"p\"\nx = \"width\"\ny = \"rms\"\n",
                    "unknown metric 'rms' in [[plots]], did you mean 'rmse'?");
    expect_bad_file("[set]\nmachine.profile = \"nv2a\"\n", "stands in quotes");
    expect_bad_file("[quick]\nsamples = 5\n", "expected a square");
    expect_bad_file("[[scenes]]\nfile = \"none.toml\"\n", "none.toml is not there");
    expect_bad_file("[[sweeps]]\nname = \"width\"\nkey = \"a\"\nvalues = [1]\n",
                    "second axis with the name 'width'");
    expect_bad_file("[[sweeps]]\nname = \"more\"\nkey = \"a\"\nvalues = [1, 1]\n",
                    "the value '1' twice");
}

TEST_F(ExperimentCommand, TimesAreNoPartOfAResult) {
    compute("out");
    const std::string csv_once = csv("out");
    const auto cell = std::filesystem::directory_iterator(path("out/cells"))->path();
    const auto written = std::filesystem::last_write_time(cell);
    std::string text = read(path("tiny.toml"));
    write(path("tiny.toml"), "repeats = 3\n" + text);
    compute("out");
    EXPECT_EQ(std::filesystem::last_write_time(cell), written);
    compute("timed");
    EXPECT_EQ(csv("timed"), csv_once);
    const Json results = Json::parse(read(path("timed/results.json")));
    for (const Json& each : results["cells"].list) {
        EXPECT_GT(each["ms_low"].number, 0.0);
        EXPECT_LE(each["ms_low"].number, each["ms"].number);
        EXPECT_LE(each["ms"].number, each["ms_high"].number);
    }
}

TEST_F(ExperimentCommand, BadSettingsNameTheCell) {
    write_experiment("[set]\n\"materials.metal.alpha\" = 1\n");
    try {
        compute("out");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_SAYS(std::string(error.what()), "unknown key 'alpha'");
        EXPECT_SAYS(std::string(error.what()), "cell ball-nv2a-0.3 of tiny");
    }
}

TEST(Formulas, KnownValues) {
    const std::map<std::string, double> variables{{"N", 12.0}, {"width", 0.5}};
    const auto value = [&](const char* text) { return lab::evaluate_formula(text, variables); };
    EXPECT_DOUBLE_EQ(value("$width * sqrt(($N + 4) / 4)"), 1.0);
    EXPECT_DOUBLE_EQ(value("1 - 2 - 3 * 2 ^ 3"), -25.0);
    EXPECT_DOUBLE_EQ(value("-2 * -3"), 6.0);
    EXPECT_NEAR(value("cos(60) + sin(30)"), 1.0, 1e-12);
    EXPECT_DOUBLE_EQ(value("round(2.5) + min($N, 3) + log2(8)"), 9.0);
    for (const char* text :
         {"", "1 +", "(1", "1 2", "$M", "sqrt 4", "1 / 0", "sqrt(0 - 1)", "min(1)"})
        EXPECT_THROW(value(text), Error) << text;
    EXPECT_THROW(value(std::string(100000, '(').c_str()), Error);
    EXPECT_EQ(lab::with_formulas(R"([1, "=$N / 8", "a"])", variables), R"([1, 1.5, "a"])");
}

TEST_F(ExperimentCommand, MirroredChartsMeetAtTheSameU) {
    write(path("mirrored.toml"),
          "schema = 1\n[[objects]]\nshape = \"plane\"\ncolumns = 4\nrows = 1\n"
          "mirror_u = true\n");
    const Scene scene = load_scene(path("mirrored.toml")).scene;
    const Mesh& mesh = std::get<Mesh>(scene.objects.front().geometry);
    EXPECT_EQ(mesh.triangle_count(), 8U);
    EXPECT_EQ(mesh.vertex_count(), 12U) << "two columns of vertices in the middle";
    for (const VertexFrame& vertex : mesh.frames()) {
        EXPECT_FLOAT_EQ(vertex.uv.x, std::abs(2.0F * vertex.position.x)) << vertex.position.x;
        if (vertex.position.x != 0.0F) {
            EXPECT_FLOAT_EQ(vertex.tangent.x, vertex.position.x > 0.0F ? 1.0F : -1.0F);
        }
        EXPECT_FLOAT_EQ(vertex.tangent.w * vertex.tangent.x, 1.0F) << "the bitangent stays";
    }
}

/// Numbers over labels, without pictures.
class Judged : public testing::Test {
  protected:
    static lab::Results results_of(const std::vector<std::pair<double, double>>& points) {
        lab::Results results;
        ExperimentAxis scene, axis;
        scene.name = "scene";
        scene.values.push_back({"s", {}, true});
        axis.name = "n";
        results.experiment.metrics = {"rmse"};
        for (std::size_t i = 0; i < points.size(); ++i) {
            axis.values.push_back({std::to_string(points[i].first), {}, true});
            lab::Cell cell;
            cell.values = {0, i};
            results.cells.push_back(cell);
            results.found.push_back(
                lab::CellResult{{{"rmse", points[i].second}}, "", 0.0, 0.0, 0.0});
        }
        results.experiment.axes = {scene, axis};
        return results;
    }

    static double only_measure(ExperimentMeasure measure,
                               const std::vector<std::pair<double, double>>& points) {
        ExperimentExpectation expectation;
        expectation.metric = "rmse";
        expectation.measure = measure;
        expectation.along = "n";
        expectation.at_least = 0.0;
        const lab::Judgement judgement = lab::judge(results_of(points), expectation);
        return judgement.measures.size() == 1 ? judgement.measures.front() : NAN;
    }
};

TEST_F(Judged, MeasuresOfKnownCurves) {
    // y = 3 x^-2, y = 5 * 2^-x, and a U.
    EXPECT_NEAR(only_measure(ExperimentMeasure::slope, {{1, 3}, {2, 0.75}, {8, 3.0 / 64}}), -2.0,
                1e-12);
    EXPECT_NEAR(only_measure(ExperimentMeasure::halving, {{8, 5}, {9, 2.5}, {12, 0.3125}}), 2.0,
                1e-12);
    EXPECT_EQ(only_measure(ExperimentMeasure::argmin, {{2, 3}, {4, 1}, {8, 2}}), 4.0);
    EXPECT_EQ(only_measure(ExperimentMeasure::argmax, {{2, 3}, {4, 1}, {8, 2}}), 2.0);
}

TEST_F(Judged, OneMeasureOutsideRefutes) {
    ExperimentExpectation expectation;
    expectation.metric = "rmse";
    expectation.at_least = 1.0;
    expectation.at_most = 2.0;
    EXPECT_EQ(lab::judge(results_of({{1, 1.0}, {2, 2.0}}), expectation).verdict,
              lab::Verdict::confirmed);
    EXPECT_EQ(lab::judge(results_of({{1, 1.0}, {2, 2.5}}), expectation).verdict,
              lab::Verdict::refuted);
    EXPECT_EQ(lab::judge(results_of({{1, 1.0}, {2, NAN}}), expectation).verdict,
              lab::Verdict::open);
    EXPECT_EQ(lab::judge(results_of({}), expectation).verdict, lab::Verdict::open);
}

}  // namespace
}  // namespace burnish
