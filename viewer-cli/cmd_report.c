/* glint report: writes runs, sweeps and other studies as one self-contained page. */
#include <stdlib.h>
#include <unistd.h>

#include "command.h"
#include "options/effect_args.h"
#include "report/shot.h"

struct arguments {
    struct list folders, images;
    const char *out, *effect;
    bool overwrite;
    uint32_t chart;
};

enum { KEY_IMAGES = 256, KEY_CHART };

/* clang-format off */
static const struct argp_option options[] = {
    {"output", 'o',        "FILE",     0, "File to write: FILE.html for the page, FILE.svg for one of its charts", 0},
    OVERWRITE_OPTION,
    {"effect", KEY_EFFECT, "EFFECT",   0, "Effect whose result, error and flicker the page of a shot shows, of those that glint passes lists (default: the first whose result the shot holds)", 0},
    {"images", KEY_IMAGES, "IMAGE,...", 0, "Images of the runs to show (default: all of full or half resolution)", 0},
    {"chart",  KEY_CHART,  "N",        0, "Number of the chart that FILE.svg contains (default 1)", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint report run -o run.html", "shows pictures, times, plan and parameters of a run"},
    {"glint report a b -o ab.html", "compares two runs"},
    {"glint report shot -o shot.html", "plays the frames of a shot, with their error and flicker"},
    {"glint report swept -o swept.html", "writes the page of a sweep"},
    {"glint report swept -o front.svg", "writes its first chart as a picture"},
    {0},
};

static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_HTML | OUTPUT_SVG),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED(KEY_EFFECT, struct arguments, effect),
    STORED_NAMES(KEY_IMAGES, struct arguments, images),
    STORED_NUMBER(KEY_CHART, struct arguments, chart, 1, 1000),
    STORED(ARGP_KEY_ARG, struct arguments, folders),
    {0},
};

static error_t cmd_report_parse(int key, char *arg, struct argp_state *state) {
    const struct arguments *a = state->input;
    (void)arg;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (!a->out) argp_error(state, "no output file given: -o FILE.html");
    return 0;
}

/* Whether the folder contains the page of a study. */
static bool has_page(const char *folder) {
    char path[4096];
    return snprintf(path, sizeof path, "%s/page.json", folder) < (int)sizeof path && access(path, F_OK) == 0;
}

static json_t *make_document(const struct arguments *a, struct glint_error *err) {
    const char *const *folders = a->folders.items;
    if (a->folders.count == 1 && has_page(folders[0])) return page_load(folders[0], err);
    if (a->folders.count == 1 && report_is_shot(folders[0])) return report_shot(folders[0], a->effect, err);
    for (size_t i = 0; i < a->folders.count; i++)
        if (has_page(folders[i]) || report_is_shot(folders[i])) {
            glint_fail(err, GLINT_ERROR_USAGE, "%s contains %s: report it separately", folders[i],
                       has_page(folders[i]) ? "the page of a study" : "the frames of a shot");
            return NULL;
        }
    return report_runs(folders, a->folders.count, list_or_null(&a->images), err);
}

/* Finds chart `number`, counted from 1; *seen counts the charts before it. */
static const json_t *find_chart(const json_t *document, uint32_t number, uint32_t *seen) {
    size_t i, k;
    json_t *section, *block;
    json_array_foreach(json_object_get(document, "sections"), i, section)
        json_array_foreach(json_object_get(section, "blocks"), k, block) {
        const json_t *chart = json_object_get(block, "chart");
        if (chart && ++*seen == number) return chart;
    }
    return NULL;
}

static bool write_chart(const struct arguments *a, const json_t *document, struct glint_error *err) {
    uint32_t count = 0;
    const json_t *chart = find_chart(document, a->chart, &count);
    if (chart) {
        struct page_charts charts = {0};
        const bool ok = page_chart_write(&charts, a->out, chart, err);
        page_charts_finish(&charts);
        return ok;
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: no chart %u: the page has %u", a->folders.items[0], a->chart, count);
}

static enum status cmd_report_run(int argc, char **argv) {
    struct arguments a = {.chart = 1};
    command_parse(&cmd_report, argc, argv, &a);
    struct glint_error err = {0};
    json_t *document = make_document(&a, &err);
    bool ok = document != NULL;
    if (ok && output_is(a.out, OUTPUT_SVG)) ok = write_chart(&a, document, &err);
    else if (ok) ok = page_write(a.out, document, a.folders.items[0], &err);
    json_decref(document);
    list_free(&a.folders);
    list_free(&a.images);
    return ok ? STATUS_DONE : command_fail(&cmd_report, &err);
}

const struct command cmd_report = {
    .name = "report",
    .arguments = "RUN|SHOT|STUDY... -o R.html",
    .summary = "write runs, a shot or a study as one self-contained page",
    .description =
        "Writes a self-contained HTML page with the pictures, times, plan, parameters and device of a run; for "
        "several runs, side by side with the differences. Studies such as sweeps keep their page in their folder; it "
        "is written again from there. A folder that glint replay wrote with several captures becomes a page that plays "
        "its "
        "frames and draws the error of an effect's result and its flicker over them. Click a picture to enlarge it, "
        "and "
        "use the arrow keys to flip through the "
        "others in place.",
    .options = options,
    .targets = targets,
    .operand = "run",
    .parse = cmd_report_parse,
    .examples = examples,
    .run = cmd_report_run,
};
