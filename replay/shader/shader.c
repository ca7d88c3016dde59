/* SPIR-V of a pass: the built-in one, or that of a user's file or of a folder of sources, compiled. */
#include "shader.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "compile.h"

/* Compiled SPIR-V, found by the hash of its source text. */
struct compiled {
    XXH128_hash_t text;
    struct compiled_text code;
    struct compiled *next;
};

static bool find_compiled(struct spirv *spirv, struct shaders *shaders, const char *path, const char *code,
                          struct glint_error *err) {
    const XXH128_hash_t hash = XXH3_128bits(code, strlen(code));
    struct compiled *found = shaders->first;
    while (found && !XXH128_isEqual(found->text, hash)) found = found->next;
    if (!found) {
        if (!(found = calloc(1, sizeof *found))) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        if (!compile_glsl(&found->code, &shaders->compiler, path, code, shaders->clamp, err)) {
            free(found);
            return false;
        }
        found->text = hash;
        found->next = shaders->first;
        shaders->first = found;
    }
    spirv->words = spirv->unprobed = found->code.words;
    spirv->bytes = spirv->unprobed_bytes = found->code.bytes;
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
        if (!ok || !spirv_vet(spirv, pass, spirv->from, err)) return false;
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
        free(one->code.words);
        free(one);
    }
    free(shaders->built_in);
    free(shaders->folder);
    compile_end(&shaders->compiler);
    *shaders = (struct shaders){0};
}
