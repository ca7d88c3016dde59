/* glint check: compares runs with approved baselines. */
#include "command.h"
#include "io/console.h"
#include "check/check.h"
#include "diff/options.h"

struct arguments {
    const char *run, *baseline;
    bool approve;
    struct diff_args diff;
};

enum { KEY_BASELINE = KEY_AFTER_DIFF, KEY_APPROVE };

/* clang-format off */
static const struct argp_option options[] = {
    {"baseline", KEY_BASELINE, "DIR", 0, "The approved run, or the folder of the approved runs if RUN is a folder of runs", 0},
    {"approve",  KEY_APPROVE,  NULL,  0, "Print what changed, and make RUN the new baseline; the previous one is kept as DIR~", 0},
    DIFF_OPTIONS,
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint check run --baseline approved --approve", "approves a run as the baseline"},
    {"glint check run --baseline approved", "compares a run with the baseline"},
    {"glint check run --baseline approved -fail 0.004 -failpercent 0.1 --html changed.html",
     "allows small differences, as of another driver, and writes a page with the changes"},
    {"glint check runs --baseline approved",
     "compares all runs of a folder, such as those of glint replay shots/room.0*.exr -o runs"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_BASELINE, struct arguments, baseline),
    STORED(KEY_APPROVE, struct arguments, approve),
    DIFF_TARGETS(struct arguments, diff),
    {0},
};

static error_t cmd_check_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->run) argp_error(state, "expected one run or one folder of runs, found also %s", arg);
        a->run = arg;
        return 0;
    case ARGP_KEY_END:
        if (!a->run) argp_error(state, "no run given");
        if (!a->baseline) argp_error(state, "no baseline given: --baseline DIR");
        return 0;
    }
    return diff_args_parse(key, arg, state, &a->diff);
}

/* ---- One run ---- */

struct counts {
    size_t changed, added, gone;
};

static struct counts count_pairs(const struct diff *diff) {
    struct counts counts = {0};
    for (size_t i = 0; i < diff->count; i++) {
        const struct diff_pair *pair = &diff->pairs[i];
        counts.added += !pair->a;
        counts.gone += !pair->b;
        counts.changed += pair->a && pair->b && (pair->status != DIFF_SAME || pair->difference.differing);
    }
    return counts;
}

static void say_approved(const struct arguments *a, const struct check_pair *pair, const struct counts *counts,
                         json_t *json) {
    if (json)
        json_object_set_new(json, "approved",
                            json_pack("{s:I, s:I, s:I}", "changed", (json_int_t)counts->changed, "new",
                                      (json_int_t)counts->added, "gone", (json_int_t)counts->gone));
    else if (!a->diff.quiet && pair->has_baseline)
        printf("approved: %zu images changed, %zu added, %zu removed; the previous baseline is %s~\n", counts->changed,
               counts->added, counts->gone, pair->baseline);
    else if (!a->diff.quiet) printf("approved: new baseline %s\n", name_text(pair->baseline));
}

/* While nobody writes into either folder. */
static bool compare_locked(const struct arguments *a, const char *const paths[2], struct diff *diff,
                           struct glint_error *err) {
    struct glint_folder_lock *locks[2] = {NULL};
    *diff = (struct diff){.status = DIFF_SAME};
    const bool ok = (locks[0] = glint_folder_lock_shared(paths[0], err)) &&
                    (locks[1] = glint_folder_lock_shared(paths[1], err)) &&
                    diff_args_compare(&a->diff, paths, diff, err);
    for (int i = 0; i < 2; i++) glint_folder_unlock(&locks[i]);
    return ok;
}

enum { SHOWN = 10 }; /* of more runs only those that differ are printed whole */

/* What goes on while runs are checked. */
struct checking {
    const struct arguments *a;
    bool many, whole;           /* whether there are several runs, and whether equal ones are printed, too */
    struct check_survey survey; /* of many */
    size_t written;             /* runs whose JSON was printed */
};

/* Prints the JSON of a run, and releases it: that of one as it ends, those of many as they come. */
static void print_run(struct checking *c, json_t *json) {
    console_plain(true);
    fputs(c->written++ ? ",\n    " : "{\n  \"runs\": [\n    ", stdout);
    json_put(stdout, json, 2, 4);
}

static bool is_shown(const struct checking *c, const struct diff *diff) {
    return !c->a->diff.json && !c->a->diff.quiet && (c->whole || diff->status);
}

static void print_pair(const struct checking *c, const struct check_pair *pair) {
    if (c->many) printf("%s%s\n", c->survey.count ? "\n" : "", name_text(pair->run));
}

/* Compares a run with its baseline, and approves it if requested. */
static bool check_both(struct checking *c, const struct check_pair *pair, enum diff_status *status,
                       struct glint_error *err) {
    const char *const paths[2] = {pair->baseline, pair->run};
    const struct arguments *a = c->a;
    struct diff diff;
    bool ok = compare_locked(a, paths, &diff, err);
    json_t *json = ok && a->diff.json ? diff_json(&diff) : NULL;
    const bool shown = ok && is_shown(c, &diff);
    if (shown) {
        print_pair(c, pair);
        diff_print(&diff, a->diff.verbose);
    }
    if (ok) *status = diff.status;
    const struct counts counts = count_pairs(&diff);
    if (ok && a->approve) {
        *status = DIFF_SAME;
        if ((ok = check_approve(pair->run, pair->baseline, err)) && (json || shown))
            say_approved(a, pair, &counts, json);
    }
    if (ok && c->many) ok = check_survey_add(&c->survey, pair, *status, &diff, NULL, err);
    diff_finish(&diff);
    if (json && ok) print_run(c, json);
    else json_decref(json);
    return ok;
}

/* A run or a baseline alone. */
static bool check_alone(struct checking *c, const struct check_pair *pair, enum diff_status *status,
                        struct glint_error *err) {
    const struct arguments *a = c->a;
    json_t *json = json_pack("{s:s, s:s}", "a", pair->baseline, "b", pair->run);
    const char *note = NULL;
    *status = a->approve ? DIFF_SAME : DIFF_FAIL;
    bool ok = true;
    if (!a->diff.json && !a->diff.quiet) print_pair(c, pair);
    if (a->approve && pair->has_run) {
        const struct counts none = {0};
        if ((ok = check_approve(pair->run, pair->baseline, err)))
            say_approved(a, pair, &none, a->diff.json ? json : NULL);
    } else {
        note = pair->has_run ? "there is no baseline; --approve makes it one" : "there is no run of this name";
        json_object_set_new(json, "note", json_string(note));
        command_note(&cmd_check, "%s against %s: %s", pair->run, pair->baseline, note);
    }
    json_object_set_new(json, "status", json_integer(*status));
    if (ok && c->many) ok = check_survey_add(&c->survey, pair, *status, NULL, note, err);
    if (ok && a->diff.json) print_run(c, json);
    else json_decref(json);
    return ok;
}

/* One of many that cannot be read is a row with its message, and does not end the others. */
static bool check_one(struct checking *c, const struct check_pair *pair, enum diff_status *status,
                      struct glint_error *err) {
    const bool both = pair->has_run && pair->has_baseline;
    struct glint_error own = {0};
    if (both ? check_both(c, pair, status, &own) : check_alone(c, pair, status, &own)) return true;
    if (!c->many || own.code == GLINT_ERROR_MEMORY || own.code == GLINT_ERROR_INTERRUPTED ||
        own.code == GLINT_ERROR_USAGE)
        return glint_fail(err, own.code, "%s", own.message);
    *status = diff_args_fail(&cmd_check, &own);
    if (c->a->diff.json)
        print_run(c, json_pack("{s:s, s:s, s:i, s:s}", "a", pair->baseline, "b", pair->run, "status", (int)*status,
                               "error", own.message));
    return check_survey_add(&c->survey, pair, *status, NULL, own.message, err);
}

/* ---- All runs ---- */

static bool writes_files(const struct diff_args *a) {
    return a->heat || a->beside || a->flicker || a->html;
}

static bool check_all(struct checking *c, const struct check_pairs *pairs, enum diff_status *worst,
                      struct glint_error *err) {
    if (c->many && writes_files(&c->a->diff))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "pictures and pages can be written for one run only, but %s contains %zu", c->a->run,
                          pairs->count);
    for (size_t i = 0; i < pairs->count; i++) {
        enum diff_status status = DIFF_SAME;
        if (!check_one(c, &pairs->items[i], &status, err)) return false;
        if (status > *worst) *worst = status;
    }
    return true;
}

/* What follows the runs in JSON. */
static void end_json(const struct checking *c, enum diff_status status) {
    printf("\n  ],\n  \"status\": %d", (int)status);
    json_t *survey = c->many ? check_survey_json(&c->survey) : json_object(), *value;
    const char *key;
    json_object_foreach(survey, key, value) {
        printf(",\n  \"%s\": ", key);
        json_put(stdout, json_incref(value), 2, 2);
    }
    json_decref(survey);
    puts("\n}");
}

static enum status cmd_check_run(int argc, char **argv) {
    struct arguments a = {.diff = diff_args_default()};
    struct glint_error err = {0};
    struct check_pairs pairs;
    enum diff_status status = DIFF_SAME;
    metric_args_complete(argc, argv);
    command_parse(&cmd_check, argc, argv, &a);
    struct checking c = {.a = &a};
    bool ok = check_pairs_find(&pairs, a.run, a.baseline, &err);
    c.many = pairs.count > 1;
    c.whole = pairs.count <= SHOWN || a.diff.verbose;
    ok = ok && check_all(&c, &pairs, &status, &err);
    if (!ok) status = diff_args_fail(&cmd_check, &err);
    check_survey_sort(&c.survey);
    if (c.written) end_json(&c, status);
    else if (ok && c.many && !a.diff.quiet) check_survey_print(&c.survey);
    check_survey_finish(&c.survey);
    check_pairs_finish(&pairs);
    return (enum status)status;
}

const struct command cmd_check = {
    .name = "check",
    .arguments = "RUN --baseline DIR",
    .summary = "compare a run with an approved baseline",
    .description =
        "Compares a run with an earlier, approved run: like glint diff DIR RUN, with the same limits, pictures, page "
        "and exit codes (0 equal, 1 warning, 2 failure, 3 different size, 4 unreadable). An image that only one of "
        "them contains is a failure, and so is a run without a baseline. Of a folder of runs a table lists all, the "
        "worst "
        "first; a run that cannot be read is a row of it, and of more than ten runs only those that differ are printed "
        "whole before it. --approve prints what changed and makes RUN "
        "the new baseline in one atomic step; the previous baseline is kept.",
    .options = options,
    .targets = targets,
    .one_dash = true,
    .usage_status = DIFF_USAGE,
    .parse = cmd_check_parse,
    .examples = examples,
    .values = metric_args_values,
    .run = cmd_check_run,
};
