#pragma once

#include <cstdint>

/// Arguments of the stages between two texture fetches: what a texel means as a number, and what
/// becomes of it on its way to the next coordinates. Contract header: plain data, no functions.
/// Floats: IEEE single precision, each operation rounded, in the order written, nothing fused.
namespace burnish {

/// What the code v of a texel, or of a register, stands for as a number.
enum class Reading : std::uint8_t {
    unsigned_texel,  ///< v / one, one = 255 (nine_bit) or 16384 (wide); also of registers
    signed_texel,    ///< v / 256 (nine_bit: v is 2 n, this n / 128) or v / 16384 (wide)
    expanded,        ///< (max(v, 0) - half) / half, half = 127.5 or 8192: 2 c - 1
    // Nine-bit only. n is the low byte of v in two's complement: v - 256 for v >= 128.
    two_complement,  ///< n / 128
    nv2a_d3d,        ///< (v - 128) / 127
    nv2a_gl,         ///< (n + 0.5) / 127.5
    nv2a_signed,     ///< n / 127
};

/// Attribute plane = number of a register plane: sum first, then one division.
struct DecodeCtx {
    int plane;
    int attribute;
    Reading reading;
};

/// to = (from * scale + offset) / divisor.
struct AffineCtx {
    int from, to;  ///< attribute planes, may be the same
    float scale, offset, divisor;
};

/// to = (a0 * b0 + a1 * b1) + a2 * b2.
struct DotCtx {
    int a[3], b[3];  ///< attribute planes
    int to;
};

/// The third component of a unit vector: to = sqrt(max((1 - x * x) - y * y, 0)); NaN gives 0.
struct HemisphereCtx {
    int x, y;  ///< attribute planes
    int to;
};

/// Coordinates moved by a vector: (s + m0 * ds) + m2 * dt and (t + m1 * ds) + m3 * dt to planes
/// `to` and `to` + 1. Where there is a q, s = s / q and t = t / q first.
struct OffsetCtx {
    int s, t, q;  ///< attribute planes, q may be -1
    int ds, dt;
    float m[4];  ///< column by column
    int to;
};

/// E mirrored at N, which need not be of unit length: k = (2 * dot(N, E)) / dot(N, N), to planes
/// `to` .. `to` + 2 go k * N - E. dot(a, b) = (a0 * b0 + a1 * b1) + a2 * b2.
struct ReflectCtx {
    int n[3], e[3];  ///< attribute planes
    int to;
};

/// to = a / b.
struct QuotientCtx {
    int a, b, to;  ///< attribute planes
};

/// The difference of two angles, 1 being a turn: d = a - b, to = d - floor(d).
struct AngleCtx {
    int a, b, to;  ///< attribute planes
};

/// keep = 1 where all four coordinates pass their test and, if there is an `also`, that plane is
/// > 0; else 0. A NaN passes no test.
struct CullCtx {
    int coordinate[4];     ///< attribute planes
    std::uint8_t less[4];  ///< 1: passes if < 0; 0: passes if >= 0
    int also;              ///< attribute plane, or -1
    int keep;              ///< attribute plane, may be `also`
};

/// Texels dimmed by a magnitude: f = bias + scale * m, m = v / one of register plane `magnitude`,
/// and f = min(max(f, 0), 1) if `clamp_factor`. Codes c of planes from .. from + 2 become
/// int(floor(min(max(c * f + round, low), one))) in planes to .. to + 2; plane from + 3 is copied.
/// nine_bit: one = 255, low = -256, round = 0.02; wide: one = 16384, low = -32768, round = 0.5.
/// NaN gives `low`.
struct MagnitudeCtx {
    int magnitude;
    int from, to;  ///< register planes, may be the same; `magnitude` is not among to .. to + 3
    float scale, bias;
    std::uint8_t clamp_factor;
};

}  // namespace burnish
