/* SPIR-V of a pass: the built-in one, or compiled from a user's file or from a folder of sources. */
#ifndef GLINT_REPLAY_SHADER_H
#define GLINT_REPLAY_SHADER_H

#include <stdint.h>

#include "frame_block.h"
#include "pipeline.h"

enum { FRAME_WORDS = sizeof(struct frame_block) / sizeof(uint32_t) };

struct spirv;
/* Compiled shaders, each source text once, and the folder whose files replace the built-in ones of passes/. */
struct shaders {
    char *folder; /* or NULL */
    struct compiled *first;
    struct spirv *
        built_in; /* what is known of the modules of passes, in the order of glint_passes(); without words: nothing yet */
    bool compiler; /* glslang is initialised */
    bool
        clamp; /* indices of compiled shaders cannot leave arrays: a device that runs them in this process needs that */
};
bool shaders_init(struct shaders *shaders, const char *folder, struct glint_error *err);
void shaders_finish(struct shaders *shaders);

struct spirv {
    const uint32_t *words; /* owned by the pass or by struct shaders */
    size_t bytes;
    const uint32_t *unprobed; /* what runs without probed pixels */
    size_t unprobed_bytes;
    const char *from; /* the file or folder that it was compiled from, or NULL */
    uint64_t hash;
    bool frame_words[FRAME_WORDS]; /* the words of the uniform block that it reads */
    bool tiles;                    /* it supports dispatches over tiles, by tile_texel() (shared/work_list.glsl) */
    bool probes;                   /* it records probed pixels */
};

bool spirv_find(struct spirv *spirv, struct shaders *shaders, const struct pipeline_pass *pass,
                struct glint_error *err);

/* vet.c: fails if a user's shader holds what could make a driver crash, such as a binding that no row declares. */
bool spirv_vet(const struct spirv *spirv, const struct glint_pass *pass, const char *path, struct glint_error *err);

/* reflect.c */
/* Sets frame_words and probes. */
void spirv_find_uses(struct spirv *spirv);

/* exact.c: a copy of a module in which each operation on floats is rounded by itself. The caller frees it; NULL: out of memory. */
uint32_t *spirv_exact(const uint32_t *words, size_t bytes, size_t *exact_bytes);

/* opaque.c: a copy of a module in which no branch depends on uniform values alone, as far as a driver can see. The caller frees it; NULL: out of memory. */
uint32_t *spirv_opaque(const uint32_t *words, size_t bytes, size_t *opaque_bytes);

/* generic.c: a copy of a module that reads parameters from memory: member i of the uniform block in set SPIRV_VALUES_SET, 32 bits at 4 i bytes,
   takes the place of the specialization constant ids[i], for each bit i of `parameters`. *turned receives the bits of those that it replaced:
   the others stay specialization constants. The caller frees it; NULL: out of memory. */
enum { SPIRV_PLACES = 64, SPIRV_VALUES_SET = 2 };
uint32_t *spirv_generic(const uint32_t *words, size_t bytes, const uint32_t ids[SPIRV_PLACES], uint64_t parameters,
                        uint64_t *turned, size_t *generic_bytes);

/* flatten.c: the text of a user's shader with includes inlined and #line directives that preserve files and line numbers. Includes are looked
   up beside the file, then in `folder` (may be NULL), then among the built-in files. The caller frees the text. */
char *shader_flatten(const char *path, const struct glint_pass *pass, const char *folder, struct glint_error *err);
/* The text of a pass's shader; NULL without an error if none of its files comes from `folder`. */
char *shader_flatten_pass(const struct glint_pass *pass, const char *folder, struct glint_error *err);

#endif
