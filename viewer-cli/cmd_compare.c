/* glint compare: compares presets on the same captures. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "compare/overall.h"
#include "io/console.h"
#include "options/effect_args.h"
#include "options/pipeline_args.h"

struct arguments {
    struct list captures, presets, settings;
    const char *out, *device, *effect;
    uint32_t rounds, limit_s;
    struct shard shard;
    struct shard_record record;    /* of a shard */
    char folder[4096], result[64]; /* of a shard */
    bool json, every;              /* every: no presets are named */
};

enum { KEY_PRESETS = 256, KEY_REPEAT };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",  'o',         "FOLDER",     0, "Folder for the table (table.json, table.csv), a sheet of pictures (sheet.png) and a page (index.html). An interrupted comparison goes on from its journal there (compare.json, log.jsonl)", 0},
    {"presets", KEY_PRESETS, "PRESET|FILE,...", 0, "Presets to compare (default: all but reference), of ", 0},
    EFFECTS_OPTION,
    {"set",     KEY_SET,     "PRESET:SLOT.PARAM=VALUE", 0, "Set a parameter of one preset; glint passes SLOT lists them", 0},
    {"repeat",  KEY_REPEAT,  "N",          0, "Timed rounds; every round runs each preset once (default 3)", 0},
    SHARD_OPTION,
    DEVICE_OPTION, LIMIT_OPTION,
    {"json",    'j',         NULL,         0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint compare street.exr", "compares all presets: error, coverage, steps, time"},
    {"glint compare street.exr room.exr --presets mafia3,kf2 -o compared",
     "compares two presets on two scenes, with pictures"},
    {"glint compare frames/ --presets mafia3,mine.json -o compared",
     "compares two presets over a folder of captures: which is better, by how much, and in which it is worst"},
    {"glint compare frames/ -o compared --shard 3/8",
     "does a share of it, one of eight; glint merge compared puts them together"},
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
    if (key == KEY_SHARD) return shard_parse(&a->shard, arg, state), 0;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    survey_check(&a->shard, a->out, state);
    a->every = a->presets.count == 0;
    for (size_t i = 0; a->every && glint_preset(i); i++)
        if (strcmp(glint_preset(i), "reference") != 0) list_add(&a->presets, glint_preset(i), state);
    return 0;
}

/* Tells on stderr which captures and presets failed; of more captures than are shown whole, how many. */
static enum status report_failures(const struct contest_table *table) {
    const size_t presets = table->contest->count;
    size_t captures = 0, failed = 0;
    for (size_t c = 0; c < table->capture_count; c++) {
        const bool read = table->log->states[c] == CONTEST_DONE;
        captures += !read;
        for (size_t p = 0; read && p < presets; p++) {
            const struct showing *s = contest_showing(table, c, p);
            if (!s->ran && !table->rows)
                command_note(&cmd_compare, "%s: preset %s: %s", table->captures[c],
                             table->contest->contestants[p].label, s->failure);
            failed += !s->ran;
        }
    }
    if (captures)
        command_note(&cmd_compare, "%zu of %zu captures could not be compared", captures, table->capture_count);
    if (failed && table->rows)
        command_note(&cmd_compare, "presets failed %zu times; --json and table.csv of -o have the messages", failed);
    return captures || failed ? STATUS_CHECK : STATUS_DONE;
}

/* FOLDER, or FOLDER/EFFECT when there are several. */
static bool effect_folder(const struct arguments *a, const struct glint_effect *effect, bool several, char path[4096],
                          struct glint_error *err) {
    path[0] = '\0';
    if (!a->out) return true;
    return snprintf(path, 4096, "%s%s%s", a->out, several ? "/" : "", several ? effect->name : "") < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", a->out);
}

/* Where the JSON of several effects is a list, what goes before and after them. */
struct json_out {
    bool wanted, several;
    size_t written;
};

static void print_effect_json(struct json_out *json, const struct contest_work *work) {
    console_plain(true);
    if (json->several) fputs(json->written++ ? ",\n  " : "[\n  ", stdout);
    contest_write_json(stdout, &work->table, work->overall, 2, json->several);
    if (!json->several) putchar('\n');
}

static void print_table(const struct contest_work *work, struct json_out *json) {
    if (json->wanted) print_effect_json(json, work);
    else if (work->table.shown_count) contest_print(&work->table);
    if (!json->wanted && work->overall) contest_print_overall(&work->table, work->overall);
}

/* What goes on while effects are compared. */
struct comparing {
    struct contest *contest;
    struct arguments *a;
    const struct glint_effect *effects[EFFECTS_MAX];
    size_t count, done; /* effects, and those that were compared without an error */
    bool begun;         /* shard.json is written */
    struct json_out json;
};

/* Compares the results of one effect. The journals of several stay until all are compared. */
static enum status compare(struct comparing *c, const struct glint_effect *effect, const char *folder,
                           struct glint_error *err) {
    struct contest *contest = c->contest;
    struct contest_work work = {.captures = &c->a->captures,
                                .folder = folder[0] ? folder : NULL,
                                .shard = c->a->shard,
                                .record = c->begun ? NULL : &c->a->record,
                                .effects = c->count};
    struct progress progress;
    struct missing missing = {0};
    contest_judge(contest, effect);
    progress_begin(&progress);
    contest->progress = &progress;
    contest->missing = &missing;
    bool ok = contest_compare(contest, &work, err);
    progress_end(&progress);
    c->done += ok;
    c->begun = !work.record;
    if (ok && c->a->shard.count && c->done == c->count) ok = shard_write(&c->a->record, true, err);
    enum status status = ok ? STATUS_DONE : command_fail(&cmd_compare, err);
    if (!ok && err->code == GLINT_ERROR_INTERRUPTED) survey_note_kept(&work.log.survey);
    missing_note(&cmd_compare, &missing, 0);
    if (ok && !c->a->shard.count) {
        print_table(&work, &c->json);
        status = report_failures(&work.table);
    }
    contest_work_finish(&work, ok && c->count == 1);
    return status;
}

static size_t find_effects(struct comparing *c, struct glint_error *err) {
    const size_t presets = c->contest->all_count;
    const struct glint_pipeline **pipelines = calloc(presets + 1, sizeof *pipelines);
    for (size_t i = 0; pipelines && i < presets; i++) pipelines[i] = c->contest->all[i].pipeline;
    const struct effect_search search = {c->a->effect, pipelines, presets, false, &c->a->captures};
    if (pipelines) c->count = effects_find(&search, c->effects, err);
    free(pipelines);
    return c->count;
}

/* The last file of the last effect is what is there when all is. */
static void describe_shard(struct comparing *c, int argc, char **argv) {
    struct arguments *a = c->a;
    if (c->count > 1) snprintf(a->result, sizeof a->result, "%s/index.html", c->effects[c->count - 1]->name);
    a->record = (struct shard_record){
        .shard = a->shard, .folder = a->out, .argc = argc, .argv = argv, .result = c->count > 1 ? a->result : NULL};
}

static void remove_journals(const struct comparing *c) {
    char folder[4096];
    for (size_t e = 0; e < c->count; e++)
        if (effect_folder(c->a, c->effects[e], true, folder, NULL)) journal_remove(folder, cmd_compare.name);
}

/* One effect after the other. JSON is an object if there is one, else a list of them. */
static enum status compare_all(struct comparing *c, int argc, char **argv, struct glint_error *err) {
    const struct arguments *a = c->a;
    struct glint_folder_lock *lock = NULL;
    enum status status = STATUS_DONE;
    const bool several = find_effects(c, err) > 1;
    if (!c->count || (several && a->out && !(lock = glint_folder_lock(a->out, err))))
        return command_fail(&cmd_compare, err);
    describe_shard(c, argc, argv);
    c->json = (struct json_out){a->json, several, 0};
    for (size_t e = 0; e < c->count && status != STATUS_INTERRUPTED; e++) {
        char folder[4096];
        if (several && !a->json && !a->shard.count) printf("%s%s\n\n", e ? "\n" : "", c->effects[e]->title);
        const enum status own = effect_folder(a, c->effects[e], several, folder, err)
                                    ? compare(c, c->effects[e], folder, err)
                                    : command_fail(&cmd_compare, err);
        if (own > status) status = own;
    }
    const bool whole = c->done == c->count;
    if (a->out && whole && several && !a->shard.count) remove_journals(c);
    if (c->json.written) puts("\n]");
    glint_folder_unlock(&lock);
    if (!whole || !a->shard.count || status != STATUS_DONE) return status;
    return shard_report(&a->record, "results", c->count * a->captures.count, a->json);
}

static enum status cmd_compare_run(int argc, char **argv) {
    struct arguments a = {.rounds = 3};
    command_parse(&cmd_compare, argc, argv, &a);
    struct glint_error err = {0};
    struct contest contest = {.rounds = a.rounds, .join = a.every, .skip = !a.effect};
    const struct glint_device_options device = {.select = a.device, .dispatch_limit_s = a.limit_s};
    struct comparing comparing = {.contest = &contest, .a = &a};
    bool ok = !a.shard.count || shard_folder(&a.shard, a.out, a.folder, &err);
    if (ok && a.shard.count) a.out = a.folder;
    ok = ok && contest_begin(&contest, a.presets.items, &a.settings, &err);
    if (ok) pipeline_note_fog(&cmd_compare, contest.all[0].pipeline, captures_fogged(&a.captures));
    ok = ok && (contest.device = glint_device_create(&device, &err)) != NULL;
    enum status status = ok ? compare_all(&comparing, argc, argv, &err) : command_fail(&cmd_compare, &err);
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
        "its own table of the presets that make it, or in a folder FOLDER/EFFECT of its own. Of several captures the "
        "means "
        "over all, and over those with each tag, follow, and the differences of presets in the same captures with "
        "their "
        "95 % intervals; of more than ten, the ten with the largest errors are shown whole, and the others as rows. A "
        "capture that cannot be read is a row.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_compare_parse,
    .examples = examples,
    .values = cmd_compare_values,
    .run = cmd_compare_run,
};
