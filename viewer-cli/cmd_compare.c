/* glint compare: compares presets on the same captures. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "compare/compare.h"
#include "draw/page/page.h"
#include "io/pipe.h"
#include "draw/view/png_file.h"
#include "io/output.h"
#include "options/effect_args.h"
#include "options/pipeline_args.h"
#include "record.h"

struct arguments {
    struct list captures, presets, settings;
    const char *out, *device, *effect;
    uint32_t rounds, limit_s;
    bool json, every; /* every: no presets are named */
};

enum { KEY_PRESETS = 256, KEY_REPEAT };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",  'o',         "FOLDER",     0, "Folder for the table (table.json, table.csv), a sheet of pictures (sheet.png) and a page (index.html)", 0},
    {"presets", KEY_PRESETS, "PRESET|FILE,...", 0, "Presets to compare (default: all but reference), of ", 0},
    EFFECTS_OPTION,
    {"set",     KEY_SET,     "PRESET:SLOT.PARAM=VALUE", 0, "Set a parameter of one preset; glint passes SLOT lists them", 0},
    {"repeat",  KEY_REPEAT,  "N",          0, "Timed rounds; every round runs each preset once (default 3)", 0},
    DEVICE_OPTION, LIMIT_OPTION,
    {"json",    'j',         NULL,         0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint compare street.exr", "compares all presets: error, coverage, steps, time"},
    {"glint compare street.exr room.exr --presets mafia3,kf2 -o compared",
     "compares two presets on two scenes, with pictures"},
    {"glint compare street.exr --presets mafia3,mine.json --repeat 20", "compares a preset file with another preset"},
    {"glint compare street.exr --presets kf2,mafia3 --set kf2:resolve.blur=0", "changes one parameter of a preset"},
    {"glint sample street -o street.exr --truth 16", "makes a capture with a truth, which errors need"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED('d', struct arguments, device),
    STORED_NUMBER(KEY_DISPATCH_LIMIT, struct arguments, limit_s, 1, UINT32_MAX),
    STORED('j', struct arguments, json),
    STORED_NAMES(KEY_PRESETS, struct arguments, presets),
    STORED(KEY_EFFECT, struct arguments, effect),
    STORED(KEY_SET, struct arguments, settings),
    STORED_NUMBER(KEY_REPEAT, struct arguments, rounds, 1, 100000),
    STORED_CAPTURES(struct arguments, captures),
    {0},
};

static char *cmd_compare_values(int key) {
    const char *names[64] = {NULL};
    for (size_t i = 0; i < sizeof names / sizeof *names - 1 && glint_preset(i); i++) names[i] = glint_preset(i);
    return key == KEY_PRESETS ? join_names("", names) : NULL;
}

static error_t cmd_compare_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    (void)arg;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    a->every = a->presets.count == 0;
    for (size_t i = 0; a->every && glint_preset(i); i++)
        if (strcmp(glint_preset(i), "reference") != 0) list_add(&a->presets, glint_preset(i), state);
    return 0;
}

static bool write_table(const char *folder, const struct contest_table *table, struct glint_error *err) {
    char json_path[4096], csv_path[4096];
    if (snprintf(json_path, sizeof json_path, "%s/table.json", folder) >= (int)sizeof json_path ||
        snprintf(csv_path, sizeof csv_path, "%s/table.csv", folder) >= (int)sizeof csv_path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    json_t *json = contest_json(table);
    char *text = json ? record_text(json, JSON_INDENT(1)) : NULL, *csv = contest_csv(table);
    bool ok = text && csv ? output_text(json_path, text, err) && output_text(csv_path, csv, err)
                          : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(csv);
    free(text);
    json_decref(json);
    return ok;
}

static bool write_all(const char *folder, const struct contest_table *table, const struct sheet *sheet,
                      const struct contest_pictures *pictures, struct glint_error *err) {
    struct picture picture = {0};
    char path[4096];
    if (snprintf(path, sizeof path, "%s/sheet.png", folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    bool ok = write_table(folder, table, err) && sheet_lay_out(&picture, sheet, err) &&
              png_file_write(path, &picture, err) && contest_write_page(folder, table, pictures, err);
    picture_finish(&picture);
    return ok;
}

static bool run_capture(struct contest *contest, const char *path, struct showing *showings,
                        struct contest_pictures *pictures, struct glint_error *err) {
    struct pipe pipe;
    const char *file = pipe_input(&pipe, path, err);
    struct glint_capture *capture = file ? glint_capture_open(file, NULL, err) : NULL;
    bool ok = capture && contest_run(contest, capture, showings, pictures, err);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    return ok;
}

/* Prints all failures to stderr. */
static enum status report_failures(const struct contest_table *table) {
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < table->capture_count * table->contest->count; i++) {
        const struct showing *s = &table->showings[i];
        if (s->ran) continue;
        command_note(&cmd_compare, "%s: preset %s: %s", table->captures[i / table->contest->count],
                     table->contest->contestants[i % table->contest->count].label, s->failure);
        status = STATUS_CHECK;
    }
    return status;
}

static bool make_folders(const char *folder, struct glint_error *err) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/pictures", folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    return glint_make_folder(path, err);
}

/* Each capture gets the same share of the sheet and of the page. */
static struct contest_pictures *begin_pictures(const struct arguments *a, const struct glint_effect *effect,
                                               const char *folder, struct sheet *sheet, uint32_t columns,
                                               struct glint_error *err) {
    const size_t count = a->captures.count, cells = CONTEST_ROWS * (size_t)columns;
    struct contest_pictures *pictures = calloc(count, sizeof *pictures);
    if (!pictures) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!pictures || !sheet_init(sheet, columns, CONTEST_ROWS * (uint32_t)count, err) || !make_folders(folder, err)) {
        free(pictures);
        return NULL;
    }
    for (size_t i = 0; i < count; i++)
        pictures[i] = (struct contest_pictures){.effect = effect,
                                                .cells = &sheet->cells[i * cells],
                                                .columns = columns,
                                                .capture = i,
                                                .folder = folder,
                                                .values_bytes = PAGE_VALUE_BYTES / (count * cells),
                                                .rows = json_pack("[[], [], []]")};
    return pictures;
}

/* FOLDER, or FOLDER/EFFECT when there are several. */
static bool effect_folder(const struct arguments *a, const struct glint_effect *effect, bool several, char path[4096],
                          struct glint_error *err) {
    path[0] = '\0';
    if (!a->out) return true;
    return snprintf(path, 4096, "%s%s%s", a->out, several ? "/" : "", several ? effect->name : "") < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", a->out);
}

/* Compares the results of one effect; `json` collects it, or is NULL. */
static enum status compare(struct contest *contest, const struct arguments *a, bool several, json_t *json,
                           struct glint_error *err) {
    char folder[4096];
    struct sheet sheet = {0};
    struct progress progress;
    struct contest_pictures *pictures = NULL;
    struct showing *showings = calloc(a->captures.count * contest->count + 1, sizeof *showings);
    const struct contest_table table = {contest, a->captures.items, showings, a->captures.count};
    bool ok = (showings || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
              effect_folder(a, contest->effect, several, folder, err);
    if (ok && a->out)
        ok = (pictures = begin_pictures(a, contest->effect, folder, &sheet, (uint32_t)contest->count + 1, err)) != NULL;
    progress_begin(&progress);
    struct missing missing = {0};
    contest->progress = &progress;
    contest->missing = &missing;
    for (size_t i = 0; ok && i < a->captures.count; i++)
        ok = run_capture(contest, a->captures.items[i], &showings[i * contest->count], pictures ? &pictures[i] : NULL,
                         err);
    if (ok && a->out) ok = write_all(folder, &table, &sheet, pictures, err);
    progress_end(&progress);
    enum status status = ok ? STATUS_DONE : command_fail(&cmd_compare, err);
    missing_note(&cmd_compare, &missing, 0);
    if (ok && json) json_array_append_new(json, contest_json(&table));
    else if (ok) contest_print(&table);
    if (ok && status == STATUS_DONE) status = report_failures(&table);
    for (size_t i = 0; showings && i < a->captures.count * contest->count; i++) showing_finish(&showings[i]);
    for (size_t i = 0; pictures && i < a->captures.count; i++) json_decref(pictures[i].rows);
    free(showings);
    free(pictures);
    sheet_finish(&sheet);
    return status;
}

/* One effect after the other. JSON is an object if there is one, else a list of them. */
static enum status compare_all(struct contest *contest, const struct arguments *a, struct glint_error *err) {
    const struct glint_effect *effects[EFFECTS_MAX];
    const struct glint_pipeline **pipelines = calloc(contest->all_count + 1, sizeof *pipelines);
    for (size_t i = 0; pipelines && i < contest->all_count; i++) pipelines[i] = contest->all[i].pipeline;
    const struct effect_search search = {a->effect, pipelines, contest->all_count, false, &a->captures};
    const size_t count = pipelines ? effects_find(&search, effects, err) : 0;
    free(pipelines);
    if (!count) return command_fail(&cmd_compare, err);
    json_t *json = a->json ? json_array() : NULL;
    enum status status = STATUS_DONE;
    for (size_t e = 0; e < count && status != STATUS_INTERRUPTED; e++) {
        contest_judge(contest, effects[e]);
        if (count > 1 && !json) printf("%s%s\n\n", e ? "\n" : "", effects[e]->title);
        const enum status own = compare(contest, a, count > 1, json, err);
        if (own > status) status = own;
    }
    if (!json) return status;
    const size_t compared = json_array_size(json);
    json_t *printed = count > 1 ? json_incref(json) : json_incref(json_array_get(json, 0));
    json_decref(json);
    const enum status shown = compared ? print_json(printed) : status;
    return shown > status ? shown : status;
}

static enum status cmd_compare_run(int argc, char **argv) {
    struct arguments a = {.rounds = 3};
    command_parse(&cmd_compare, argc, argv, &a);
    struct glint_error err = {0};
    struct contest contest = {.rounds = a.rounds, .join = a.every, .skip = !a.effect};
    const struct glint_device_options device = {.select = a.device, .dispatch_limit_s = a.limit_s};
    bool ok = contest_begin(&contest, a.presets.items, &a.settings, &err);
    if (ok) pipeline_note_fog(&cmd_compare, contest.all[0].pipeline, captures_fogged(&a.captures));
    ok = ok && (contest.device = glint_device_create(&device, &err)) != NULL;
    struct glint_folder_lock *lock = NULL;
    ok = ok && (!a.out || (lock = glint_folder_lock(a.out, &err)));
    enum status status = ok ? compare_all(&contest, &a, &err) : command_fail(&cmd_compare, &err);
    glint_folder_unlock(&lock);
    contest_finish(&contest);
    glint_device_destroy(&contest.device);
    list_free(&a.captures);
    list_free(&a.presets);
    list_free(&a.settings);
    return status;
}

const struct command cmd_compare = {
    .name = "compare",
    .arguments = "F... --presets A,B,...",
    .summary = "compare presets on the same captures",
    .description =
        "Runs several presets on captures and prints for each: the error of an effect's result against the truth in "
        "the "
        "capture, the coverage (the share of pixels for which the preset finds one), separately for the effect's "
        "classes of pixels, such as mirror-like, glossy and rough surfaces, the end reasons, steps and texture fetches "
        "of rays, and the time of "
        "all passes, measured in alternating rounds. Passes that a scene does not need are not run, and listed. Fog "
        "is off, because the truth has none. Without --presets, presets that make the result by the same passes are "
        "measured once, and have the time of the first. Several effects are compared one after the other, each with "
        "its own table of the presets that make it, or in a folder FOLDER/EFFECT of its own.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_compare_parse,
    .examples = examples,
    .values = cmd_compare_values,
    .run = cmd_compare_run,
};
