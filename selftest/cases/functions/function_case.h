/* A function of passes/shared/ evaluated on the device over a table of arguments, and in double on the host. */
#ifndef GLINT_SELFTEST_FUNCTION_CASE_H
#define GLINT_SELFTEST_FUNCTION_CASE_H

#include <math.h>
#include <stddef.h>

enum { ARGUMENTS = 8, VALUES = 4 };

enum scale { UNUSED, LINEAR, LOG, WHOLE };
enum { ZERO = 1, ENDLESS = 2, NEGATIVE = 4 };
/* Both ends are in the table, and every combination with those of the other arguments. `more`: so are 0, +inf; and all of it
   with a minus. */
struct axis {
    enum scale scale;
    double low, high;
    unsigned more;
};

enum measure { ULP, ABSOLUTE };

struct function {
    const char *name, *what;
    const char *glsl;  /* what stands in vec4(…); arguments are a.x … a.w, b.x … b.w */
    const char *names; /* of the arguments, with spaces between them */
    struct axis axes[ARGUMENTS];
    void (*make)(float x[ARGUMENTS]); /* arguments from the axes' values; NULL: they are these */
    void (*expect)(const double x[ARGUMENTS], double y[VALUES]);
    int values; /* how many of the four are compared */
    enum measure measure;
    double bound;
    const char *reason;
};

struct function_list {
    const struct function *items;
    size_t count;
};
extern const struct function_list functions_elementary, functions_patterns, functions_geometry, functions_lobes;

static const double pi = 3.14159265358979323846;

#endif
