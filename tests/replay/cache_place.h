/* A cache folder for tests, and a file to store there and to copy an entry to. */
#ifndef GLINT_TEST_CACHE_PLACE_H
#define GLINT_TEST_CACHE_PLACE_H

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "glint/cache.h"
#include "unit.h"

static const char *const keys[] = {"00000000000000000000000000000000", "11111111111111111111111111111111",
                                   "22222222222222222222222222222222"};
struct place {
    char top[64], folder[96], file[96], back[96];
};

static inline void begin(struct place *place) {
    snprintf(place->top, sizeof place->top, "/tmp/glint-cache-XXXXXX");
    assert_non_null(mkdtemp(place->top));
    snprintf(place->folder, sizeof place->folder, "%s/a/b", place->top); /* neither exists */
    snprintf(place->file, sizeof place->file, "%s/file", place->top);
    snprintf(place->back, sizeof place->back, "%s/back", place->top);
}

static inline void remove_place(const struct place *place) {
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", place->top);
    assert_int_equal(system(command), 0);
}

static inline void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static inline void expect_text(const char *path, const char *text) {
    char found[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(found, sizeof found, file));
    fclose(file);
    assert_string_equal(found, text);
}

static inline size_t count_files(const char *folder) {
    size_t count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (struct dirent *entry; (entry = readdir(entries));) count += entry->d_name[0] != '.';
    closedir(entries);
    return count;
}

static inline void set_age(const char *path, time_t seconds) {
    const struct timespec times[2] = {{time(NULL) - seconds, 0}, {time(NULL) - seconds, 0}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

#endif
