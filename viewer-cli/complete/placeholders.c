/* Completion: what the placeholders of the help stand for. */
#include "complete/complete.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "batch/studied.h"
#include "draw/view/source.h"
#include "glint/declarations.h"
#include "glint/edit.h"
#include "glint/exr.h"
#include "glint/replay.h"
#include "glint/samples.h"
#include "options/pass_names.h"

enum { TEXT = 512 };

static void offer_before(struct completion *c, const char *name, char end, const char *about) {
    char text[TEXT];
    snprintf(text, sizeof text, "%s%c", name, end);
    complete_offer(c, text, about);
}

/* Continues after the first `end` in the word, if there is one. */
static bool finish_part(struct completion *c, char end) {
    const char *at = strchr(c->typed, end);
    if (at) complete_finish(c, (size_t)(at + 1 - c->typed));
    return at != NULL;
}

static void ask_shell(struct completion *c, const char *what) {
    printf(":%s\t%s\n", what, c->before);
}

static void folders(struct completion *c) {
    ask_shell(c, "folders");
}

static void scenes(struct completion *c) {
    size_t count = 0;
    const struct glint_sample *all = glint_samples(&count);
    for (size_t i = 0; i < count; i++) complete_offer(c, all[i].name, all[i].summary);
}

/* The commands that glint batch cuts into shards. */
static void sharded(struct completion *c) {
    for (size_t i = 0; i < command_count; i++)
        if (batch_studied(commands[i]->name)) complete_offer(c, commands[i]->name, commands[i]->summary);
}

static void effects(struct completion *c) {
    size_t count = 0;
    const struct glint_effect *all = glint_effects(&count);
    for (size_t i = 0; i < count; i++) complete_offer(c, all[i].name, all[i].title);
}

/* The built-in ones and those of $GLINT_PRESETS. */
static void presets(struct completion *c) {
    for (size_t i = 0; glint_preset(i); i++) complete_offer(c, glint_preset(i), "built-in preset");
    const char *folder = getenv("GLINT_PRESETS");
    DIR *list = folder ? opendir(folder) : NULL;
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        char name[256];
        const size_t length = strlen(entry->d_name);
        if (length < 6 || strcmp(entry->d_name + length - 5, ".json") != 0) continue;
        snprintf(name, sizeof name, "%.*s", (int)length - 5, entry->d_name);
        complete_offer(c, name, "preset of $GLINT_PRESETS");
    }
    if (list) closedir(list);
}

/* ---- Passes ---- */

typedef void (*pass_offer)(struct completion *c, const struct glint_pass *pass);

static void each_pass(struct completion *c, pass_offer offer) {
    size_t count = 0;
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < count; i++) offer(c, &all[i]);
}

static void offer_slot(struct completion *c, const struct glint_pass *pass) {
    complete_offer(c, pass->slot, pass->effect);
}

/* Passes of the survey are in no pipeline. */
static void offer_slot_before(struct completion *c, const struct glint_pass *pass, char end) {
    if (strcmp(pass->effect, "survey") != 0) offer_before(c, pass->slot, end, pass->effect);
}

static void offer_slot_equals(struct completion *c, const struct glint_pass *pass) {
    offer_slot_before(c, pass, '=');
}

static void offer_slot_dot(struct completion *c, const struct glint_pass *pass) {
    offer_slot_before(c, pass, '.');
}

static void offer_group(struct completion *c, const struct glint_pass *pass) {
    complete_offer(c, pass->effect, glint_effect_find(pass->effect) ? "effect" : "shared by effects");
}

static void offer_pass(struct completion *c, const struct glint_pass *pass) {
    char text[TEXT];
    snprintf(text, sizeof text, "%s/%s", pass->slot, pass->variant);
    if (strchr(c->typed, '/')) complete_offer(c, text, pass->title);
    else offer_slot(c, pass);
}

static void slots(struct completion *c) {
    each_pass(c, offer_slot);
}

static void groups(struct completion *c) {
    each_pass(c, offer_group);
}

static void passes(struct completion *c) {
    each_pass(c, offer_pass);
}

/* SLOT=FILE */
static void slot_files(struct completion *c) {
    if (finish_part(c, '=')) ask_shell(c, "files");
    else each_pass(c, offer_slot_equals);
}

static bool is_slot(const char *name, const char *text, char end) {
    const size_t length = strlen(name);
    return !strncmp(name, text, length) && text[length] == end;
}

static void variants(struct completion *c) {
    const char *slot = c->typed;
    size_t count = 0;
    const struct glint_pass *all = glint_passes(&count);
    if (!finish_part(c, '=')) {
        each_pass(c, offer_slot_equals);
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (is_slot(all[i].slot, slot, '=')) complete_offer(c, all[i].variant, all[i].title);
    complete_offer(c, GLINT_NO_VARIANT, "leaves the slot out");
}

static void offer_values(struct completion *c, const struct glint_pass *pass, const struct glint_row *row) {
    char about[TEXT];
    if (row->choices)
        for (size_t i = 0; row->choices[i]; i++)
            complete_offer(c, row->choices[i], i == (size_t)row->initial ? "default" : NULL);
    else if (row->type == GLINT_VALUE_BOOL) {
        complete_offer(c, "true", row->initial != 0 ? "default" : NULL);
        complete_offer(c, "false", row->initial == 0 ? "default" : NULL);
    } else {
        snprintf(about, sizeof about, "default of %s, %s to %s", pass->variant, value_text(row, row->lowest),
                 value_text(row, row->highest));
        complete_offer(c, value_text(row, row->initial), about);
    }
}

/* SLOT.PARAM=VALUE; pipeline.PARAM is the parameter of every pass that has it. */
static void parameters(struct completion *c) {
    const char *slot = c->typed;
    size_t count = 0;
    const struct glint_pass *all = glint_passes(&count);
    if (!finish_part(c, '.')) {
        each_pass(c, offer_slot_dot);
        complete_offer(c, "pipeline.", "in all passes that have it");
        return;
    }
    const char *name = c->typed;
    const bool valued = finish_part(c, '=');
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < all[i].row_count && (is_slot(all[i].slot, slot, '.') || is_slot("pipeline", slot, '.'));
             r++) {
            const struct glint_row *row = &all[i].rows[r];
            if (!glint_row_is_parameter(row)) continue;
            if (!valued) offer_before(c, row->name, '=', row->help);
            else if (is_slot(row->name, name, '=')) offer_values(c, &all[i], row);
        }
    if (is_slot("pipeline", slot, '.') && !valued) complete_offer(c, "rays=", "rays a pixel");
}

/* PRESET:SLOT.PARAM=VALUE */
static void preset_parameters(struct completion *c) {
    if (finish_part(c, ':')) {
        parameters(c);
        return;
    }
    for (size_t i = 0; glint_preset(i); i++) offer_before(c, glint_preset(i), ':', "built-in preset");
}

/* ---- What is in files ---- */

static void run_images(struct completion *c, struct glint_run *run) {
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        complete_offer(c, image->name, image->meaning);
    }
}

/* The images of the runs among the words; those that passes declare, if none is there. */
static void images(struct completion *c) {
    size_t found = 0, count = 0;
    for (size_t i = 1; i < c->count; i++) {
        struct glint_run *run = glint_run_open(c->words[i], NULL);
        if (run) run_images(c, run);
        found += run != NULL;
        glint_run_close(&run);
    }
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < count && !found; i++)
        for (size_t r = 0; r < all[i].row_count; r++)
            if (glint_row_is_output(&all[i].rows[r])) complete_offer(c, all[i].rows[r].name, all[i].rows[r].help);
}

static void offer_parts(struct completion *c, const struct glint_exr *exr) {
    for (size_t i = 0; exr && i < glint_exr_part_count(exr); i++)
        if (glint_exr_part(exr, i)->name[0]) complete_offer(c, glint_exr_part(exr, i)->name, "part");
}

/* The parts of the captures among the words, and after a colon their channels. */
static void parts(struct completion *c) {
    const char *part = c->typed;
    const bool named = finish_part(c, ':');
    for (size_t w = 1; w < c->count; w++) {
        struct glint_exr *exr = glint_exr_open(c->words[w], NULL, NULL);
        if (!named) offer_parts(c, exr);
        for (size_t i = 0; exr && named && i < glint_exr_part_count(exr); i++) {
            const struct glint_exr_part_info *info = glint_exr_part(exr, i);
            for (size_t k = 0; is_slot(info->name, part, ':') && k < info->channel_count; k++)
                complete_offer(c, info->channels[k].name, "channel");
        }
        glint_exr_close(&exr);
    }
}

/* A file or a run; after a colon the images of a run, or the parts of a file. */
static void contents(struct completion *c) {
    char *part, *layer, *path = source_split(c->typed, &part, &layer);
    const char *colon = path && c->typed[strlen(path)] == ':' ? c->typed + strlen(path) : NULL;
    struct stat info;
    if (colon && stat(path, &info) == 0) {
        complete_finish(c, strlen(path) + 1);
        struct glint_run *run = S_ISDIR(info.st_mode) ? glint_run_open(path, NULL) : NULL;
        struct glint_exr *exr = S_ISREG(info.st_mode) ? glint_exr_open(path, NULL, NULL) : NULL;
        if (run) run_images(c, run);
        offer_parts(c, exr);
        glint_run_close(&run);
        glint_exr_close(&exr);
    } else ask_shell(c, "files");
    free(path);
}

/* [PART:]KEY=VALUE */
static void keys(struct completion *c) {
    struct glint_edit_key key;
    const char *name;
    const char *typed = c->typed;
    const bool valued = finish_part(c, '=');
    for (size_t i = 0; glint_edit_key(i, &key); i++) {
        if (!valued) offer_before(c, key.name, '=', key.meaning);
        else if (is_slot(key.name, typed, '='))
            for (size_t k = 0; (name = glint_edit_value_name(i, k)) != NULL; k++) complete_offer(c, name, NULL);
    }
}

/* ---- Placeholders ---- */

static const struct {
    const char *name;
    void (*complete)(struct completion *c);
} kinds[] = {
    {"EFFECT", effects},
    {"GROUP", groups},
    {"PRESET", presets},
    {"SCENE", scenes},
    {"SLOT", slots},
    {"SLOT[/VARIANT]", passes},
    {"SLOT=VARIANT", variants},
    {"SLOT=FILE", slot_files},
    {"SLOT.PARAM=VALUE", parameters},
    {"NAMES=VALUES", parameters},
    {"NAME[=VALUES]", parameters},
    {"PRESET:SLOT.PARAM=VALUE", preset_parameters},
    {"IMAGE", images},
    {"PART", parts},
    {"PART[:CHANNEL]", parts},
    {"[PART:]KEY=VALUE", keys},
    {"COMMAND", sharded},
    {"F", contents},
    {"A", contents},
    {"B", contents},
    {"F|RUN", contents},
    {"FILE|RUN", contents},
    {"RUN", folders},
    {"RUN|STUDY", folders},
    {"FOLDER", folders},
    {"DIR", folders},
};

static bool complete_kind(struct completion *c, const char *name, size_t length) {
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strlen(kinds[i].name) == length && !strncmp(kinds[i].name, name, length)) {
            kinds[i].complete(c);
            return true;
        }
    return false;
}

void complete_placeholder(struct completion *c, const char *placeholder) {
    size_t length = strlen(placeholder);
    if (length > 3 && !strcmp(placeholder + length - 3, "...")) length -= 3;
    if (length > 1 && placeholder[length - 1] == ',') length--;
    if (complete_kind(c, placeholder, length)) return;
    for (const char *at = placeholder, *end = placeholder + length; at < end;) {
        const char *bar = memchr(at, '|', (size_t)(end - at));
        const size_t size = (size_t)((bar ? bar : end) - at);
        char word[TEXT];
        snprintf(word, sizeof word, "%.*s", (int)size, at);
        const struct completion here = *c; /* a kind moves the end of what is finished */
        if (complete_kind(c, at, size)) {
            const size_t count = c->offered_count;
            char **offered = c->offered;
            *c = here;
            c->offered = offered;
            c->offered_count = count;
        } else if (strstr(word, "FILE") || strstr(word, "MANIFEST") || strchr(word, '.') || !strcmp(word, "G") ||
                   !strcmp(word, "F2"))
            ask_shell(c, "files");
        else if (islower((unsigned char)word[0]) && strspn(word, "abcdefghijklmnopqrstuvwxyz_") == size)
            complete_offer(c, word, NULL);
        at += size + 1;
    }
}
