/* Phases of a replay that are timed, and memory use. */
#ifndef GLINT_REPLAY_TIMING_H
#define GLINT_REPLAY_TIMING_H

#include "glint/replay.h"

enum phase { PHASE_READ, PHASE_UPLOAD, PHASE_PASSES, PHASE_READBACK, PHASE_WRITE, PHASES };

/* The peak resident memory of this process, 0 if unknown. */
uint64_t peak_memory_bytes(void);

#endif
