/// Fragments to compute: whole groups, so that no kernel has a tail.
int group_count(const Packet& packet) {
    return (packet.count + kFragmentGroup - 1) / kFragmentGroup * kFragmentGroup;
}
