// What the command says of texture units that are off.
#include "tests/run_command.hpp"

namespace burnish {
namespace {

TEST_F(Command, SaysWhichTextureUnitsAreOff) {
    write(path("s.toml"), R"(schema = 1
[output]
width = 4
height = 4
[machine]
profile = "nv2a"
[[textures]]
name = "t"
width = 1
height = 1
texels = [10, 20, 30, 255]
[[materials]]
name = "bumpy"
units = ["t", "t"]
texture_shader_text = '''!!TS1.0 texture_2d(); offset_2d(tex0, 1, 0, 0, 1);'''
combiners_text = '''!!RC1.0 out.rgb = tex1; out.a = tex0;'''
[[objects]]
material = "bumpy"
space = "window"
vertices = [
{ position = [0, 0, 0.5] }, { position = [8, 0, 0.5] }, { position = [0, 8, 0.5] },
]
)");
    const std::string note =
        "burnish: material 'bumpy', texture unit 1 is off: offset_2d reads unit 0, whose texels "
        "are "
        "unsigned colours, expected DSDT\n";
    Result result = run("render s.toml -o s.png");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, note);
    EXPECT_EQ(run("render s.toml --quiet -o s.png").err, "");
    result = run("trace s.toml --pixel 1,1");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, note);
    EXPECT_SAYS(result.out, "unit 1: offset_2d(tex0, 1, 0, 0, 1)\n  off: offset_2d reads unit 0");
    result = run("trace s.toml --pixel 1,1 --json");
    EXPECT_SAYS(result.out, "\"problem\": \"offset_2d reads unit 0");
}

}  // namespace
}  // namespace burnish
