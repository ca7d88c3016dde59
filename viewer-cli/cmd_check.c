/* glint check: compares runs with approved baselines. */
#include "command.h"
#include "io/console.h"
#include "check/check.h"
#include "diff/options.h"
#include "journal/survey.h"
#include "record.h"

struct arguments {
    const char *run, *baseline;
    const char *out; /* a picture of one run, or a folder of many */
    struct shard shard;
    bool approve;
    struct diff_args diff;
};

enum { KEY_BASELINE = KEY_AFTER_DIFF, KEY_APPROVE };

/* clang-format off */
static const struct argp_option options[] = {
    {"baseline", KEY_BASELINE, "DIR", 0, "The approved run, or the folder of the approved runs if RUN is a folder of runs", 0},
    {"approve",  KEY_APPROVE,  NULL,  0, "Print what changed, and make RUN the new baseline; the previous one is kept as DIR~", 0},
    SHARD_OPTION,
    DIFF_OPTIONS("FILE.png|FOLDER", "Of one run: write " DIFF_HEAT ". Of a folder of runs: a " SURVEY_OUTPUT "; the table alone is then printed"),
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
    {"glint check runs --baseline approved -o checked",
     "keeps the result in a folder, and goes on from there when it is interrupted"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(KEY_BASELINE, struct arguments, baseline),
    STORED(KEY_APPROVE, struct arguments, approve),
    STORED('o', struct arguments, out),
    DIFF_TARGETS(struct arguments, diff),
    {0},
};

/* -o names a picture of one run, or a folder for the result of many. */
static void check_output(struct arguments *a, struct argp_state *state) {
    const bool picture = a->out && (check_is_run(a->run) || output_is(a->out, OUTPUT_PNG));
    if (picture) {
        a->diff.heat = a->out;
        a->out = NULL;
    }
    if (a->out && a->approve) argp_error(state, "--approve has no result to keep in a folder: -o");
    if (a->shard.count && picture) argp_error(state, "--shard: expected a folder of runs, and -o FOLDER");
    survey_check(&a->shard, a->out, state);
}

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
        check_output(a, state);
        return 0;
    case KEY_SHARD:
        shard_parse(&a->shard, arg, state);
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

/* Notes in the JSON of the pair that the run is the baseline now. */
static void note_approved(json_t *json, const struct counts *counts) {
    json_object_set_new(json, "approved",
                        json_pack("{s:I, s:I, s:I}", "changed", (json_int_t)counts->changed, "new",
                                  (json_int_t)counts->added, "gone", (json_int_t)counts->gone));
}

static void say_approved(const struct check_pair *pair, const struct counts *counts) {
    if (pair->has_baseline)
        printf("approved: %zu images changed, %zu added, %zu removed; the previous baseline is %s~\n", counts->changed,
               counts->added, counts->gone, pair->baseline);
    else printf("approved: new baseline %s\n", name_text(pair->baseline));
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
    struct check_pairs pairs;
    bool many, whole;         /* whether there are several runs, and whether equal ones are printed, too */
    bool text;                /* runs are printed as they come: text without a folder */
    size_t printed;           /* runs */
    struct check_survey rows; /* of many, and of those that are kept in a folder */
    size_t written;           /* runs whose JSON was printed */
};

static void print_pair(struct checking *c, const struct check_pair *pair) {
    if (c->many) printf("%s%s\n", c->printed ? "\n" : "", name_text(pair->run));
}

/* Compares a run with its baseline, and approves it if requested. The JSON of the pair; NULL with an error. */
static json_t *check_both(struct checking *c, const struct check_pair *pair, struct glint_error *err) {
    const char *const paths[2] = {pair->baseline, pair->run};
    const struct arguments *a = c->a;
    struct diff diff;
    bool ok = compare_locked(a, paths, &diff, err);
    json_t *json = ok ? diff_json(&diff) : NULL;
    const bool shown = ok && c->text && (c->whole || diff.status);
    if (shown) {
        print_pair(c, pair);
        diff_print(&diff, a->diff.verbose);
    }
    const struct counts counts = count_pairs(&diff);
    if (ok && !json) ok = fail_memory(err);
    if (ok && a->approve && (ok = check_approve(pair->run, pair->baseline, err))) {
        note_approved(json, &counts);
        if (shown) say_approved(pair, &counts);
    }
    diff_finish(&diff);
    return record_if(ok, json);
}

/* A run or a baseline alone. */
static json_t *check_alone(struct checking *c, const struct check_pair *pair, struct glint_error *err) {
    static const struct counts none;
    const bool approve = c->a->approve && pair->has_run;
    json_t *json = json_pack("{s:o, s:o}", "a", json_text(pair->baseline), "b", json_text(pair->run));
    if (c->text) print_pair(c, pair);
    if (approve && !check_approve(pair->run, pair->baseline, err)) return record_if(false, json);
    if (approve) note_approved(json, &none);
    if (approve && c->text) say_approved(pair, &none);
    if (!approve)
        record_set(&json, "note",
                   json_string(pair->has_run ? "there is no baseline; --approve makes it one"
                                             : "there is no run of this name"));
    record_set(&json, "status", json_integer(c->a->approve ? DIFF_SAME : DIFF_FAIL));
    if (!json) fail_memory(err);
    return json;
}

/* One of many that cannot be read is a line with its message, and does not end the others. */
static json_t *check_one(void *user, size_t i, struct glint_error *err) {
    struct checking *c = user;
    const struct check_pair *pair = &c->pairs.items[i];
    struct glint_error own = {0};
    json_t *json = pair->has_run && pair->has_baseline ? check_both(c, pair, &own) : check_alone(c, pair, &own);
    const bool alone = own.code != GLINT_ERROR_MEMORY && own.code != GLINT_ERROR_INTERRUPTED &&
                       own.code != GLINT_ERROR_USAGE && (c->many || c->a->out);
    if (!json && alone)
        json = json_pack("{s:o, s:o, s:i, s:o}", "a", json_text(pair->baseline), "b", json_text(pair->run), "status",
                         DIFF_FILE, "error", json_text(own.message));
    else if (!json) *err = own;
    json_t *line = json ? json_pack("{s:o}", "result", json) : NULL;
    if (!line && !err->code) fail_memory(err);
    return line;
}

/* ---- What is told of runs ---- */

/* One run of JSON that is written in pieces: that of one as it ends, those of many as they come. */
static void put_run(FILE *out, size_t i, const json_t *json) {
    fputs(i ? ",\n    " : "{\n  \"runs\": [\n    ", out);
    json_put(out, json_incref((json_t *)json), 2, 4);
}

/* What follows the runs in JSON. */
static void end_json(FILE *out, const struct checking *c, enum diff_status status) {
    fprintf(out, "\n  ],\n  \"status\": %d", (int)status);
    json_t *survey = c->many ? check_survey_json(&c->rows) : json_object(), *value;
    const char *key;
    json_object_foreach(survey, key, value) {
        fprintf(out, ",\n  \"%s\": ", key);
        json_put(out, json_incref(value), 2, 2);
    }
    json_decref(survey);
    fputs("\n}\n", out);
}

/* Says on stderr why a run was not compared. */
static void tell_failure(const struct check_pair *pair, const json_t *json) {
    const char *note = json_string_value(json_object_get(json, "note")),
               *error = json_string_value(json_object_get(json, "error"));
    struct glint_error own = {0};
    if (note) command_note(&cmd_check, "%s against %s: %s", pair->run, pair->baseline, note);
    if (!error) return;
    glint_fail(&own, GLINT_ERROR_FORMAT, "%s", error);
    command_fail(&cmd_check, &own);
}

static bool tell_run(struct checking *c, size_t i, const json_t *line, struct glint_error *err) {
    const struct check_pair *pair = &c->pairs.items[i];
    const json_t *json = json_object_get(line, "result");
    tell_failure(pair, json);
    if (c->a->diff.json && !c->a->out) {
        console_plain(true);
        put_run(stdout, c->written++, json);
    }
    c->printed++;
    return check_survey_add(&c->rows, pair, json, err);
}

/* ---- All runs ---- */

static bool writes_files(const struct diff_args *a) {
    return a->heat || a->beside || a->flicker || a->html;
}

static bool check_all(struct checking *c, struct survey *survey, struct glint_error *err) {
    if ((c->many || c->a->out) && writes_files(&c->a->diff))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "pictures and pages can be written for one run only, but %s contains %zu", c->a->run,
                          c->pairs.count);
    for (size_t i = survey->begin; i < survey->end; i++) {
        json_t *line = survey_take(survey, i, check_one, c, err);
        const bool ok = line && (survey->shard.count || tell_run(c, i, line, err) ||
                                 (!err->code && survey_fail_line(survey, i, err)));
        json_decref(line);
        if (!ok) return false;
    }
    return true;
}

static enum diff_status worst_of(const struct checking *c) {
    enum diff_status worst = DIFF_SAME;
    for (size_t i = 0; i < c->rows.count; i++)
        if (c->rows.rows[i].status > worst) worst = c->rows.rows[i].status;
    return worst;
}

/* The JSON of all runs, which are in a journal. */
static bool write_json(FILE *out, const struct checking *c, struct survey *survey, struct glint_error *err) {
    for (size_t i = 0; i < survey->count; i++) {
        json_t *line = survey_line(survey, i, err);
        if (!line) return false;
        put_run(out, i, json_object_get(line, "result"));
        json_decref(line);
    }
    end_json(out, c, worst_of(c));
    return true;
}

static bool write_result(const struct checking *c, struct survey *survey, struct glint_error *err) {
    char path[4096];
    struct output output;
    return journal_path(survey->folder, SURVEY_RESULT, path, err) && output_open(&output, path, err) &&
           output_close(&output, write_json(output.file, c, survey, err), err);
}

static enum diff_status tell_all(const struct checking *c, struct survey *survey, struct glint_error *err) {
    const struct arguments *a = c->a;
    if (a->shard.count) return (enum diff_status)shard_report(&survey->record, "runs", survey->count, a->diff.json);
    if (a->diff.json) console_plain(true);
    if (a->diff.json && a->out && !write_json(stdout, c, survey, err)) return diff_args_fail(&cmd_check, err);
    if (!a->diff.json && !a->diff.quiet && (c->many || a->out)) check_survey_print(&c->rows);
    return worst_of(c);
}

static bool check_runs(struct checking *c, struct survey *survey, int argc, char **argv, struct glint_error *err) {
    if (!check_pairs_find(&c->pairs, c->a->run, c->a->baseline, err)) return false;
    c->many = c->pairs.count > 1;
    c->whole = c->pairs.count <= SHOWN || c->a->diff.verbose;
    c->text = !c->a->diff.json && !c->a->diff.quiet && !c->a->out;
    const bool ok = survey_place(survey, c->a->out, err) && check_survey_open(survey, &c->pairs, &c->a->diff, err) &&
                    survey_begin_shard(survey, argc, argv, err) && check_all(c, survey, err) &&
                    survey_end_shard(survey, err);
    check_survey_sort(&c->rows);
    return ok && (!survey_has_result(survey) || write_result(c, survey, err));
}

static enum status cmd_check_run(int argc, char **argv) {
    struct arguments a = {.diff = diff_args_default()};
    struct glint_error err = {0};
    metric_args_complete(argc, argv);
    command_parse(&cmd_check, argc, argv, &a);
    struct checking c = {.a = &a};
    struct survey survey = {.command = &cmd_check, .item = "run", .shard = a.shard};
    const bool ok = check_runs(&c, &survey, argc, argv, &err);
    const enum diff_status status = ok ? tell_all(&c, &survey, &err) : diff_args_fail(&cmd_check, &err);
    if (!ok && err.code == GLINT_ERROR_INTERRUPTED) survey_note_kept(&survey);
    if (c.written) end_json(stdout, &c, status);
    survey_close(&survey, ok);
    check_survey_finish(&c.rows);
    check_pairs_finish(&c.pairs);
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
    .operand = "run",
    .one_dash = true,
    .usage_status = DIFF_USAGE,
    .parse = cmd_check_parse,
    .examples = examples,
    .values = metric_args_values,
    .run = cmd_check_run,
};
