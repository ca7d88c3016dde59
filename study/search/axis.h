/* An axis of a space of pipelines. */
#ifndef GLINT_STUDY_AXIS_H
#define GLINT_STUDY_AXIS_H

#include "glint/space.h"

enum { VALUE_SIZE = 48, AXIS_NAMES = 8, AXIS_VALUES = 10000 };

struct axis {
    char text[256];   /* NAMES as given */
    char pieces[256]; /* NAMES split at '+' */
    const char *names[AXIS_NAMES];
    size_t name_count;
    bool variant; /* its values are variants */
    char (*values)[VALUE_SIZE];
    size_t count;
    bool range, log, whole; /* range: the values are those between low and high */
    double low, high;
};

/* `pipelines` contains each variant that another axis chooses: a parameter must exist in one of them. */
bool axis_init(struct axis *axis, const char *text, const struct glint_pipeline *const *pipelines, size_t count,
               struct glint_error *err);
void axis_finish(struct axis *axis);
/* Parses only the names, which determine whether the values are variants. */
bool axis_read_names(struct axis *axis, const char *text, struct glint_error *err);
/* The value at the fraction `at` in [0, 1] of the axis. */
void axis_value(const struct axis *axis, double at, char value[VALUE_SIZE]);
/* Whether the pipeline has one of the parameters; assigns the value to those that it has. */
bool axis_applies(const struct axis *axis, const struct glint_pipeline *pipeline);
bool axis_assign(const struct axis *axis, struct glint_pipeline *pipeline, const char *value, struct glint_error *err);

#endif
