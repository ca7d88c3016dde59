/* Parses arguments. */
#include "options/args.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/console.h"
#include "nearest.h"
#include "io/memory.h"
#include "options/capture_set.h"
#include "record.h"

void list_add(struct list *list, const char *item, struct argp_state *state) {
    const char **items = realloc(list->items, (list->count + 2) * sizeof *items);
    if (!items) {
        argp_failure(state, STATUS_CHECK, ENOMEM, "arguments");
        return;
    }
    items[list->count++] = item;
    items[list->count] = NULL;
    list->items = items;
}

void list_split(struct list *list, const char *text, struct argp_state *state) {
    if (!list->pieces) list->pieces = json_array();
    for (const char *end; text; text = *end ? end + 1 : NULL) {
        end = text + strcspn(text, ",");
        if (end == text) argp_error(state, "a list contains an empty name");
        json_t *piece = json_stringn_nocheck(text, (size_t)(end - text));
        if (json_array_append_new(list->pieces, piece) != 0) argp_failure(state, STATUS_CHECK, ENOMEM, "arguments");
        else list_add(list, json_string_value(piece), state);
    }
}

void list_free(struct list *list) {
    free(list->items);
    json_decref(list->set);
    json_decref(list->pieces);
    *list = (struct list){0};
}

const char *const *list_or_null(const struct list *list) {
    return list->count ? list->items : NULL;
}

uint32_t arg_uint(const char *option, const char *text, uint32_t lowest, uint32_t highest, struct argp_state *state) {
    char *end = NULL;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (errno || end == text || *end || text[0] == '-' || value < lowest || value > highest)
        argp_error(state, "--%s=%s: expected a whole number from %u to %u", option, text, lowest, highest);
    return (uint32_t)value;
}

static const char *option_name(const struct arg_table *table, const struct arg_target *target) {
    const struct argp_option *option = table->options;
    while (option->key != target->key) option++;
    return option->name;
}

static uint32_t number_of(const struct arg_table *table, const struct arg_target *target, const char *text,
                          struct argp_state *state) {
    return arg_uint(option_name(table, target), text, target->lowest, target->highest, state);
}

bool args_store(const struct arg_table *table, int key, char *arg, struct argp_state *state, void *arguments) {
    const struct arg_target *target = table->targets;
    while (target && target->kind && target->key != key) target++;
    if (!target || !target->kind) return false;
    void *field = (char *)arguments + target->offset;
    switch (target->kind) {
    case STORES_NOTHING:
        break;
    case STORES_FLAG:
        *(bool *)field = true;
        break;
    case STORES_OUTPUT:
        *(const char **)field = arg;
        break;
    case STORES_TEXT:
        if (key == ARGP_KEY_ARG && *(const char **)field)
            argp_error(state, "expected one %s, found %s and %s", table->operand, *(const char **)field, arg);
        *(const char **)field = arg;
        break;
    case STORES_ITEM:
    case STORES_CAPTURES:
        list_add(field, arg, state);
        break;
    case STORES_NAMES:
        list_split(field, arg, state);
        break;
    case STORES_UINT32:
        *(uint32_t *)field = number_of(table, target, arg, state);
        break;
    case STORES_UINT64:
        *(uint64_t *)field = number_of(table, target, arg, state);
        break;
    }
    return true;
}

void args_expand_sets(const struct arg_table *table, struct argp_state *state, void *arguments) {
    struct glint_error err = {0};
    for (const struct arg_target *t = table->targets; t && t->kind; t++)
        if (t->kind == STORES_CAPTURES && !capture_set_expand((struct list *)((char *)arguments + t->offset), &err))
            argp_failure(state, err.code == GLINT_ERROR_USAGE ? STATUS_USAGE : STATUS_CHECK, 0, "%s", err.message);
}

/* Whether `text` names this file, alone or before the ':' of FILE:PART:LAYER. */
static bool names_file(const char *text, const struct stat *file) {
    char path[4096];
    struct stat status;
    if (snprintf(path, sizeof path, "%s", text) >= (int)sizeof path) return false;
    for (char *end = path + strlen(path); end; end = strrchr(path, ':')) {
        *end = '\0';
        if (stat(path, &status) == 0 && status.st_dev == file->st_dev && status.st_ino == file->st_ino) return true;
    }
    return false;
}

/* Any argument but `output` itself that names the same file: as it is, or behind the '=' of --option=FILE and SLOT=FILE. */
static const char *named_besides(const char *output, const struct stat *file, const struct argp_state *state) {
    for (int i = 1; i < state->argc; i++)
        for (const char *text = state->argv[i]; text; text = (text = strchr(text, '=')) ? text + 1 : NULL)
            if (text != output && names_file(text, file)) return text;
    return NULL;
}

static void check_output(const struct arg_table *table, const struct arg_target *target, bool overwrite,
                         struct argp_state *state, void *arguments) {
    const char *path = *(const char **)((char *)arguments + target->offset);
    struct glint_error err = {0};
    struct stat status;
    if (!path) return;
    const char *option = option_name(table, target);
    if (!output_check(path, target->lowest, overwrite, &err)) argp_error(state, "--%s: %s", option, err.message);
    for (const struct arg_target *other = table->targets; other < target; other++) {
        const char *taken = other->kind == STORES_OUTPUT ? *(const char **)((char *)arguments + other->offset) : NULL;
        if (taken && strcmp(path, "-") != 0 && !strcmp(taken, path))
            argp_error(state, "--%s: %s: --%s writes to it, too", option, path, option_name(table, other));
    }
    if (stat(path, &status) == 0 && S_ISREG(status.st_mode) && named_besides(path, &status, state))
        argp_error(state, "--%s: %s is an input, too (%s): nothing would be left of it; choose another name", option,
                   path, named_besides(path, &status, state));
}

void args_check_outputs(const struct arg_table *table, struct argp_state *state, void *arguments) {
    bool overwrite = false;
    for (const struct arg_target *t = table->targets; t && t->kind; t++)
        if (t->key == KEY_OVERWRITE) overwrite = *(bool *)((char *)arguments + t->offset);
    for (const struct arg_target *t = table->targets; t && t->kind; t++)
        if (t->kind == STORES_OUTPUT) check_output(table, t, overwrite, state, arguments);
}

void arg_numbers(const char *option, const char *text, double *out, size_t count, struct argp_state *state) {
    const char *p = text;
    for (size_t i = 0; i < count; i++) {
        char *end = NULL;
        out[i] = strtod(p, &end);
        bool last = i + 1 == count;
        if (end == p || !isfinite(out[i]) || *end != (last ? '\0' : ','))
            argp_error(state, "--%s=%s: expected %zu number%s%s", option, text, count, count > 1 ? "s" : "",
                       count > 1 ? " separated by commas" : "");
        p = end + 1;
    }
}

void arg_pixel(const char *text, int32_t pixel[2], struct argp_state *state) {
    char rest;
    if (sscanf(text, "%6d,%6d%c", &pixel[0], &pixel[1], &rest) != 2)
        argp_error(state, "%s: expected a pixel X,Y in whole numbers from the top left corner, such as 640,360", text);
}

void arg_size(const char *option, const char *text, uint32_t *width, uint32_t *height, struct argp_state *state) {
    unsigned w = 0, h = 0;
    int used = 0;
    if (sscanf(text, "%6ux%6u%n", &w, &h, &used) != 2 || text[used] || w < 1 || h < 1 || w > 32768 || h > 32768)
        argp_error(state, "--%s=%s: expected WIDTHxHEIGHT, such as 1280x720, at most 32768", option, text);
    *width = w;
    *height = h;
}

char *join_names(const char *before, const char *const *names) {
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f) return NULL;
    fputs(before, f);
    for (size_t i = 0; names[i]; i++) fprintf(f, "%s%s", i ? ", " : "", names[i]);
    fclose(f);
    return text;
}

int arg_choice(const char *option, const char *text, const char *const *names, struct argp_state *state) {
    struct glint_nearest near = glint_nearest_to(text);
    for (int i = 0; names[i]; i++) {
        if (!strcmp(names[i], text)) return i;
        glint_nearest_offer(&near, names[i]);
    }
    char *all = join_names("", names);
    argp_error(state, "--%s=%s: expected one of %s%s", option, text, all ? all : "its values",
               glint_nearest_text(&near));
    free(all);
    return -1;
}

const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *without_path(const char *message, const char *path) {
    const size_t length = strlen(path);
    const bool named = !strncmp(message, path, length) && !strncmp(message + length, ": ", 2);
    return message + (named ? length + 2 : 0);
}

bool fail_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

enum status print_json(json_t *json) {
    char *text = json ? record_text(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(json);
    const bool failed = !text;
    console_plain(true);
    if (text) puts(text);
    else fprintf(stderr, "glint: cannot make the JSON text: out of memory, or a text that is not UTF-8\n");
    free(text);
    return failed ? STATUS_CHECK : STATUS_DONE;
}

/* Strings of JSON have no line breaks. */
void json_put_text(FILE *out, const char *text, size_t spaces) {
    for (const char *end; (end = strchr(text, '\n')) != NULL; text = end + 1)
        fprintf(out, "%.*s\n%*s", (int)(end - text), text, (int)spaces, "");
    fputs(text, out);
}

void json_put(FILE *out, json_t *json, size_t indent, size_t spaces) {
    char *text = json ? record_text(json, JSON_INDENT(indent) | (indent > 1 ? JSON_REAL_PRECISION(9) : 0)) : NULL;
    if (text) json_put_text(out, text, spaces);
    else memory_note();
    free(text);
    json_decref(json);
}

json_t *json_text(const char *text) {
    return json_stringn_nocheck(text, strlen(text));
}

/* The list is found by the line break before its name, which no string has. */
void json_put_list(FILE *out, json_t *object, const char *list, size_t count, json_put_item put, void *user,
                   size_t indent, size_t spaces) {
    const size_t flags = JSON_INDENT(indent) | (indent > 1 ? JSON_REAL_PRECISION(9) : 0), inner = spaces + 2 * indent;
    char *text = object ? record_text(object, flags) : NULL, mark[128];
    snprintf(mark, sizeof mark, "\n%*s\"%s\": []", (int)indent, "", list);
    char *cut = text ? strstr(text, mark) : NULL;
    if (cut) {
        char *end = cut + strlen(mark) - 1;
        *end = '\0';
        json_put_text(out, text, spaces);
        for (size_t i = 0; i < count; i++) {
            fprintf(out, "%s\n%*s", i ? "," : "", (int)inner, "");
            put(out, user, i, indent, inner);
        }
        if (count) fprintf(out, "\n%*s", (int)(spaces + indent), "");
        fputc(']', out);
        json_put_text(out, end + 1, spaces);
    } else memory_note();
    free(text);
    json_decref(object);
}

json_t *json_number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_numbers(const double *values, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(list, json_number(values[i]));
    return list;
}
