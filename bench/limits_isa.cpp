/// The loops of limits.hpp for one instruction set; compiled like kernels/isa.cpp.
#include "bench/limits.hpp"
#include "kernels/simd.hpp"

namespace burnish::BURNISH_ISA {
namespace {

constexpr int kChains = 8;  // more than latency times operations per cycle asks for

template <class Vector, class Element>
void spin(Element* data, long count) noexcept {
    constexpr int kStep = static_cast<int>(Vector::size);
    Vector x[kChains];
    for (int k = 0; k < kChains; ++k) x[k] = load(data + k * kStep);
    const Vector a = load(data), b = load(data + kStep);
    for (long i = 0; i < count; ++i)
        for (int k = 0; k < kChains; ++k) x[k] = x[k] * a + b;
    for (int k = 0; k < kChains; ++k) store(data + k * kStep, x[k]);
}

void copy(std::int16_t* to, const std::int16_t* from, long size) noexcept {
    const long elements = size / 2;
    for (long i = 0; i < elements; i += 2 * kLanes) {
        const I16 first = load(from + i), second = load(from + i + kLanes);
        store(to + i, first);
        store(to + i + kLanes, second);
    }
}

void pairs(std::int16_t* out, const std::uint8_t* texels, const std::int32_t* offset,
           long count) noexcept {
    I16 sum(0);
    for (long i = 0; i < count; ++i)
        for (int first = 0; first < 256; first += kLanes)
            for (int k = 0; k < 4; ++k)
                sum = sum ^ load_pairs(texels + i % 8 * 8, offset + first + 2 * k);
    store(out, sum);
}

constexpr LimitLoops kLoops{kLanes,           kLanes32, spin<I16, std::int16_t>,
                            spin<F32, float>, pairs,    copy};

}  // namespace

const LimitLoops* limit_loops() {
    return &kLoops;
}

}  // namespace burnish::BURNISH_ISA
