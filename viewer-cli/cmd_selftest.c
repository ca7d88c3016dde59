/* glint selftest: the hard cases on this machine's device. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "args.h"
#include "progress.h"
#include "selftest/selftest.h"
#include "table.h"

/* clang-format off */
static const struct selftest_group *const groups[] = {
    &selftest_functions,
    &selftest_geometry,
    &selftest_numbers,
    &selftest_garbage,
    &selftest_time,
    &selftest_invariance,
};
/* clang-format on */
enum { GROUPS = sizeof groups / sizeof *groups };

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

/* ---- Which cases ---- */

struct chosen {
    bool *cases[GROUPS];
    struct selftest_finding *findings[GROUPS];
    size_t count;
};

static bool is_chosen(const struct list *only, const struct selftest_group *group, const struct selftest_case *c) {
    for (size_t i = 0; i < only->count; i++)
        if (strcasestr(c->name, only->items[i]) || strcasestr(group->name, only->items[i]) ||
            strcasestr(c->what, only->items[i]) || (c->source && strcasestr(c->source, only->items[i])))
            return true;
    return only->count == 0;
}

static bool choose(struct chosen *chosen, const struct list *only, struct glint_error *err) {
    for (size_t g = 0; g < GROUPS; g++) {
        const size_t count = groups[g]->count();
        chosen->cases[g] = calloc(count, sizeof *chosen->cases[g]);
        chosen->findings[g] = calloc(count, sizeof *chosen->findings[g]);
        if (!chosen->cases[g] || !chosen->findings[g]) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        for (size_t i = 0; i < count; i++) {
            const struct selftest_case c = groups[g]->get(i);
            chosen->cases[g][i] = is_chosen(only, groups[g], &c);
            chosen->count += chosen->cases[g][i];
        }
    }
    if (chosen->count) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "--only %s: no case has that; glint selftest --list names them",
                      only->items[0]);
}

static void chosen_finish(struct chosen *chosen) {
    for (size_t g = 0; g < GROUPS; g++) {
        free(chosen->cases[g]);
        free(chosen->findings[g]);
    }
}

/* A case that compared nothing has not passed. */
static bool passes(const struct selftest_case *c, const struct selftest_finding *finding) {
    return finding->values > 0 && finding->worst <= c->bound;
}

/* ---- What is said of them ---- */

typedef void (*visit)(void *user, const struct selftest_group *group, const struct selftest_case *c,
                      const struct selftest_finding *finding);
static void for_each(const struct chosen *chosen, visit visit, void *user) {
    for (size_t g = 0; g < GROUPS; g++)
        for (size_t i = 0, count = groups[g]->count(); i < count; i++) {
            const struct selftest_case c = groups[g]->get(i);
            if (chosen->cases[g][i] && !chosen->findings[g][i].left_out)
                visit(user, groups[g], &c, &chosen->findings[g][i]);
        }
}

static void list_row(void *user, const struct selftest_group *group, const struct selftest_case *c,
                     const struct selftest_finding *finding) {
    (void)finding;
    table_cell(user, "%s", group->name);
    table_cell(user, "%s", c->name);
    table_cell(user, "%s", number_text(c->bound));
    table_cell(user, "%s", c->bound > 0 ? c->unit : "exact");
    table_cell(user, "%s: %s", c->what, c->reason);
}

static void result_row(void *user, const struct selftest_group *group, const struct selftest_case *c,
                       const struct selftest_finding *finding) {
    (void)group;
    table_cell(user, "%s", c->name);
    table_cell(user, "%s", number_text(finding->worst));
    table_cell(user, "%s", number_text(c->bound));
    table_cell(user, "%s", c->bound > 0 ? c->unit : "exact");
    table_cell(user, "%s", passes(c, finding) ? "pass" : "FAIL");
    table_cell(user, finding->ties ? "%zu" : "%.0zu", finding->ties);
    table_cell(user, "%s", finding->worst > 0 ? finding->at : "");
}

static void print_table(const struct chosen *chosen, bool list) {
    static const char *const listed[] = {"<group", "<case", ">bound", "<", "<what", NULL};
    static const char *const found[] = {"<case", ">worst", ">bound", "<", "<", ">ties", "<worst at", NULL};
    struct table *table = table_create(list ? listed : found);
    for_each(chosen, list ? list_row : result_row, table);
    table_print(table, stdout);
    table_destroy(&table);
}

struct report {
    bool list;
    json_t *cases;
    size_t count, failed;
};

static void add_case(void *user, const struct selftest_group *group, const struct selftest_case *c,
                     const struct selftest_finding *finding) {
    struct report *report = user;
    report->count++;
    report->failed += !report->list && !passes(c, finding);
    if (!report->cases) return;
    json_t *object = json_pack("{s:s, s:s, s:s, s:s, s:f, s:s}", "group", group->name, "name", c->name, "what", c->what,
                               "unit", c->unit, "bound", c->bound, "reason", c->reason);
    if (c->source) json_object_set_new(object, "evaluated", json_string(c->source));
    if (!report->list) {
        json_object_set_new(object, "pass", json_boolean(passes(c, finding)));
        json_object_set_new(object, "worst", json_number(finding->worst)); /* null: infinite */
        json_object_set_new(object, "values", json_integer((json_int_t)finding->values));
        json_object_set_new(object, "ties", json_integer((json_int_t)finding->ties));
        if (finding->worst > 0) json_object_set_new(object, "worst_at", json_string(finding->at));
    }
    json_array_append_new(report->cases, object);
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

static bool run_groups(const struct arguments *a, const struct chosen *chosen, struct glint_device *device,
                       struct progress *progress, struct glint_error *err) {
    char folder[256] = "";
    bool ok = make_folder(folder, err);
    const struct selftest test = {device, folder, a->quick, progress_report, progress};
    for (size_t g = 0; ok && g < GROUPS; g++) {
        bool any = false;
        for (size_t i = 0; i < groups[g]->count(); i++) any = any || chosen->cases[g][i];
        if (any) ok = groups[g]->run(&test, chosen->cases[g], chosen->findings[g], err);
    }
    remove_folder(folder);
    const char *last = NULL;
    const uint32_t messages = glint_device_messages(device, &last);
    if (ok && messages)
        ok = glint_fail(err, GLINT_ERROR_DEVICE, "%u validation messages, the last: %s", messages, last);
    return ok;
}

static enum status say(const struct arguments *a, const struct chosen *chosen, const struct glint_device_info *device,
                       double seconds) {
    struct report report = {.list = a->list, .cases = a->json ? json_array() : NULL};
    for_each(chosen, add_case, &report);
    if (a->json) {
        json_t *json = json_object();
        if (device) json_object_set_new(json, "device", json_string(device->name));
        if (!a->list) {
            json_object_set_new(json, "seconds", json_real(seconds));
            json_object_set_new(json, "failed", json_integer((json_int_t)report.failed));
        }
        json_object_set_new(json, "cases", report.cases);
        const enum status status = print_json(json);
        return report.failed ? STATUS_CHECK : status;
    }
    print_table(chosen, a->list);
    if (device)
        printf("\n%s: %zu cases, %zu failed, %s\n", device->name, report.count, report.failed, time_text(seconds));
    return report.failed ? STATUS_CHECK : STATUS_DONE;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct chosen chosen = {0};
    struct progress progress;
    struct timespec start, end;
    command_parse(&cmd_selftest, argc, argv, &a);
    clock_gettime(CLOCK_MONOTONIC, &start);
    bool ok = choose(&chosen, &a.only, &err);
    struct glint_device *device = NULL;
    if (ok && !a.list) {
        progress_begin(&progress);
        device = glint_device_create(&(struct glint_device_options){.select = a.device, .passes = a.passes}, &err);
        ok = device && run_groups(&a, &chosen, device, &progress, &err);
        progress_end(&progress);
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    const double seconds = (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
    const enum status status = ok ? say(&a, &chosen, device ? glint_device_get_info(device) : NULL, seconds)
                                  : command_fail(&cmd_selftest, &err);
    chosen_finish(&chosen);
    if (device) glint_device_destroy(&device);
    list_free(&a.only);
    return status;
}

const struct command cmd_selftest = {
    .name = "selftest",
    .arguments = "",
    .summary = "the hard cases on this machine's device, each against a stated bound",
    .description =
        "Checks what a device makes of the shaders' arithmetic, case by case, and prints a table: the worst error, the "
        "bound, and the input where it is worst. A case is a claim: functions that the passes share are evaluated over "
        "dense tables that include the ends (0, the poles, the largest and smallest, infinity) and compared with "
        "double "
        "precision on the very inputs that the device had, so that storage is not mistaken for arithmetic; a scene far "
        "from the origin, or stored in another encoding, has to give the same picture; and bad pixels of a G-buffer "
        "must "
        "spoil no others. An ULP is the distance of neighbouring floats at the expected value. Bounds have reasons, "
        "which "
        "--list gives; where a reason names the precision that Vulkan grants, a device may use it up and still "
        "conform. "
        "The exit status is 1 when a case fails.",
    .options = options,
    .parse = parse,
    .examples = examples,
    .run = run,
};
