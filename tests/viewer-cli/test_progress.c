/* Progress without a terminal, on a clock that the test sets: which lines are printed, and when. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "io/progress.h"
#include "unit.h"

static double now_s;

/* In place of the C library's. */
int clock_gettime(UNUSED clockid_t id, struct timespec *time) {
    *time = (struct timespec){.tv_sec = 1000 + (time_t)now_s, .tv_nsec = (long)((now_s - (double)(time_t)now_s) * 1e9)};
    return 0;
}

static char *text;
static size_t size;
static FILE *before;

static int collect(UNUSED void **state) {
    before = stderr;
    stderr = open_memstream(&text, &size);
    now_s = 0;
    return stderr ? 0 : -1;
}

static int stop_collecting(UNUSED void **state) {
    fclose(stderr);
    stderr = before;
    free(text);
    return 0;
}

static size_t count(const char *what) {
    size_t found = 0;
    fflush(stderr);
    for (const char *at = text; (at = strstr(at, what)); at += strlen(what)) found++;
    return found;
}

/* Reports every second of a step that takes `seconds`, up to `until`. */
static void work(struct progress *progress, double seconds, double until) {
    const double start = now_s;
    for (; now_s <= start + until; now_s += 1)
        assert_true(progress_report(progress, "item", (now_s - start) / seconds));
}

static void short_work_is_silent(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress_phase(&progress, "pipelines");
    work(&progress, 20, 20);
    progress_end(&progress);
    fflush(stderr);
    assert_string_equal(text, "");
}

static void long_work_says_how_long_it_takes_and_every_thirty_seconds_how_far_it_is(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress_phase(&progress, "pipelines");
    work(&progress, 600, 62);
    assert_int_equal(count("pipelines: about 10 min in all, going by the first"), 1);
    assert_int_equal(count("pipelines: item: "), 2);
    work(&progress, 600, 62);
    assert_int_equal(count("in all"), 1);
    assert_int_equal(count("pipelines: item: "), 4);
}

static void each_phase_has_its_own_estimate(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress_phase(&progress, "reference");
    work(&progress, 100, 20);
    progress_phase(&progress, "times");
    work(&progress, 7200, 200);
    assert_int_equal(count("reference: about 2 min"), 1);
    assert_int_equal(count("times: about 2.0 h"), 1);
    assert_in_range(count("times: item: "), 6, 7); /* of 200 seconds */
    assert_true(count(" 1:59:") + count(" 1:58:") >= 2);
}

/* The driver compiles during the first items. */
static void a_slow_start_does_not_count(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress_phase(&progress, "pipelines");
    for (int item = 0; item < 20; item++, now_s += item < 2 ? 30 : 2) progress_report(&progress, "item", item / 128.0);
    assert_int_equal(count("pipelines: about 5 min"), 1);
}

static void a_phase_that_goes_on_at_half_counts_from_there(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress_phase(&progress, "points");
    for (int s = 0; s <= 40; s++, now_s += 1) progress_report(&progress, "item", 0.5 + 0.5 * s / 100);
    assert_int_equal(count("points: about 2 min"), 1);
}

static void lines_that_are_asked_for_come_at_once_and_every_ten_seconds(UNUSED void **state) {
    struct progress progress;
    progress_begin(&progress);
    progress.lines = true;
    work(&progress, 100, 0);
    assert_int_equal(count("item: 0.0 %"), 1);
    work(&progress, 100, 50);
    assert_int_equal(count("item: "), 5);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, collect, stop_collecting)
int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(short_work_is_silent),
        TEST(long_work_says_how_long_it_takes_and_every_thirty_seconds_how_far_it_is),
        TEST(each_phase_has_its_own_estimate),
        TEST(a_slow_start_does_not_count),
        TEST(a_phase_that_goes_on_at_half_counts_from_there),
        TEST(lines_that_are_asked_for_come_at_once_and_every_ten_seconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
