int tile_x(int pixel) {
    return pixel / kBlockPixels % (kTileSize / kBlockSize) * kBlockSize + pixel % kBlockSize;
}
int tile_y(int pixel) {
    return pixel / kBlockPixels / (kTileSize / kBlockSize) * kBlockSize +
           pixel % kBlockPixels / kBlockSize;
}

int tile_index(int x, int y) {
    const int block = y / kBlockSize * (kTileSize / kBlockSize) + x / kBlockSize;
    return block * kBlockPixels + y % kBlockSize * kBlockSize + x % kBlockSize;
}

std::uint32_t outcode(const HomogeneousVertex& v, const Viewport& viewport) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w))
        return Outcode::nonfinite;
    std::uint32_t code = 0;
    if (v.x < 0.0F) code |= Outcode::left;
    if (v.x > v.w * viewport.width) code |= Outcode::right;
    if (v.y < 0.0F) code |= Outcode::above;
    if (v.y > v.w * viewport.height) code |= Outcode::below;
    if (v.z < 0.0F) code |= Outcode::near;
    if (v.z > v.w) code |= Outcode::far;
    const auto outside = [&](float window) { return window < kGuardLow || window > kGuardHigh; };
    if (!(v.w > 0.0F) || outside(v.x / v.w) || outside(v.y / v.w)) code |= Outcode::guard;
    return code;
}

void transform(const TransformCtx& ctx) noexcept {
    const float* m = ctx.m;
    const Viewport& port = ctx.viewport;
    for (int k = 0; k < ctx.count; ++k) {
        float clip[4];
        for (int i = 0; i < 4; ++i)
            clip[i] = ((ctx.x[k] * m[i] + ctx.y[k] * m[4 + i]) + ctx.z[k] * m[8 + i]) + m[12 + i];
        HomogeneousVertex& h = ctx.homogeneous[k];
        h.x = clip[0] * port.half_width + clip[3] * port.half_width;
        h.y = clip[3] * port.half_height - clip[1] * port.half_height;
        h.z = clip[2] * 0.5F + clip[3] * 0.5F;
        h.w = clip[3];

        ScreenVertex& s = ctx.screen[k];
        s = {0, 0, 0.0F, outcode(h, port)};
        if ((s.outcode & (Outcode::needs_clip | Outcode::nonfinite)) != 0) continue;
        const auto snap = [&](float window) {
            const float step = std::floor(window * port.subpixels + port.snap_bias);
            return static_cast<std::int32_t>(step) *
                   (256 / static_cast<std::int32_t>(port.subpixels));
        };
        s.x = snap(h.x / h.w);
        s.y = snap(h.y / h.w);
        s.z = h.z / h.w;
    }
}

/// Whether the centre of the pixel lies inside, with the top-left rule.
bool covers(const SetupTriangle& t, int x, int y) {
    for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        const Int a = t.y[i] - t.y[next], b = t.x[next] - t.x[i];
        const Int value = a * (256 * x + 128 - t.x[i]) + b * (256 * y + 128 - t.y[i]);
        const bool top_left = a > 0 || (a == 0 && b > 0);
        if (value < 0 || (value == 0 && !top_left)) return false;
    }
    return true;
}

/// First and last pixel whose centre lies from `low` to `high`.
Int first_pixel(Int low) {
    return (low - 128 + 255) >> 8;
}
Int last_pixel(Int high) {
    return (high - 128) >> 8;
}

void depth_plane(const ScreenVertex (&v)[3], Int area, SetupTriangle& out) {
    const double z0 = static_cast<double>(v[0].z);
    const double dz1 = static_cast<double>(v[1].z) - z0, dz2 = static_cast<double>(v[2].z) - z0;
    const double x1 = v[1].x - v[0].x, y1 = v[1].y - v[0].y;
    const double x2 = v[2].x - v[0].x, y2 = v[2].y - v[0].y;
    const double scale = 256.0 / static_cast<double>(area);
    const double zx = (dz1 * y2 - dz2 * y1) * scale, zy = (dz2 * x1 - dz1 * x2) * scale;
    const double dx = out.reference_x + 0.5 - v[0].x / 256.0;
    const double dy = out.reference_y + 0.5 - v[0].y / 256.0;
    out.z = static_cast<float>(z0 + dx * zx + dy * zy);
    out.zx = static_cast<float>(zx);
    out.zy = static_cast<float>(zy);
    out.z_low = std::min({v[0].z, v[1].z, v[2].z});
    out.z_high = std::max({v[0].z, v[1].z, v[2].z});
}

/// Whether the triangle is drawn. Corners need no clipping.
bool set_up(const SetupCtx& ctx, ScreenVertex (&v)[3], SetupCounts& counts, SetupTriangle& out,
            SetupPlace& place) {
    const Int area =
        Int{v[1].x - v[0].x} * (v[2].y - v[0].y) - Int{v[1].y - v[0].y} * (v[2].x - v[0].x);
    if (area == 0) {
        ++counts.degenerate;
        return false;
    }
    if ((area > 0 ? ctx.drop_positive : ctx.drop_negative) != 0) return false;
    out.swapped = area < 0 ? 1 : 0;
    if (area < 0) std::swap(v[1], v[2]);
    for (int i = 0; i < 3; ++i) {
        out.x[i] = v[i].x;
        out.y[i] = v[i].y;
    }
    const auto [x_low, x_high] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [y_low, y_high] = std::minmax({v[0].y, v[1].y, v[2].y});
    const Int x0 = first_pixel(x_low), x1 = last_pixel(x_high);
    const Int y0 = first_pixel(y_low), y1 = last_pixel(y_high);
    out.box = {static_cast<std::int16_t>(std::max(x0, Int{0})),
               static_cast<std::int16_t>(std::max(y0, Int{0})),
               static_cast<std::int16_t>(std::min(x1, Int{ctx.width} - 1)),
               static_cast<std::int16_t>(std::min(y1, Int{ctx.height} - 1))};
    if (out.box.x0 > out.box.x1 || out.box.y0 > out.box.y1) return false;
    const bool small = x_high - x_low <= 256 * kSmallSize && y_high - y_low <= 256 * kSmallSize;
    const bool one_tile = out.box.x0 / kTileSize == out.box.x1 / kTileSize &&
                          out.box.y0 / kTileSize == out.box.y1 / kTileSize;
    place = {0, static_cast<std::uint16_t>(out.box.x0), static_cast<std::uint16_t>(out.box.y0),
             !small     ? SetupPlace::kLarge
             : one_tile ? 0U
                        : 1U};
    const bool tiny = x1 - x0 < kTinySize && y1 - y0 < kTinySize;
    for (int y = out.box.y0; tiny && y <= out.box.y1; ++y) {
        for (int x = out.box.x0; x <= out.box.x1; ++x) {
            const int bit = kTinySize * (y - out.box.y0) + x - out.box.x0;
            if (covers(out, x, y)) place.covered |= std::uint64_t{1} << bit;
        }
    }
    if (tiny && place.covered == 0) return false;
    const ScreenVertex& farthest = *std::max_element(
        v, v + 3, [](const ScreenVertex& a, const ScreenVertex& b) { return a.z < b.z; });
    out.reference_x = static_cast<std::int16_t>(clamp(farthest.x >> 8, 0, ctx.width - 1));
    out.reference_y = static_cast<std::int16_t>(clamp(farthest.y >> 8, 0, ctx.height - 1));
    depth_plane(v, area < 0 ? -area : area, out);
    return true;
}

void setup(const SetupCtx& ctx) noexcept {
    SetupCounts& counts = *ctx.counts = {};
    PixelRect& bounds = counts.bounds = {32767, 32767, -1, -1};
    for (; counts.taken < ctx.count; ++counts.taken) {
        ScreenVertex v[3];
        for (int i = 0; i < 3; ++i) v[i] = ctx.vertices[ctx.indices[3 * counts.taken + i]];
        const std::uint32_t any = v[0].outcode | v[1].outcode | v[2].outcode;
        if ((any & Outcode::nonfinite) != 0) {
            ++counts.nonfinite;
            continue;
        }
        if ((v[0].outcode & v[1].outcode & v[2].outcode & Outcode::frustum) != 0) continue;
        if ((any & Outcode::needs_clip) != 0) return;
        SetupTriangle triangle{};
        if (!set_up(ctx, v, counts, triangle, ctx.places[counts.drawn])) continue;
        triangle.number = ctx.number + static_cast<std::uint32_t>(counts.taken);
        triangle.draw = ctx.draw & ((1U << 30) - 1);
        ctx.triangles[counts.drawn++] = triangle;
        bounds = {std::min(bounds.x0, triangle.box.x0), std::min(bounds.y0, triangle.box.y0),
                  std::max(bounds.x1, triangle.box.x1), std::max(bounds.y1, triangle.box.y1)};
    }
}

bool covers(const TileTriangle& t, int x, int y) {
    for (int e = 0; e < t.edges; ++e)
        if (Int{t.a[e]} * x + Int{t.b[e]} * y + t.c[e] < 0) return false;
    return true;
}

/// Of a TileTriangle or a DepthRun.
template <class Triangle>
float depth_at(const Triangle& t, int x, int y) {
    const auto dx = static_cast<float>(x + t.offset_x);
    const auto dy = static_cast<float>(y + t.offset_y);
    return minimum(maximum((t.z + dx * t.zx) + dy * t.zy, t.z_low), t.z_high);
}

/// A depth test, of TileTriangle or LateDepthCtx.
template <class Rule>
bool passes(const Rule& rule, float depth, float old) {
    return depth < old   ? rule.pass_less != 0
           : depth > old ? rule.pass_greater != 0
                         : rule.pass_equal != 0;
}

void clear_words(const ClearWordsCtx& ctx) noexcept {
    for (int i = 0; i < ctx.count; ++i)
        std::memcpy(static_cast<std::uint8_t*>(ctx.to) + 4 * i, &ctx.value, 4);
}

void rasterize(const RasterizeCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const TileTriangle& t = ctx.triangles[k];
        std::uint64_t drawn = 0;
        for (int y = t.y0; y <= t.y1; ++y) {
            for (int x = t.x0; x <= t.x1; ++x) {
                if (!covers(t, x, y)) continue;
                const int pixel = tile_index(x, y);
                const float depth = depth_at(t, x, y);
                if (!passes(t, depth, ctx.depth[pixel])) continue;
                if (ctx.id != nullptr) ctx.id[pixel] = t.id;
                drawn |= std::uint64_t{1} << pixel / kBlockPixels;
                if (t.depth_write != 0) ctx.depth[pixel] = depth;
            }
        }
        if (ctx.id != nullptr) ctx.drawn[k] = drawn;
    }
    for (int block = 0; block < kTileBlocks; ++block) {
        const float* depth = ctx.depth + block * kBlockPixels;
        ctx.block_far[block] = *std::max_element(depth, depth + kBlockPixels);
    }
}

/// Entry k of a tile's list at a pixel that it covers.
void draw_pixel(const RasterizeEntriesCtx& ctx, int k, int x, int y) {
    const SetupTriangle& triangle = ctx.triangles[ctx.entries[k].triangle];
    TileTriangle t{};
    t.z = triangle.z;
    t.zx = triangle.zx;
    t.zy = triangle.zy;
    t.z_low = triangle.z_low;
    t.z_high = triangle.z_high;
    t.offset_x = ctx.left - triangle.reference_x;
    t.offset_y = ctx.top - triangle.reference_y;
    const int pixel = tile_index(x, y);
    const float depth = depth_at(t, x, y);
    if (!passes(ctx.rule, depth, ctx.depth[pixel])) return;
    if (ctx.id != nullptr) {
        ctx.id[pixel] = ctx.first_id + static_cast<std::uint32_t>(k);
        ctx.drawn[k] |= std::uint64_t{1} << pixel / kBlockPixels;
    }
    if (ctx.rule.write == 0) return;
    ctx.depth[pixel] = depth;
    float& far = ctx.block_far[pixel / kBlockPixels];
    far = std::max(far, depth);
}

/// Writes `value` to blank blocks.
template <class Value>
void fill_blank(std::uint8_t* blank, Value* tile, Value value) {
    for (int i = 0; i < kTilePixels; ++i)
        if (blank[i / kBlockPixels] != 0) tile[i] = value;
    std::fill_n(blank, kTileBlocks, std::uint8_t{0});
}

void rasterize_small(const RasterizeEntriesCtx& ctx) noexcept {
    if (ctx.id != nullptr) {
        fill_blank(ctx.blank_depths, ctx.depth, 1.0F);
        fill_blank(ctx.blank_ids, ctx.id, kNoTriangle);
    }
    for (int k = 0; k < ctx.count; ++k) {
        const SetupTriangle& t = ctx.triangles[ctx.entries[k].triangle];
        if (ctx.id != nullptr) ctx.drawn[k] = 0;
        const int last_x = std::min<int>(t.box.x1, ctx.left + kTileSize - 1),
                  last_y = std::min<int>(t.box.y1, ctx.top + kTileSize - 1);
        for (int y = std::max<int>(t.box.y0, ctx.top); y <= last_y; ++y) {
            for (int x = std::max<int>(t.box.x0, ctx.left); x <= last_x; ++x) {
                if (covers(t, x, y)) draw_pixel(ctx, k, x - ctx.left, y - ctx.top);
            }
        }
    }
}

void rasterize_tiny(const RasterizeEntriesCtx& ctx) noexcept {
    for (int k = 0; k < ctx.count; ++k) {
        const TileEntry& entry = ctx.entries[k];
        if (ctx.id != nullptr) ctx.drawn[k] = 0;
        for (int bit = 0; bit < kTinySize * kTinySize; ++bit) {
            if ((entry.covered >> bit & 1) != 0)
                draw_pixel(ctx, k, entry.x + bit % kTinySize, entry.y + bit / kTinySize);
        }
    }
}

void cover(const CoverCtx& ctx) noexcept {
    const TileTriangle& t = *ctx.triangle;
    std::uint64_t passed[kTileBlocks] = {};
    *ctx.blocks = 0;
    for (int y = t.y0; y <= t.y1; ++y) {
        for (int x = t.x0; x <= t.x1; ++x) {
            if (!covers(t, x, y)) continue;
            const int pixel = tile_index(x, y), block = pixel / kBlockPixels;
            const float depth = depth_at(t, x, y);
            if (!passes(t, depth, ctx.depth[pixel])) continue;
            passed[block] |= std::uint64_t{1} << pixel % kBlockPixels;
            if (t.depth_write != 0) ctx.depth[pixel] = depth;
        }
    }
    for (int block = 0; block < kTileBlocks; ++block) {
        const float* depth = ctx.depth + block * kBlockPixels;
        ctx.block_far[block] = *std::max_element(depth, depth + kBlockPixels);
        if (passed[block] == 0) continue;
        ctx.passed[block] = passed[block];
        *ctx.blocks |= std::uint64_t{1} << block;
    }
}

void collect(const CollectCtx& ctx) noexcept {
    std::uint16_t* out = ctx.pixels;
    for (int k = 0; k < ctx.count; ++k) {
        ctx.first[k] = static_cast<std::uint32_t>(out - ctx.pixels);
        for (int pixel = 0; pixel < kTilePixels; ++pixel) {
            const bool drawn = (ctx.drawn[k] >> pixel / kBlockPixels & 1) != 0;
            if (drawn && ctx.id[pixel] == static_cast<std::uint32_t>(k))
                *out++ = static_cast<std::uint16_t>(pixel);
        }
    }
    ctx.first[ctx.count] = static_cast<std::uint32_t>(out - ctx.pixels);
}
