/* The progress bar on a terminal, and Ctrl-C as a polite request to stop. */
#ifndef GLINT_VIEWER_PROGRESS_H
#define GLINT_VIEWER_PROGRESS_H

#include <stdbool.h>
#include <time.h>

struct progress {
    struct timespec start, shown;
    char what[64];
    bool terminal, drawn;
};

/* From here the first Ctrl-C only sets a flag; a second one ends the program as usual. */
void progress_begin(struct progress *progress);
/* A glint_progress callback; `user` is a struct progress. Returns false after Ctrl-C. */
bool progress_report(void *user, const char *what, double done);
/* Clears the bar. */
void progress_end(struct progress *progress);
bool progress_interrupted(void);

#endif
