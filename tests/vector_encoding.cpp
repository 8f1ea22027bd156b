#include "models/vector_encoding.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "models/srgb.hpp"

namespace burnish {
namespace {

constexpr std::array kEncodings{VectorEncoding::a, VectorEncoding::b, VectorEncoding::c,
                                VectorEncoding::d};

TEST(VectorEncoding, OnlyAHasNoZero) {
    double nearest = 1.0;
    for (int n = 0; n < 256; ++n)
        nearest = std::min(nearest, std::abs(decode_vector_code(VectorEncoding::a, n, 8)));
    EXPECT_NEAR(nearest, 1.0 / 255.0, 1e-15);  // 128 / 127.5 - 1 and its mirror image 127
    EXPECT_EQ(decode_vector_code(VectorEncoding::b, 128, 8), 0.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::c, 0, 8), 0.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::d, 128, 8), 0.0);
}

TEST(VectorEncoding, EndsOfTheRange) {
    EXPECT_EQ(decode_vector_code(VectorEncoding::a, 0, 8), -1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::a, 255, 8), 1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::b, 0, 8), -1.0);  // -128/127, clamped
    EXPECT_EQ(decode_vector_code(VectorEncoding::b, 1, 8), -1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::b, 255, 8), 1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::c, 127, 8), 1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::c, 128, 8), -1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::c, 129, 8), -1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::c, 255, 8), -1.0 / 127.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::d, 0, 8), -1.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::d, 255, 8), 127.0 / 128.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::d, 65535, 16), 32767.0 / 32768.0);
    EXPECT_EQ(decode_vector_code(VectorEncoding::a, 65535, 16), 1.0);
}

TEST(VectorEncoding, EveryCodeComesBack) {
    for (const int bits : {8, 16}) {
        for (const VectorEncoding e : kEncodings) {
            for (int n = 0; n < 1 << bits; ++n) {
                const double x = decode_vector_code(e, n, bits);
                const int again = encode_vector_code(e, x, bits);
                // The lowest codes of b and c repeat the number of their neighbours.
                const bool repeats = (e == VectorEncoding::b && n == 0) ||
                                     (e == VectorEncoding::c && n == 1 << (bits - 1));
                ASSERT_EQ(again, repeats ? n + 1 : n) << "encoding " << static_cast<int>(e);
            }
        }
    }
}

TEST(VectorEncoding, NearestCodeOfAnyNumber) {
    for (const int bits : {8, 16}) {
        const double half = 1 << (bits - 1);
        for (const VectorEncoding e : kEncodings) {
            for (int i = -1000; i <= 1000; ++i) {
                const double x = i / 1000.0;
                const int n = encode_vector_code(e, x, bits);
                ASSERT_GE(n, 0);
                ASSERT_LT(n, 1 << bits);
                // Half a step; d stops short of 1 by a whole one.
                const double step = e == VectorEncoding::a   ? 1.0 / (half - 0.5)
                                    : e == VectorEncoding::d ? 1.0 / half
                                                             : 1.0 / (half - 1.0);
                const double allowed = e == VectorEncoding::d && x > 1.0 - 1.0 / half
                                           ? x - (1.0 - 1.0 / half)
                                           : 0.5 * step;
                ASSERT_LE(std::abs(decode_vector_code(e, n, bits) - x), allowed + 1e-15)
                    << "encoding " << static_cast<int>(e) << " of " << x;
            }
        }
    }
}

TEST(VectorEncoding, OutOfRangeIsClamped) {
    for (const VectorEncoding e : kEncodings) {
        EXPECT_EQ(encode_vector_code(e, 7.0, 8), encode_vector_code(e, 1.0, 8));
        EXPECT_EQ(encode_vector_code(e, -7.0, 8), encode_vector_code(e, -1.0, 8));
    }
}

TEST(Srgb, KnownValuesAndWayBack) {
    EXPECT_EQ(linear_from_srgb(0.0), 0.0);
    EXPECT_NEAR(linear_from_srgb(1.0), 1.0, 1e-14);
    EXPECT_NEAR(linear_from_srgb(0.5), 0.2140411405, 1e-10);
    // Both branches meet within the rounding of the standard's constants.
    EXPECT_NEAR(linear_from_srgb(0.04045), linear_from_srgb(0.04045001), 1e-8);
    for (int i = 0; i <= 1000; ++i) {
        const double x = i / 1000.0;
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(x)), x, 1e-7);
        EXPECT_NEAR(linear_from_srgb(x),
                    x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4), 1e-14);
    }
}

}  // namespace
}  // namespace burnish
