// Starts glslang in a process that may be short of memory: a shim that catches what glslang throws then. Exceptions must not leave this file.
#include "start.h"

#include <exception>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

static bool start() {
    glslang_input_t input = {};
    input.language = GLSLANG_SOURCE_GLSL;
    input.stage = GLSLANG_STAGE_COMPUTE;
    input.client = GLSLANG_CLIENT_VULKAN;
    input.client_version = GLSLANG_TARGET_VULKAN_1_3;
    input.target_language = GLSLANG_TARGET_SPV;
    input.target_language_version = GLSLANG_TARGET_SPV_1_6;
    input.code = "#version 460\nvoid main() {}\n";
    input.default_version = 460;
    input.default_profile = GLSLANG_CORE_PROFILE;
    input.messages = GLSLANG_MSG_DEFAULT_BIT;
    input.resource = glslang_default_resource();
    if (!glslang_initialize_process()) return false;
    glslang_shader_t *shader = glslang_shader_create(&input);
    const bool ok = shader && glslang_shader_preprocess(shader, &input) && glslang_shader_parse(shader, &input);
    if (shader) glslang_shader_delete(shader);
    return ok;
}

bool start_glslang() {
    try {
        return start();
    } catch (const std::exception &) {
        return false;
    }
}
