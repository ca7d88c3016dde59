/* SPIR-V of a pass: the embedded one, or the user's file compiled here. */
#ifndef GLINT_REPLAY_SHADER_H
#define GLINT_REPLAY_SHADER_H

#include <stdint.h>

#include "pipeline.h"

struct spirv {
    const uint32_t *words;
    size_t bytes;
    uint32_t *owned; /* words, when they were compiled here */
    uint64_t hash;
};

bool spirv_init(struct spirv *spirv, const struct pipeline_pass *pass, struct glint_error *err);
void spirv_finish(struct spirv *spirv);

/* The file's text with every include in place, and #line directives that keep files and lines as the author sees
   them. The caller frees it. */
char *shader_flatten(const char *path, const char *slot, struct glint_error *err);

#endif
