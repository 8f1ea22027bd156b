// What captures of a real NV2A show, drawn through scene files: programs as text, quads in window
// coordinates, the codes of the frame. The numbers are the chip's (COMBINERS facts H1 to H15).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

using Bytes = std::array<int, 4>;

class HardwareFacts : public ScratchDirectory {
  protected:
    /// A frame of `width` x `height` pixels, filled by one quad with coordinates 0 .. 1.
    Framebuffer draw(const std::string& material, int width, int height,
                     const std::string& vertex = "", const std::string& textures = "") {
        std::string text = fmt::format(
            "schema = 1\n[output]\nwidth = {}\nheight = {}\n[machine]\nprofile = \"nv2a\"\n{}"
            "[[materials]]\nname = \"m\"\n{}[[objects]]\nmaterial = \"m\"\nspace = \"window\"\n"
            "primitive = \"quads\"\ndepth_test = \"always\"\nvertices = [\n",
            width, height, textures, material);
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            text += fmt::format("{{ position = [{}, {}, 0.5], uv0 = [{}, {}]{} }},\n", x * width,
                                y * height, x, y, vertex.empty() ? "" : ", " + vertex);
        }
        write(path("s.toml"), text + "]\n");
        const Scene scene = load_scene(path("s.toml")).scene;
        Framebuffer frame(width, height);
        Renderer().render(scene, frame);
        return frame;
    }
    static Bytes pixel(const Framebuffer& frame, int x, int y = 0) {
        const std::byte* at = frame.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
        return {std::to_integer<int>(at[0]), std::to_integer<int>(at[1]),
                std::to_integer<int>(at[2]), std::to_integer<int>(at[3])};
    }
    /// The colour of a program with both constants.
    Bytes run(const std::string& program, const Bytes& const0, const Bytes& const1 = {},
              const std::string& more = "") {
        const auto list = [](const Bytes& b) {
            return fmt::format("[{}, {}, {}, {}]", b[0], b[1], b[2], b[3]);
        };
        return pixel(draw(fmt::format("combiners_text = '''!!RC1.0\n{}'''\nconst0_bytes = {}\n"
                                      "const1_bytes = {}\n{}",
                                      program, list(const0), list(const1), more),
                          1, 1),
                     0);
    }
};

const Bytes kSteps{25, 63, 255, 127};

TEST_F(HardwareFacts, H1ConstantsAreBytes) {
    EXPECT_EQ(run("out.rgb = const0; out.a = const0;", kSteps), (Bytes{25, 63, 255, 127}));
}

TEST_F(HardwareFacts, H2HalfOfTheOutputBiasIs128) {
    EXPECT_EQ(
        run("{ rgb { spare0 = const0; bias_by_negative_one_half(); } } out.rgb = spare0;", kSteps),
        (Bytes{0, 0, 127, 0}));
    EXPECT_EQ(run("{ rgb { spare0 = const0; bias_by_negative_one_half_scale_by_two(); } }"
                  "out.rgb = spare0;",
                  kSteps),
              (Bytes{0, 0, 254, 0}));
}

TEST_F(HardwareFacts, H3HalvesRoundUp) {
    EXPECT_EQ(run("{ rgb { spare0 = const0; scale_by_one_half(); } } out.rgb = spare0;", kSteps),
              (Bytes{13, 32, 128, 0}));
}

TEST_F(HardwareFacts, H4DoublingsSaturate) {
    EXPECT_EQ(run("{ rgb { spare0 = const0; scale_by_two(); } } out.rgb = spare0;", kSteps),
              (Bytes{50, 126, 255, 0}));
    EXPECT_EQ(run("{ rgb { spare0 = const0; scale_by_four(); } } out.rgb = spare0;", kSteps),
              (Bytes{100, 252, 255, 0}));
}

TEST_F(HardwareFacts, H5TheAlphaPortionDoesTheSame) {
    const Bytes white{255, 255, 255, 255};
    EXPECT_EQ(run("{ alpha { spare0 = const0; bias_by_negative_one_half(); } } out.a = spare0;",
                  white)[3],
              127);
    EXPECT_EQ(run("{ alpha { spare0 = const0; scale_by_one_half(); } } out.a = spare0;", white)[3],
              128);
}

TEST_F(HardwareFacts, H6UnsignedInvertIs255Minus) {
    EXPECT_EQ(run("out.rgb = unsigned_invert(const0);", {191, 0, 255, 0}), (Bytes{64, 255, 0, 0}));
}

TEST_F(HardwareFacts, H7TheFinalSumKeepsNineBits) {
    const std::string sum =
        "{ rgb { spare0 = const0; col1 = const1; } } out.rgb = color_sum * const0.a;";
    EXPECT_EQ(run(sum, {255, 255, 255, 127}, {255, 255, 255, 0}), (Bytes{254, 254, 254, 0}));
}

TEST_F(HardwareFacts, H7TheClampOfTheSum) {
    const std::string stage = "{ rgb { spare0 = const0; col1 = const1; } } ";
    EXPECT_EQ(run(stage + "clamp_color_sum(); out.rgb = color_sum * const0.a;",
                  {255, 255, 255, 127}, {255, 255, 255, 0}),
              (Bytes{127, 127, 127, 0}));
}

TEST_F(HardwareFacts, H7ComplementsOfTheSum) {
    const std::string program = "{ rgb { spare0 = const0; col1 = const1; } } out.rgb = color_sum;";
    const Bytes a{63, 127, 191, 0}, b{178, 127, 38, 0};
    const auto complement = [](const char* which) {
        return fmt::format("[materials.hardware]\ncomplement = [\"{}\"]\n", which);
    };
    EXPECT_EQ(run(program, a, b), (Bytes{241, 254, 229, 0}));
    EXPECT_EQ(run(program, a, b, complement("spare0")), (Bytes{255, 255, 102, 0}));
    EXPECT_EQ(run(program, a, b, complement("secondary")), (Bytes{140, 255, 255, 0}));
}

TEST_F(HardwareFacts, H8ProductOfEAndF) {
    EXPECT_EQ(run("final_product = const0 * const1; out.rgb = final_product;", {255, 191, 127, 0},
                  {127, 127, 127, 0}),
              (Bytes{127, 95, 63, 0}));
}

TEST_F(HardwareFacts, H9FinalProductsRoundToNearest) {
    const std::array<std::pair<int, int>, 5> pairs{
        {{128, 26}, {153, 31}, {178, 36}, {204, 41}, {229, 46}}};
    for (const auto& [x, product] : pairs)
        EXPECT_EQ(run("out.rgb = const0 * const1;", {51, 51, 51, 0}, {x, x, x, 0})[0], product);
}

TEST_F(HardwareFacts, H10TheFinalLerpRoundsItsTotal) {
    for (int f = 0; f < 256; ++f) {
        const Bytes got =
            run("out.rgb = lerp(const0.a, const0, const1);", {255, 255, 255, f}, {48, 32, 127, 0});
        const auto want = [&](int c) {
            return static_cast<int>(std::floor((f * 255 + (255 - f) * c) / 255.0 + 0.5));
        };
        ASSERT_EQ(got, (Bytes{want(48), want(32), want(127), 0})) << "f " << f;
    }
}

TEST_F(HardwareFacts, H11BlueToAlphaCopiesTheResult) {
    for (const int blue : {255, 191, 127, 63, 0}) {
        const Bytes color{10, 20, blue, 40};
        EXPECT_EQ(run("{ rgb { spare0 = const0; } } out.rgb = spare0; out.a = spare0;", color, {},
                      "[materials.hardware]\nblue_to_alpha = [[0, \"ab\"]]\n"),
                  (Bytes{10, 20, blue, blue}));
        EXPECT_EQ(run("{ rgb { discard = zero; spare0 = const0; scale_by_one_half(); } }"
                      "out.rgb = spare0; out.a = spare0;",
                      color, {}, "[materials.hardware]\nblue_to_alpha = [[0, \"cd\"]]\n"),
                  (Bytes{5, 10, (blue + 1) / 2, (blue + 1) / 2}));
    }
}

// All 256 signed bytes through a clamp at zero, and their negatives.
TEST_F(HardwareFacts, H12SignedTexelsEnterAsTwiceTheirValue) {
    std::string texels;
    for (int s = 0; s < 256; ++s) texels += fmt::format("{0}, {0}, {0}, 127, ", s);
    const auto row = [&](const std::string& program) {
        const std::string texture =
            "[[textures]]\nname = \"t\"\nformat = \"signed_rgba8\"\nfilter = \"nearest\"\n"
            "width = 256\nheight = 1\ntexels = [" +
            texels + "]\n";
        return draw("units = [\"t\"]\ncombiners_text = '''!!RC1.0 " + program + "'''\n", 256, 1, "",
                    texture);
    };
    const Framebuffer plain = row("out.rgb = tex0; out.a = tex0;");
    const Framebuffer negated = row("{ rgb { spare0 = -tex0; } } out.rgb = spare0;");
    for (int s = 0; s < 256; ++s) {
        const int value = s < 128 ? s : s - 256;
        ASSERT_EQ(pixel(plain, s)[0], std::max(0, 2 * value)) << "texel " << value;
        ASSERT_EQ(pixel(plain, s)[3], 254);
        ASSERT_EQ(pixel(negated, s)[0], std::min(std::max(0, -2 * value), 255)) << value;
    }
}

// 131,072 pixels: every alpha with every d in red, s and the other channels scattered.
TEST_F(HardwareFacts, H13BlendingRoundsOnce) {
    constexpr int kWidth = 512, kHeight = 256;
    const auto destination = [](int x, int y, int c) {
        return c == 0 ? y : (y * (2 * c + 3) + x * 7 + c * 90) % 256;
    };
    const auto source = [](int x, int y, int c) {
        return c == 3 ? x % 256 : (x / 256 * 128 + x * 37 + y * (11 * c + 5) + c * 50) % 256;
    };
    const auto save = [&](const auto& code, const char* name) {
        Framebuffer image(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 4; ++c)
                    image.row(y)[4 * x + c] = static_cast<std::byte>(code(x, y, c));
        save_image(image, path(name));
    };
    save(destination, "d.png");
    save(source, "s.png");
    std::string text = fmt::format(
        "schema = 1\n[output]\nwidth = {}\nheight = {}\n[machine]\nprofile = \"nv2a\"\n", kWidth,
        kHeight);
    for (const char* name : {"d", "s"})
        text += fmt::format(
            "[[textures]]\nname = \"{0}\"\nfile = \"{0}.png\"\n"
            "filter = \"nearest\"\n[[materials]]\nname = \"{0}\"\nunits = [\"{0}\"]\n"
            "combiners_text = '!!RC1.0 out.rgb = tex0; out.a = tex0;'\n",
            name);
    for (const char* name : {"d", "s"}) {
        text += fmt::format(
            "[[objects]]\nmaterial = \"{}\"\nspace = \"window\"\n"
            "primitive = \"quads\"\ndepth_test = \"always\"\nblend = \"{}\"\n"
            "vertices = [\n",
            name, name[0] == 's' ? "alpha" : "off");
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            text += fmt::format("{{ position = [{}, {}, 0.5], uv0 = [{}, {}] }},\n", x * kWidth,
                                y * kHeight, x, y);
        text += "]\n";
    }
    write(path("s.toml"), text);
    const Scene scene = load_scene(path("s.toml")).scene;
    Framebuffer frame(kWidth, kHeight);
    Renderer().render(scene, frame);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int a = source(x, y, 3);
            for (int c = 0; c < 4; ++c) {
                const int sum = source(x, y, c) * a + destination(x, y, c) * (255 - a);
                ASSERT_EQ(pixel(frame, x, y)[static_cast<std::size_t>(c)],
                          static_cast<int>(std::floor((sum + 127.5) / 255.0)))
                    << x << ", " << y << ", channel " << c;
            }
        }
    }
}

TEST_F(HardwareFacts, H14ColorsOfVerticesBecomeBytes) {
    const std::array<std::pair<const char*, int>, 10> pairs{{{"0.1", 25},
                                                             {"0.2", 51},
                                                             {"0.3", 76},
                                                             {"0.4", 102},
                                                             {"0.5", 128},
                                                             {"0.6", 153},
                                                             {"0.65", 166},
                                                             {"0.7", 178},
                                                             {"0.8", 204},
                                                             {"0.9", 229}}};
    for (const auto& [x, code] : pairs) {
        const Framebuffer frame =
            draw("combiners_text = '''!!RC1.0 out.rgb = col0; out.a = col0;'''\n", 3, 3,
                 fmt::format("color0 = [{0}, {0}, {0}, {0}]", x));
        EXPECT_EQ(pixel(frame, 1, 1), (Bytes{code, code, code, code})) << x;
    }
}

TEST_F(HardwareFacts, H15DisabledUnitsReadBlackWithAlpha1) {
    for (int unit = 0; unit < 4; ++unit) {
        EXPECT_EQ(run(fmt::format("out.rgb = tex{0}; out.a = tex{0};", unit), {}),
                  (Bytes{0, 0, 0, 255}));
        EXPECT_EQ(run(fmt::format("out.rgb = unsigned_invert(tex{});", unit), {}),
                  (Bytes{255, 255, 255, 0}));
    }
}

// Golden "Mux": alpha 0x82, 0x81 and 0, the highest and the lowest bit.
TEST_F(HardwareFacts, TheMuxTestsABitOfAlpha) {
    const std::string program =
        "{ alpha { spare0 = const0; } }"
        "{ rgb { discard = const0; discard = const1; spare1 = mux(); } } out.rgb = spare1;";
    const auto takes_cd = [&](int alpha, const char* bit) {
        return run(program, {10, 10, 10, alpha}, {20, 20, 20, 0},
                   fmt::format("[materials.hardware]\nmux_bit = \"{}\"\n", bit))[0] == 20;
    };
    EXPECT_TRUE(takes_cd(0x82, "msb"));
    EXPECT_FALSE(takes_cd(0x82, "lsb"));
    EXPECT_TRUE(takes_cd(0x81, "msb"));
    EXPECT_TRUE(takes_cd(0x81, "lsb"));
    EXPECT_FALSE(takes_cd(0, "msb"));
    EXPECT_FALSE(takes_cd(0, "lsb"));
}

// Golden "Independence": all reads of a stage come before its writes.
TEST_F(HardwareFacts, PortionsReadWhatWasThereBeforeTheStage) {
    EXPECT_EQ(run("{ rgb { spare0 = const0; spare1 = const1; } }"
                  "{ rgb { spare0 = spare1; spare1 = spare0; } }"
                  "out.rgb = spare0; out.a = spare1.b;",
                  {63, 63, 63, 0}, {191, 191, 191, 0}),
              (Bytes{191, 191, 191, 63}));
}

// Fractions cut to 8 bits, two horizontal lerps rounded half up to bytes, then the vertical one.
TEST_F(HardwareFacts, BilinearFilterInTwoRoundedPasses) {
    constexpr int kSize = 64, kTexels = 4;
    std::string texels;
    std::array<std::array<int, kTexels>, kTexels> red{};
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            red[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
                (x * 97 + y * 61 + x * y * 40) % 256;
            texels += fmt::format("{}, 0, 0, 255, ",
                                  red[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
        }
    }
    const Framebuffer frame =
        draw("units = [\"t\"]\ncombiners_text = '''!!RC1.0 out.rgb = tex0;'''\n", kSize, kSize, "",
             fmt::format("[[textures]]\nname = \"t\"\nwidth = 4\nheight = 4\n"
                         "wrap = [\"clamp_to_edge\", \"clamp_to_edge\"]\ntexels = [{}]\n",
                         texels));
    const auto lerp = [](int a, int b, int w) { return ((256 - w) * a + w * b + 128) / 256; };
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            // Pixel centres lie at odd multiples of 1/32 texel: exact in 1/256.
            const auto position = [](int p) {
                return (2 * p + 1) * 256 * kTexels / (2 * kSize) - 128;
            };
            const auto texel = [&](int tx, int ty) {
                const auto inside = [](int t) {
                    return static_cast<std::size_t>(std::min(std::max(t, 0), kTexels - 1));
                };
                return red[inside(ty)][inside(tx)];
            };
            const int u = position(x), v = position(y);
            const int x0 = u >> 8, y0 = v >> 8;
            const int top = lerp(texel(x0, y0), texel(x0 + 1, y0), u & 255);
            const int bottom = lerp(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), u & 255);
            ASSERT_EQ(pixel(frame, x, y)[0], lerp(top, bottom, v & 255)) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace burnish
