/* glint selftest: runs difficult cases on this machine's device. */
#include <time.h>

#include <jansson.h>

#include "command.h"
#include "options/args.h"
#include "glint/selftest.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    struct list only;
    const char *device, *passes;
    bool quick, list, json;
};

enum { KEY_QUICK = 256, KEY_ONLY, KEY_LIST, KEY_PASSES };

/* clang-format off */
static const struct argp_option options[] = {
    {"quick",  KEY_QUICK,  NULL,         0, "Test fewer points in each table: half a minute on two cores, two where no shader is compiled yet", 0},
    {"only",   KEY_ONLY,   "TEXT",       0, "Run only cases whose name, group or description contains TEXT; may be repeated", 0},
    {"list",   KEY_LIST,   NULL,         0, "List the cases with their bounds and reasons without running them", 0},
    {"passes", KEY_PASSES, "FOLDER",     0, "Use the shaders in FOLDER, such as the passes/ folder of a source tree, instead of the built-in ones (default: "
        "$GLINT_PASSES). No rebuild is needed; files that FOLDER does not contain are taken from the built-in ones", 0},
    {"device", 'd',        "INDEX|NAME", 0, "Vulkan device to use; glint devices lists them (default: $GLINT_DEVICE, else the first usable one in that list)", 0},
    {"json",   'j',        NULL,         0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint selftest", "runs all cases on the default device"},
    {"glint selftest --quick --device llvmpipe", "runs a shorter test on the CPU"},
    {"glint selftest --only time --only geometry", "runs two groups"},
    {"glint selftest --list --only fog", "shows the properties of fog with bounds and reasons"},
    {"glint selftest --only cone --passes src/glint/passes", "tests the cone functions of a source tree"},
    {"glint selftest --json | jq '.cases[] | select(.pass | not)'", "extracts the failed cases for a script"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_QUICK, struct arguments, quick),
    STORED(KEY_ONLY, struct arguments, only),
    STORED(KEY_LIST, struct arguments, list),
    STORED(KEY_PASSES, struct arguments, passes),
    STORED('d', struct arguments, device),
    STORED('j', struct arguments, json),
    {0},
};

static error_t cmd_selftest_parse(int key, char *arg, struct argp_state *state) {
    if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
    argp_error(state, "unexpected argument %s (use --only to choose cases)", arg);
    return 0;
}

/* ---- Tables ---- */

static const char *unit_of(const struct glint_selftest_case *c) {
    return c->bound > 0 ? c->unit : "exact";
}

static void list_row(struct table *table, const struct glint_selftest_case *c) {
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", number_text(c->bound));
    table_cell(table, "%s", unit_of(c));
    table_cell(table, "%s: %s", c->what, c->reason);
}

static void result_row(struct table *table, const struct glint_selftest_case *c,
                       const struct glint_selftest_finding *finding) {
    table_cell(table, "%s", c->name);
    table_cell(table, "%s", number_text(finding->worst));
    table_cell(table, "%s", number_text(c->bound));
    table_cell(table, "%s", unit_of(c));
    const bool passes = glint_selftest_passes(c, finding);
    table_cell(table, "%s", passes ? "pass" : "FAIL");
    table_mark(table, passes ? MARK_GOOD : MARK_FAIL);
    table_cell(table, finding->ties ? "%zu" : "%.0zu", finding->ties);
    table_cell(table, "%s", finding->values == 0 ? "no value was compared" : finding->worst > 0 ? finding->at : "");
}

static void print_cases(const struct glint_selftest_group *group, bool list) {
    static const char *const listed[] = {"<case", ">bound", "<", "<property: reason for the bound", NULL};
    static const char *const found[] = {"<case", ">worst", ">bound", "<", "<", ">ties", "<worst at", NULL};
    struct table *table = table_create(list ? listed : found);
    for (size_t i = 0; i < group->count; i++)
        if (list) list_row(table, &group->cases[i]);
        else if (!group->findings[i].left_out) result_row(table, &group->cases[i], &group->findings[i]);
    if (!table_is_empty(table)) {
        printf("%s: %s\n\n", group->name, group->what);
        table_print(table, stdout);
        putchar('\n');
    }
    table_destroy(&table);
}

struct sum {
    size_t cases, failed, ties;
};

static void sum_up(struct sum *sum, const struct glint_selftest_group *group) {
    for (size_t i = 0; i < group->count; i++) {
        if (group->findings[i].left_out) continue;
        sum->cases++;
        sum->failed += !glint_selftest_passes(&group->cases[i], &group->findings[i]);
        sum->ties += group->findings[i].ties;
    }
}

static void summary_row(struct table *table, const char *name, const struct sum *sum, double seconds) {
    table_cell(table, "%s", name);
    table_cell(table, "%zu", sum->cases);
    table_cell(table, "%zu", sum->failed);
    table_cell(table, "%zu", sum->ties);
    table_cell(table, "%s", time_text(seconds));
}

static void print_summary(const struct glint_selftest *selftest, double seconds) {
    static const char *const titles[] = {"<group", ">cases", ">failed", ">ties", ">time", NULL};
    struct table *table = table_create(titles);
    struct sum all = {0};
    for (size_t g = 0; g < glint_selftest_group_count(selftest); g++) {
        const struct glint_selftest_group *group = glint_selftest_get_group(selftest, g);
        struct sum sum = {0};
        sum_up(&sum, group);
        sum_up(&all, group);
        if (sum.cases) summary_row(table, group->name, &sum, group->seconds);
    }
    summary_row(table, "all", &all, seconds);
    table_print(table, stdout);
    table_destroy(&table);
    printf("\n%s: %zu cases, %zu failed\n", glint_selftest_device(selftest)->name, all.cases, all.failed);
}

/* Repeats the failed cases at the end, with their description, so that they are easy to find. */
static void print_failed(const struct glint_selftest_group *group) {
    for (size_t i = 0; i < group->count; i++) {
        const struct glint_selftest_case *c = &group->cases[i];
        const struct glint_selftest_finding *finding = &group->findings[i];
        if (finding->left_out || glint_selftest_passes(c, finding)) continue;
        printf("FAIL %s, %s (%s): %s %s, bound %s (%s); %s\n", group->name, c->name, c->what,
               number_text(finding->worst), unit_of(c), number_text(c->bound), c->reason,
               finding->values ? finding->at : "no value was compared");
    }
}

static void print_tables(const struct glint_selftest *selftest, bool list, double seconds, size_t failed) {
    const size_t count = glint_selftest_group_count(selftest);
    for (size_t g = 0; g < count; g++) print_cases(glint_selftest_get_group(selftest, g), list);
    if (list) return;
    for (size_t g = 0; g < count; g++) print_failed(glint_selftest_get_group(selftest, g));
    if (failed) putchar('\n');
    print_summary(selftest, seconds);
}

/* ---- JSON ---- */

static json_t *case_json(const struct glint_selftest_group *group, size_t i, bool list) {
    const struct glint_selftest_case *c = &group->cases[i];
    const struct glint_selftest_finding *finding = &group->findings[i];
    json_t *object = json_pack("{s:s, s:s, s:s, s:s, s:f, s:s}", "group", group->name, "name", c->name, "what", c->what,
                               "unit", c->unit, "bound", c->bound, "reason", c->reason);
    if (c->source) json_object_set_new(object, "evaluated", json_string(c->source));
    if (list) return object;
    json_object_set_new(object, "pass", json_boolean(glint_selftest_passes(c, finding)));
    json_object_set_new(object, "worst", json_number(finding->worst)); /* null: infinite */
    json_object_set_new(object, "values", json_integer((json_int_t)finding->values));
    json_object_set_new(object, "ties", json_integer((json_int_t)finding->ties));
    if (finding->worst > 0) json_object_set_new(object, "worst_at", json_string(finding->at));
    return object;
}

static json_t *group_json(const struct glint_selftest_group *group, const struct sum *sum, bool list) {
    json_t *object =
        json_pack("{s:s, s:s, s:I}", "name", group->name, "what", group->what, "cases", (json_int_t)sum->cases);
    if (!list) json_object_set_new(object, "failed", json_integer((json_int_t)sum->failed));
    if (!list) json_object_set_new(object, "seconds", json_real(group->seconds));
    return object;
}

static enum status print_document(const struct glint_selftest *selftest, bool list, double seconds, size_t failed) {
    json_t *json = json_object(), *groups = json_array(), *cases = json_array();
    for (size_t g = 0; g < glint_selftest_group_count(selftest); g++) {
        const struct glint_selftest_group *group = glint_selftest_get_group(selftest, g);
        struct sum sum = {0};
        sum_up(&sum, group);
        if (sum.cases) json_array_append_new(groups, group_json(group, &sum, list));
        for (size_t i = 0; i < group->count; i++)
            if (!group->findings[i].left_out) json_array_append_new(cases, case_json(group, i, list));
    }
    if (!list) {
        json_object_set_new(json, "device", json_string(glint_selftest_device(selftest)->name));
        json_object_set_new(json, "seconds", json_real(seconds));
        json_object_set_new(json, "failed", json_integer((json_int_t)failed));
    }
    json_object_set_new(json, "groups", groups);
    json_object_set_new(json, "cases", cases);
    return print_json(json);
}

static enum status report(const struct glint_selftest *selftest, const struct arguments *a, double seconds) {
    struct sum all = {0};
    for (size_t g = 0; !a->list && g < glint_selftest_group_count(selftest); g++)
        sum_up(&all, glint_selftest_get_group(selftest, g));
    const enum status status = all.failed ? STATUS_CHECK : STATUS_DONE;
    if (!a->json) {
        print_tables(selftest, a->list, seconds, all.failed);
        return status;
    }
    const enum status printed = print_document(selftest, a->list, seconds, all.failed);
    return status ? status : printed;
}

static double seconds_since(const struct timespec *start) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - start->tv_sec) + 1e-9 * (double)(now.tv_nsec - start->tv_nsec);
}

static bool run_cases(struct glint_selftest *selftest, const struct arguments *a, struct glint_error *err) {
    const struct glint_selftest_options run_options = {a->device, a->passes, a->quick};
    struct progress progress = {0};
    progress_begin(&progress);
    progress_phase(&progress, "cases");
    const bool ok = glint_selftest_run(selftest, &run_options, progress_report, &progress, err);
    progress_end(&progress);
    return ok;
}

/* That a device cannot be tested is another result than that it computes wrongly. */
static enum status fail(const struct glint_error *err) {
    const enum status status = command_fail(&cmd_selftest, err);
    return status == STATUS_CHECK ? STATUS_NOT_RUN : status;
}

static enum status cmd_selftest_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct timespec start;
    command_parse(&cmd_selftest, argc, argv, &a);
    clock_gettime(CLOCK_MONOTONIC, &start);
    struct glint_selftest *selftest = glint_selftest_create(list_or_null(&a.only), &err);
    const bool ok = selftest && (a.list || run_cases(selftest, &a, &err));
    const enum status status = ok ? report(selftest, &a, seconds_since(&start)) : fail(&err);
    glint_selftest_destroy(&selftest);
    list_free(&a.only);
    return status;
}

const struct command cmd_selftest = {
    .name = "selftest",
    .arguments = "",
    .summary = "test this machine's device on difficult cases, each with a stated bound",
    .description =
        "Tests how a device executes the shaders. Each case states a property with a bound: the table shows the "
        "largest error, the bound, and the input with the largest error; --list shows the property and the reason "
        "for the bound. Groups: functions (shared shader functions, over dense tables with 0, poles and infinity, "
        "compared with double precision on the exact inputs of the device; decoding of captures), geometry (rays "
        "through difficult geometry), numbers (positions far from the origin, other depths and projections), garbage "
        "(invalid pixels do not affect others), sizes (images and cube maps of any size), time (history and noise "
        "over consecutive frames), invariance (one scene under every convention). An ULP is the distance between "
        "neighbouring floats at the expected value. Where the reason for a bound is the precision that Vulkan "
        "guarantees, a conforming device may reach the bound. Ties are decisions, such as hit or miss, that are "
        "within rounding of the opposite result. Failed cases are repeated at the end with their description. The "
        "exit status is 1 if a case fails and 2 if the cases could not be run, such as without a device.",
    .options = options,
    .targets = targets,
    .parse = cmd_selftest_parse,
    .examples = examples,
    .run = cmd_selftest_run,
};
