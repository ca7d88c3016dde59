/* The progress bar on a terminal, and Ctrl-C as a polite request to stop. */
#include "progress.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t interrupted;

static void on_interrupt(int number) {
    (void)number;
    interrupted = 1;
}

bool progress_interrupted(void) {
    return interrupted;
}

static double seconds_between(const struct timespec *a, const struct timespec *b) {
    return (double)(b->tv_sec - a->tv_sec) + 1e-9 * (double)(b->tv_nsec - a->tv_nsec);
}

void progress_begin(struct progress *progress) {
    *progress = (struct progress){.terminal = isatty(STDERR_FILENO)};
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    clock_gettime(CLOCK_MONOTONIC, &progress->start);
}

static void draw(struct progress *progress, const char *what, double done, double elapsed) {
    enum { WIDTH = 30 };
    int full = (int)(done * WIDTH + 0.5);
    char left[32] = "";
    if (done > 0.02 && elapsed > 0.5) {
        long s = (long)(elapsed * (1 - done) / done + 0.5);
        snprintf(left, sizeof left, " %ld:%02ld left", s / 60, s % 60);
    }
    fprintf(stderr, "\r\033[K%-24.24s ", what);
    for (int i = 0; i < WIDTH; i++) fputs(i < full ? "█" : "░", stderr);
    fprintf(stderr, " %3.0f %%%s", done * 100, left);
    fflush(stderr);
    progress->drawn = true;
}

bool progress_report(void *user, const char *what, double done) {
    struct progress *progress = user;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!(done >= 0)) done = 0;
    if (done > 1) done = 1;
    if (!what) what = "";
    if (strncmp(what, progress->what, sizeof progress->what - 1) != 0) {
        snprintf(progress->what, sizeof progress->what, "%s", what);
        /* A step that starts anew gets its own estimate of the time left. */
        if (done < 0.02) progress->start = now;
    }
    if (progress->terminal && (!progress->drawn || seconds_between(&progress->shown, &now) > 0.1)) {
        draw(progress, what, done, seconds_between(&progress->start, &now));
        progress->shown = now;
    }
    return !interrupted;
}

void progress_end(struct progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = false;
}
