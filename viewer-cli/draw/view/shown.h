/* Which images of runs are shown when nobody names any, in sheets and reports alike. */
#ifndef GLINT_VIEWER_SHOWN_H
#define GLINT_VIEWER_SHOWN_H

#include "glint/common.h"

struct shown_image {
    char name[128], pass[96]; /* pass: "screen_trace/hiz"; "" if no run has the image */
    bool *in;                 /* for each run, whether it has the image */
};
struct shown {
    struct shown_image *images; /* in the order of the passes */
    size_t count;
};
/* The images of all runs together that have full or half resolution, each once; with `all` also MIP levels, cube maps and tables.
   With `asked`, a NULL-terminated list, these images in its order. Release it with shown_finish even after a failure. */
bool shown_find(struct shown *shown, const char *const *runs, size_t run_count, const char *const *asked, bool all,
                struct glint_error *err);
void shown_finish(struct shown *shown);

#endif
