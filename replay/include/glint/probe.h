/* Single pixels' stories: every step that the shaders took for them, told by those shaders themselves. */
#ifndef GLINT_PROBE_H
#define GLINT_PROBE_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A kind of step, or one of its values (passes/shared/probe/steps.h). */
struct glint_probe_row {
    const char *name, *unit; /* unit: NULL for a kind */
    const char *text;
};

enum { GLINT_PROBE_VALUES = 12 };
struct glint_probe_record {
    const struct glint_probe_row *kind; /* kind[1 + i] tells what values[i] is, up to a row without a unit */
    const struct glint_pass *pass;
    uint32_t ray; /* of the frame, from pipeline.first_ray */
    float values[GLINT_PROBE_VALUES];
};
size_t glint_probe_count(const struct glint_probe_row *kind); /* of a kind's values */
/* A value by its name; NaN when the record's kind has none of that name. */
float glint_probe_value(const struct glint_probe_record *record, const char *name);
bool glint_probe_is(const struct glint_probe_record *record, const char *kind);

/* What a value of the units "decision", "end reason", "image" and "face" stands for; {NULL, NULL} for others. */
struct glint_probe_word {
    const char *name, *text;
};
struct glint_probe_word glint_probe_word(const char *unit, float value);
/* Some of the end reasons: rays that end on a surface, in the sky, by the fallback; and how many reasons there are. */
enum { GLINT_END_HIT = 1, GLINT_END_SKY = 7, GLINT_END_FALLBACK = 9, GLINT_END_REASONS = 11 };

struct glint_probe_story {
    struct glint_probe_record *records; /* in the order of passes, the caller frees them */
    size_t count, lost;                 /* lost: that the device had no room for, the last ones of a pass */
};
/* Of the last run, of its options' probes[i]. */
bool glint_replay_probe(const struct glint_replay *replay, size_t i, struct glint_probe_story *story,
                        struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
