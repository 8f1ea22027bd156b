/// Fragments to compute: whole groups, so that no kernel has a tail.
int group_count(const Packet& packet) {
    return (packet.count + kFragmentGroup - 1) / kFragmentGroup * kFragmentGroup;
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
