/* Looks for programs on the PATH. */
#include "need.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "unit.h"

static const char *const programs[][2] = {
#define PROGRAM(name, package) {name, package},
#define MODULE(name, package)
#define LONG(name, package) {name, package},
#include "programs.h"
#undef PROGRAM
#undef MODULE
#undef LONG
};

static bool found(const char *name) {
    char path[4096];
    const char *folders = getenv("PATH");
    for (size_t length = 0; folders && *folders; folders += length + (folders[length] == ':')) {
        length = strcspn(folders, ":");
        snprintf(path, sizeof path, "%.*s/%s", (int)length, folders, name);
        if (access(path, X_OK) == 0) return true;
    }
    return false;
}

/* GLINT_TEST_ONLY, a pattern of names, leaves out the other cases of a program. */
__attribute__((constructor)) static void choose_cases(void) {
    const char *only = getenv("GLINT_TEST_ONLY");
    if (only) cmocka_set_test_filter(only);
}

void need_program(const char *name) {
    if (strchr(name, '/') || found(name)) return;
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (strcmp(programs[i][0], name) == 0)
            fail_msg("%s is not installed: apt-get install %s, or ./dev test, which does", name, programs[i][1]);
    fail_msg("%s is not installed", name);
}
