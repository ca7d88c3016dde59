/* The progress bar on a terminal, lines elsewhere, and Ctrl-C as a polite request to stop. */
#ifndef GLINT_VIEWER_PROGRESS_H
#define GLINT_VIEWER_PROGRESS_H

#include <stdbool.h>
#include <time.h>

enum { PROGRESS_TEXT = 36, PROGRESS_LINES_SECONDS = 10 };
struct progress {
    struct timespec start, shown;
    double begun, done; /* where the step started, and where it is */
    bool terminal, drawn;
    bool lines; /* asked for: a line every few seconds where there is no terminal */
};

/* For commands that may take long, with `lines` set where it was given. */
#define PROGRESS_OPTION                                                                                                \
    {                                                                                                                  \
        "progress", KEY_PROGRESS, NULL, 0,                                                                             \
            "Print progress and the remaining time to stderr every ten seconds even if it is not a terminal. The "     \
            "signal "                                                                                                  \
            "USR1 makes any long-running command print them once",                                                     \
            0                                                                                                          \
    }

/* From here the first Ctrl-C only sets a flag; a second one ends the program as usual. SIGUSR1 is answered with a line. */
void progress_begin(struct progress *progress);
/* A glint_progress callback; `user` is a struct progress. Returns false after Ctrl-C. */
bool progress_report(void *user, const char *what, double done);
/* Clears the bar. */
void progress_end(struct progress *progress);
bool progress_interrupted(void);

#endif
