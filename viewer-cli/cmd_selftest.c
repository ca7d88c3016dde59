/* glint selftest: the hard cases on this machine's device. */
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <pthread.h>

#include "args.h"
#include "progress.h"
#include "selftest/chosen.h"
#include "threads.h"

/* clang-format off */
static const struct selftest_group *const groups[] = {
    &selftest_functions,
    &selftest_geometry,
    &selftest_numbers,
    &selftest_garbage,
    &selftest_sizes,
    &selftest_time,
    &selftest_invariance,
};
/* clang-format on */

struct arguments {
    struct list only;
    const char *device, *passes;
    bool quick, list, json;
};

enum { KEY_QUICK = 256, KEY_ONLY, KEY_LIST, KEY_PASSES };

/* clang-format off */
static const struct argp_option options[] = {
    {"quick",  KEY_QUICK,  NULL,         0, "Fewer points in each table: under 20 s on two cores", 0},
    {"only",   KEY_ONLY,   "TEXT",       0, "Only cases that have TEXT in their name, their group's, or what they say; "
                                            "several --only choose more", 0},
    {"list",   KEY_LIST,   NULL,         0, "List the cases with their bounds and the reasons for them; run none", 0},
    {"passes", KEY_PASSES, "FOLDER",     0, "Check the shaders of FOLDER, such as a source tree's passes/ that is being edited, "
                                            "instead of those built in (default: $GLINT_PASSES); nothing needs a rebuild, and what "
                                            "FOLDER lacks is taken from what is built in", 0},
    {"device", 'd',        "INDEX|NAME", 0, "The Vulkan device; glint devices lists them (default: $GLINT_DEVICE, else the best)", 0},
    {"json",   'j',        NULL,         0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint selftest", "every case on the best device; exit status 1 when one fails"},
    {"glint selftest --quick --device llvmpipe", "a short run on the CPU"},
    {"glint selftest --only time --only geometry", "two of the groups"},
    {"glint selftest --list --only fog", "what is claimed of fog, how exactly, and why not more so"},
    {"glint selftest --only cone --passes src/glint/passes", "the cones of a source tree, as its files are now"},
    {"glint selftest --json | jq '.cases[] | select(.pass | not)'", "what fails, for a script"},
    {0},
};

extern const struct command cmd_selftest;

static error_t parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_QUICK:
        a->quick = true;
        return 0;
    case KEY_ONLY:
        list_add(&a->only, arg, state);
        return 0;
    case KEY_LIST:
        a->list = true;
        return 0;
    case KEY_PASSES:
        a->passes = arg;
        return 0;
    case 'd':
        a->device = arg;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "unexpected argument %s (cases are chosen by --only)", arg);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- Running ---- */

static bool make_folder(char path[256], struct glint_error *err) {
    const char *parent = getenv("TMPDIR");
    if (snprintf(path, 256, "%s/glint-selftest-XXXXXX", parent ? parent : "/tmp") < 256 && mkdtemp(path)) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    path[0] = '\0';
    return false;
}

static void remove_folder(const char *folder) {
    DIR *dir = folder[0] ? opendir(folder) : NULL;
    for (const struct dirent *entry; dir && (entry = readdir(dir));)
        if (entry->d_name[0] != '.') unlinkat(dirfd(dir), entry->d_name, 0);
    if (dir) closedir(dir);
    if (folder[0]) rmdir(folder);
}

/* Groups run side by side, each worker on a device and in a folder of its own. A worker that gets no device, or whose device has
   not the memory beside the others, leaves its group to those that go on; the last one finds all of the device its own. */
struct work {
    const struct arguments *arguments;
    struct chosen *chosen;
    pthread_mutex_t lock; /* of all that follows */
    bool waits[MOST_GROUPS], alone;
    struct glint_device_info info; /* of any: they are the same device */
    struct progress progress;
    size_t ready[MOST_GROUPS]; /* cases of each group */
    struct glint_error error;  /* of the first group that has one */
    size_t failed;             /* that group */
};

/* The bar goes by cases, those with a finding before all; what a replay says of itself is too small for it. */
struct watch {
    struct work *work;
    struct chosen_group *group;
};
static bool show(void *user, const char *what, double done) {
    const struct watch *watch = user;
    struct work *work = watch->work;
    const struct chosen_group *group = watch->group;
    size_t all = 0, ready = 0;
    (void)what, (void)done;
    for (size_t i = 0; i < group->group->count(); i++)
        ready +=
            group->cases[i] && (group->findings[i].values > 0 || group->findings[i].left_out || group->seconds > 0);
    pthread_mutex_lock(&work->lock);
    work->ready[group - work->chosen->groups] = ready;
    ready = 0;
    for (size_t g = 0; g < work->chosen->group_count; g++)
        all += work->chosen->groups[g].count, ready += work->ready[g];
    const bool go_on = progress_report(&work->progress, group->group->name, (double)ready / (double)all);
    pthread_mutex_unlock(&work->lock);
    return go_on;
}

static double seconds_since(const struct timespec *start) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - start->tv_sec) + 1e-9 * (double)(now.tv_nsec - start->tv_nsec);
}

static bool run_group(struct work *work, struct glint_device *device, struct chosen_group *group,
                      struct glint_error *err) {
    struct watch watch = {work, group};
    struct timespec start;
    char folder[256] = "";
    double filter_step = NAN;
    const struct selftest test = {device, folder, work->arguments->quick, &filter_step, show, &watch};
    clock_gettime(CLOCK_MONOTONIC, &start);
    memset(group->findings, 0, group->group->count() * sizeof *group->findings); /* of a worker that left */
    const bool ok = make_folder(folder, err) && group->group->run(&test, group->cases, group->findings, err);
    remove_folder(folder);
    if (!ok) return false;
    group->seconds = seconds_since(&start);
    return show(&watch, NULL, 1) || glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
}

static bool is_silent(const struct glint_device *device, struct glint_error *err) {
    const char *last = NULL;
    const uint32_t messages = glint_device_messages(device, &last);
    return !messages || glint_fail(err, GLINT_ERROR_DEVICE, "%u validation messages, the last: %s", messages, last);
}

/* The first group that waits; the number of groups when none does, or when there is no use in going on. */
static size_t take_group(struct work *work) {
    size_t g = 0;
    pthread_mutex_lock(&work->lock);
    while (g < work->chosen->group_count && (work->error.code || !work->waits[g])) g++;
    if (g < work->chosen->group_count) work->waits[g] = false;
    pthread_mutex_unlock(&work->lock);
    return g;
}

/* starved: what failed may not fail where fewer devices are open. */
static void leave_group(struct work *work, size_t g, bool starved, const struct glint_error *err) {
    pthread_mutex_lock(&work->lock);
    if (starved && !work->alone) work->waits[g] = true;
    else if (!work->error.code || g < work->failed) work->error = *err, work->failed = g;
    pthread_mutex_unlock(&work->lock);
}

static struct glint_device *open_device(struct work *work, struct glint_error *err) {
    const struct glint_device_options options = {.select = work->arguments->device, .passes = work->arguments->passes};
    struct glint_device *device = glint_device_create(&options, err);
    if (!device) return NULL;
    pthread_mutex_lock(&work->lock);
    work->info = *glint_device_get_info(device);
    pthread_mutex_unlock(&work->lock);
    return device;
}

static bool run_worker(void *user, uint32_t worker, size_t index) {
    struct work *work = user;
    struct glint_device *device = NULL;
    (void)worker, (void)index;
    for (size_t g; (g = take_group(work)) < work->chosen->group_count;) {
        struct glint_error err = {0};
        if (!device) device = open_device(work, &err);
        const bool ran = device && run_group(work, device, &work->chosen->groups[g], &err);
        const bool starved = !device || err.code == GLINT_ERROR_DEVICE || err.code == GLINT_ERROR_MEMORY;
        if (ran && is_silent(device, &err)) continue;
        glint_device_destroy(&device); /* before others take what it starved for */
        leave_group(work, g, starved, &err);
        break;
    }
    glint_device_destroy(&device);
    return true;
}

static bool run_groups(struct work *work, struct glint_error *err) {
    size_t count = 0;
    for (size_t g = 0; g < work->chosen->group_count; g++) {
        work->waits[g] = work->chosen->groups[g].count > 0;
        count += work->waits[g];
    }
    pthread_mutex_init(&work->lock, NULL);
    progress_begin(&work->progress);
    const uint32_t workers = glint_loop_workers(count, 0);
    glint_loop(workers, workers, run_worker, work);
    work->alone = true;
    run_worker(work, 0, 0);
    progress_end(&work->progress);
    pthread_mutex_destroy(&work->lock);
    if (work->error.code) *err = work->error;
    return !work->error.code;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct chosen chosen;
    struct work work = {.arguments = &a, .chosen = &chosen};
    struct timespec start;
    command_parse(&cmd_selftest, argc, argv, &a);
    clock_gettime(CLOCK_MONOTONIC, &start);
    bool ok = chosen_init(&chosen, groups, sizeof groups / sizeof *groups, &a.only, &err);
    if (ok && !a.list) ok = run_groups(&work, &err);
    const enum status status = ok ? chosen_report(&chosen, a.list ? NULL : &work.info, seconds_since(&start), a.json)
                                  : command_fail(&cmd_selftest, &err);
    chosen_finish(&chosen);
    list_free(&a.only);
    return status;
}

const struct command cmd_selftest = {
    .name = "selftest",
    .arguments = "",
    .summary = "the hard cases on this machine's device, each against a stated bound",
    .description =
        "Checks what a device makes of the shaders, case by case. A case is a claim with a bound: the table has the "
        "worst "
        "error, the bound, and the input where it is worst; --list has the claim and the bound's reason. Groups: "
        "functions (those that the passes share, over dense tables with 0, poles and infinity, against double "
        "precision "
        "on the very inputs that the device had; what captures hold, decoded), geometry (rays through hard places), "
        "numbers (worlds far away, other depths and projections), garbage (bad pixels spoil no others), time "
        "(histories "
        "and noise of frames that follow each other), invariance (one scene under every convention). "
        "An ULP is the distance of neighbouring floats at the expected value. Where a reason names the precision that "
        "Vulkan grants, a device may use it up and still conform. Ties are decisions, such as hit or not, that lie "
        "within rounding of going the other way. Cases that fail are said once more at the end, with what they claim. "
        "The exit status is 1 when a case fails, 2 when none could be run.",
    .options = options,
    .parse = parse,
    .examples = examples,
    .run = run,
};
