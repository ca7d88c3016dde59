/* Clocks and statistics of times. */
#ifndef GLINT_REPLAY_TIMING_H
#define GLINT_REPLAY_TIMING_H

#include "glint/replay.h"

double now_seconds(void);
/* Least, median and greatest; sorts `ns`. */
struct glint_time time_statistics(uint64_t *ns, size_t count);
/* The most memory this process has held, 0 when unknown. */
uint64_t peak_memory_bytes(void);

#endif
