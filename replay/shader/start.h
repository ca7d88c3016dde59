/* Starts glslang in a process that may be short of memory. */
#ifndef GLINT_REPLAY_START_H
#define GLINT_REPLAY_START_H

#include <stdbool.h>

#include <glslang/Include/glslang_c_interface.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Initialises glslang, and parses a shader, with which it parses GLSL's built-in functions, too, for later shaders that are given to it in the same
   way. False without memory: glslang then is in no state to be used or ended in this process. */
bool start_glslang(const glslang_input_t *shader);

#ifdef __cplusplus
}
#endif
#endif
