// Starts glslang in a process that may be short of memory: a shim that catches what glslang throws then. Exceptions must not leave this file.
#include "start.h"

#include <exception>

static bool start(const glslang_input_t *input) {
    if (!glslang_initialize_process()) return false;
    glslang_shader_t *shader = glslang_shader_create(input);
    const bool ok = shader && glslang_shader_preprocess(shader, input) && glslang_shader_parse(shader, input);
    if (shader) glslang_shader_delete(shader);
    return ok;
}

bool start_glslang(const glslang_input_t *shader) {
    try {
        return start(shader);
    } catch (const std::exception &) {
        return false;
    }
}
