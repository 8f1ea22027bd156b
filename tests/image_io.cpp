#include <gtest/gtest.h>
#include <sys/resource.h>
#include <burnish/error.hpp>
#include <burnish/files.hpp>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include "tests/float_picture.hpp"
#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

/// Every byte different from its neighbours, alpha unrelated to the colours.
Image8 busy_image(int width, int height) {
    Image8 image(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>((i * 2654435761U) >> 13);
    return image;
}

/// A binary PGM or PPM, whose bytes are simple enough to write by hand.
void write_netpbm(const std::filesystem::path& path, int channels, int width, int height,
                  const std::vector<std::uint8_t>& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << (channels == 1 ? "P5" : "P6") << '\n' << width << ' ' << height << "\n255\n";
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

ErrorCode error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::bad_option;
}

/// While it lives, files cannot grow beyond `bytes`: what a full disk looks like.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : m_handler(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &m_before);
        const rlimit limit{bytes, m_before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &m_before);
        std::signal(SIGXFSZ, m_handler);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    void (*m_handler)(int);
    rlimit m_before{};
};

class ImageFiles : public ScratchDirectory {};

TEST_F(ImageFiles, EightBitsSurviveWithTheirAlpha) {
    const Image8 image = busy_image(37, 23);
    for (const char* name : {"a.png", "a.tif", "a.tga"}) {
        save_image(image, path(name));
        const Image8 back = load_image(path(name));
        EXPECT_EQ(back.width, 37) << name;
        EXPECT_EQ(back.height, 23) << name;
        EXPECT_EQ(back.rgba, image.rgba) << name;
    }
}

TEST_F(ImageFiles, GreyIsSpreadAndMissingAlphaIsOpaque) {
    write_netpbm(path("grey.pgm"), 1, 2, 1, {7, 200});
    EXPECT_EQ(load_image(path("grey.pgm")).rgba,
              (std::vector<std::uint8_t>{7, 7, 7, 255, 200, 200, 200, 255}));
    write_netpbm(path("rgb.ppm"), 3, 2, 1, {1, 2, 3, 40, 50, 60});
    EXPECT_EQ(load_image(path("rgb.ppm")).rgba,
              (std::vector<std::uint8_t>{1, 2, 3, 255, 40, 50, 60, 255}));
}

TEST_F(ImageFiles, FramesKeepTheirRowsWhateverThePitch) {
    constexpr int kWidth = 5;
    constexpr int kHeight = 4;
    constexpr std::ptrdiff_t kPitch = 4 * kWidth + 12;
    std::vector<std::uint8_t> memory(kPitch * kHeight, 0xee);
    const Image8 image = busy_image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        std::memcpy(memory.data() + y * kPitch, image.at(0, y), std::size_t{4} * kWidth);
    save_image(Framebuffer(memory.data(), kPitch, kWidth, kHeight), path("frame.png"));
    EXPECT_EQ(load_image(path("frame.png")).rgba, image.rgba);
}

TEST_F(ImageFiles, SixteenBitFramesReachTheFileAsSixteenBits) {
    Framebuffer frame(1, 1, PixelFormat::rgba16);
    const std::uint16_t texel[4]{0, 257 * 100, 65535, 257 * 9};
    std::memcpy(frame.row(0), texel, sizeof texel);
    save_image(frame, path("deep.png"));
    EXPECT_EQ(load_image(path("deep.png")).rgba, (std::vector<std::uint8_t>{0, 100, 255, 9}));
    const std::string bytes = read(path("deep.png"));
    ASSERT_GT(bytes.size(), 24U);
    EXPECT_EQ(bytes[24], 16);  // bit depth in the PNG header
}

TEST_F(ImageFiles, FloatFramesReachEXR) {
    Framebuffer frame(1, 1, PixelFormat::rgba32f);
    const float texel[4]{0.0F, 0.5F, 3.0F, 1.0F};
    std::memcpy(frame.row(0), texel, sizeof texel);
    save_image(frame, path("float.exr"));
    // Reading as 8 bits clamps: 0.5 * 255 rounds to 128.
    EXPECT_EQ(load_image(path("float.exr")).rgba, (std::vector<std::uint8_t>{0, 128, 255, 255}));
}

std::vector<float> floats_of(const Framebuffer& frame) {
    std::vector<float> values(4 * static_cast<std::size_t>(frame.width()) *
                              static_cast<std::size_t>(frame.height()));
    std::memcpy(values.data(), frame.pixels(), values.size() * sizeof(float));
    return values;
}

TEST_F(ImageFiles, FloatsComeBackAsTheyWere) {
    // What colours can be: negative, tiny, beyond 1, with an alpha that is not multiplied in.
    std::vector<float> values{-2.5F, 1e-30F, 3e30F, 0.25F, 0.1F, 0.2F, 0.3F, 0.0F};
    save_image(Framebuffer(values.data(), 32, 2, 1, PixelFormat::rgba32f), path("a.exr"));
    const Framebuffer back = load_frame(path("a.exr"));
    EXPECT_EQ(back.format(), PixelFormat::rgba32f);
    EXPECT_EQ(floats_of(back), values);
}

TEST_F(ImageFiles, IntegersBecomeFloatsOverTheirLargest) {
    Image8 bytes(64, 1);  // each byte once
    for (std::size_t n = 0; n < 256; ++n) bytes.rgba[n] = static_cast<std::uint8_t>(n);
    save_image(bytes, path("bytes.png"));
    const std::vector<float> got = floats_of(load_frame(path("bytes.png")));
    ASSERT_EQ(got.size(), 256U);
    for (std::size_t n = 0; n < 256; ++n) EXPECT_EQ(got[n], static_cast<float>(n) / 255.0F) << n;

    std::vector<std::uint16_t> words(65536);  // 16384 pixels
    for (std::size_t n = 0; n < words.size(); ++n) words[n] = static_cast<std::uint16_t>(n);
    save_image(Framebuffer(words.data(), 1024, 128, 128, PixelFormat::rgba16), path("words.png"));
    const std::vector<float> deep = floats_of(load_frame(path("words.png")));
    ASSERT_EQ(deep.size(), words.size());
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < deep.size(); ++n)
        wrong += deep[n] != static_cast<float>(n) / 65535.0F ? 1 : 0;
    EXPECT_EQ(wrong, 0U);

    write_netpbm(path("grey.pgm"), 1, 1, 1, {51});
    EXPECT_EQ(floats_of(load_frame(path("grey.pgm"))),
              (std::vector<float>{51.0F / 255.0F, 51.0F / 255.0F, 51.0F / 255.0F, 1.0F}));
}

TEST_F(ImageFiles, DepthsAreOneChannel) {
    Framebuffer frame(2, 1, PixelFormat::depth32f);
    const float depths[2]{0.25F, 1.0F};
    std::memcpy(frame.row(0), depths, sizeof depths);
    for (const char* name : {"depths.exr", "depths.png"}) {
        save_image(frame, path(name));
        // As 8 bits: 0.25 * 255 is 63.75.
        EXPECT_EQ(load_image(path(name)).rgba,
                  (std::vector<std::uint8_t>{64, 64, 64, 255, 255, 255, 255, 255}))
            << name;
    }
}

TEST_F(ImageFiles, FilesDoNotCarryTheTimeOfWriting) {
    for (const char* name : {"dated.exr", "dated.tif"}) {
        save_image(busy_image(8, 8), path(name));
        EXPECT_NE(read(path(name)).find("1970:01:01 00:00:00"), std::string::npos) << name;
    }
    save_image(busy_image(8, 8), path("dated.png"));
    EXPECT_EQ(read(path("dated.png")).find("tIME"), std::string::npos);
}

TEST_F(ImageFiles, TruncatedFilesAreErrorsInEveryFormat) {
    const Image8 image = busy_image(64, 64);
    for (const char* name : {"t.png", "t.jpg", "t.tif", "t.exr", "t.bmp", "t.tga"}) {
        save_image(image, path(name));
        const std::string whole = read(path(name));
        write(path(name), whole.substr(0, whole.size() / 2));
        EXPECT_EQ(error_of([&] { load_image(path(name)); }), ErrorCode::bad_input) << name;
    }
}

TEST_F(ImageFiles, ADamagedPNGIsAnErrorAndPrintsNothing) {
    save_image(busy_image(64, 64), path("d.png"));
    const std::string whole = read(path("d.png"));
    for (std::size_t at = 9; at < whole.size(); at += 97) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        write(path("d.png"), damaged);
        testing::internal::CaptureStderr();
        EXPECT_EQ(error_of([&] { load_image(path("d.png")); }), ErrorCode::bad_input) << at;
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << at;
    }
}

TEST_F(ImageFiles, WhatIsNoImageIsAnError) {
    write(path("empty.png"), "");
    EXPECT_EQ(error_of([&] { load_image(path("empty.png")); }), ErrorCode::bad_input);
    write(path("text.png"), "this is no image\n");
    EXPECT_EQ(error_of([&] { load_image(path("text.png")); }), ErrorCode::bad_input);
    EXPECT_EQ(error_of([&] { load_image(path("missing.png")); }), ErrorCode::io);
    EXPECT_EQ(error_of([&] { load_image(directory()); }), ErrorCode::io);
}

TEST_F(ImageFiles, HugeSizesAreRefusedBeforeMemoryIsTaken) {
    std::ofstream(path("huge.ppm"), std::ios::binary) << "P6\n100000 100000\n255\n";
    EXPECT_EQ(error_of([&] { load_image(path("huge.ppm")); }), ErrorCode::limit);
}

TEST_F(ImageFiles, FailedWritesLeaveNothingBehind) {
    const Image8 image = busy_image(8, 8);
    std::filesystem::create_directory(path("taken.png"));
    EXPECT_EQ(error_of([&] { save_image(image, path("taken.png")); }), ErrorCode::io);
    EXPECT_EQ(error_of([&] { save_image(image, path("no/such/place.png")); }), ErrorCode::io);
    EXPECT_EQ(error_of([&] { save_image(image, path("what.xyz")); }), ErrorCode::io);
    EXPECT_EQ(entries(), (std::vector<std::string>{"taken.png"}));
}

TEST_F(ImageFiles, ADiskThatFillsUpLeavesNothingBehind) {
    for (const char* name : {"full.png", "full.tif", "full.exr", "full.tga", "full.jpg"}) {
        const FileSizeLimit limit(1000);
        testing::internal::CaptureStderr();
        EXPECT_EQ(error_of([&] { save_image(busy_image(256, 256), path(name)); }), ErrorCode::io)
            << name;
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
    }
    EXPECT_EQ(entries(), (std::vector<std::string>{}));
}

TEST_F(ImageFiles, AFailedWriteKeepsTheOldFile) {
    const Image8 image = busy_image(8, 8);
    save_image(image, path("kept.png"));
    Image8 broken = image;
    broken.rgba.pop_back();
    EXPECT_EQ(error_of([&] { save_image(broken, path("kept.png")); }), ErrorCode::bad_option);
    EXPECT_EQ(load_image(path("kept.png")).rgba, image.rgba);
    EXPECT_EQ(entries(), (std::vector<std::string>{"kept.png"}));
}

TEST_F(ImageFiles, ThreadsMayReadAndWriteTheSameNames) {
    const Image8 image = busy_image(32, 32);
    save_image(image, path("shared.png"));
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                save_image(image, path("shared.png"));
                EXPECT_EQ(load_image(path("shared.png")).rgba, image.rgba);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(entries(), (std::vector<std::string>{"shared.png"}));
}

TEST(Text, IsWhereItWasAskedFor) {
    constexpr glm::vec4 kColor{1.0F, 0.5F, 0.0F, 1.0F};
    Framebuffer frame = plain(120, 40, 0.0F), wider = plain(120, 40, 0.0F);
    draw_text(frame, 10, 30, "1.5", 16, kColor);
    draw_text(wider, 10, 30, "1.5 1.5", 16, kColor);
    int inked = 0, more = 0;
    float brightest = 0.0F;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 120; ++x) {
            const glm::vec4 ink = get(frame, x, y);
            if (ink.r > 0.0F) {
                ++inked;
                EXPECT_TRUE(x >= 10 && x < 42 && y >= 14 && y <= 30) << x << ' ' << y;
                EXPECT_FLOAT_EQ(ink.g, 0.5F * ink.r);
                EXPECT_EQ(ink, get(wider, x, y));
            }
            brightest = std::max(brightest, ink.r);
            more += get(wider, x, y).r > 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(brightest, 0.9F);
    EXPECT_GT(inked, 30);
    EXPECT_EQ(more, 2 * inked);
    draw_text(frame, -5, 3, "cut off", 16, kColor);
    Framebuffer bytes(8, 8);
    EXPECT_EQ(error_of([&] { draw_text(bytes, 0, 8, "1", 8, kColor); }), ErrorCode::bad_option);
}

}  // namespace
}  // namespace burnish
