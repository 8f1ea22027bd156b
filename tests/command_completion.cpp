// What shells complete, asked of the shells themselves.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/run_command.hpp"

namespace burnish {
namespace {

class Completion : public Command {
  protected:
    void SetUp() override {
        Command::SetUp();
        for (const char* shell : {"bash", "zsh"}) {
            const Result result = run(std::string("completion ") + shell);
            ASSERT_EQ(result.code, 0) << result.err;
            write(path(std::string("burnish.") + shell), result.out);
        }
        write(path("scene.toml"), "");
        write(path("other scene.toml"), "");
        write(path("mesh.PLY"), "");
        write(path("notes.txt"), "");
        write(path("picture.png"), "");
        std::filesystem::create_directory(path("folder"));
    }

    /// Runs `script` in the directory and returns what it printed.
    std::string output(const std::string& shell, const std::string& script) {
        write(path("script"), script);
        const std::string line =
            "cd '" + directory().string() + "' && " + shell + " script >out 2>err </dev/null";
        EXPECT_EQ(std::system(line.c_str()), 0) << read(path("err"));
        EXPECT_EQ(read(path("err")), "");
        return read(path("out"));
    }

    /// What bash offers for the last of `words`, as readline hands them over; sorted, with commas.
    std::string offered(const std::string& words) {
        return output("bash", R"(
set -u  # -e would end it at compopt, which wants a completion going on
source burnish.bash
COMP_WORDS=()" + words + R"()
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_burnish
if ((${#COMPREPLY[@]} == 0)); then exit; fi
printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort | paste -sd ,
)");
    }
};

TEST_F(Completion, BashKnowsVerbs) {
    EXPECT_EQ(offered("burnish ren"), "render\n");
    EXPECT_EQ(offered("burnish com"), "compare,compile,completion\n");
    EXPECT_EQ(offered("burnish bake ''"), "--help,-h,anisotropy,brushed,material,mesh,mips\n");
    EXPECT_EQ(offered("burnish bake m"), "material,mesh,mips\n");
    EXPECT_EQ(offered("burnish --v"), "--version\n");
}

TEST_F(Completion, BashKnowsOptionsAndTheirWords) {
    EXPECT_EQ(offered("burnish render scene.toml --camera-v"),
              "--camera-view-angle,--camera-view-up\n");
    EXPECT_EQ(offered("burnish bake mips --me"), "--method\n");
    EXPECT_EQ(offered("burnish render --machine ''"), "double,geforce256,ideal,nv2a\n");
    EXPECT_EQ(offered("burnish render --machine = nv"), "nv2a\n") << "--machine=nv";
    EXPECT_EQ(offered("burnish render --machine ="), "double,geforce256,ideal,nv2a\n");
    EXPECT_EQ(offered("burnish render --half-vector c"), "cube:\n");
    EXPECT_EQ(offered("burnish bake mesh k"), "knot\n");
    EXPECT_EQ(offered("burnish completion ''"), "bash,zsh\n");
    EXPECT_EQ(offered("burnish compare a.png b.png --metric rmse,ps"), "rmse,psnr\n");
    EXPECT_EQ(offered("burnish compare a.png b.png --threshold rm"), "rmse=\n");
    EXPECT_EQ(offered("burnish render --samples ''"), "") << "any number";
}

TEST_F(Completion, BashKnowsFilesByExtension) {
    EXPECT_EQ(offered("burnish render ''"), "folder,mesh.PLY,other scene.toml,scene.toml\n");
    EXPECT_EQ(offered("burnish render --material ''"), "folder,other scene.toml,scene.toml\n");
    EXPECT_EQ(offered("burnish compare pic"), "picture.png\n");
    EXPECT_EQ(offered("burnish bake brushed -o ''"), "folder\n");
    EXPECT_EQ(offered("burnish experiment e1"), "e1,e10,e11,e12\n");
    EXPECT_EQ(offered("burnish experiment sc"), "scene.toml\n");
}

/// Lines of its editor after a tab, in a terminal of its own.
TEST_F(Completion, ZshKnowsTheSame) {
    if (std::system("command -v zsh >/dev/null") != 0) GTEST_SKIP() << "no zsh";
    const std::string typed = output("zsh -f", R"(
zmodload zsh/zpty
zpty shell 'TERM=dumb zsh -f -i'
say() { zpty -w shell "$1" }
say 'PS1=; autoload -Uz compinit; compinit -u -D; source ./burnish.zsh; unsetopt beep
report() { print -r -- "$BUFFER|" >> lines; BUFFER= }
zle -N report; bindkey "^X" report; zstyle ":completion:*" menu no; : > lines'
for line in 'burnish ren' 'burnish bake mi' 'burnish render --machine=nv' 'burnish render --multi' \
            'burnish render --half-vector=cu' 'burnish bake mesh k' 'burnish compare pic' \
            'burnish render mesh' 'burnish compare --metric rmse,ps' 'burnish experiment e7_' \
            'burnish bake brushed -o f'; do
    zpty -w -n shell "$line"$'\t\x18'
done
zpty -w shell ''
say 'print done > finished'
for ((i = 0; i < 300; ++i)); do
    if [[ -s finished ]]; then break; fi
    sleep 0.1
    zpty -r -t shell >/dev/null
done
cat lines
zpty -d shell
)");
    EXPECT_EQ(typed,
              "burnish render |\nburnish bake mips |\nburnish render --machine=nv2a |\n"
              "burnish render --multipass |\nburnish render --half-vector=cube:|\n"
              "burnish bake mesh knot |\nburnish compare picture.png |\nburnish render mesh.PLY |\n"
              "burnish compare --metric rmse,psnr,|\nburnish experiment e7_edge |\n"
              "burnish bake brushed -o folder/|\n");
}

}  // namespace
}  // namespace burnish
