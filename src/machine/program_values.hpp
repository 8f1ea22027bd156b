#pragma once

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/machine.hpp>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "kernels/kernel_table.hpp"
#include "machine/bind.hpp"

namespace burnish {

/// A value of the program: a constant, an input, or the output of a portion.
using Value = int;
inline constexpr Value kNothing = -1;

using Components = std::array<Value, 4>;  // r, g, b, a

struct OperandValues {
    std::array<Value, 3> value{kNothing, kNothing, kNothing};
    Mapping mapping = Mapping::unsigned_identity;
};

/// One portion, or one fetch, on values instead of planes.
struct Operation {
    int step = 0;  ///< the portions of a stage read before any of them writes
    OperandValues a, b, c, d;
    ProductKind ab = ProductKind::none, cd = ProductKind::none;
    ThirdKind third = ThirdKind::none;
    Portion source;
    int components = 1;
    Value mux = kNothing;
    std::array<Value, 3> ab_out{kNothing, kNothing, kNothing};
    std::array<Value, 3> cd_out = ab_out, third_out = ab_out;
    bool coding = false;  ///< no part of the program
    const StageFetch* fetch = nullptr;
    std::array<Value, 3> coordinates{kNothing, kNothing, kNothing};
    Components fetched{kNothing, kNothing, kNothing, kNothing};
};

/// A program as operations on values: each value is written once, and what nothing reads is not
/// there. Fetches point into the program.
struct ProgramValues {
    int count = 0;                   ///< values are 0 .. count - 1
    int steps = 0;                   ///< fetches and stages
    std::map<int, Value> constants;  ///< by code
    std::vector<std::pair<Register, Components>> inputs;
    std::set<Value> beyond_one;  ///< what may lie outside of [-1, 1]
    std::vector<Operation> operations;
    std::array<OperandValues, 7> final_inputs;  ///< A .. G
    std::array<OperandValues, 2> color_sum;     ///< spare0, col1
    bool uses_color_sum = false, uses_final_product = false;
    std::optional<Components> shown;  ///< a register that is the result instead of the combiner's

    /// What an operation reads.
    template <class F>
    static void for_each_read(const Operation& op, F&& f) {
        if (op.fetch != nullptr) {
            for (const Value v : op.coordinates) {
                if (v != kNothing) f(v);
            }
            return;
        }
        const auto operand = [&](const OperandValues& o, ProductKind product) {
            const int used = product == ProductKind::dot ? 3 : op.components;
            for (int c = 0; c < used; ++c) f(o.value[static_cast<std::size_t>(c)]);
        };
        operand(op.a, op.ab);
        operand(op.b, op.ab);
        if (op.cd != ProductKind::none) {
            operand(op.c, op.cd);
            operand(op.d, op.cd);
        }
        if (op.third == ThirdKind::mux) f(op.mux);
    }

    /// What is read behind the last operation.
    template <class F>
    void for_each_final_read(F&& f) const {
        if (shown) {
            for (const Value v : *shown) f(v);
            return;
        }
        for (const OperandValues& o : final_inputs) {
            for (const Value v : o.value) f(v);
        }
        if (!uses_color_sum) return;
        for (const OperandValues& o : color_sum) {
            for (const Value v : o.value) f(v);
        }
    }

    /// Whether an operand of the final combiner is 0 everywhere.
    [[nodiscard]] bool is_zero(const OperandValues& o) const;
};

/// The values of `program`, which `machine` can run.
ProgramValues values_of(const CombinerProgram& program, const Machine& machine,
                        const UnitStates& units, const Wanted& wanted);

}  // namespace burnish
