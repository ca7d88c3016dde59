/* Pairs runs with their baselines: a single pair, or two folders of runs. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "check/check.h"

bool check_is_run(const char *folder) {
    char *path = NULL;
    if (asprintf(&path, "%s/run.json", folder) < 0) return false;
    const bool is = access(path, F_OK) == 0;
    free(path);
    return is;
}

/* Takes both paths. */
static bool add_check_pair(struct check_pairs *pairs, char *run, char *baseline, struct glint_error *err) {
    struct check_pair *larger = realloc(pairs->items, (pairs->count + 1) * sizeof *larger);
    if (larger) pairs->items = larger;
    if (!larger || !run || !baseline) {
        free(run);
        free(baseline);
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    pairs->items[pairs->count++] = (struct check_pair){run, baseline, check_is_run(run), check_is_run(baseline)};
    return true;
}

static char *inside(const char *folder, const char *name) {
    char *path = NULL;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

/* A folder of runs may come from anybody: a link in it, which may lead to a run elsewhere, is refused. */
static bool check_is_no_link(const char *path, struct glint_error *err) {
    struct stat info;
    return lstat(path, &info) != 0 || !S_ISLNK(info.st_mode) ||
           glint_fail(err, GLINT_ERROR_IO, "%s: expected a run, found a symbolic link, which is not followed", path);
}

/* The runs in one of two folders; those of the second that the first has too are there already. */
static bool add_folder(struct check_pairs *pairs, const char *run, const char *baseline, bool second,
                       struct glint_error *err) {
    struct dirent **entries = NULL;
    const int count = scandir(second ? baseline : run, &entries, NULL, alphasort);
    bool ok = count >= 0 || (second && errno == ENOENT) ||
              glint_fail(err, GLINT_ERROR_IO, "%s: %s", second ? baseline : run,
                         errno == ENOTDIR ? "expected a run, or a folder of runs, found a file" : strerror(errno));
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        const bool hidden = name[0] == '.' || name[strlen(name) - 1] == '~';
        char *a = hidden ? NULL : inside(run, name), *b = hidden ? NULL : inside(baseline, name);
        const bool run = ok && a && b && check_is_run(second ? b : a) && !(second && check_is_run(a));
        ok = ok && (!run || (check_is_no_link(a, err) && check_is_no_link(b, err)));
        if (run && ok) ok = add_check_pair(pairs, a, b, err);
        else {
            free(a);
            free(b);
        }
        free(entries[i]);
    }
    free(entries);
    return ok;
}

bool check_pairs_find(struct check_pairs *pairs, const char *run, const char *baseline, struct glint_error *err) {
    *pairs = (struct check_pairs){0};
    if (check_is_run(run)) return add_check_pair(pairs, strdup(run), strdup(baseline), err);
    if (!add_folder(pairs, run, baseline, false, err) || !add_folder(pairs, run, baseline, true, err)) return false;
    return pairs->count ||
           glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a run, or a folder of runs: no run.json", run);
}

void check_pairs_finish(struct check_pairs *pairs) {
    for (size_t i = 0; i < pairs->count; i++) {
        free(pairs->items[i].run);
        free(pairs->items[i].baseline);
    }
    free(pairs->items);
    *pairs = (struct check_pairs){0};
}
