/* A function of passes/shared/, evaluated on the device over a table of arguments and on the host in double precision. */
#ifndef GLINT_SELFTEST_FUNCTION_CASE_H
#define GLINT_SELFTEST_FUNCTION_CASE_H

#include <math.h>
#include <stddef.h>

enum { ARGUMENTS = 8, VALUES = 4 };

enum scale { UNUSED, LINEAR, LOG, WHOLE };
enum { ZERO = 1, ENDLESS = 2, NEGATIVE = 4 };
/* The table contains both ends of the range, in every combination with those of the other arguments. `more` adds 0, +inf and the negative values. */
struct axis {
    enum scale scale;
    double low, high;
    unsigned more;
};

enum measure { ULP, ABSOLUTE };

struct function {
    const char *name, *what;
    const char *glsl;  /* the arguments of vec4(…), which may use a.x … a.w, b.x … b.w */
    const char *names; /* names of the arguments, separated by spaces */
    struct axis axes[ARGUMENTS];
    void (*make)(float x[ARGUMENTS]); /* computes the arguments from the values of the axes; NULL: both are equal */
    void (*expect)(const double x[ARGUMENTS], double y[VALUES]);
    int values; /* the number of components that are compared */
    enum measure measure;
    double bound;
    const char *reason;
};

struct function_list {
    const struct function *items;
    size_t count;
};
extern const struct function_list functions_elementary, functions_patterns, functions_geometry, functions_lobes,
    functions_hemisphere, functions_light, functions_sun;

static const double pi = 3.14159265358979323846;

#endif
