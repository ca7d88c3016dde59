/* Finished references that one process stores in the cache folder for others, here one reference's folder for another. */
#include <dirent.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/reference.h"
#include "unit.h"

enum { RAYS = 16 };

/* A reference in a folder of its own beside the capture, and how it was made. */
struct traced {
    char folder[128];
    bool traced; /* false: taken from the cache */
    int calls;   /* reports of tracing */
    struct glint_pixels pixels;
    float *error;
    double noise, seconds;
};

struct asked {
    const char *name, *set;
    uint32_t rays, at_once;
    double noise;
    int stop; /* after so many reports, of which eight rays make some 41; 0: never */
    const char
        *appears; /* a folder that gets the cache's name at the first report, which then takes a while; or NULL */
};

struct watched {
    int calls, stop;
    const char *appears, *cache;
};
static bool count_calls(void *user, UNUSED const char *what, UNUSED double done) {
    struct watched *watched = user;
    if (watched->calls == 0 && watched->appears) {
        assert_int_equal(rename(watched->appears, watched->cache), 0);
        sleep(6); /* the folder is saved every five seconds */
    }
    return ++watched->calls != watched->stop;
}

/* Where glint reads which processor it runs on; NULL: in the system. */
static const char *processor;
FILE *fopen64(const char *path, const char *mode) {
    FILE *(*open)(const char *, const char *);
    *(void **)&open = dlsym(RTLD_NEXT, "fopen64");
    return open(processor && !strcmp(path, "/proc/cpuinfo") ? processor : path, mode);
}

static void trace(struct fixture *fixture, const char *cache, struct asked asked, struct traced *found) {
    struct glint_error err = {0};
    struct watched watched = {.stop = asked.stop, .appears = asked.appears, .cache = cache};
    memset(found, 0, sizeof *found);
    snprintf(found->folder, sizeof found->folder, "%s/%s", fixture->folder, asked.name);
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", &err);
    assert_non_null(pipeline);
    if (asked.set && !glint_pipeline_set(pipeline, asked.set, &err)) fail_msg("%s", err.message);
    struct glint_reference *reference = glint_reference_create(
        fixture->replay, fixture->capture, pipeline,
        &(struct glint_reference_options){
            .folder = found->folder, .cache = cache, .at_once = asked.at_once ? asked.at_once : 8},
        &err);
    glint_pipeline_destroy(&pipeline);
    if (!reference) fail_msg("%s", err.message);
    const uint32_t rays = asked.rays ? asked.rays : RAYS;
    const bool ok = glint_reference_trace(reference, rays, asked.noise, count_calls, &watched, &err);
    if (asked.stop) assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    else if (!ok) fail_msg("%s", err.message);
    if (ok && !glint_reference_pixels(reference, &found->pixels, &found->error, &err)) fail_msg("%s", err.message);
    const struct glint_reference_state *state = glint_reference_state(reference);
    if (ok && !(asked.noise > 0)) assert_int_equal(state->rays, (rays + 15) / 16 * 16);
    assert_int_equal(state->kept, state->rays + state->begun);
    found->traced = watched.calls > 0;
    found->calls = watched.calls;
    found->noise = state->noise[0].relative;
    found->seconds = state->seconds;
    glint_reference_destroy(&reference);
    fixture_check_messages(fixture);
}

static void finish(struct traced *found) {
    glint_pixels_finish(&found->pixels);
    free(found->error);
}

/* Bit for bit, in memory and in the folder; run.json only as far as the reference itself is concerned. */
static void check_same(const struct traced *a, const struct traced *b, const char *file) {
    const size_t pixels = (size_t)a->pixels.width * a->pixels.height;
    char command[512];
    assert_memory_equal(a->pixels.values, b->pixels.values, pixels * a->pixels.components * sizeof(float));
    assert_memory_equal(a->error, b->error, pixels * sizeof(float));
    assert_true(a->noise == b->noise);
    snprintf(command, sizeof command, "cmp -s '%s/%s' '%s/%s' && test $(ls -A '%s' | wc -l) = 2", a->folder, file,
             b->folder, file, b->folder);
    assert_int_equal(system(command), 0);
}

static size_t entries_of(const char *cache, char paths[8][512]) {
    size_t count = 0;
    DIR *entries = opendir(cache);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (entry->d_name[0] == '.') continue;
        assert_true(count < 8);
        snprintf(paths[count++], 512, "%s/%s", cache, entry->d_name);
    }
    if (entries) closedir(entries);
    return count;
}

static void use_folder(const struct fixture *fixture, const char *name, char cache[160]) {
    snprintf(cache, 160, "%s/%s", fixture->folder, name);
}

static void open_capture(struct fixture *fixture, const char *path) {
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture || !glint_replay_load(fixture->replay, capture, &err)) fail_msg("%s", err.message);
    glint_capture_close(&fixture->capture);
    fixture->capture = capture;
}

/* Catches: other bits, a reference that is traced again, and a record of another process's capture. */
static void another_folder_gets_the_same_bits_untraced(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct traced none, first, second;
    char cache[160], paths[8][512], command[512], moved[160];
    use_folder(fixture, "cache", cache);
    trace(fixture, NULL, (struct asked){.name = "none"}, &none);
    assert_int_not_equal(access(cache, F_OK), 0);
    trace(fixture, cache, (struct asked){.name = "first"}, &first);
    assert_true(none.traced && first.traced);
    assert_int_equal(entries_of(cache, paths), 2);
    check_same(&none, &first, "reference-16.exr");
    /* the same capture somewhere else */
    snprintf(moved, sizeof moved, "%s/moved.exr", fixture->folder);
    snprintf(command, sizeof command, "cp '%s' '%s'", fixture->capture_path, moved);
    assert_int_equal(system(command), 0);
    open_capture(fixture, moved);
    trace(fixture, cache, (struct asked){.name = "second", .rays = 10}, &second); /* 10 are 16, too */
    assert_false(second.traced);
    assert_true(second.seconds > 0);
    check_same(&none, &second, "reference-16.exr");
    struct glint_run *run = glint_run_open(second.folder, &err);
    if (!run) fail_msg("%s", err.message);
    assert_non_null(strstr(glint_run_json(run), moved));
    assert_null(strstr(glint_run_json(run), fixture->capture_path));
    glint_run_close(&run);
    open_capture(fixture, fixture->capture_path);
    finish(&none);
    finish(&first);
    finish(&second);
}

/* Catches: a file that is damaged, cut, gone or another one's, and is used, or stays. */
static void what_is_damaged_is_made_anew(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct traced first, again;
    char cache[160], paths[8][512], aside[160];
    use_folder(fixture, "damaged", cache);
    snprintf(aside, sizeof aside, "%s/aside", fixture->folder);
    trace(fixture, cache, (struct asked){.name = "whole"}, &first);
    assert_int_equal(entries_of(cache, paths), 2);
    for (int how = 0; how < 3; how++) {
        char name[16];
        struct stat file;
        const char *path = paths[how % 2];
        snprintf(name, sizeof name, "again%d", how);
        assert_int_equal(stat(path, &file), 0);
        FILE *open = fopen(path, "r+");
        assert_non_null(open);
        if (how == 0) { /* one bit */
            assert_int_equal(fseek(open, (long)file.st_size / 2, SEEK_SET), 0);
            const int byte = fgetc(open);
            assert_int_equal(fseek(open, (long)file.st_size / 2, SEEK_SET), 0);
            assert_int_equal(fputc(byte ^ 1, open), byte ^ 1);
        }
        assert_int_equal(fclose(open), 0);
        if (how == 1) assert_int_equal(truncate(path, file.st_size - 1), 0);
        if (how == 2) assert_int_equal(rename(path, aside), 0);
        trace(fixture, cache, (struct asked){.name = name}, &again);
        assert_true(again.traced);
        check_same(&first, &again, "reference-16.exr");
        finish(&again);
        assert_int_equal(entries_of(cache, paths), 2);
        strcat(name, "b");
        trace(fixture, cache, (struct asked){.name = name}, &again);
        assert_false(again.traced);
        check_same(&first, &again, "reference-16.exr");
        finish(&again);
    }
    finish(&first);
}

/* Catches: a key that lacks something that the bits depend on. */
static void other_references_are_not_found(void **state) {
    static const struct asked others[] = {
        {.name = "set", .set = "cubemap_trace.tolerance=0.03"},
        {.name = "digits", .set = "cubemap_trace.tolerance=0.020000000004"},
        {.name = "more", .rays = 32},
        {.name = "at_once", .at_once = 3},
    };
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct traced found;
    char cache[160], path[160], first[160];
    use_folder(fixture, "others", cache);
    trace(fixture, cache, (struct asked){.name = "one"}, &found);
    finish(&found);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        trace(fixture, cache, others[i], &found);
        assert_true(found.traced);
        finish(&found);
    }
    trace(fixture, cache, (struct asked){.name = "more_again", .rays = 32}, &found); /* both are kept */
    assert_false(found.traced);
    finish(&found);
    snprintf(path, sizeof path, "%s/cpuinfo", fixture->folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs("processor\t: 0\nmodel name\t: Another\nflags\t\t: fpu sse2\n\n", file) > 0);
    assert_int_equal(fclose(file), 0);
    processor = path;
    trace(fixture, cache, (struct asked){.name = "processor"}, &found);
    processor = NULL;
    assert_true(found.traced || !glint_device_get_info(fixture->device)->is_cpu);
    finish(&found);
    snprintf(first, sizeof first, "%s", fixture->capture_path);
    snprintf(path, sizeof path, "%s/other.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.number = 8}, &err));
    open_capture(fixture, path);
    trace(fixture, cache, (struct asked){.name = "capture"}, &found);
    assert_true(found.traced);
    finish(&found);
    open_capture(fixture, first);
}

/* Catches: a part of a reference in the cache, and one whose rays depend on where it began. */
static void only_finished_ones_are_stored(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct traced found;
    char cache[160], paths[8][512];
    use_folder(fixture, "unfinished", cache);
    trace(fixture, cache, (struct asked){.name = "stopped", .stop = 60}, &found);
    finish(&found);
    assert_int_equal(entries_of(cache, paths), 0);
    trace(fixture, cache, (struct asked){.name = "noisy", .noise = 0.9}, &found);
    finish(&found);
    assert_int_equal(entries_of(cache, paths), 0);
    trace(fixture, cache, (struct asked){.name = "stopped"}, &found);
    finish(&found);
    assert_int_equal(entries_of(cache, paths), 2);
}

/* A folder that has some of the rays already, and a part of a round. Catches: rays of both that are mixed, and files that stay. */
static void a_begun_reference_is_completed_by_it(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct traced whole, found;
    char cache[160], path[160];
    use_folder(fixture, "begun", cache);
    trace(fixture, cache, (struct asked){.name = "done", .rays = 32}, &whole);
    trace(fixture, NULL, (struct asked){.name = "begun_here"}, &found);
    finish(&found);
    trace(fixture, NULL, (struct asked){.name = "begun_here", .rays = 32, .stop = 60}, &found);
    finish(&found);
    snprintf(path, sizeof path, "%s/unfinished.exr", found.folder);
    assert_int_equal(access(path, F_OK), 0);
    trace(fixture, cache, (struct asked){.name = "begun_here", .rays = 32}, &found);
    assert_false(found.traced);
    check_same(&whole, &found, "reference-32.exr"); /* and no other file in the folder */
    finish(&found);
    trace(fixture, NULL, (struct asked){.name = "begun_here", .rays = 32}, &found); /* as another process reads it */
    assert_false(found.traced);
    check_same(&whole, &found, "reference-32.exr");
    finish(&found);
    finish(&whole);
}

/* Several machines begin at the same moment, and one of them is faster. */
static void one_that_another_finishes_meanwhile_is_taken(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct traced whole, found;
    char cache[160], later[160];
    use_folder(fixture, "slow", cache);
    use_folder(fixture, "fast", later);
    trace(fixture, later, (struct asked){.name = "fast_one", .rays = 64}, &whole);
    trace(fixture, cache, (struct asked){.name = "slow_one", .rays = 64, .appears = later}, &found);
    assert_true(found.calls < whole.calls / 2);
    check_same(&whole, &found, "reference-64.exr");
    finish(&found);
    finish(&whole);
}

/* "slow": what takes seconds. */
int main(int argc, UNUSED char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_folder_gets_the_same_bits_untraced),
        cmocka_unit_test(what_is_damaged_is_made_anew),
        cmocka_unit_test(other_references_are_not_found),
        cmocka_unit_test(only_finished_ones_are_stored),
        cmocka_unit_test(a_begun_reference_is_completed_by_it),
    };
    const struct CMUnitTest slow[] = {cmocka_unit_test(one_that_another_finishes_meanwhile_is_taken)};
    return argc > 1 ? cmocka_run_group_tests(slow, fixture_setup_device, fixture_teardown)
                    : cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
