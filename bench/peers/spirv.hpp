#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace burnish::peers {

enum class ShaderStage { vertex, fragment };

/// GLSL as Vulkan 1.1 takes it. Throws std::runtime_error with the compiler's log.
std::vector<std::uint32_t> spirv_of(ShaderStage stage, const std::string& source);

}  // namespace burnish::peers
