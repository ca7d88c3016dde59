/* Probed pixels: a record of every step that the shaders take for a chosen pixel, written by the shaders themselves. */
#ifndef GLINT_PROBE_H
#define GLINT_PROBE_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A kind of record, or one of the values that such a record holds (passes/shared/probe/steps.h). */
struct glint_probe_row {
    const char *name, *unit; /* unit: NULL for a kind */
    const char *text;
};

enum { GLINT_PROBE_VALUES = 12 };
struct glint_probe_record {
    const struct glint_probe_row *kind; /* kind[1 + i] describes values[i]; the next row with unit NULL ends the list */
    const struct glint_pass *pass;
    uint32_t ray; /* which ray of the frame, counted from pipeline.first_ray */
    float values[GLINT_PROBE_VALUES];
};
/* The number of values that a record of this kind holds. */
size_t glint_probe_count(const struct glint_probe_row *kind);
/* The record's value of this name, or NaN if its kind has none. */
float glint_probe_value(const struct glint_probe_record *record, const char *name);
bool glint_probe_is(const struct glint_probe_record *record, const char *kind);

/* The name and the meaning of a value whose unit is "decision", "end reason", "image" or "face". {NULL, NULL} for any other
   unit or value. */
struct glint_probe_label {
    const char *name, *text;
};
struct glint_probe_label glint_probe_label(const char *unit, float value);
/* Those end reasons that callers distinguish, and the number of all end reasons. */
enum { GLINT_END_HIT = 1, GLINT_END_SKY = 7, GLINT_END_FALLBACK = 9, GLINT_END_REASONS = 11 };

struct glint_probe_trace {
    struct glint_probe_record *records; /* in the order of the passes; the caller frees them */
    size_t count, dropped;              /* dropped: records that the buffer had no room for, the last ones of a pass */
};
/* The records that the last run made for its options' probes[i]. */
bool glint_replay_probe(const struct glint_replay *replay, size_t i, struct glint_probe_trace *trace,
                        struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
