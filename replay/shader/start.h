/* Starts glslang in a process that may be short of memory. */
#ifndef GLINT_REPLAY_START_H
#define GLINT_REPLAY_START_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Initialises glslang, and parses GLSL's built-in functions, which the first compilation does. False without memory: glslang then is in no state to
   be used or ended in this process. */
bool start_glslang(void);

#ifdef __cplusplus
}
#endif
#endif
