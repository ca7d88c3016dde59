/* glint lint: finds likely convention mistakes of an engine's dump from the data. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "options/args.h"
#include "capture/depth_facts.h"
#include "lint/lint.h"
#include "lint/survey.h"
#include "journal/survey.h"
#include "io/pipe.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    struct list captures;
    const char *out, *copy; /* copy: the same, with --fix */
    struct shard shard;
    bool json, fix, list, markdown, overwrite;
};

enum { KEY_FIX = 256, KEY_LIST, KEY_MARKDOWN };

/* clang-format off */
static const struct argp_option options[] = {
    {"fix",      KEY_FIX,      NULL, 0, "Write a copy that fixes the certain findings: with corrected declarations, and with the sky texels of cube maps as FORMAT.md requires. All other pixels stay as they are. A fix that would make another comparison worse is left out. Needs -o", 0},
    {"list",     KEY_LIST,     NULL, 0, "List all possible findings by name", 0},
    {"markdown", KEY_MARKDOWN, NULL, 0, "Print the list as Markdown, with how each finding is measured and what corrects it", 0},
    {"output",   'o',          "F2|FOLDER", 0, "With --fix, the copy that it writes; without, a " SURVEY_OUTPUT, 0},
    SHARD_OPTION,
    OVERWRITE_OPTION,
    {"json",     'j',          NULL, 0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct arg_target targets[] = {
    STORED(KEY_FIX, struct arguments, fix),
    STORED(KEY_LIST, struct arguments, list),
    STORED('o', struct arguments, out),
    STORED_OUTPUT('o', struct arguments, copy, OUTPUT_EXR),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('j', struct arguments, json),
    STORED_CAPTURES(struct arguments, captures),
    {0},
};
static const struct example examples[] = {
    {"glint lint frame.exr", "lists the likely mistakes of a dump"},
    {"glint lint frame.exr --fix -o fixed.exr", "also writes a copy in which the certain ones are fixed"},
    {"glint lint frames/", "lists which captures of a folder have which mistakes, the worst first"},
    {"glint lint frames/ -o linted", "keeps the list in a folder, and goes on from there when it is interrupted"},
    {"glint lint --list", "lists all mistakes that it can find"},
    {"glint lint --markdown > lint.md", "writes the same with how each is measured"},
    {0},
};

/* Whether there is one capture, and not a set that may have any number of them. */
static bool is_one(const struct arguments *a) {
    return a->captures.count == 1 && !a->captures.set;
}

/* -o names a copy with --fix, else a folder. */
static void check_output(struct arguments *a, struct argp_state *state) {
    if (a->fix && !a->out) argp_error(state, "--fix and -o F2 must be used together");
    if (a->fix && !is_one(a)) argp_error(state, "--fix: expected one capture");
    if (a->fix && a->shard.count) argp_error(state, "--fix writes one copy, and has no shares: --shard");
    if (!a->fix && a->out && output_is(a->out, OUTPUT_EXR))
        argp_error(state, "-o %s: expected a folder; a copy is written with --fix", a->out);
    if (a->fix) a->copy = a->out;
    survey_check(&a->shard, a->out, state);
}

static error_t cmd_lint_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_SHARD:
        shard_parse(&a->shard, arg, state);
        return 0;
    case KEY_MARKDOWN:
        a->list = a->markdown = true;
        return 0;
    case ARGP_KEY_END:
        if (!a->captures.count && !a->list)
            argp_error(state, "no capture given; --list shows what can be found in one");
        check_output(a, state);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static bool find_findings(struct glint_capture *capture, struct lint_findings *findings,
                          struct lint_agreement *agreement, struct progress *progress, struct glint_error *err) {
    struct lint_data data;
    bool ok = lint_data_read(&data, capture, err);
    if (ok) {
        struct lint_reading reading = lint_declared(&data);
        *agreement = lint_agree(&data, &reading, NULL, 0);
        struct lint_agreement read = *agreement;
        progress_report(progress, "other conventions", 0.3);
        lint_find_readings(&data, &reading, &read, findings);
        progress_report(progress, "faces", 0.8);
        lint_find_faces(&data, &reading, &read, findings);
        char text[160], line[240];
        const struct depth_facts facts = depth_facts(capture);
        depth_steps_text(&facts, text, sizeof text);
        snprintf(line, sizeof line, "%s, %s, has steps of %s", facts.storage, facts.encoding, text);
        lint_find_coarse_depth(&data, &reading, line, findings);
        lint_find_values(&data, &reading, &read, findings);
    }
    lint_data_finish(&data);
    return ok;
}

static json_t *findings_json(const struct lint_findings *findings, const struct lint_agreement *agreement,
                             const struct glint_capture *capture) {
    json_t *items = json_array(), *undecided = json_array(), *measures = json_array();
    for (size_t i = 0; i < findings->count; i++) {
        const struct lint_finding *f = &findings->items[i];
        json_t *item = json_pack("{ss ss ss ss ss sb}", "id", f->id, "what", f->what, "likelihood", f->likelihood,
                                 "evidence", f->evidence, "fix", f->remedy, "fixable", lint_is_fixable(f));
        if (f->either[0]) json_object_set_new(item, "or", json_string(f->either));
        json_array_append_new(items, item);
    }
    for (size_t i = 0; i < findings->undecided_count; i++)
        json_array_append_new(undecided, json_string(findings->undecided[i]));
    for (int m = 0; m < LINT_MEASURES; m++)
        json_array_append_new(measures, json_pack("{ss sI sf}", "what", lint_measure_names[m], "compared",
                                                  (json_int_t)agreement->count[m], "share", agreement->share[m]));
    const struct depth_facts facts = depth_facts(capture);
    return json_pack("{so so so so}", "findings", items, "undecided", undecided, "agreement", measures, "depth",
                     depth_facts_json(&facts));
}

static void print_depth(const struct glint_capture *capture) {
    const struct depth_facts facts = depth_facts(capture);
    char text[160];
    depth_steps_text(&facts, text, sizeof text);
    printf("\ndepth stored as %s, %s: steps of %s\n", facts.storage, facts.encoding, text);
}

static void print_findings(const char *path, const struct lint_findings *findings,
                           const struct lint_agreement *agreement, const struct glint_capture *capture) {
    static const char *const titles[] = {"<comparisons as declared", ">match", ">samples", NULL};
    struct table *table = table_create(titles);
    for (int m = 0; m < LINT_MEASURES; m++) {
        table_cell(table, "%s", lint_measure_names[m]);
        table_cell(table, agreement->count[m] ? "%.1f %%" : "–", 100 * agreement->share[m]);
        table_cell(table, "%zu", agreement->count[m]);
    }
    table_print(table, stdout);
    table_destroy(&table);
    print_depth(capture);
    for (size_t i = 0; i < findings->count; i++) {
        const struct lint_finding *f = &findings->items[i];
        putchar('\n');
        mark_print(strcmp(f->likelihood, "certain") ? MARK_WARN : MARK_FAIL, "%s%s%s%s", f->either[0] ? "either " : "",
                   f->what, f->either[0] ? ", or " : "", f->either);
        printf("  [%s, %s]\n    %s\n    fix: %s\n", f->id, f->likelihood, name_text(f->evidence), name_text(f->remedy));
    }
    printf("\nCannot be decided from the data:\n");
    for (size_t i = 0; i < findings->undecided_count; i++) printf("  - %s\n", name_text(findings->undecided[i]));
    putchar('\n');
    mark_print(findings->count ? MARK_FAIL : MARK_GOOD, "%s: %zu finding%s", name_text(path), findings->count,
               findings->count == 1 ? "" : "s");
    putchar('\n');
}

static bool write_fixed_copy(const struct arguments *a, const char *path, struct lint_findings *findings,
                             struct glint_error *err) {
    size_t fixed = 0;
    if (!lint_fix(path, a->copy, findings, &fixed, err)) return false;
    for (size_t i = 0; i < findings->count && !a->json; i++)
        if (lint_is_fixable(&findings->items[i]) && findings->items[i].left_out)
            printf("%s is not fixed: another comparison would match less\n", findings->items[i].id);
    if (!a->json) printf("%s: %zu finding%s fixed\n", name_text(a->copy), fixed, fixed == 1 ? "" : "s");
    return true;
}

static enum status list_findings(bool json) {
    static const char *const titles[] = {"<name", "<meaning", NULL};
    json_t *items = json_array();
    struct table *table = json ? NULL : table_create(titles);
    struct lint_known known;
    for (size_t i = 0; lint_known(i, &known); i++) {
        json_array_append_new(items, json_pack("{ss ss ss ss sb}", "id", known.id, "what", known.what, "measured",
                                               known.measured, "fix", known.remedy, "fixable",
                                               *known.attribute || known.pixels != LINT_NO_PIXELS));
        table_cell(table, "%s", known.id);
        table_cell(table, "%s", known.what);
    }
    if (json) return print_json(items);
    table_print(table, stdout);
    table_destroy(&table);
    json_decref(items);
    return STATUS_DONE;
}

static void print_introduction(void) {
    fputs("# What `glint lint` finds\n\nGenerated by `glint lint --markdown`.\n\n"
          "`glint lint` compares independent images of the same surfaces:\n\n",
          stdout);
    for (int m = 0; m < LINT_MEASURES; m++) printf("- %s\n", lint_measure_names[m]);
    fputs("\nThey are compared as the capture declares them and under every other convention in these tables. Where "
          "another "
          "convention matches and the\ndeclared one does not, this is reported as\n\n"
          "- **certain** if more than 60 % of the samples match under it and no other convention explains the data "
          "nearly as well,\n"
          "- **likely** if fewer match,\n"
          "- **possible** if another convention explains the data about as well; both are then named.\n\n"
          "Other findings are measured in one image alone, or say that two images match under no convention. `--fix` "
          "writes a copy of the capture in which\ncertain findings and a wrong up axis are corrected, where the last "
          "column says that it can, unless another comparison would match less. The copy "
          "follows every\nrule that `glint validate` checks, or none is written.\n",
          stdout);
}

/* A table for each image or attribute that the names begin with. */
static void print_handbook_of_findings(void) {
    static const char *const titles[] = {"<name", "<what is wrong", "<how it is measured", "<remedy", "<`--fix`", NULL};
    struct lint_known known, first;
    print_introduction();
    for (size_t g = 0; lint_known(g, &first); g++) {
        const size_t length = strcspn(first.id, ".") + 1;
        bool repeated = false;
        for (size_t i = 0; i < g && lint_known(i, &known); i++) repeated |= !strncmp(known.id, first.id, length);
        if (repeated) continue;
        struct table *table = table_create(titles);
        for (size_t i = g; lint_known(i, &known); i++) {
            if (strncmp(known.id, first.id, length) != 0) continue;
            table_cell(table, "`%s`", known.id);
            table_cell(table, "%s", known.what);
            table_cell(table, "%s", known.measured);
            table_cell(table, "%s", known.remedy);
            table_cell(table, "%s", *known.attribute || known.pixels != LINT_NO_PIXELS ? "yes" : "no");
        }
        printf("\n## `%.*s`\n\n", (int)length - 1, first.id);
        table_print_markdown(table, stdout);
        table_destroy(&table);
    }
}

static enum status lint_one(const struct arguments *a) {
    struct glint_error err = {0};
    struct progress progress;
    struct pipe pipe;
    struct lint_findings *findings = calloc(1, sizeof *findings);
    struct lint_agreement agreement;
    progress_begin(&progress);
    const char *path = pipe_input(&pipe, a->captures.items[0], &err);
    struct glint_capture *capture = path ? glint_capture_open(path, NULL, &err) : NULL;
    bool ok = capture && (findings || glint_fail(&err, GLINT_ERROR_MEMORY, "out of memory")) &&
              find_findings(capture, findings, &agreement, &progress, &err);
    progress_end(&progress);
    enum status status = ok && findings->count ? STATUS_CHECK : STATUS_DONE;
    if (ok && a->json) print_json(findings_json(findings, &agreement, capture));
    else if (ok) print_findings(a->captures.items[0], findings, &agreement, capture);
    ok = ok && (!a->fix || write_fixed_copy(a, path, findings, &err));
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    free(findings);
    return ok ? status : command_fail(&cmd_lint, &err);
}

/* What goes on while many captures are read. */
struct linting {
    const struct list *captures;
    struct progress *progress;
    struct lint_survey rows;
};

/* One of many captures. What cannot be read is a line of its own; NULL for what concerns all. */
static json_t *lint_capture(void *user, size_t i, struct glint_error *err) {
    struct linting *linting = user;
    struct glint_error own = {0};
    struct pipe pipe;
    struct lint_agreement agreement;
    json_t *line = NULL;
    struct lint_findings *findings = calloc(1, sizeof *findings);
    if (!findings) return fail_memory(err), NULL;
    progress_phase(linting->progress, "%zu of %zu", i + 1, linting->captures->count);
    const char *file = pipe_input(&pipe, linting->captures->items[i], &own);
    struct glint_capture *capture = file ? glint_capture_open(file, NULL, &own) : NULL;
    const bool read = capture && find_findings(capture, findings, &agreement, linting->progress, &own);
    if (!read && own.code == GLINT_ERROR_MEMORY) *err = own;
    else if (!(line = read ? lint_survey_line(findings) : lint_survey_failure(own.message))) fail_memory(err);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    free(findings);
    return line;
}

static bool take_capture(struct linting *linting, struct survey *survey, size_t i, struct glint_error *err) {
    json_t *line = survey_take(survey, i, lint_capture, linting, err);
    const bool ok =
        line && (survey->shard.count || lint_survey_add(&linting->rows, linting->captures->items[i], line, err) ||
                 (!err->code && survey_fail_line(survey, i, err)));
    json_decref(line);
    if (ok && progress_interrupted())
        return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted after %zu of %zu captures", i + 1,
                          linting->captures->count);
    return ok;
}

static enum status tell_many(const struct arguments *a, const struct survey *survey, struct linting *linting) {
    if (a->shard.count) return shard_report(&survey->record, "captures", survey->count, a->json);
    if (a->json) print_json(lint_survey_json(&linting->rows));
    else lint_survey_print(&linting->rows);
    return lint_survey_is_clean(&linting->rows) ? STATUS_DONE : STATUS_CHECK;
}

static enum status lint_many(const struct arguments *a, int argc, char **argv) {
    struct glint_error err = {0};
    struct progress progress;
    struct linting linting = {.captures = &a->captures, .progress = &progress};
    struct survey survey = {.command = &cmd_lint, .item = "capture", .shard = a->shard};
    progress_begin(&progress);
    bool ok = survey_begin_files(&survey, a->out, &a->captures, argc, argv, &err);
    for (size_t i = survey.begin; ok && i < survey.end; i++) ok = take_capture(&linting, &survey, i, &err);
    lint_survey_sort(&linting.rows);
    ok = ok && survey_end_shard(&survey, &err);
    if (ok && survey_has_result(&survey)) ok = survey_write_json(&survey, lint_survey_json(&linting.rows), &err);
    progress_end(&progress);
    const enum status status = ok ? tell_many(a, &survey, &linting) : command_fail(&cmd_lint, &err);
    if (!ok && err.code == GLINT_ERROR_INTERRUPTED) survey_note_kept(&survey);
    survey_close(&survey, ok);
    lint_survey_finish(&linting.rows);
    return status;
}

static enum status cmd_lint_run(int argc, char **argv) {
    struct arguments a = {0};
    enum status status = STATUS_DONE;
    command_parse(&cmd_lint, argc, argv, &a);
    if (a.markdown) print_handbook_of_findings();
    else if (a.list) status = list_findings(a.json);
    else status = is_one(&a) && (a.fix || !a.out) ? lint_one(&a) : lint_many(&a, argc, argv);
    list_free(&a.captures);
    return status;
}

const struct command cmd_lint = {
    .name = "lint",
    .arguments = "F...",
    .summary = "find likely convention mistakes of an engine's dump",
    .description =
        "Compares independent images of the same surfaces (depth and normals, depth and cube maps, depth and motion, "
        "colours on screen and in cube maps, this frame and the previous one), interpreted as the capture declares and "
        "under every other known convention. Where another convention matches and the declared one does not, this is "
        "reported with the evidence, the likelihood and the declaration that would fix it; where two conventions "
        "explain the data equally well, both are named. A convention is reported only if at least a fifth of the "
        "samples match under it, and samples whose comparison could be decided by rounding of depth or normals are "
        "skipped. The sky texels and inner volumes of cube maps and the resolution of the depth storage are checked "
        "too. What cannot be decided from the data is listed. Of several captures a table lists how many findings "
        "each has, the worst first, and how many captures have each finding; a capture that cannot be read is a row of "
        "it. The exit status is 1 when there are findings.",
    .options = options,
    .targets = targets,
    .parse = cmd_lint_parse,
    .examples = examples,
    .run = cmd_lint_run,
};
