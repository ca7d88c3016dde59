/* A shot that was interrupted is completed; what is there already, made the same way, is not made again. */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct glint_sample_options options(void) {
    return (struct glint_sample_options){.width = 16, .height = 12, .cube_size = 8, .light_samples = 2, .frames = 3};
}

/* Files are written under a temporary name: a file made again is another inode, or a later one. */
static struct stat status_of(void **state, const char *name) {
    struct stat status;
    assert_int_equal(stat(in_folder(state, name), &status), 0);
    return status;
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_ino == b->st_ino && a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec;
}

/* FNV-1a */
static uint64_t hash_of(void **state, const char *name) {
    uint64_t hash = 14695981039346656037U;
    FILE *file = fopen(in_folder(state, name), "rb");
    assert_non_null(file);
    for (int c; (c = fgetc(file)) != EOF;) hash = (hash ^ (uint64_t)c) * 1099511628211U;
    fclose(file);
    return hash;
}

static const char *const files[4] = {"s.cubemaps.exr", "s.0001.exr", "s.0002.exr", "s.0003.exr"};

static void test_missing_frames_are_made(void **state) {
    struct glint_sample_options o = options();
    struct stat before[4];
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) before[i] = status_of(state, files[i]);
    uint64_t whole = hash_of(state, "s.0002.exr");
    assert_int_equal(unlink(in_folder(state, "s.0002.exr")), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) {
        struct stat after = status_of(state, files[i]);
        assert_int_equal(same_file(&before[i], &after), i != 2);
    }
    assert_true(whole == hash_of(state, "s.0002.exr")); /* as if it had never been interrupted */
}

static void test_a_damaged_frame_is_made_again(void **state) {
    struct glint_sample_options o = options();
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    uint64_t whole = hash_of(state, "s.0003.exr");
    struct stat status = status_of(state, "s.0003.exr");
    assert_int_equal(truncate(in_folder(state, "s.0003.exr"), status.st_size / 2), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    assert_true(whole == hash_of(state, "s.0003.exr"));
}

static void test_other_settings_make_all_of_it_again(void **state) {
    struct glint_sample_options o = options();
    struct stat before[4];
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) before[i] = status_of(state, files[i]);
    o.encodings.roughness = GLINT_ROUGHNESS_ALPHA;
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    for (int i = 0; i < 4; i++) {
        struct stat after = status_of(state, files[i]);
        assert_false(same_file(&before[i], &after));
    }
}

/* Frames belong to their cube maps. */
static void test_lost_cube_maps_come_back(void **state) {
    struct glint_sample_options o = options();
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    uint64_t whole = hash_of(state, files[0]);
    struct stat before = status_of(state, files[1]);
    assert_int_equal(unlink(in_folder(state, files[0])), 0);
    write_sample("mirror_box", in_folder(state, "s.exr"), &o);
    assert_true(whole == hash_of(state, files[0]));
    struct stat after = status_of(state, files[1]);
    assert_true(same_file(&before, &after)); /* the same cube maps: the frames still hold */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_missing_frames_are_made, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_a_damaged_frame_is_made_again, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_other_settings_make_all_of_it_again, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_lost_cube_maps_come_back, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
