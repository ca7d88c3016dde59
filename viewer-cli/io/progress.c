/* A progress bar on terminals, lines elsewhere, and Ctrl-C as a request to stop. */
#include "io/progress.h"

#include <signal.h>
#include <stdio.h>
#include <unistd.h>

static volatile sig_atomic_t interrupted, asked;

static void on_interrupt(int number) {
    (void)number;
    interrupted = 1;
}

static void on_question(int number) {
    (void)number;
    asked = 1;
}

bool progress_interrupted(void) {
    return interrupted;
}

static double seconds_between(const struct timespec *a, const struct timespec *b) {
    return (double)(b->tv_sec - a->tv_sec) + 1e-9 * (double)(b->tv_nsec - a->tv_nsec);
}

void progress_begin(struct progress *progress) {
    *progress = (struct progress){.terminal = isatty(STDERR_FILENO)};
    struct sigaction interrupt = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    struct sigaction question = {.sa_handler = on_question, .sa_flags = SA_RESTART};
    sigaction(SIGINT, &interrupt, NULL);
    sigaction(SIGUSR1, &question, NULL);
    clock_gettime(CLOCK_MONOTONIC, &progress->start);
}

/* " 4:10 left", estimated from the rate since the step began; "" until the estimate is usable. */
static const char *time_left(const struct progress *progress, double done, double elapsed, char text[32]) {
    const double share = done - progress->begun;
    *text = '\0';
    if (elapsed > 0.5 && (share > 0.02 || (elapsed > 10 && share > 0.0005))) {
        const long s = (long)(elapsed * (1 - done) / share + 0.5);
        if (s >= 3600) snprintf(text, 32, " %ld:%02ld:%02ld left", s / 3600, s / 60 % 60, s % 60);
        else snprintf(text, 32, " %ld:%02ld left", s / 60, s % 60);
    }
    return text;
}

static void draw_progress(struct progress *progress, const char *what, double done, double elapsed) {
    enum { WIDTH = 30 };
    int full = (int)(done * WIDTH + 0.5);
    char left[32];
    fprintf(stderr, "\r\033[K%-*.*s ", PROGRESS_TEXT, PROGRESS_TEXT, what);
    for (int i = 0; i < WIDTH; i++) fputs(i < full ? "█" : "░", stderr);
    fprintf(stderr, " %3.0f %%%s", done * 100, time_left(progress, done, elapsed, left));
    fflush(stderr);
    progress->drawn = true;
}

static void print_line(const struct progress *progress, const char *what, double done, double elapsed) {
    char left[32];
    fprintf(stderr, "%s%s: %.1f %%%s\n", progress->drawn ? "\r\033[K" : "", what, done * 100,
            time_left(progress, done, elapsed, left));
}

bool progress_report(void *user, const char *what, double done) {
    struct progress *progress = user;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!(done >= 0)) done = 0;
    if (done > 1) done = 1;
    if (!what) what = "";
    /* Each step has its own estimate of the remaining time. */
    if (done < progress->done - 1e-6) progress->start = now, progress->begun = done;
    progress->done = done;
    const double elapsed = seconds_between(&progress->start, &now), since = seconds_between(&progress->shown, &now);
    const bool first = progress->shown.tv_sec == 0 && progress->shown.tv_nsec == 0;
    const bool line = asked || (progress->lines && !progress->terminal && (first || since > PROGRESS_LINES_SECONDS));
    asked = 0;
    if (line) print_line(progress, what, done, elapsed);
    if (progress->terminal && (first || line || since > 0.1)) draw_progress(progress, what, done, elapsed);
    if (line || (progress->terminal && (first || since > 0.1))) progress->shown = now;
    return !interrupted;
}

void progress_end(struct progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = false;
}
