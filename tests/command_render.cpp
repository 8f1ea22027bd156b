// Frame ranges, references and progress of the command.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/run_command.hpp"

namespace burnish {
namespace {

/// Sanitizers find nothing here that takes them a minute to find.
bool without_terminal() {
#ifdef BURNISH_SANITIZED
    return true;
#else
    return std::system("command -v script >/dev/null") != 0;
#endif
}

class RenderCommand : public Command {
  protected:
    void SetUp() override {
        Command::SetUp();
        write_scene("s.toml");
    }

    /// What the command prints on a terminal of its own, where "\r\x1b[K" takes a line away.
    std::string on_terminal(const std::string& arguments) {
        const std::string line =
            fmt::format("cd '{}' && script -qec \"'{}' {}\" /dev/null >typed </dev/null",
                        directory().string(), BURNISH_COMMAND, arguments);
        EXPECT_EQ(std::system(line.c_str()), 0) << line;
        return read(path("typed"));
    }
};

constexpr const char kGone[] = "\r\x1b[K";

TEST_F(RenderCommand, FrameRangesAreTheTurnsOwnPictures) {
    const std::string turn = "render s.toml --turntable 5 --quiet -o ";
    ASSERT_EQ(run(turn + "'whole-{frame:2}.png'").code, 0);
    ASSERT_EQ(run(turn + "'part-{frame:2}.png' --frames 0-1").code, 0);
    ASSERT_EQ(run(turn + "'part-{frame:2}.png' --frames 3").code, 0);
    EXPECT_EQ(entries(), (std::vector<std::string>{
                             "part-00.png", "part-01.png", "part-03.png", "s.toml", "whole-00.png",
                             "whole-01.png", "whole-02.png", "whole-03.png", "whole-04.png"}));
    for (const char* frame : {"00", "01", "03"})
        EXPECT_EQ(read(path(fmt::format("part-{}.png", frame))),
                  read(path(fmt::format("whole-{}.png", frame))));
    EXPECT_NE(read(path("whole-00.png")), read(path("whole-03.png")));
    expect_failure("render s.toml --frames 0-1", 2, "--turntable");
    expect_failure(turn + "'x{frame}.png' --frames 3-5", 2, "expected some of 0 .. 4");
    for (const char* bad : {"3-1", "a", "1-", "-1", "1-2-3", "99999999999"})
        expect_failure(turn + "'x{frame}.png' --frames=" + bad, 2, "expected A-B");
}

TEST_F(RenderCommand, ReferencesFailPicturesThatDiffer) {
    const std::string render = "render s.toml --quiet ";
    ASSERT_EQ(run(render + "-o same.png").code, 0);
    ASSERT_EQ(run(render + "-o moved.png --light 1,0,0").code, 0);
    EXPECT_EQ(run(render + "--reference same.png").code, 0) << "the same bits every time";
    const Result differs = run(render + "--reference moved.png -o out.png");
    EXPECT_EQ(differs.code, 1);
    EXPECT_TRUE(differs.err.starts_with("burnish: out.png: max 0.")) << differs.err;
    EXPECT_SAYS(differs.err, ", expected at most 0\n");
    EXPECT_EQ(read(path("out.png")), read(path("same.png"))) << "written all the same";

    // The limit is that of `compare`.
    const std::string text = run("compare same.png moved.png --metric rmse").out;
    const double rmse = std::stod(text.substr(text.find("rmse") + 4));
    ASSERT_GT(rmse, 0.01);
    const std::string limit = render + "--reference moved.png --reference-threshold ";
    EXPECT_EQ(run(limit + fmt::format("rmse={}", 1.01 * rmse)).code, 0);
    EXPECT_EQ(run(limit + fmt::format("rmse={}", 0.99 * rmse)).code, 1);
    EXPECT_EQ(run(limit + fmt::format("{}", 0.99 * rmse)).code, 1) << "a number alone is of rmse";
    EXPECT_EQ(run(limit + fmt::format("{}", 1.01 * rmse)).code, 0);
    const Result two = run(limit + "psnr=90,ssim=0.9999");
    EXPECT_EQ(two.code, 1);
    EXPECT_SAYS(two.err, ": psnr ");
    EXPECT_SAYS(two.err, ": ssim ");
}

TEST_F(RenderCommand, ReferencesOfATurnHaveNumbers) {
    const std::string turn = "render s.toml --turntable 3 --quiet -o ";
    ASSERT_EQ(run(turn + "'old-{frame}.png'").code, 0);
    EXPECT_EQ(run(turn + "'new-{frame}.png' --reference 'old-{frame}.png'").code, 0);
    std::filesystem::rename(path("old-2.png"), path("old-1.png"));
    const Result wrong = run(turn + "'new-{frame}.png' --frames 0-1 --reference 'old-{frame}.png'");
    EXPECT_EQ(wrong.code, 1);
    EXPECT_TRUE(wrong.err.starts_with("burnish: new-1.png: max ")) << wrong.err;
}

TEST_F(RenderCommand, ReferencesThatAreNoneAreBadInputBeforeAnythingIsDrawn) {
    write_scene("large.toml");
    ASSERT_EQ(run("render large.toml --size 8x8 -o small.png").code, 0);
    expect_failure("render s.toml --reference missing.png", 3, "missing.png: No such file");
    expect_failure("render s.toml --reference small.png", 3,
                   "s.png: 40 x 30 pixels, expected 8 x 8 as in small.png");
    expect_failure("render s.toml --reference small.png -o -", 2, "-o -, expected a file");
    expect_failure("render s.toml --reference-threshold 1", 2, "--reference");
    expect_failure("render s.toml --reference small.png --reference-threshold rsme=1", 2,
                   "did you mean 'rmse'?");
    expect_failure("render s.toml --reference 'a{frame:x}.png'", 2, "{frame:W}");
}

TEST_F(RenderCommand, ProgressIsShownOnATerminalAndGoneAfterwards) {
    if (without_terminal()) GTEST_SKIP() << "no script(1), or with sanitizers";
    const std::string render =
        "render s.toml --machine double --size 320x240 --threads 1 --samples ";
    const std::string typed = on_terminal(render + "400");
    // A machine that needs less than a second has nothing to show.
    if (typed.find("s left") != std::string::npos) {
        EXPECT_SAYS(typed, "\r[#");
        EXPECT_SAYS(typed, "/300, ") << "tiles of 16 x 16";
        EXPECT_SAYS(typed, " s left\x1b[K");
        EXPECT_SAYS(typed, kGone + std::string("s.png: 320 x 240"));
    }
    EXPECT_EQ(run(render + "225").err, "") << "no terminal";
}

/// Where nobody knows how much there is to do, seconds are counted.
TEST_F(RenderCommand, BakingTellsSeconds) {
    if (without_terminal()) GTEST_SKIP() << "no script(1), or with sanitizers";
    const std::string typed = on_terminal("bake material orbital --size 1024 -o orbital");
    if (typed.find('\x1b') != std::string::npos) {
        EXPECT_TRUE(typed.starts_with("\r1 s\x1b[K")) << typed;
        EXPECT_SAYS(typed, kGone + std::string("orbital: material.toml"));
    }
}

}  // namespace
}  // namespace burnish
