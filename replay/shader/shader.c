/* SPIR-V of a pass: the built-in one, or that of a user's file or of a folder of sources, compiled with glslang. */
#include "shader.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <pthread.h>
#include <xxhash.h>

/* Joins glslang's log, which has one message a line, into one error message. Messages of the linker do not name a file. */
static bool fail_with_log(const char *path, bool names_file, const char *log, struct glint_error *err) {
    char text[800] = "", line[512];
    size_t used = 0;
    while (*log) {
        size_t length = strcspn(log, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, log);
        log += length + (log[length] == '\n');
        /* Skips summaries such as "compilation terminated" and "2 compilation errors". */
        if (strncmp(line, "ERROR: ", 7) != 0 || strstr(line, "compilation terminated") ||
            strstr(line, "No code generated"))
            continue;
        if (used + strlen(line) < sizeof text) used += (size_t)sprintf(text + used, "%s%s", used ? "; " : "", line + 7);
    }
    const bool prefix = !names_file || !used;
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s%s%s", prefix ? path : "", prefix ? ": " : "",
                      used ? text : "does not compile");
}

/* Compiled SPIR-V, found by the hash of its source text. */
struct compiled {
    XXH128_hash_t text;
    uint32_t *words;
    size_t bytes;
    struct compiled *next;
};

static bool compile_text(struct compiled *out, const char *path, const char *code, struct glint_error *err) {
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
            out->bytes = glslang_program_SPIRV_get_size(program) * sizeof(uint32_t);
            out->words = out->bytes ? malloc(out->bytes) : NULL;
            if (out->words) glslang_program_SPIRV_get(program, out->words);
            ok = out->words || glint_fail(err, GLINT_ERROR_MEMORY, "%s: no SPIR-V was generated", path);
        }
    }
    if (program) glslang_program_delete(program);
    if (shader) glslang_shader_delete(shader);
    return ok;
}

/* Initialising and finalising glslang is global to the process, counted, and not thread-safe. The first compilation after it parses GLSL's built-in
   functions, which takes longer than most shaders: so what is initialised stays so as long as the device. */
static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

static bool start_compiler(struct shaders *shaders, const char *path, struct glint_error *err) {
    if (!shaders->compiler) shaders->compiler = glslang_initialize_process() != 0;
    return shaders->compiler || glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: glslang cannot start", path);
}

static bool find_compiled(struct spirv *spirv, struct shaders *shaders, const char *path, const char *code,
                          struct glint_error *err) {
    const XXH128_hash_t hash = XXH3_128bits(code, strlen(code));
    struct compiled *found = shaders->first;
    while (found && !XXH128_isEqual(found->text, hash)) found = found->next;
    if (!found) {
        found = calloc(1, sizeof *found);
        pthread_mutex_lock(&one_at_a_time);
        const bool ok = found && start_compiler(shaders, path, err) && compile_text(found, path, code, err);
        pthread_mutex_unlock(&one_at_a_time);
        if (!ok) {
            if (!found) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
            free(found);
            return false;
        }
        found->text = hash;
        found->next = shaders->first;
        shaders->first = found;
    }
    spirv->words = spirv->unprobed = found->words;
    spirv->bytes = spirv->unprobed_bytes = found->bytes;
    return true;
}

/* Where the pass's own module is kept; NULL if memory is short. */
static struct spirv *find_built_in(struct shaders *shaders, const struct glint_pass *pass) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    if (!shaders->built_in) shaders->built_in = calloc(count, sizeof *shaders->built_in);
    return shaders->built_in && pass >= all && pass < all + count ? &shaders->built_in[pass - all] : NULL;
}

bool spirv_find(struct spirv *spirv, struct shaders *shaders, const struct pipeline_pass *entry,
                struct glint_error *err) {
    const struct glint_pass *pass = entry->pass;
    struct glint_error own = {0};
    char *code = entry->shader ? shader_flatten(entry->shader, pass, shaders->folder, &own)
                               : shader_flatten_pass(pass, shaders->folder, &own);
    *spirv = (struct spirv){.words = pass->spirv,
                            .bytes = pass->spirv_bytes,
                            .unprobed = pass->unprobed,
                            .unprobed_bytes = pass->unprobed_bytes,
                            .tiles = true};
    if (own.code != GLINT_OK) return glint_fail(err, own.code, "%s", own.message);
    if (code) {
        spirv->from = entry->shader ? entry->shader : shaders->folder;
        spirv->tiles = strstr(code, "tile_texel(") != NULL;
        const bool ok = find_compiled(spirv, shaders, spirv->from, code, err);
        free(code);
        if (!ok || !spirv_check_bindings(spirv, pass, spirv->from, err)) return false;
    }
    if (!spirv->words)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s/%s: this build has no shader for it", pass->slot,
                          pass->variant);
    struct spirv *known = spirv->from ? NULL : find_built_in(shaders, pass);
    if (known && known->words) {
        *spirv = *known;
        return true;
    }
    spirv->hash = XXH3_64bits(spirv->words, spirv->bytes);
    spirv_find_uses(spirv);
    if (known) *known = *spirv;
    return true;
}

bool shaders_init(struct shaders *shaders, const char *folder, struct glint_error *err) {
    *shaders = (struct shaders){0};
    if (!folder || !folder[0]) return true;
    shaders->folder = realpath(folder, NULL);
    return shaders->folder || glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno));
}

void shaders_finish(struct shaders *shaders) {
    for (struct compiled *next, *one = shaders->first; one; one = next) {
        next = one->next;
        free(one->words);
        free(one);
    }
    free(shaders->built_in);
    free(shaders->folder);
    pthread_mutex_lock(&one_at_a_time);
    if (shaders->compiler) glslang_finalize_process();
    pthread_mutex_unlock(&one_at_a_time);
    *shaders = (struct shaders){0};
}
