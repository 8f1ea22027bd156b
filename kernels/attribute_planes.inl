inline Doubles operator+(const Doubles& a, const Doubles& b) {
    return {a.low + b.low, a.high + b.high};
}
inline Doubles operator-(const Doubles& a, const Doubles& b) {
    return {a.low - b.low, a.high - b.high};
}
inline Doubles operator*(const Doubles& a, const Doubles& b) {
    return {a.low * b.low, a.high * b.high};
}
inline Doubles same_doubles(double v) {
    return {F64(v), F64(v)};
}

/// In homogeneous window coordinates, one for each of kLanes32 triangles.
struct HomogeneousVector {
    Doubles x, y, w;
};
inline HomogeneousVector cross(const HomogeneousVector& a, const HomogeneousVector& b) {
    return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}
inline HomogeneousVector scaled(const HomogeneousVector& a, const Doubles& s) {
    return {a.x * s, a.y * s, a.w * s};
}

/// kLanes32 triangles from number `first` on; those past the last one repeat it.
struct PlaneTriangles {
    PlaneTriangles(const AttributePlanesCtx& ctx, int first) {
        for (int k = 0; k < kLanes32; ++k)
            lane[k] = ctx.triangles + (first + k < ctx.count ? first + k : ctx.count - 1);
    }
    /// Columns of numbers 4 part .. 4 part + 3 of each.
    [[nodiscard]] Columns numbers(int part) const {
        return load_columns(
            [&](int k) { return reinterpret_cast<const std::int32_t*>(lane[k]) + 4 * part; });
    }
    const PlaneTriangle* lane[kLanes32];
};
static_assert(sizeof(PlaneTriangle) == 12 * sizeof(std::int32_t));

/// The inverses of the triangles' vertex matrices: weights of the corners over w.
struct CornerWeights {
    HomogeneousVector corner[3];
    MaskF invertible;  ///< not seen edge-on
};

/// A corner of a clipped triangle is (hx - cx * w) * 1, of another one (x - cx * 1) * w.
CornerWeights corner_weights(const AttributePlanesCtx& ctx, const PlaneTriangles& triangles) {
    const Columns upper = triangles.numbers(0), middle = triangles.numbers(1),
                  lower = triangles.numbers(2);
    const I32 x[3] = {upper[0], upper[1], upper[2]}, y[3] = {upper[3], middle[0], middle[1]};
    const Doubles half = same_doubles(0.5);
    const Doubles centre_x = to_double(to_float(lower[1])) + half;
    const Doubles centre_y = to_double(to_float(lower[2])) + half;
    const MaskF clipped = as_float(lower[3] != I32(0));
    const F32 one(1.0F), pixel(1.0F / 256.0F);
    HomogeneousVector v[3];
    for (int i = 0; i < 3; ++i) {
        const Columns h =
            load_columns([&](int k) { return ctx.homogeneous + triangles.lane[k]->vertex[i]; });
        const Doubles inner = to_double(::xsimd::select(clipped, h.floats(3), one));
        const Doubles outer = to_double(::xsimd::select(clipped, one, h.floats(3)));
        const auto from_centre = [&](F32 homogeneous, I32 window, const Doubles& centre) {
            const F32 at = ::xsimd::select(clipped, homogeneous, to_float(window) * pixel);
            return (to_double(at) - centre * inner) * outer;
        };
        v[i] = {from_centre(h.floats(0), x[i], centre_x), from_centre(h.floats(1), y[i], centre_y),
                to_double(h.floats(3))};
    }
    const HomogeneousVector b[3] = {cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
    const Doubles volume = v[0].x * b[0].x + v[0].y * b[0].y + v[0].w * b[0].w;
    const Doubles scale{divide(F64(1.0), volume.low), divide(F64(1.0), volume.high)};
    // A difference with itself is 0 for finite numbers only.
    return {{scaled(b[0], scale), scaled(b[1], scale), scaled(b[2], scale)},
            to_float(scale - scale) == F32(0.0F)};
}

/// Writes equation `number` of kLanes32 triangles from `first` on, of what the corners have.
class EquationWriter {
  public:
    EquationWriter(const AttributePlanesCtx& ctx, const CornerWeights& weights, int first)
        : m_weights(weights),
          m_all_invertible(bits(as_int(weights.invertible)) == (1U << kLanes32) - 1),
          m_out(ctx.equations + first) {}

    void write(int number, F32 a0, F32 a1, F32 a2) const {
        const HomogeneousVector(&b)[3] = m_weights.corner;
        const Doubles a[3] = {to_double(a0), to_double(a1), to_double(a2)};
        F32 origin = to_float(a[0] * b[0].w + a[1] * b[1].w + a[2] * b[2].w);
        F32 dx = to_float(a[0] * b[0].x + a[1] * b[1].x + a[2] * b[2].x);
        F32 dy = to_float(a[0] * b[0].y + a[1] * b[1].y + a[2] * b[2].y);
        if (!m_all_invertible) {
            origin = ::xsimd::select(m_weights.invertible, origin, a0);
            dx = ::xsimd::select(m_weights.invertible, dx, F32(0.0F));
            dy = ::xsimd::select(m_weights.invertible, dy, F32(0.0F));
        }
        float* const out = m_out + 3 * number * kAttributeStride;
        store(out, origin);
        store(out + kAttributeStride, dx);
        store(out + 2 * kAttributeStride, dy);
    }

  private:
    const CornerWeights& m_weights;
    bool m_all_invertible;
    float* m_out;
};

/// Formulas: AttributePlanesCtx. A lane is a triangle.
void attribute_planes(const AttributePlanesCtx& ctx) noexcept {
    for (int first = 0; first < ctx.count; first += kLanes32) {
        const PlaneTriangles triangles(ctx, first);
        const CornerWeights weights = corner_weights(ctx, triangles);
        const EquationWriter equations(ctx, weights, first);
        const F32 one(1.0F);
        equations.write(0, one, one, one);
        const float* row[3][kLanes32];
        for (int k = 0; k < kLanes32; ++k) {
            for (int i = 0; i < 3; ++i)
                row[i][k] = ctx.rows + triangles.lane[k]->vertex[i] * ctx.row_stride;
        }
        for (int a = 0; a < ctx.attribute_count; a += 4) {
            const auto corner = [&](int i) {
                return load_columns([&](int k) { return row[i][k] + a; });
            };
            const Columns c[3] = {corner(0), corner(1), corner(2)};
            const int left = ctx.attribute_count - a;
            for (int k = 0; k < 4 && k < left; ++k)
                equations.write(a + k + 1, c[0].floats(k), c[1].floats(k), c[2].floats(k));
        }
    }
}
