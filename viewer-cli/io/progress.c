/* A progress bar on terminals, lines elsewhere, and Ctrl-C as a request to stop. */
#include "io/progress.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include "io/console.h"
#include "shown.h"

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

/* Each phase, and each step that begins again at 0, has its own estimate of the remaining time. */
static void begin_step(struct progress *progress, double done) {
    clock_gettime(CLOCK_MONOTONIC, &progress->start);
    progress->begun = progress->done = done;
    for (int k = 0; k < 2; k++) progress->halves[k] = (struct progress_mark){progress->start, done};
}

void progress_phase(struct progress *progress, const char *format, ...) {
    va_list args;
    va_start(args, format);
    char text[sizeof progress->phase];
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    shown_text(progress->phase, sizeof progress->phase, text);
    progress->told = false;
    progress->fresh = true;
    begin_step(progress, 0);
}

/* Seconds that a step takes from here on, negative until that is usable. The rate is that of about the second half of what is done:
   the first runs of each pass take longer, because drivers compile then. */
static double seconds_left(struct progress *progress, const struct timespec *now, double elapsed) {
    const double share = progress->done - progress->begun;
    struct progress_mark *half = progress->halves;
    if (share > 0 && share >= 2 * (half[1].done - progress->begun)) {
        half[0] = half[1];
        half[1] = (struct progress_mark){*now, progress->done};
    }
    const double part = progress->done - half[0].done;
    const bool usable = elapsed > 0.5 && part > 0 && (share > 0.02 || (elapsed > 10 && share > 0.0005));
    return usable ? seconds_between(&half[0].time, now) * (1 - progress->done) / part : -1;
}

/* " 4:10 left", or "". */
static const char *time_left(double seconds, char text[32]) {
    const long s = (long)(seconds + 0.5);
    if (seconds < 0) *text = '\0';
    else if (s >= 3600) snprintf(text, 32, " %ld:%02ld:%02ld left", s / 3600, s / 60 % 60, s % 60);
    else snprintf(text, 32, " %ld:%02ld left", s / 60, s % 60);
    return text;
}

/* "search: point 12 of 150" */
static void describe(const struct progress *progress, const char *what, char text[PROGRESS_TEXT + 1]) {
    const char *phase = progress->phase;
    char plain[PROGRESS_TEXT + 1];
    snprintf(plain, sizeof plain, "%s%s%s", phase, *phase && *what ? ": " : "", what);
    shown_text(text, PROGRESS_TEXT + 1, plain);
}

static void draw_progress(struct progress *progress, const char *text, double seconds) {
    enum { BAR = 24, REST = 24 }; /* REST: of the bar, per cent, and the time that is left */
    const size_t columns = console_width(stderr);
    const int width =
        columns && columns < PROGRESS_TEXT + 1 + BAR + REST ? (int)(columns > 60 ? columns - REST - 37 : 0) : BAR;
    const int room = columns && columns < PROGRESS_TEXT + REST ? (int)columns - REST : PROGRESS_TEXT;
    const int full = (int)(progress->done * width + 0.5);
    char left[32];
    console_code(stderr, "\r\033[K");
    fprintf(stderr, "%-*.*s ", width ? 36 : 0, room > 36 && width ? 36 : room, text);
    for (int i = 0; i < width; i++) fputs(i < full ? "█" : "░", stderr);
    fprintf(stderr, " %3.0f %%%s", progress->done * 100, time_left(seconds, left));
    fflush(stderr);
    progress->drawn = true;
}

static void print_line(const struct progress *progress, const char *text, double seconds) {
    char left[32];
    if (progress->drawn) console_code(stderr, "\r\033[K");
    fprintf(stderr, "%s: %.1f %%%s\n", text, progress->done * 100, time_left(seconds, left));
}

/* Says how long a step takes that takes long, as soon as its first part is timed. */
static void tell_duration(struct progress *progress, double elapsed, double seconds) {
    const double all = elapsed + seconds;
    const bool sure = progress->done - progress->begun > 0.15 ? elapsed > 10 : elapsed > 60;
    if (progress->told || seconds < 0 || !sure) return;
    progress->told = true;
    if (all < PROGRESS_LONG_SECONDS) return;
    if (progress->drawn) console_code(stderr, "\r\033[K");
    fprintf(stderr, "%s%sabout ", progress->phase, progress->phase[0] ? ": " : "");
    if (all < 90) fprintf(stderr, "%.0f s", all);
    else if (all < 5400) fprintf(stderr, "%.0f min", all / 60);
    else fprintf(stderr, "%.1f h", all / 3600);
    fprintf(stderr, " in all, going by the first %.0f s; Ctrl-C stops it\n", elapsed);
}

bool progress_report(void *user, const char *what, double done) {
    struct progress *progress = user;
    struct timespec now;
    char text[PROGRESS_TEXT + 1];
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!(done >= 0)) done = 0;
    if (done > 1) done = 1;
    if (progress->fresh)
        progress->begun = progress->halves[0].done = progress->halves[1].done =
            done; /* the phases of several captures share one scale */
    else if (done < progress->done - 1e-6) begin_step(progress, done);
    progress->fresh = false;
    progress->done = done;
    describe(progress, what ? what : "", text);
    const double elapsed = seconds_between(&progress->start, &now), since = seconds_between(&progress->shown, &now),
                 left = seconds_left(progress, &now, elapsed);
    const bool first = progress->shown.tv_sec == 0 && progress->shown.tv_nsec == 0;
    tell_duration(progress, elapsed, left);
    /* Without a terminal, the first line comes at once where lines are asked for, else when it takes long. */
    if (first && !progress->lines) progress->shown = now;
    const double every = progress->lines ? PROGRESS_LINES_SECONDS : PROGRESS_LONG_SECONDS;
    const bool line = asked || (!progress->terminal && ((first && progress->lines) || (!first && since > every))),
               draw = progress->terminal && (first || line || since > 0.1);
    asked = 0;
    if (line) print_line(progress, text, left);
    if (draw) draw_progress(progress, text, left);
    if (line || draw) progress->shown = now;
    return !interrupted;
}

void progress_end(struct progress *progress) {
    if (progress->drawn) console_code(stderr, "\r\033[K");
    progress->drawn = false;
}
