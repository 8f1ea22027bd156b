#include "bench/peers/spirv.hpp"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

#include <memory>
#include <stdexcept>

namespace burnish::peers {

namespace {

/// The compiler's state, kept to the end of the process.
void initialize() {
    static const int kInitialized = glslang_initialize_process();
    if (kInitialized == 0) throw std::runtime_error("glslang does not start");
}

}  // namespace

std::vector<std::uint32_t> spirv_of(ShaderStage stage, const std::string& source) {
    initialize();
    glslang_input_t input{};
    input.language = GLSLANG_SOURCE_GLSL;
    input.stage = stage == ShaderStage::vertex ? GLSLANG_STAGE_VERTEX : GLSLANG_STAGE_FRAGMENT;
    input.client = GLSLANG_CLIENT_VULKAN;
    input.client_version = GLSLANG_TARGET_VULKAN_1_1;
    input.target_language = GLSLANG_TARGET_SPV;
    input.target_language_version = GLSLANG_TARGET_SPV_1_3;
    input.code = source.c_str();
    input.default_version = 450;
    input.default_profile = GLSLANG_NO_PROFILE;
    input.messages = GLSLANG_MSG_DEFAULT_BIT;
    input.resource = glslang_default_resource();
    const std::unique_ptr<glslang_shader_t, void (*)(glslang_shader_t*)> shader(
        glslang_shader_create(&input), glslang_shader_delete);
    const std::unique_ptr<glslang_program_t, void (*)(glslang_program_t*)> program(
        glslang_program_create(), glslang_program_delete);
    if (glslang_shader_preprocess(shader.get(), &input) == 0 ||
        glslang_shader_parse(shader.get(), &input) == 0)
        throw std::runtime_error("GLSL: " + std::string(glslang_shader_get_info_log(shader.get())) +
                                 source);
    glslang_program_add_shader(program.get(), shader.get());
    constexpr int kMessages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT;
    if (glslang_program_link(program.get(), kMessages) == 0)
        throw std::runtime_error("GLSL: program does not link");
    glslang_program_SPIRV_generate(program.get(), input.stage);
    std::vector<std::uint32_t> words(glslang_program_SPIRV_get_size(program.get()));
    glslang_program_SPIRV_get(program.get(), words.data());
    return words;
}

}  // namespace burnish::peers
