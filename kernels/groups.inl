/// Fragments to compute: whole groups, so that no kernel has a tail.
int group_count(const Packet& packet) {
    return (packet.count + kFragmentGroup - 1) / kFragmentGroup * kFragmentGroup;
}

/// Values of edges at points, less 1 where a point on the edge is outside: edges are closed where
/// the inside lies right of them or, level ones, below: the top-left rule. a and b are the steps of
/// a value.
inline I32 with_top_left_rule(I32 value, I32 a, I32 b) {
    const I32 zero(0);
    const Mask32 closed = (a > zero) | ((a == zero) & (b > zero));
    return ::xsimd::select(closed, value, value - I32(1));
}

/// Pixels of kLanes32 fragments: tile coordinates plus an offset.
struct PixelPositions {
    F32 x, y;
};
inline PixelPositions positions(const std::uint16_t* pixels, I32 offset_x, I32 offset_y) {
    const I32 index = load_widened(pixels), seven(7), high(56);
    return {to_float(((index & seven) | ((index >> 3) & high)) + offset_x),
            to_float((((index >> 3) & seven) | ((index >> 6) & high)) + offset_y)};
}
