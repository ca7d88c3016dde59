/* The levels of probes that an engine pre-filtered by roughness. */
#ifndef GLINT_PROBE_LEVELS_H
#define GLINT_PROBE_LEVELS_H

#include "check.h"

/* glint_capture_probe() for an array of parts. */
size_t glint_probe_levels(const struct glint_part_info *parts, size_t count, int32_t index,
                          const struct glint_part_info *levels[GLINT_MAX_LEVELS], double roughness[GLINT_MAX_LEVELS]);
/* Checks the rule about the levels of every probe. */
bool glint_probes_check(struct glint_check *check, const struct glint_part_info *parts, size_t count);

#endif
