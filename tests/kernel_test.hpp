#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/cpu.hpp"
#include "kernel_packet.hpp"

/// One set of kernels per test: each is compared with the scalar reference, bit for bit.
namespace burnish {

class KernelTest : public testing::TestWithParam<const KernelTable*> {
  protected:
    static const KernelTable& table() { return *GetParam(); }
    /// Beginning of a failure line.
    static std::string name(const char* stage) { return std::string(table().isa) + " " + stage; }
};

inline std::string isa_name(const testing::TestParamInfo<const KernelTable*>& info) {
    return info.param->isa;
}

inline auto every_table() {
    const auto tables = available_tables();
    return testing::ValuesIn(tables.begin(), tables.end());
}

}  // namespace burnish
