/* Reports and files of `glint stability`. */
#ifndef GLINT_VIEWER_STABILITY_H
#define GLINT_VIEWER_STABILITY_H

#include <jansson.h>

#include "glint/stability.h"

struct stability_report {
    const struct glint_stability *stability;
    const struct glint_effect *effect; /* whose judged pixels are compared */
    const char *capture, *preset, *device;
    const char *const *inputs; /* what was perturbed; NULL: all */
    bool half;
};

/* NULL when memory is short. */
json_t *stability_json(const struct stability_report *report);
void stability_print(const struct stability_report *report);

/* The folder holds a run of layers, one file for each pass, which `glint view` shows: run.json last, stability.json and a sheet
   beside it. */
bool stability_write(const char *folder, const struct stability_report *report, struct glint_error *err);

#endif
