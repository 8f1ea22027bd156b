void clear_words(const ClearWordsCtx& ctx) noexcept {
    auto* const to = static_cast<std::int32_t*>(ctx.to);
    const int count = ctx.count;
    const I32 value(static_cast<std::int32_t>(ctx.value));
    for (int i = 0; i < count; i += 16) {
        for (int k = 0; k < 16; k += kLanes32) store(to + i + k, value);
    }
}
