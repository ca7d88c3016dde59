/* SPIR-V of a pass: the embedded one, or the user's file compiled with glslang. */
#include "shader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <xxhash.h>

/* glslang's log, one message a line, as one line of ours. The linker's messages name no file. */
static bool fail_with_log(const char *path, bool names_file, const char *log, struct glint_error *err) {
    char text[800] = "", line[512];
    size_t used = 0;
    while (*log) {
        size_t length = strcspn(log, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, log);
        log += length + (log[length] == '\n');
        /* Its closing words ("compilation terminated", "2 compilation errors") tell nothing. */
        if (strncmp(line, "ERROR: ", 7) != 0 || strstr(line, "compilation terminated") ||
            strstr(line, "No code generated"))
            continue;
        if (used + strlen(line) < sizeof text) used += (size_t)sprintf(text + used, "%s%s", used ? "; " : "", line + 7);
    }
    const bool prefix = !names_file || !used;
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s%s%s", prefix ? path : "", prefix ? ": " : "",
                      used ? text : "does not compile");
}

static bool compile(struct spirv *spirv, const char *path, const char *code, struct glint_error *err) {
    const glslang_input_t input = {.language = GLSLANG_SOURCE_GLSL,
                                   .stage = GLSLANG_STAGE_COMPUTE,
                                   .client = GLSLANG_CLIENT_VULKAN,
                                   .client_version = GLSLANG_TARGET_VULKAN_1_3,
                                   .target_language = GLSLANG_TARGET_SPV,
                                   .target_language_version = GLSLANG_TARGET_SPV_1_6,
                                   .code = code,
                                   .default_version = 460,
                                   .default_profile = GLSLANG_CORE_PROFILE,
                                   .messages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT,
                                   .resource = glslang_default_resource()};
    if (!glslang_initialize_process())
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: glslang cannot start", path);
    glslang_shader_t *shader = glslang_shader_create(&input);
    glslang_program_t *program = glslang_program_create();
    bool ok = false;
    if (!shader || !program) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    else if (!glslang_shader_preprocess(shader, &input) || !glslang_shader_parse(shader, &input))
        fail_with_log(path, true, glslang_shader_get_info_log(shader), err);
    else {
        glslang_program_add_shader(program, shader);
        if (!glslang_program_link(program, (int)input.messages))
            fail_with_log(path, false, glslang_program_get_info_log(program), err);
        else {
            glslang_program_SPIRV_generate(program, input.stage);
            spirv->bytes = glslang_program_SPIRV_get_size(program) * sizeof(uint32_t);
            spirv->owned = spirv->bytes ? malloc(spirv->bytes) : NULL;
            if (spirv->owned) glslang_program_SPIRV_get(program, spirv->owned);
            spirv->words = spirv->owned;
            ok = spirv->owned || glint_fail(err, GLINT_ERROR_MEMORY, "%s: no SPIR-V was made", path);
        }
    }
    if (program) glslang_program_delete(program);
    if (shader) glslang_shader_delete(shader);
    glslang_finalize_process();
    return ok;
}

bool spirv_init(struct spirv *spirv, const struct pipeline_pass *entry, struct glint_error *err) {
    *spirv = (struct spirv){0};
    if (entry->shader) {
        struct glint_error own = {0};
        char *code = shader_flatten(entry->shader, entry->pass->slot, &own);
        if (!code) return glint_fail(err, own.code, "%s", own.message);
        bool ok = compile(spirv, entry->shader, code, err);
        free(code);
        if (!ok || !spirv_check_bindings(spirv, entry->pass, entry->shader, err)) return false;
    } else {
        spirv->words = entry->pass->spirv;
        spirv->bytes = entry->pass->spirv_bytes;
    }
    if (!spirv->words)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s/%s: this build has no shader for it", entry->pass->slot,
                          entry->pass->variant);
    spirv->hash = XXH3_64bits(spirv->words, spirv->bytes);
    spirv_find_frame_words(spirv);
    return true;
}

void spirv_finish(struct spirv *spirv) {
    free(spirv->owned);
    *spirv = (struct spirv){0};
}
