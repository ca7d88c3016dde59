/* SPIR-V of a pass: the embedded one, or what is compiled here: the user's file, or the pass from a folder of sources. */
#ifndef GLINT_REPLAY_SHADER_H
#define GLINT_REPLAY_SHADER_H

#include <stdint.h>

#include "frame_block.h"
#include "pipeline.h"

enum { FRAME_WORDS = sizeof(struct frame_block) / sizeof(uint32_t) };

/* What was compiled here, each text once, and the folder whose files stand in for those of passes/ that are built in. */
struct shaders {
    char *folder; /* or NULL */
    struct compiled *first;
};
bool shaders_init(struct shaders *shaders, const char *folder, struct glint_error *err);
void shaders_finish(struct shaders *shaders);

struct spirv {
    const uint32_t *words; /* the pass's, or of the shaders that it was found in */
    size_t bytes;
    const char *from; /* the file or folder that it was compiled from; NULL: built in */
    uint64_t hash;
    bool frame_words[FRAME_WORDS]; /* those of the frame's block that it reads */
    bool tiles;                    /* it takes its texels by tile_texel() (shared/work_list.glsl) */
    bool probes;                   /* it has the buffer that probed pixels are told in */
};

bool spirv_find(struct spirv *spirv, struct shaders *shaders, const struct pipeline_pass *pass,
                struct glint_error *err);

/* reflect.c */
/* A user's shader may declare bindings by hand; what no row declares has no image behind it. */
bool spirv_check_bindings(const struct spirv *spirv, const struct glint_pass *pass, const char *path,
                          struct glint_error *err);
/* Sets frame_words and probes. */
void spirv_find_uses(struct spirv *spirv);

/* flatten.c: a shader's text with every include in place, and #line directives that keep files and lines as the author
   sees them. The caller frees it. What is not beside the user's file comes from `folder` (or NULL), else from what is
   built in. */
char *shader_flatten(const char *path, const struct glint_pass *pass, const char *folder, struct glint_error *err);
/* The same of a pass; NULL without an error when nothing of it comes from the folder. */
char *shader_flatten_pass(const struct glint_pass *pass, const char *folder, struct glint_error *err);

#endif
