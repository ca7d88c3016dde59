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

/* Compares a run with its baseline, and approves it if requested. */
static bool check_both(const struct arguments *a, const struct check_pair *pair, json_t *list, enum diff_status *status,
                       struct glint_error *err) {
    const char *const paths[2] = {pair->baseline, pair->run};
    struct diff diff;
    bool ok = compare_locked(a, paths, &diff, err);
    json_t *json = ok && list ? diff_json(&diff) : NULL;
    if (ok && !list && !a->diff.quiet) diff_print(&diff, a->diff.verbose);
    if (ok) *status = diff.status;
    const struct counts counts = count_pairs(&diff);
    diff_finish(&diff);
    if (ok && a->approve) {
        *status = DIFF_SAME;
        if ((ok = check_approve(pair->run, pair->baseline, err))) say_approved(a, pair, &counts, json);
    }
    if (json) json_array_append_new(list, json);
    return ok;
}

static bool check_one(const struct arguments *a, const struct check_pair *pair, json_t *list, enum diff_status *status,
                      struct glint_error *err) {
    if (pair->has_run && pair->has_baseline) return check_both(a, pair, list, status, err);
    json_t *json = json_pack("{s:s, s:s}", "a", pair->baseline, "b", pair->run);
    *status = a->approve ? DIFF_SAME : DIFF_FAIL;
    bool ok = true;
    if (a->approve && pair->has_run) {
        const struct counts none = {0};
        if ((ok = check_approve(pair->run, pair->baseline, err))) say_approved(a, pair, &none, list ? json : NULL);
    } else {
        const char *note =
            pair->has_run ? "there is no baseline; --approve makes it one" : "there is no run of this name";
        json_object_set_new(json, "note", json_string(note));
        command_note(&cmd_check, "%s against %s: %s", pair->run, pair->baseline, note);
    }
    json_object_set_new(json, "status", json_integer(*status));
    if (list) json_array_append(list, json);
    json_decref(json);
    return ok;
}

/* ---- All runs ---- */

static bool writes_files(const struct diff_args *a) {
    return a->heat || a->beside || a->flicker || a->html;
}

static bool check_all(const struct arguments *a, const struct check_pairs *pairs, json_t *list, enum diff_status *worst,
                      struct glint_error *err) {
    if (pairs->count > 1 && writes_files(&a->diff))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "pictures and pages can be written for one run only, but %s contains %zu", a->run,
                          pairs->count);
    for (size_t i = 0; i < pairs->count; i++) {
        enum diff_status status = DIFF_SAME;
        if (pairs->count > 1 && !list && !a->diff.quiet)
            printf("%s%s\n", i ? "\n" : "", name_text(pairs->items[i].run));
        if (!check_one(a, &pairs->items[i], list, &status, err)) return false;
        if (status > *worst) *worst = status;
    }
    return true;
}

static enum status cmd_check_run(int argc, char **argv) {
    struct arguments a = {.diff = diff_args_default()};
    struct glint_error err = {0};
    struct check_pairs pairs;
    enum diff_status status = DIFF_SAME;
    metric_args_complete(argc, argv);
    command_parse(&cmd_check, argc, argv, &a);
    json_t *list = a.diff.json ? json_array() : NULL;
    const bool ok = check_pairs_find(&pairs, a.run, a.baseline, &err) && check_all(&a, &pairs, list, &status, &err);
    if (!ok) status = diff_args_fail(&cmd_check, &err);
    if (ok && list) print_json(json_pack("{s:i, s:O}", "status", (int)status, "runs", list));
    json_decref(list);
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
        "them contains is a failure, and so is a run without a baseline. --approve prints what changed and makes RUN "
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
