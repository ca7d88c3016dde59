/* glint lint: the likely mistakes of an engine's dump, found from the data. */
#include <stdlib.h>
#include <string.h>

#include "args.h"
#include "lint/lint.h"
#include "pipe.h"
#include "progress.h"
#include "table.h"

struct arguments {
    const char *path, *out;
    bool json, fix;
};

enum { KEY_FIX = 256 };

/* clang-format off */
static const struct argp_option options[] = {
    {"fix",    KEY_FIX, NULL,   0, "Write a copy with the declarations that mend the findings, pixels untouched; needs -o", 0},
    {"output", 'o',     "F2",   0, "The copy that --fix writes", 0},
    {"json",   'j',     NULL,   0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint lint frame.exr", "what is likely wrong with a dump"},
    {"glint lint frame.exr --fix -o mended.exr", "with what a declaration can mend"},
    {0},
};

extern const struct command cmd_lint;

static error_t parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_FIX:
        a->fix = true;
        return 0;
    case 'o':
        a->out = arg;
        return 0;
    case 'j':
        a->json = true;
        return 0;
    case ARGP_KEY_ARG:
        if (a->path) argp_error(state, "one capture at a time");
        a->path = arg;
        return 0;
    case ARGP_KEY_END:
        if (!a->path) argp_error(state, "which capture?");
        if (a->fix != (a->out != NULL)) argp_error(state, "--fix and -o go together");
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static bool find(struct glint_capture *capture, struct lint_findings *findings, struct lint_agreement *agreement,
                 struct progress *progress, struct glint_error *err) {
    struct lint_data data;
    bool ok = lint_data_read(&data, capture, err);
    if (ok) {
        struct lint_reading reading = lint_declared(&data);
        *agreement = lint_agree(&data, &reading, NULL, 0);
        struct lint_agreement read = *agreement;
        progress_report(progress, "other readings", 0.3);
        lint_find_readings(&data, &reading, &read, findings);
        progress_report(progress, "faces", 0.8);
        lint_find_faces(&data, &reading, &read, findings);
        lint_find_values(&data, &reading, &read, findings);
    }
    lint_data_finish(&data);
    return ok;
}

static json_t *findings_json(const struct lint_findings *findings, const struct lint_agreement *agreement) {
    json_t *items = json_array(), *undecided = json_array(), *measures = json_array();
    for (size_t i = 0; i < findings->count; i++) {
        const struct lint_finding *f = &findings->items[i];
        json_array_append_new(items, json_pack("{ss ss ss ss ss sb}", "id", f->id, "what", f->what, "likelihood",
                                               f->likelihood, "evidence", f->evidence, "mend", f->mend, "fixable",
                                               f->attribute != NULL));
    }
    for (size_t i = 0; i < findings->undecided_count; i++)
        json_array_append_new(undecided, json_string(findings->undecided[i]));
    for (int m = 0; m < LINT_MEASURES; m++)
        json_array_append_new(measures, json_pack("{ss sI sf}", "what", lint_measure_names[m], "compared",
                                                  (json_int_t)agreement->count[m], "share", agreement->share[m]));
    return json_pack("{so so so}", "findings", items, "undecided", undecided, "agreement", measures);
}

static void print_findings(const char *path, const struct lint_findings *findings,
                           const struct lint_agreement *agreement) {
    static const char *const titles[] = {"<as declared, these agree", ">share", ">compared", NULL};
    struct table *table = table_create(titles);
    for (int m = 0; m < LINT_MEASURES; m++) {
        table_cell(table, "%s", lint_measure_names[m]);
        table_cell(table, agreement->count[m] ? "%.1f %%" : "–", 100 * agreement->share[m]);
        table_cell(table, "%zu", agreement->count[m]);
    }
    table_print(table, stdout);
    table_destroy(&table);
    for (size_t i = 0; i < findings->count; i++) {
        const struct lint_finding *f = &findings->items[i];
        printf("\n%s  [%s, %s]\n    %s\n    to mend: %s\n", f->what, f->id, f->likelihood, f->evidence, f->mend);
    }
    printf("\nCannot be told from the data:\n");
    for (size_t i = 0; i < findings->undecided_count; i++) printf("  - %s\n", findings->undecided[i]);
    printf("\n%s: %zu finding%s\n", path, findings->count, findings->count == 1 ? "" : "s");
}

static bool fix(const struct arguments *a, const char *path, const struct lint_findings *findings,
                struct glint_error *err) {
    size_t fixed = 0;
    if (!lint_fix(path, a->out, findings, &fixed, err)) return false;
    if (!a->json) printf("%s: %zu declaration%s changed\n", a->out, fixed, fixed == 1 ? "" : "s");
    return true;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_lint, argc, argv, &a);
    struct glint_error err = {0};
    struct progress progress;
    struct pipe pipe;
    struct lint_findings *findings = calloc(1, sizeof *findings);
    struct lint_agreement agreement;
    progress_begin(&progress);
    const char *path = pipe_input(&pipe, a.path, &err);
    struct glint_capture *capture = path ? glint_capture_open(path, NULL, &err) : NULL;
    bool ok = capture && (findings || glint_fail(&err, GLINT_ERROR_MEMORY, "out of memory")) &&
              find(capture, findings, &agreement, &progress, &err);
    progress_end(&progress);
    enum status status = ok && findings->count ? STATUS_CHECK : STATUS_DONE;
    if (ok && a.json) print_json(findings_json(findings, &agreement));
    else if (ok) print_findings(a.path, findings, &agreement);
    ok = ok && (!a.fix || fix(&a, path, findings, &err));
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    free(findings);
    return ok ? status : command_fail(&cmd_lint, &err);
}

const struct command cmd_lint = {
    .name = "lint",
    .arguments = "F",
    .summary = "the likely convention mistakes of an engine's dump",
    .description =
        "Compares what independent images of a capture say of the same surfaces (depth and normals, depth and cube "
        "maps, "
        "depth and motion, colours on screen and in cube maps), as declared and under every other reading. Where "
        "another "
        "reading agrees and the declared one does not, it says so, with the evidence, the likelihood and the "
        "declaration "
        "that would mend it. What the data alone cannot decide is listed. The exit status is 1 when anything is found.",
    .options = options,
    .parse = parse,
    .examples = examples,
    .run = run,
};
