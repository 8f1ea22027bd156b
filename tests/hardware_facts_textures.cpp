// What captures of a real NV2A show of its texture shaders, drawn through scene files, for every
// pair of bytes: 65,536 pixels each. The numbers are the chip's; oracles are written from its
// formulas, in integers where that is possible.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <functional>
#include <string>

#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

using Bytes = std::array<int, 4>;

constexpr int kSize = 256;

/// floor(x / y) for y > 0
int floor_quotient(int x, int y) {
    return x >= 0 ? x / y : -((-x + y - 1) / y);
}

class TextureFacts : public ScratchDirectory {
  protected:
    /// A texture of `width` x `height` texels from a function of column and row.
    std::string texture(const std::string& name, int width, int height,
                        const std::function<Bytes(int, int)>& texel,
                        const std::string& more = "filter = \"nearest\"\n") {
        Image8 image(width, height);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const Bytes bytes = texel(x, y);
                for (std::size_t c = 0; c < 4; ++c)
                    image.at(x, y)[c] = static_cast<std::uint8_t>(bytes[c]);
            }
        }
        save_image(image, path(name + ".png"));
        return fmt::format("[[textures]]\nname = \"{0}\"\nfile = \"{0}.png\"\n{1}", name, more);
    }

    /// A frame of 256 x 256 pixels under one quad; at pixel (x, y) coordinates are exactly those at
    /// (x / 256, y / 256) of the planes through the corners' (0, 0), (1, 0), (0, 1).
    Framebuffer draw(const std::string& textures, const std::string& material,
                     const std::function<std::string(double, double)>& vertex,
                     const std::string& machine = "") {
        std::string text = fmt::format(
            "schema = 1\n[output]\nwidth = 256\nheight = 256\n[machine]\nprofile = \"nv2a\"\n{}"
            "{}[[materials]]\nname = \"m\"\n{}[[objects]]\nmaterial = \"m\"\nspace = \"window\"\n"
            "primitive = \"quads\"\ndepth_test = \"always\"\nvertices = [\n",
            machine, textures, material);
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            const double half = 0.5 / kSize;
            text += fmt::format("{{ position = [{}, {}, 0.5], {} }},\n", x * kSize, y * kSize,
                                vertex(x - half, y - half));
        }
        write(path("s.toml"), text + "]\n");
        const Scene scene = load_scene(path("s.toml")).scene;
        Framebuffer frame(kSize, kSize);
        Renderer().render(scene, frame);
        return frame;
    }
    static Bytes pixel(const Framebuffer& frame, int x, int y) {
        const std::byte* at = frame.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
        return {std::to_integer<int>(at[0]), std::to_integer<int>(at[1]),
                std::to_integer<int>(at[2]), std::to_integer<int>(at[3])};
    }
    /// Unit 0 shows texel (x, y) of a 256 x 256 texture at pixel (x, y).
    static std::string on_the_grid(double x, double y) {
        return fmt::format("uv0 = [{:.17g}, {:.17g}]", x + 0.5 / kSize, y + 0.5 / kSize);
    }
    static std::string shader(const std::string& statements, const std::string& units) {
        return fmt::format(
            "units = [{}]\ntexture_shader_text = '''!!TS1.0\n{}'''\n"
            "combiners_text = '''!!RC1.0 out.rgb = tex1; out.a = tex1;'''\n",
            units, statements);
    }
};

Bytes texel_address(int x, int y) {
    return {x, y, x ^ y, 255 - x};
}

constexpr const char* kNearest =
    "filter = \"nearest\"\nwrap = [\"clamp_to_edge\", "
    "\"clamp_to_edge\"]\n";

TEST_F(TextureFacts, DependentArAddressesByAlphaAndRed) {
    for (const int n : {256, 64, 100}) {
        const Framebuffer frame =
            draw(texture("a", kSize, kSize,
                         [](int x, int y) {
                             return Bytes{y, 7, 9, x};
                         }) +
                     texture("t", n, n, texel_address, kNearest),
                 shader("texture_2d();\ndependent_ar(tex0);\n", "\"a\", \"t\""), on_the_grid);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const auto at = [&](int byte) { return std::min(n - 1, byte * n / 255); };
                ASSERT_EQ(pixel(frame, x, y), texel_address(at(x), at(y)))
                    << n << " texels, alpha " << x << ", red " << y;
            }
        }
    }
}

TEST_F(TextureFacts, DependentGbAddressesByGreenAndBlue) {
    const Framebuffer frame =
        draw(texture("a", kSize, kSize,
                     [](int x, int y) {
                         return Bytes{11, x, y, 200};
                     }) +
                 texture("t", kSize, kSize, texel_address, kNearest),
             shader("texture_2d();\ndependent_gb(tex0);\n", "\"a\", \"t\""), on_the_grid);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const auto at = [&](int byte) { return std::min(255, byte * 256 / 255); };
            ASSERT_EQ(pixel(frame, x, y), texel_address(at(x), at(y))) << x << ", " << y;
        }
    }
}

// 255 is exactly 1.0: the last texel with clamp, the first one again with repeat.
TEST_F(TextureFacts, Byte255AddressesOne) {
    const auto last = [&](const std::string& wrap) {
        const Framebuffer frame =
            draw(texture("a", kSize, kSize,
                         [](int, int) {
                             return Bytes{255, 255, 255, 255};
                         }) +
                     texture(
                         "t", 4, 4,
                         [](int x, int y) {
                             return Bytes{x, y, 0, 255};
                         },
                         "filter = \"nearest\"\nwrap = [\"" + wrap + "\", \"" + wrap + "\"]\n"),
                 shader("texture_2d();\ndependent_ar(tex0);\n", "\"a\", \"t\""), on_the_grid);
        return pixel(frame, 100, 100);
    };
    EXPECT_EQ(last("clamp_to_edge"), (Bytes{3, 3, 0, 255}));
    EXPECT_EQ(last("repeat"), (Bytes{0, 0, 0, 255}));
}

// Dot products are float, of bytes / 255.
TEST_F(TextureFacts, DotStIsAFloatDotProduct) {
    const auto vector = [](int x, int y) { return Bytes{x, y, (7 * x + 13 * y + x * y) % 256, 0}; };
    const Framebuffer frame = draw(
        texture("n", kSize, kSize, vector) + texture("t", kSize, kSize, texel_address, kNearest),
        "units = [\"n\", \"\", \"t\"]\ntexture_shader_text = '''!!TS1.0\ntexture_2d();\n"
        "dot_product_2d_1of2(tex0);\ndot_product_2d_2of2(tex0);\n'''\n"
        "combiners_text = '''!!RC1.0 out.rgb = tex2; out.a = tex2;'''\n",
        [](double x, double y) {
            return on_the_grid(x, y) +
                   fmt::format(", uv1 = [{:.17g}, 0.25, 0.375], uv2 = [0.5, {:.17g}, 0.125]", x, y);
        });
    int inexact = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const Bytes v = vector(x, y);
            const auto c = [&](std::size_t k) { return static_cast<float>(v[k]) / 255.0F; };
            const float fx = static_cast<float>(x) / 256.0F, fy = static_cast<float>(y) / 256.0F;
            const float s = (fx * c(0) + 0.25F * c(1)) + 0.375F * c(2);
            const float t = (0.5F * c(0) + fy * c(1)) + 0.125F * c(2);
            const auto texel = [](double u) {
                return std::min(255, static_cast<int>(std::floor(u * 256.0)));
            };
            ASSERT_EQ(pixel(frame, x, y),
                      texel_address(texel(static_cast<double>(s)), texel(static_cast<double>(t))))
                << x << ", " << y;
            // In integers; float may differ where the exact value is a whole texel.
            const int exact_s = std::min(255, (x * v[0] + 64 * v[1] + 96 * v[2]) / 255);
            inexact += exact_s != pixel(frame, x, y)[0] ? 1 : 0;
        }
    }
    EXPECT_LT(inexact, 150);  // one in 255 would be 257
}

/// ds = blue and dt = green of the texel as two's complement, / 128.
constexpr const char* kBump = "[materials.hardware]\nbump_source = \"rgba8\"\n";

int signed_byte(int byte) {
    return byte >= 128 ? byte - 256 : byte;
}

// Matrix words in the register's order w0 w1 w2 w3 = 00 01 11 10: s + w0 ds + w3 dt and
// t + w1 ds + w2 dt. The text wants column by column: w0 w1 w3 w2.
TEST_F(TextureFacts, BumpEnvMapReadsBlueAndGreenAsSigned) {
    // Words in 1/8, offsets in 1/1024; texels in 1/256: everything is exact.
    const int w0 = 3, w1 = -5, w2 = 6, w3 = 2;
    const Framebuffer frame =
        draw(texture("b", kSize, kSize,
                     [](int x, int y) {
                         return Bytes{1, y, x, 2};
                     }) +
                 texture("t", kSize, kSize, texel_address),
             shader(fmt::format("texture_2d();\noffset_2d(tex0, {}, {}, {}, {});\n", w0 / 8.0,
                                w1 / 8.0, w3 / 8.0, w2 / 8.0),
                    "\"b\", \"t\"") +
                 kBump,
             [](double x, double y) {
                 return on_the_grid(x, y) + fmt::format(", uv1 = [{:.17g}, {:.17g}]", x, y);
             });
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const int ds = signed_byte(x), dt = signed_byte(y);
            const int s = floor_quotient(4 * x + w0 * ds + w3 * dt, 4) & 255;
            const int t = floor_quotient(4 * y + w1 * ds + w2 * dt, 4) & 255;
            ASSERT_EQ(pixel(frame, x, y), texel_address(s, t)) << "ds " << ds << ", dt " << dt;
        }
    }
}

// Rectangle textures have coordinates in texels, and offsets too.
TEST_F(TextureFacts, OffsetsOfRectangleTexturesAreTexels) {
    const Framebuffer frame = draw(
        texture("b", kSize, kSize,
                [](int x, int y) {
                    return Bytes{1, y, x, 2};
                }) +
            texture("t", 200, 150, texel_address,
                    std::string(kNearest) + "target = \"rectangle\"\n"),
        shader("texture_2d();\noffset_rectangle(tex0, 32, 0, 0, 16);\n", "\"b\", \"t\"") + kBump,
        [](double x, double y) { return on_the_grid(x, y) + ", uv1 = [100.5, 75.25]"; });
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            // 100.5 + 32 ds / 128 and 75.25 + 16 dt / 128 in quarters and eighths of a texel.
            const int s = floor_quotient(402 + signed_byte(x), 4);
            const int t = floor_quotient(602 + signed_byte(y), 8);
            ASSERT_EQ(pixel(frame, x, y), texel_address(s, t)) << x << ", " << y;
        }
    }
}

// The bytes are filtered as the unsigned ones that they are declared to be and read as signed only
// then: +127/128 turns to -1 where the filtered byte passes 127.5.
TEST_F(TextureFacts, UnsignedBumpSourcesAreReadAsSignedAfterTheFilter) {
    const Framebuffer frame =
        draw(texture(
                 "b", 2, 1,
                 [](int x, int) {
                     return Bytes{0, 0, 127 + x, 0};
                 },
                 "wrap = [\"clamp_to_edge\", \"clamp_to_edge\"]\n") +
                 texture("t", kSize, 1, texel_address),
             shader("texture_2d();\noffset_2d(tex0, 1, 0, 0, 0);\n", "\"b\", \"t\"") + kBump,
             [](double x, double y) {
                 return fmt::format("uv0 = [{:.17g}, {:.17g}], uv1 = [0.25, 0]", x, y);
             });
    for (int x = 0; x < kSize; ++x) {
        // Between the texels' centres u = 0.25 and 0.75 the weight grows by 2 / 256 a pixel.
        const int weight = std::clamp(2 * x - 128, 0, 256);
        const int filtered = 127 + (weight + 128) / 256;
        const int ds = filtered == 127 ? 127 : -128;  // / 128
        ASSERT_EQ(pixel(frame, x, 0)[0], (64 + 2 * ds) & 255) << "pixel " << x;
    }
    EXPECT_EQ(pixel(frame, 127, 0)[0], (64 + 254) & 255);
    EXPECT_EQ(pixel(frame, 128, 0)[0], (64 - 256) & 255);
}

/// The colours of a row of texels v = 0 .. 255, dimmed by red * scale + bias of the bump source.
class DimmedTexels : public TextureFacts {
  protected:
    Framebuffer dimmed(int red, double scale, double bias, const std::string& machine = "") {
        return draw(
            texture("b", 1, 1,
                    [&](int, int) {
                        return Bytes{red, 0, 0, 0};
                    }) +
                texture("t", kSize, 1,
                        [](int x, int) {
                            return Bytes{x, 255 - x, x / 2, 255 - x};
                        }),
            shader(fmt::format("texture_2d();\noffset_2d_scale(tex0, 0, 0, 0, 0, {}, {});\n", scale,
                               bias),
                   "\"b\", \"t\"") +
                kBump,
            [](double x, double y) {
                return fmt::format("uv0 = [0.5, 0.5], uv1 = [{:.17g}, {:.17g}]", x + 0.5 / kSize,
                                   y);
            },
            machine);
    }
};

TEST_F(DimmedTexels, TheFactorOfBumpEnvMapLuminanceIsNotClamped) {
    // The capture's own number: 121 * 1.2755 = 154.3.
    EXPECT_EQ(pixel(dimmed(255, 1.0, 0.2755), 121, 0)[0], 154);
    EXPECT_EQ(pixel(dimmed(255, 1.0, 0.2755), 240, 0)[0], 255);  // 306 stops at 255
    for (const int red : {0, 1, 51, 128, 254}) {
        for (const auto& [scale, bias] : {std::pair{1.0, 0.0}, {0.75, 0.5}, {2.0, 0.25}}) {
            const Framebuffer frame = dimmed(red, scale, bias);
            for (int v = 0; v < kSize; ++v) {
                const float factor = static_cast<float>(bias) +
                                     static_cast<float>(scale) * (static_cast<float>(red) / 255.0F);
                const auto product = [&](int texel) {
                    const float x = static_cast<float>(texel) * factor + 0.02F;
                    return static_cast<int>(std::floor(std::min(x, 255.0F)));
                };
                ASSERT_EQ(pixel(frame, v, 0),
                          (Bytes{product(v), product(255 - v), product(v / 2), 255 - v}))
                    << "red " << red << ", " << scale << ", " << bias << ", texel " << v;
            }
        }
    }
}

TEST_F(DimmedTexels, TheFactorCanBeClampedAsTheSpecificationHasIt) {
    const std::string gl = "magnitude_factor = \"clamped\"\n";
    EXPECT_EQ(pixel(dimmed(255, 1.0, 0.2755, gl), 121, 0)[0], 121);
    EXPECT_EQ(pixel(dimmed(255, -1.0, 0.5, gl), 121, 0)[0], 0);
    EXPECT_EQ(pixel(dimmed(51, 1.0, 0.0, gl), 121, 0)[0], 24);  // 24.2
}

}  // namespace
}  // namespace burnish
