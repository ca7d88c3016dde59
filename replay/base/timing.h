/* Clocks, and where a replay's time goes. */
#ifndef GLINT_REPLAY_TIMING_H
#define GLINT_REPLAY_TIMING_H

#include "glint/replay.h"

enum phase { PHASE_READ, PHASE_UPLOAD, PHASE_PASSES, PHASE_READBACK, PHASE_WRITE, PHASES };

/* The most memory this process has held, 0 when unknown. */
uint64_t peak_memory_bytes(void);

#endif
