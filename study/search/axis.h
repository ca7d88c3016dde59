/* One thing that varies in a space of pipelines. */
#ifndef GLINT_STUDY_AXIS_H
#define GLINT_STUDY_AXIS_H

#include "glint/space.h"

enum { VALUE_SIZE = 48, AXIS_NAMES = 8, AXIS_VALUES = 10000 };

struct axis {
    char text[256];   /* NAMES, whole */
    char pieces[256]; /* NAMES, cut */
    const char *names[AXIS_NAMES];
    size_t name_count;
    bool variant; /* it chooses variants */
    char (*values)[VALUE_SIZE];
    size_t count;
    /* of a range */
    bool range, log, whole;
    double low, high;
};

/* Variants that other axes choose are in `pipelines`, one of each: a parameter has to be that of one of them. */
bool axis_init(struct axis *axis, const char *text, const struct glint_pipeline *const *pipelines, size_t count,
               struct glint_error *err);
void axis_finish(struct axis *axis);
/* Cuts the names and tells whether the axis chooses variants; all that is known before the pipelines are. */
bool axis_read_names(struct axis *axis, const char *text, struct glint_error *err);
/* The value at `at`, 0 to 1, of the way through the axis. */
void axis_value(const struct axis *axis, double at, char value[VALUE_SIZE]);
/* Whether one of the names is in the pipeline, and assigns the value to those that are. */
bool axis_applies(const struct axis *axis, const struct glint_pipeline *pipeline);
bool axis_assign(const struct axis *axis, struct glint_pipeline *pipeline, const char *value, struct glint_error *err);

#endif
