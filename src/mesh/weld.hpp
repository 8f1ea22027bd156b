#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burnish {

/// Which of many items are the same.
struct Weld {
    std::vector<std::uint32_t> id;     ///< per item; equal items have equal numbers, which count up
                                       ///< in the order of first appearance
    std::vector<std::uint32_t> first;  ///< per number: the first item that has it
};

/// Bits of a float as part of a key: -0 equals 0, and a NaN equals itself.
inline std::uint32_t key_bits(float x) {
    return x == 0.0F ? 0U : std::bit_cast<std::uint32_t>(x);
}

/// Numbers `count` items, fewer than 2^32 - 1, by `key_of(i)`, an array of words. The result does
/// not depend on the hash, only the time does.
template <class KeyOf>
Weld weld(std::size_t count, const KeyOf& key_of) {
    struct Slot {
        std::uint32_t hash;
        std::uint32_t number;  ///< 0: empty
    };
    const auto hash_of = [](const auto& key) {
        std::uint64_t h = 0;
        for (const std::uint32_t word : key) {
            h = (h ^ word) * 0x9e3779b97f4a7c15U;
            h ^= h >> 32;
        }
        return static_cast<std::uint32_t>(h);
    };
    std::vector<Slot> slots(1024, Slot{0, 0});
    const auto free_slot = [&](std::uint32_t hash) {
        std::size_t at = hash & (slots.size() - 1);
        while (slots[at].number != 0) at = (at + 1) & (slots.size() - 1);
        return at;
    };
    const auto grow = [&] {
        const std::vector<Slot> old = std::move(slots);
        slots.assign(2 * old.size(), Slot{0, 0});
        for (const Slot& slot : old)
            if (slot.number != 0) slots[free_slot(slot.hash)] = slot;
    };

    Weld result;
    result.id.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto key = key_of(i);
        const std::uint32_t hash = hash_of(key);
        std::size_t at = hash & (slots.size() - 1);
        while (slots[at].number != 0 &&
               !(slots[at].hash == hash && key_of(result.first[slots[at].number - 1]) == key))
            at = (at + 1) & (slots.size() - 1);
        if (slots[at].number == 0) {
            result.first.push_back(static_cast<std::uint32_t>(i));
            slots[at] = {hash, static_cast<std::uint32_t>(result.first.size())};
        }
        result.id[i] = slots[at].number - 1;
        if (2 * result.first.size() > slots.size()) grow();
    }
    return result;
}

}  // namespace burnish
