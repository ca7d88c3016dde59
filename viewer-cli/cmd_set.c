/* glint set: changes attributes of a capture. */
#include "command.h"
#include "edit/edit.h"
#include "edit/lut.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/table.h"
#include "nearest.h"

struct arguments {
    const char *path, *out;
    struct list settings;
    bool list, json, overwrite;
    struct lut_options lut;
};

enum { KEY_LIST = 256, KEY_LUT, KEY_OCIO, KEY_DISPLAY, KEY_LUT_SIZE, KEY_LUT_STOPS };

/* clang-format off */
static const struct argp_option options[] = {
    {"output", 'o',      "G",  0, "The copy, a new file", 0},
    OVERWRITE_OPTION,
    {"list",   KEY_LIST, NULL, 0, "List all keys with what they take and mean. ", 0},
    {"json",   'j',      NULL, 0, "With --list, print JSON", 0},
    {"lut",    KEY_LUT,  "VIEW", 0, "Add the part lut, or replace it: a table of colours with which the slot grade shows the picture as glint view does with this view of the "
        "OpenColorIO configuration; built-in views: ", 0},
    {"display", KEY_DISPLAY, "NAME", 0, "With --lut: display of the configuration", 0},
    {"ocio",   KEY_OCIO, "FILE", 0, "With --lut: OpenColorIO configuration to use (default: $OCIO, else the built-in one)", 0},
    {"lut-size", KEY_LUT_SIZE, "N", 0, "With --lut: entries in a row (default 65)", 0},
    {"lut-stops", KEY_LUT_STOPS, "LOW,HIGH", 0, "With --lut: log2 of the light below which entries are evenly spaced, and above which the table ends (default -10,7)", 0},
    {0},
};
/* clang-format on */
static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_EXR),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('j', struct arguments, json),
    STORED(KEY_LIST, struct arguments, list),
    STORED(KEY_LUT, struct arguments, lut.ocio.view),
    STORED(KEY_DISPLAY, struct arguments, lut.ocio.display),
    STORED(KEY_OCIO, struct arguments, lut.ocio.config),
    STORED_NUMBER(KEY_LUT_SIZE, struct arguments, lut.size, 2, LUT_SIZE_MAX),
    {0},
};
static const struct example examples[] = {
    {"glint set frame.exr metresPerUnit=0.01 up=+z -o fixed.exr", "says that a unit is a centimetre, and z is up"},
    {"glint set frame.exr depth=reversed previous.gbuffer:depth=device -o fixed.exr",
     "declares reversed depth everywhere, but device depth in the previous frame"},
    {"glint set frame.exr cubemap.003:center=12.5,1.6,-4 cubemap:outdoor=0 -o fixed.exr",
     "moves a cube map, and declares all of them indoors"},
    {"glint set frame.exr --lut ACES -o graded.exr",
     "adds a table of colours for the slot grade: it then shows what glint view --view ACES does"},
    {"glint set frame.exr jitter= -o fixed.exr", "removes an attribute, so that its default holds"},
    {0},
};

static const char *const scope_titles[] = {[GLINT_EDIT_FRAME] = "the frame",
                                           [GLINT_EDIT_CUBEMAP] = "cubemap.NNN",
                                           [GLINT_EDIT_SKY] = "sky",
                                           [GLINT_EDIT_PROBE] = "probe.NNN",
                                           [GLINT_EDIT_PLANAR] = "planar.NNN",
                                           [GLINT_EDIT_INDIRECT] = "indirect",
                                           [GLINT_EDIT_SHADOW] = "shadow.NNN",
                                           [GLINT_EDIT_VOLUME] = "volume.NNN",
                                           [GLINT_EDIT_FROXELS] = "froxels",
                                           [GLINT_EDIT_TRUTH] = "truth.occlusion, truth.sun",
                                           [GLINT_EDIT_ENCODING] = "parts with such channels",
                                           [GLINT_EDIT_STORAGE] = "parts with the channel"};

static error_t cmd_set_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    double stops[2];
    switch (key) {
    case KEY_LUT_STOPS:
        arg_numbers("lut-stops", arg, stops, 2, state);
        if (!(stops[0] >= -64 && stops[0] < stops[1] && stops[1] <= 64))
            argp_error(state, "--lut-stops=%s: expected two increasing numbers from -64 to 64", arg);
        memcpy(a->lut.stops, stops, sizeof stops);
        return 0;
    case ARGP_KEY_ARG:
        if (!a->path) a->path = arg;
        else if (!strchr(arg, '=')) argp_error(state, "expected KEY=VALUE or PART:KEY=VALUE, found %s", arg);
        else list_add(&a->settings, arg, state);
        return 0;
    case ARGP_KEY_END:
        if (a->list) return 0;
        if (!a->path) argp_error(state, "no capture given; --list shows the keys");
        if (!a->settings.count && !a->lut.ocio.view)
            argp_error(state, "nothing to set; expected KEY=VALUE or --lut, and --list shows the keys");
        if (!a->lut.ocio.view && (a->lut.ocio.display || a->lut.ocio.config || a->lut.size != LUT_SIZE ||
                                  a->lut.stops[0] != LUT_STOPS_LOW || a->lut.stops[1] != LUT_STOPS_HIGH))
            argp_error(state, "--display, --ocio, --lut-size and --lut-stops are for --lut");
        if (!a->out) argp_error(state, "no output given; -o names the copy");
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- The keys ---- */

/* "Keys of the frame: worldToView, …. Keys of cubemap.NNN: …", for --help. */
static char *cmd_set_values(int key) {
    struct glint_edit_key k;
    if (key == KEY_LUT) return ocio_builtin_views();
    char *text = NULL;
    size_t size = 0;
    FILE *f = key == KEY_LIST ? open_memstream(&text, &size) : NULL;
    if (!f) return NULL;
    for (int scope = 0; scope <= GLINT_EDIT_STORAGE; scope++) {
        fprintf(f, "%sKeys of %s:", scope ? ". " : "", scope_titles[scope]);
        for (size_t i = 0, n = 0; glint_edit_key(i, &k); i++)
            if ((int)k.scope == scope) fprintf(f, "%s %s", n++ ? "," : "", k.name);
    }
    fclose(f);
    return text;
}

/* "up (default), down" */
static void values_text(size_t i, const char *form, char *text, size_t size) {
    const char *name;
    snprintf(text, size, "%s", glint_edit_value_name(i, 0) ? "" : form);
    for (size_t k = 0; (name = glint_edit_value_name(i, k)) != NULL; k++)
        snprintf(text + strlen(text), size - strlen(text), "%s%s", k ? ", " : "", name);
}

static enum status list_keys(bool json) {
    static const char *const titles[] = {"<key", "<on", "<value", "<meaning", NULL};
    struct glint_edit_key key;
    char values[300];
    json_t *list = json_array();
    struct table *table = json ? NULL : table_create(titles);
    for (size_t i = 0; glint_edit_key(i, &key); i++) {
        values_text(i, key.form, values, sizeof values);
        json_array_append_new(list,
                              json_pack("{ss ss ss sb ss ss}", "key", key.name, "on", scope_titles[key.scope], "value",
                                        values, "required", key.required, "unit", key.unit, "meaning", key.meaning));
        if (!table) continue;
        table_cell(table, "%s", key.name);
        table_cell(table, "%s", scope_titles[key.scope]);
        table_cell(table, "%s%s%s%s", values, *key.unit ? " (" : "", key.unit, *key.unit ? ")" : "");
        table_cell(table, "%s", key.meaning);
    }
    if (json) return print_json(json_pack("{so}", "keys", list));
    table_print(table, stdout);
    table_destroy(&table);
    json_decref(list);
    return STATUS_DONE;
}

/* ---- Settings ---- */

static const char *without_prefix(const char *key) {
    return strncmp(key, "glint.", 6) ? key : key + 6;
}

/* The name of a key, with the number that stands in `key` in place of NNN, where it has one. */
static const char *numbered(const char *known, const char *key, char text[80]) {
    const char *place = strstr(known, "NNN");
    const size_t before = place ? (size_t)(place - known) : 0;
    if (!place || strncmp(known, key, before) != 0 || strspn(key + before, "0123456789") != 3) return known;
    snprintf(text, 80, "%.*s%.3s%s", (int)before, known, key + before, place + 3);
    return text;
}

/* Whether the key is one of FORMAT.md's or an attribute of a part. */
static bool check_key(const struct glint_edit *edit, const char *key, struct glint_error *err) {
    enum { NUMBERED = 32 };
    char texts[NUMBERED][80];
    size_t used = 0;
    const struct glint_exr_part_info *part;
    struct glint_nearest near = glint_nearest_to(without_prefix(key));
    struct glint_edit_key known;
    for (size_t i = 0; glint_edit_key(i, &known); i++) {
        const char *name = used < NUMBERED ? numbered(known.name, without_prefix(key), texts[used]) : known.name;
        used += name != known.name;
        if (!strcmp(name, without_prefix(key)) && !strstr(name, "NNN")) return true;
        glint_nearest_offer(&near, name);
    }
    for (size_t p = 0; (part = glint_edit_part(edit, p)) != NULL; p++)
        for (size_t a = 0; a < part->attribute_count; a++) {
            if (!strcmp(part->attributes[a].name, key)) return true;
            if (strncmp(part->attributes[a].name, "glint.", 6) != 0)
                glint_nearest_offer(&near, part->attributes[a].name);
        }
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: no such key%s; glint set --list shows them", key,
                      glint_nearest_text(&near));
}

static bool check_part(const struct glint_edit *edit, const char *name, struct glint_error *err) {
    const struct glint_exr_part_info *part;
    struct glint_nearest near = glint_nearest_to(name);
    const size_t length = strlen(name);
    for (size_t p = 0; (part = glint_edit_part(edit, p)) != NULL; p++) {
        if (!strncmp(part->name, name, length) && (!part->name[length] || part->name[length] == '.')) return true;
        glint_nearest_offer(&near, part->name);
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "%s: the capture has no such part%s", name, glint_nearest_text(&near));
}

/* A colon in the value does not separate a part. */
static bool assign(struct glint_edit *edit, const char *setting, struct glint_error *err) {
    char *copy = strdup(setting), *value = copy ? strchr(copy, '=') : NULL;
    if (!value) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    *value++ = '\0';
    char *colon = strchr(copy, ':'), *key = colon ? colon + 1 : copy;
    if (colon) *colon = '\0';
    const bool ok = (!colon || check_part(edit, copy, err)) && check_key(edit, key, err) &&
                    glint_edit_assign(edit, colon ? copy : NULL, key, value, err);
    free(copy);
    return ok;
}

static bool assign_all(struct glint_edit *edit, const char *path, void *user, struct glint_error *err) {
    (void)path;
    const struct arguments *a = user;
    for (size_t i = 0; i < a->settings.count; i++)
        if (!assign(edit, a->settings.items[i], err)) return false;
    return !a->lut.ocio.view || lut_add(edit, &a->lut, err);
}

static enum status cmd_set_run(int argc, char **argv) {
    struct arguments a = {.lut = {.size = LUT_SIZE, .stops = {LUT_STOPS_LOW, LUT_STOPS_HIGH}}};
    command_parse(&cmd_set, argc, argv, &a);
    const enum status status = a.list ? list_keys(a.json) : edit_file(&cmd_set, a.path, a.out, assign_all, &a);
    list_free(&a.settings);
    return status;
}

const struct command cmd_set = {
    .name = "set",
    .arguments = "F [PART:]KEY=VALUE... -o G",
    .summary = "copy a capture with changed attributes",
    .description =
        "Copies a capture with changed attributes: the camera and everything else of the frame, how channels are "
        "encoded, the engine's storage formats, and the attributes of cube maps and planar maps. Keys are the names of "
        "FORMAT.md, without glint. Attributes of the frame are on gbuffer; other keys apply to every part that can "
        "have them, or, after PART:, only to the part of this name, or to those whose names begin with it (cubemap, "
        "previous). Numbers "
        "are separated by commas, matrices are written row by row, and an empty value removes the attribute. Pixels "
        "keep every bit: set changes what is said about them. The input may break rules of FORMAT.md, the copy must "
        "not: an attribute that a part must not have is removed by its whole name, such as glint.exposurE=. Other "
        "attributes that a part already has can be set by their names, too.",
    .options = options,
    .targets = targets,
    .parse = cmd_set_parse,
    .examples = examples,
    .values = cmd_set_values,
    .run = cmd_set_run,
};
