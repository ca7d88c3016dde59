/* A progress bar on terminals, lines elsewhere, and Ctrl-C as a request to stop. */
#ifndef GLINT_VIEWER_PROGRESS_H
#define GLINT_VIEWER_PROGRESS_H

#include <stdbool.h>
#include <time.h>

enum { PROGRESS_TEXT = 36, PROGRESS_LINES_SECONDS = 10 };
struct progress {
    struct timespec start, shown;
    double begun, done; /* progress at the beginning of the step, and now */
    bool terminal, drawn;
    bool lines; /* requested: a line every few seconds if stderr is not a terminal */
};

/* For commands that may take long; sets `lines`. */
#define PROGRESS_OPTION                                                                                                \
    {                                                                                                                  \
        "progress", KEY_PROGRESS, NULL, 0,                                                                             \
            "Print progress and the remaining time to stderr every ten seconds even if it is not a terminal. The "     \
            "signal "                                                                                                  \
            "USR1 makes any long-running command print them once",                                                     \
            0                                                                                                          \
    }

/* From here on the first Ctrl-C only sets a flag, and a second one ends the program. SIGUSR1 prints the progress. */
void progress_begin(struct progress *progress);
/* A glint_progress callback; `user` is a struct progress. Returns false after Ctrl-C. */
bool progress_report(void *user, const char *what, double done);
void progress_end(struct progress *progress);
bool progress_interrupted(void);

#endif
