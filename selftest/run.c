/* Runs the selected cases; groups run in parallel. */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "glint/selftest.h"
#include "internal.h"
#include "threads.h"

/* The folder is open, so that it can be emptied without memory. */
static DIR *make_folder(char path[256], struct glint_error *err) {
    const char *parent = getenv("TMPDIR");
    const bool made = snprintf(path, 256, "%s/glint-selftest-XXXXXX", parent ? parent : "/tmp") < 256 && mkdtemp(path);
    DIR *folder = made ? opendir(path) : NULL;
    if (folder) return folder;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (made) rmdir(path);
    return NULL;
}

static void remove_folder(DIR *folder, const char *path) {
    rewinddir(folder);
    for (const struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.') unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(path);
}

/* Each worker has its own device and folder. A worker whose device has not enough memory beside the others leaves its group to the
   remaining workers; what none of them could run is run again with one device. Devices are opened before the workers start and closed
   when all are done: releases of the loader and of the validation layer up to 2023 race where one thread opens or closes a device while
   another one uses its own (Vulkan-Loader issue 200, Vulkan-ValidationLayers issue 4391). */
struct work {
    struct glint_selftest *selftest;
    const struct glint_selftest_options *options;
    glint_progress progress;
    void *user;
    struct glint_device *devices[SELFTEST_GROUPS]; /* of each worker */
    pthread_mutex_t lock;                          /* of the following members, and of calls of progress */
    bool waits[SELFTEST_GROUPS], alone;
    size_t ready[SELFTEST_GROUPS]; /* number of cases of each group */
    struct glint_error error;      /* of the first group that failed */
    size_t failed;                 /* that group */
};

/* Progress is counted in finished cases, ignoring the progress within replays. */
struct group_progress {
    struct work *work;
    struct selected_group *group;
};
static bool report_group_progress(void *user, const char *what, double done) {
    const struct group_progress *progress = user;
    struct work *work = progress->work;
    const struct selected_group *s = progress->group;
    size_t all = 0, ready = 0;
    (void)what, (void)done;
    for (size_t i = 0; i < s->group->count(); i++)
        ready += s->selected[i] && (s->findings[i].values > 0 || s->findings[i].left_out || s->public.seconds > 0);
    pthread_mutex_lock(&work->lock);
    work->ready[s - work->selftest->groups] = ready;
    ready = 0;
    for (size_t g = 0; g < SELFTEST_GROUPS; g++) all += work->selftest->groups[g].public.count, ready += work->ready[g];
    const bool go_on = !work->progress || work->progress(work->user, s->group->name, (double)ready / (double)all);
    pthread_mutex_unlock(&work->lock);
    return go_on;
}

static double seconds_since(const struct timespec *start) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - start->tv_sec) + 1e-9 * (double)(now.tv_nsec - start->tv_nsec);
}

static void publish_findings(struct selected_group *s) {
    for (size_t i = 0, k = 0; i < s->group->count(); i++)
        if (s->selected[i]) s->shown_findings[k++] = s->findings[i];
}

static bool run_group(struct work *work, struct glint_device *device, struct selected_group *s,
                      struct glint_error *err) {
    struct group_progress progress = {work, s};
    struct timespec start;
    char path[256] = "";
    double filter_step = NAN;
    const struct case_context context = {device,   path, work->options->quick, &filter_step, report_group_progress,
                                         &progress};
    clock_gettime(CLOCK_MONOTONIC, &start);
    s->public.seconds = 0;
    memset(s->findings, 0, s->group->count() * sizeof *s->findings); /* of a worker that left, or of an earlier run */
    DIR *folder = make_folder(path, err);
    const bool ok = folder && s->group->run(&context, s->selected, s->findings, err);
    if (folder) remove_folder(folder, path);
    if (!ok) return false;
    s->public.seconds = seconds_since(&start);
    publish_findings(s);
    return report_group_progress(&progress, NULL, 1) || glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
}

static bool is_silent(const struct glint_device *device, struct glint_error *err) {
    const char *last = NULL;
    const uint32_t messages = glint_device_messages(device, &last);
    return !messages || glint_fail(err, GLINT_ERROR_DEVICE, "%u validation messages, the last: %s", messages, last);
}

/* The first waiting group; the number of groups if there is none, or no point in continuing. */
static size_t take_group(struct work *work) {
    size_t g = 0;
    pthread_mutex_lock(&work->lock);
    while (g < SELFTEST_GROUPS && (work->error.code || !work->waits[g])) g++;
    if (g < SELFTEST_GROUPS) work->waits[g] = false;
    pthread_mutex_unlock(&work->lock);
    return g;
}

/* starved: the group may succeed if fewer devices are open. */
static void leave_group(struct work *work, size_t g, bool starved, const struct glint_error *err) {
    pthread_mutex_lock(&work->lock);
    if (starved && !work->alone) work->waits[g] = true;
    else if (!work->error.code || g < work->failed) work->error = *err, work->failed = g;
    pthread_mutex_unlock(&work->lock);
}

static bool run_worker(void *user, uint32_t worker, size_t index) {
    struct work *work = user;
    struct glint_device *device = work->devices[index];
    (void)worker;
    for (size_t g; (g = take_group(work)) < SELFTEST_GROUPS;) {
        struct glint_error err = {0};
        const bool ran = run_group(work, device, &work->selftest->groups[g], &err);
        const bool starved = err.code == GLINT_ERROR_DEVICE || err.code == GLINT_ERROR_MEMORY;
        if (ran && is_silent(device, &err)) continue;
        leave_group(work, g, starved, &err);
        break;
    }
    return true;
}

/* Runs the waiting groups with as many devices as can be opened, up to `wanted`. False if there is none. */
static bool run_waiting(struct work *work, uint32_t wanted, struct glint_error *err) {
    const struct glint_device_options options = {.select = work->options->device, .passes = work->options->passes};
    struct glint_error refused = {0};
    uint32_t count = 0;
    while (count < wanted && (work->devices[count] = glint_device_create(&options, &refused))) count++;
    if (count) work->selftest->device = *glint_device_get_info(work->devices[0]); /* the same one for all workers */
    work->alone = count == 1;
    glint_loop(count, count, run_worker, work);
    for (uint32_t i = 0; i < count; i++) glint_device_destroy(&work->devices[i]);
    return count || glint_fail(err, refused.code, "%s", refused.message);
}

static uint32_t count_waiting(const struct work *work) {
    uint32_t count = 0;
    for (size_t g = 0; g < SELFTEST_GROUPS; g++) count += work->waits[g];
    return count;
}

bool glint_selftest_run(struct glint_selftest *selftest, const struct glint_selftest_options *options,
                        glint_progress progress, void *user, struct glint_error *err) {
    struct work work = {.selftest = selftest, .options = options, .progress = progress, .user = user};
    for (size_t g = 0; g < SELFTEST_GROUPS; g++) work.waits[g] = selftest->groups[g].public.count > 0;
    pthread_mutex_init(&work.lock, NULL);
    bool ok = run_waiting(&work, glint_loop_workers(count_waiting(&work), 0), err);
    if (ok && !work.error.code && count_waiting(&work)) ok = run_waiting(&work, 1, err);
    pthread_mutex_destroy(&work.lock);
    return ok && (!work.error.code || glint_fail(err, work.error.code, "%s", work.error.message));
}
