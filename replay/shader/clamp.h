/* Shaders whose indices cannot leave arrays. */
#ifndef GLINT_REPLAY_CLAMP_H
#define GLINT_REPLAY_CLAMP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A copy of a module in which each index of an array, vector or matrix is clamped to what it has: variables of functions, shared memory and blocks, which robust
   access of a device does not all cover. The caller frees it; NULL: out of memory, or the module uses what SPIRV-Tools cannot clamp. */
uint32_t *spirv_clamp(const uint32_t *words, size_t bytes, size_t *clamped_bytes);

#ifdef __cplusplus
}
#endif
#endif
