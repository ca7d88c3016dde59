/* SPIR-V of a pass: the embedded one, or the user's file compiled here. */
#ifndef GLINT_REPLAY_SHADER_H
#define GLINT_REPLAY_SHADER_H

#include <stdint.h>

#include "frame_block.h"
#include "pipeline.h"

enum { FRAME_WORDS = sizeof(struct frame_block) / sizeof(uint32_t) };

struct spirv {
    const uint32_t *words;
    size_t bytes;
    uint32_t *owned; /* words, when they were compiled here */
    uint64_t hash;
    bool frame_words[FRAME_WORDS]; /* those of the frame's block that it reads */
};

bool spirv_init(struct spirv *spirv, const struct pipeline_pass *pass, struct glint_error *err);
void spirv_finish(struct spirv *spirv);

/* reflect.c */
/* A user's shader may declare bindings by hand; what no row declares has no image behind it. */
bool spirv_check_bindings(const struct spirv *spirv, const struct glint_pass *pass, const char *path,
                          struct glint_error *err);
void spirv_find_frame_words(struct spirv *spirv);

/* The file's text with every include in place, and #line directives that keep files and lines as the author sees
   them. The caller frees it. */
char *shader_flatten(const char *path, const char *slot, struct glint_error *err);

#endif
