/* A progress bar on terminals, lines elsewhere, and Ctrl-C as a request to stop. */
#ifndef GLINT_VIEWER_PROGRESS_H
#define GLINT_VIEWER_PROGRESS_H

#include <stdbool.h>
#include <time.h>

enum { PROGRESS_TEXT = 60, PROGRESS_LINES_SECONDS = 10, PROGRESS_LONG_SECONDS = 30 };
struct progress_mark {
    struct timespec time;
    double done;
};
struct progress {
    struct timespec start, shown;
    double begun, done;             /* progress at the beginning of the step, and now */
    struct progress_mark halves[2]; /* where the step was at a quarter to a half of what is done, and at half to all */
    char phase[40];                 /* what the command does at present, or "" */
    bool terminal, drawn;           /* whether stderr is a terminal, and a bar is on it */
    bool fresh;                     /* whether the phase has not reported yet */
    bool told;                      /* whether the duration of the phase was printed */
    bool lines; /* requested: a line every ten seconds if stderr is not a terminal, instead of every 30 */
};

/* For commands that may take long; sets `lines`. */
#define PROGRESS_OPTION                                                                                                \
    {                                                                                                                  \
        "progress", KEY_PROGRESS, NULL, 0,                                                                             \
            "Where stderr is not a terminal, print progress and the remaining time at once and every ten seconds. "    \
            "Without this, it is every 30 seconds. The signal USR1 makes any long-running command print them once",    \
            0                                                                                                          \
    }

/* From here on the first Ctrl-C only sets a flag, and a second one ends the program. SIGUSR1 prints the progress. */
void progress_begin(struct progress *progress);
/* Names what the command does from here on, such as "reference"; the first reports are timed, and where it will take longer than
   PROGRESS_LONG_SECONDS, its duration is printed. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void progress_phase(struct progress *progress, const char *format, ...);
/* A glint_progress callback; `user` is a struct progress. Returns false after Ctrl-C. */
bool progress_report(void *user, const char *what, double done);
void progress_end(struct progress *progress);
bool progress_interrupted(void);

#endif
