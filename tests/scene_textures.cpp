// [[textures]] of scene files: every key, and what is said about wrong ones.
#include <gtest/gtest.h>

#include <array>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cstring>
#include <string>

#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

class SceneTextures : public ScratchDirectory {
  protected:
    /// The texture 't' of a scene whose table [[textures]] goes on with `keys` from line 5 on.
    TexturePtr texture(const std::string& keys) {
        write(path("s.toml"), "schema = 1\n[[materials]]\nname = \"m\"\nunits = [\"t\"]\n" +
                                  std::string("[[textures]]\nname = \"t\"\n") + keys +
                                  "[[objects]]\nmaterial = \"m\"\nvertices = []\n");
        const Scene scene = load_scene(path("s.toml")).scene;
        return scene.objects.at(0).material->program->units.at(0);
    }
    /// What is said about it, without the name of the directory.
    std::string complaint(const std::string& keys) {
        try {
            texture(keys);
        } catch (const Error& error) {
            std::string text = error.what();
            for (std::size_t at; (at = text.find(path("s.toml").string())) != std::string::npos;)
                text.replace(at, path("s.toml").string().size(), "FILE");
            return text;
        }
        return "no error";
    }
    void image(const std::string& name, int width, int height, int red) {
        Image8 image(width, height);
        for (std::size_t i = 0; i < image.rgba.size(); ++i)
            image.rgba[i] = static_cast<std::uint8_t>(i % 4 == 0 ? red : 255);
        save_image(image, path(name));
    }
};

const std::string kOne = "width = 1\nheight = 1\ntexels = [1, 2, 3, 4]\n";

TEST_F(SceneTextures, SamplersHaveEveryKey) {
    const TexturePtr t = texture(
        "width = 2\nheight = 2\ntexels = [1,2,3,4, 5,6,7,8, 9,10,11,12, 13,14,15,16]\n"
        "filter = \"nearest_mipmap_linear\"\nmag_filter = \"linear\"\nmipmaps = \"box\"\n"
        "wrap = [\"mirrored_repeat\", \"clamp_to_border\"]\nlod_bias = -1.5\n"
        "border_color = [1.0, 0.5, -0.5, 0.0]\n");
    const Sampler& s = t->sampler();
    EXPECT_EQ(s.filter, Filter::nearest_mipmap_linear);
    EXPECT_EQ(s.mag_filter, Filter::linear);
    EXPECT_EQ(s.wrap_s, Wrap::mirrored_repeat);
    EXPECT_EQ(s.wrap_t, Wrap::clamp_to_border);
    EXPECT_EQ(s.lod_bias, -1.5F);
    EXPECT_EQ(t->levels().size(), 2U);
    EXPECT_EQ(t->texel(1, 0, 0, 0, 0), 7);     // (1 + 5 + 9 + 13) / 4
    EXPECT_EQ(t->texel(0, 0, 0, -1, 0), 255);  // the border above, of bytes
    EXPECT_EQ(t->texel(0, 0, 1, 2, 1), 128);   // 127.5
    EXPECT_EQ(t->texel(0, 0, 1, 2, 2), 0);
}

TEST_F(SceneTextures, MagFollowsTheFilterWithinALevel) {
    EXPECT_TRUE(texture(kOne)->sampler().mag_is_linear());
    EXPECT_TRUE(texture(kOne + "filter = \"linear_mipmap_nearest\"\n")->sampler().mag_is_linear());
    EXPECT_FALSE(texture(kOne + "filter = \"nearest_mipmap_linear\"\n")->sampler().mag_is_linear());
}

TEST_F(SceneTextures, FormatsOfBytesAndWords) {
    for (const auto& [word, format] :
         {std::pair{"rgb8", TexelFormat::rgb8},
          {"r8", TexelFormat::r8},
          {"luminance8_alpha8", TexelFormat::luminance8_alpha8},
          {"signed_rgb8_unsigned_alpha8", TexelFormat::signed_rgb8_unsigned_alpha8},
          {"signed_hilo8", TexelFormat::signed_hilo8},
          {"dsdt8_mag8", TexelFormat::dsdt8_mag8}})
        EXPECT_EQ(texture(kOne + "format = \"" + word + "\"\n")->format(), format) << word;
    const std::string words = "width = 1\nheight = 1\ntexels = [65535, 32768, 0, 0]\n";
    EXPECT_EQ(texture(words + "format = \"hilo16\"\n")->texel(0, 0, 0, 0, 1), 32768);
    EXPECT_EQ(texture(words + "format = \"signed_hilo16\"\n")->texel(0, 0, 0, 0, 0), -1);
    EXPECT_EQ(texture(words + "format = \"signed_hilo16\"\n")->texel(0, 0, 0, 0, 1), -32768);
    EXPECT_EQ(texture(words + "format = \"rgba16\"\n")->texel(0, 0, 0, 0, 0), 65535);
}

TEST_F(SceneTextures, WordsComeFromFilesToo) {
    image("bytes.png", 1, 1, 10);
    EXPECT_EQ(texture("file = \"bytes.png\"\nformat = \"hilo16\"\n")->texel(0, 0, 0, 0, 0),
              10 * 257);
    Framebuffer frame(1, 1, PixelFormat::rgba16);
    const std::array<std::uint16_t, 4> words{1234, 50000, 3, 65535};
    std::memcpy(frame.pixels(), words.data(), sizeof words);
    save_image(frame, path("words.png"));
    const TexturePtr t = texture("file = \"words.png\"\nformat = \"hilo16\"\n");
    EXPECT_EQ(t->texel(0, 0, 0, 0, 0), 1234);
    EXPECT_EQ(t->texel(0, 0, 0, 0, 1), 50000);
}

TEST_F(SceneTextures, TargetsAndTheirImages) {
    std::string files = "files = [";
    for (int f = 0; f < 6; ++f) {
        image("f" + std::to_string(f) + ".png", 4, 4, 10 * f);
        files += "\"f" + std::to_string(f) + ".png\", ";
    }
    files += "]\n";
    const TexturePtr cube = texture("target = \"cube\"\nmipmaps = \"box\"\n" + files);
    EXPECT_EQ(cube->target(), TextureTarget::cube);
    EXPECT_EQ(cube->levels().size(), 3U);
    for (int f = 0; f < 6; ++f) EXPECT_EQ(cube->texel(2, f, 0, 0, 0), 10 * f);
    const TexturePtr slices = texture("target = \"3d\"\ndepth = 6\n" + files +
                                      "wrap = [\"repeat\", \"repeat\", \"clamp_to_edge\"]\n");
    EXPECT_EQ(slices->levels()[0].depth, 6);
    EXPECT_EQ(slices->texel(0, 5, 0, 0, 0), 50);
    EXPECT_EQ(slices->sampler().wrap_r, Wrap::clamp_to_edge);
    const TexturePtr line = texture(
        "target = \"1d\"\nwidth = 2\ntexels = [1, 2, 3, 4, 5, 6, 7, 8]\nwrap = [\"repeat\"]\n");
    EXPECT_EQ(line->height(), 1);
    EXPECT_EQ(texture("target = \"rectangle\"\n" + kOne)->sampler().wrap_s, Wrap::clamp_to_edge);
    std::string faces = "target = \"cube\"\nwidth = 1\nheight = 1\ntexels = [";
    for (int i = 0; i < 24; ++i) faces += std::to_string(i) + ", ";
    EXPECT_EQ(texture(faces + "]\n")->texel(0, 5, 0, 0, 0), 20);
}

TEST_F(SceneTextures, MipFiles) {
    image("0.png", 4, 2, 10);
    image("1.png", 2, 1, 20);
    image("2.png", 1, 1, 30);
    const std::string base = "file = \"0.png\"\nmipmaps = \"files\"\n";
    const TexturePtr t = texture(base + "mip_files = [\"1.png\", \"2.png\"]\n");
    EXPECT_EQ(t->texel(2, 0, 0, 0, 0), 30);
    EXPECT_EQ(texture(base + "mip_files = [\"1.png\"]\n")->levels().size(), 2U);
    EXPECT_EQ(complaint(base + "mip_files = [\"2.png\"]\n"),
              "FILE:6: mip level 1 with an image of 1x1 texels, expected 2x1 texels");
    EXPECT_EQ(complaint(base + "mip_files = [\"1.png\", \"2.png\", \"2.png\"]\n"),
              "FILE:9: 'mip_files' in [[textures]] names 3 files, expected 2: whole levels, 1 "
              "first");
    EXPECT_EQ(complaint(base),
              "FILE:5: 'mip_files' and mipmaps = \"files\" in [[textures]] go "
              "together, expected both or neither");
}

TEST_F(SceneTextures, Errors) {
    EXPECT_EQ(complaint(kOne + "target = \"cube\"\n"),
              "FILE:9: 'texels' in [[textures]] has 4 elements, expected an array of 24 numbers");
    EXPECT_EQ(complaint(kOne + "depth = 2\n"),
              "FILE:10: 'depth' in [[textures]] whose target is not 3d");
    EXPECT_EQ(complaint(kOne + "target = \"3d\"\nwrap = [\"repeat\", \"repeat\"]\n"),
              "FILE:11: 'wrap' in [[textures]] has 2 elements, expected 3: for s, t and r");
    EXPECT_EQ(complaint(kOne + "wrap = [\"repeat\", \"repeat\", \"repeat\"]\n"),
              "FILE:10: 'wrap' in [[textures]] has 3 elements, expected 2: for s and t");
    EXPECT_EQ(complaint(kOne + "target = \"rectangle\"\nwrap = [\"repeat\", \"repeat\"]\n"),
              "FILE:6: rectangle texture that repeats, expected clamp_to_edge or clamp_to_border");
    EXPECT_EQ(complaint(kOne + "mag_filter = \"linear_mipmap_linear\"\n"),
              "FILE:10: 'mag_filter' = \"linear_mipmap_linear\" in [[textures]], expected "
              "nearest, linear");
    EXPECT_EQ(complaint("width = 1\nheight = 1\ntexels = [1, 2, 3, 65536]\nformat = \"hilo16\"\n"),
              "FILE:9: 'texels' in [[textures]] has the value 65536, expected a number of at "
              "least 0 and at most 65535");
    EXPECT_EQ(complaint("file = \"a.png\"\ntarget = \"cube\"\n"),
              "FILE:7: 'file' in [[textures]] with 6 faces, expected 'files'");
    EXPECT_EQ(complaint("files = [\"a.png\"]\ntarget = \"cube\"\n"),
              "FILE:7: 'files' in [[textures]] names 1 files, expected 6: faces +x -x +y -y +z -z");
    EXPECT_EQ(complaint("generator = \"brushed\"\nwidth = 4\nformat = \"r8\"\n"),
              "FILE:9: 'format' in [[textures]], expected rgba8 for a generated map");
    EXPECT_NE(complaint(kOne + "lod_bias = 16.0\n").find("FILE:10"), std::string::npos);
    EXPECT_NE(complaint(kOne + "mipmaps = \"learn\"\n").find("did you mean 'lean'?"),
              std::string::npos);
}

}  // namespace
}  // namespace burnish
