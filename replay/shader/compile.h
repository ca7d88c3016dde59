/* Compiles GLSL to SPIR-V, within limits. */
#ifndef GLINT_REPLAY_COMPILE_H
#define GLINT_REPLAY_COMPILE_H

#include <stdint.h>

#include "glint/replay.h"

struct compiled_text {
    uint32_t *words; /* malloc'd */
    size_t bytes;
};
/* Compiles a compute shader; `path` names it in messages; with `clamp` indices cannot leave arrays. The compiler starts with the first call, which sets *started, and stays until
   compile_end. What takes too much time or memory fails with GLINT_ERROR_LIMIT. Can be called by several threads. */
bool compile_glsl(struct compiled_text *out, bool *started, const char *path, const char *code, bool clamp,
                  struct glint_error *err);
void compile_end(bool *started);

#endif
