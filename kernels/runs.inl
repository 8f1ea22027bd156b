/// kLanes pixels one after the other, as where a triangle covers whole blocks.
inline bool are_consecutive(const std::uint16_t* pixels) {
    const auto* const p = reinterpret_cast<const std::int16_t*>(pixels);
    return ::xsimd::all(load(p) == I16(p[0]) + load(kLaneNumbers.of16));
}

/// Vectors of one run that are taken together, so that rows of equations are loaded once. Where a
/// vector has whole rows of a block these must lie below each other, in the same columns of one
/// block.
inline constexpr int kColumnVectors = 4;
inline constexpr bool kHasColumns = kLanes32 >= kBlockSize;
/// Vectors of one run that are taken together where they are no column.
inline constexpr int kRunVectors = kHasColumns ? 16 / kLanes32 : 1;
inline bool are_below_each_other(const std::uint16_t* pixels) {
    constexpr int kFragments = kColumnVectors * kLanes32;
    return pixels[0] % kBlockPixels <= kBlockPixels - kFragments &&
           pixels[kLanes] == pixels[0] + kLanes && are_consecutive(pixels) &&
           are_consecutive(pixels + kLanes);
}

/// Rows of the equations at fragments of one run.
struct RowsOfOneRun {
    F32 operator()(int k) const { return F32(at(k)); }
    float at(int k) const { return equations[k * kAttributeStride]; }
    /// 1 / w, where it is the same everywhere, as in whatever faces the viewer; else 0.
    float level_w() const { return at(1) == 0.0F && at(2) == 0.0F ? 1.0F / (at(0) + 0.0F) : 0.0F; }
    const float* equations;
};

/// The same where runs change between the fragments of a vector.
struct RowsOfRuns {
    F32 operator()(int k) const { return spread(load(equations + k * kAttributeStride)); }
    static float level_w() { return 0.0F; }
    const float* equations;
    const LaneOrder& spread;
};

/// What the runs of a packet say, brought to its fragments.
class FragmentRuns {
  public:
    FragmentRuns(const Packet& packet, const AttributesCtx& ctx) : m_packet(packet), m_ctx(ctx) {
        const Run* const runs = ctx.runs;
        for (int r = 0; r < ctx.run_count; ++r) {
            m_offset_x[r] = runs[r].offset_x;
            m_offset_y[r] = runs[r].offset_y;
            const I16 number(static_cast<std::int16_t>(r));
            const int end = runs[r].first + runs[r].count;
            for (int i = runs[r].first; i < end; i += kLanes) store(m_run_of + i, number);
        }
        const Run& last = runs[ctx.run_count - 1];
        m_end = last.first + last.count;
        store(m_run_of + m_end, I16(static_cast<std::int16_t>(ctx.run_count - 1)));
    }

    /// Calls f(first fragment, pixel positions, row) for every vector of fragments; row(k) is row k
    /// of the equations at each of them.
    template <class F>
    void for_each_vector(F&& f) const {
        for (int i = 0; i < m_end; i += kLanes32) call(i, f);
    }

    /// The same, but g(first fragment, pixel positions of each, row) for kColumnVectors of one run,
    /// which have one x where kHasColumns, and for kRunVectors others.
    template <class F, class G>
    void for_each_vector(F&& f, G&& g) const {
        constexpr int kFragments = kColumnVectors * kLanes32;
        for (int i = 0; i < m_end;) {
            const int run = m_run_of[i];
            const std::uint16_t* const pixels = m_packet.pixels + i;
            const bool together = i + kFragments <= m_end && m_run_of[i + kFragments - 1] == run &&
                                  (!kHasColumns || are_below_each_other(pixels));
            if (!together) {
                if constexpr (kRunVectors > 1) {
                    constexpr int kPart = kRunVectors * kLanes32;
                    if (i + kPart <= m_end && m_run_of[i + kPart - 1] == run) {
                        PixelPositions pixel[kRunVectors];
                        for (int v = 0; v < kRunVectors; ++v)
                            pixel[v] = positions(pixels + v * kLanes32, I32(m_offset_x[run]),
                                                 I32(m_offset_y[run]));
                        g(i, pixel, RowsOfOneRun{m_ctx.equations + run});
                        i += kPart;
                        continue;
                    }
                }
                call(i, f);
                i += kLanes32;
                continue;
            }
            PixelPositions pixel[kColumnVectors];
            const I32 offset_x(m_offset_x[run]), offset_y(m_offset_y[run]);
            pixel[0] = positions(pixels, offset_x, offset_y);
            for (int v = 1; v < kColumnVectors; ++v) {
                if constexpr (kHasColumns) {
                    // Whole numbers below 2^24: exact, however they are added.
                    const F32 down(static_cast<float>(v * kLanes32 / kBlockSize));
                    pixel[v] = {pixel[0].x, pixel[0].y + down};
                } else {
                    pixel[v] = positions(pixels + v * kLanes32, offset_x, offset_y);
                }
            }
            g(i, pixel, RowsOfOneRun{m_ctx.equations + run});
            i += kFragments;
        }
    }

  private:
    template <class F>
    [[gnu::always_inline]] void call(int i, F&& f) const {
        const int run = m_run_of[i];
        const float* const equations = m_ctx.equations + run;
        const std::uint16_t* const pixels = m_packet.pixels + i;
        if (run == m_run_of[i + kLanes32 - 1]) {
            f(i, positions(pixels, I32(m_offset_x[run]), I32(m_offset_y[run])),
              RowsOfOneRun{equations});
            return;
        }
        // Fragments of a vector belong to runs that follow each other, no more than its lanes.
        const auto* const numbers = reinterpret_cast<const std::uint16_t*>(m_run_of + i);
        const LaneOrder spread(load_widened(numbers) - I32(run));
        f(i, positions(pixels, spread(load(m_offset_x + run)), spread(load(m_offset_y + run))),
          RowsOfRuns{equations, spread});
    }

    const Packet& m_packet;
    const AttributesCtx& m_ctx;
    int m_end;
    alignas(64) std::int16_t m_run_of[kPacketSize + 2 * kLanes];
    alignas(64) std::int32_t m_offset_x[kPacketSize + kLanes32];
    alignas(64) std::int32_t m_offset_y[kPacketSize + kLanes32];
};
