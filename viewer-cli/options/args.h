/* Parses arguments. Errors are reported through argp, and the functions then do not return. */
#ifndef GLINT_VIEWER_ARGS_H
#define GLINT_VIEWER_ARGS_H

#include <argp.h>
#include <jansson.h>
#include <stdint.h>

#include "glint/common.h"
#include "status.h"
#include "io/output.h"

/* A growing, NULL-terminated list of pointers into the program's arguments. */
struct list {
    const char **items;
    size_t count;
    json_t *
        set; /* of captures that a set names: {path, hash, tags} each, which own the items (options/capture_set.h); or NULL */
    json_t *pieces; /* texts that own the items of list_split; or NULL */
};
void list_add(struct list *list, const char *item, struct argp_state *state);
/* Adds the items of "a,b,c". */
void list_split(struct list *list, const char *text, struct argp_state *state);
void list_free(struct list *list);
/* NULL for an empty list, as the libraries expect. */
const char *const *list_or_null(const struct list *list);

/* Where the argument of an option goes that needs no more than parsing. The type of the field decides how it is parsed: a bool is set, a
   text is kept, a list grows. ARGP_KEY_ARG stands for arguments that are no options, of
   which a text keeps one, the command's operand. */
struct arg_target {
    int key;
    enum {
        STORES_NOTHING,
        STORES_FLAG,
        STORES_TEXT,
        STORES_ITEM,
        STORES_CAPTURES,
        STORES_NAMES,
        STORES_UINT32,
        STORES_UINT64,
        STORES_OUTPUT
    } kind;
    size_t offset;
    uint32_t lowest, highest; /* of a number; of an output, lowest is its kinds */
};
/* clang-format off */
#define STORED(key, type, field) \
    {key, _Generic(((type *)NULL)->field, bool: STORES_FLAG, const char *: STORES_TEXT, struct list: STORES_ITEM), offsetof(type, field), 0, 0}
/* A list of captures, which may be given as sets (options/capture_set.h). */
#define STORED_CAPTURES(type, field) \
    {ARGP_KEY_ARG, _Generic(((type *)NULL)->field, struct list: STORES_CAPTURES), offsetof(type, field), 0, 0}
/* A list to which the items of "a,b,c" are added. */
#define STORED_NAMES(key, type, field) \
    {key, _Generic(((type *)NULL)->field, struct list: STORES_NAMES), offsetof(type, field), 0, 0}
#define STORED_NUMBER(key, type, field, lowest, highest) \
    {key, _Generic(((type *)NULL)->field, uint32_t: STORES_UINT32, uint64_t: STORES_UINT64), offsetof(type, field), lowest, highest}
/* The name of a file that is written: OUTPUT_ bits say what it contains (io/output.h). */
#define STORED_OUTPUT(key, type, field, kinds) \
    {key, _Generic(((type *)NULL)->field, const char *: STORES_OUTPUT), offsetof(type, field), kinds, 0}
/* Commands with such an output have this option, too. */
#define OVERWRITE_OPTION \
    {"overwrite", KEY_OVERWRITE, NULL, 0, "Replace a file that exists and is of another kind; an input is never replaced", 0}
/* clang-format on */
enum { KEY_OVERWRITE = 4096 };

/* Where the arguments of a command go. */
struct arg_table {
    const struct arg_target *targets; /* may be NULL */
    const struct argp_option *options;
    const char *operand; /* what ARGP_KEY_ARG is, for messages */
};
/* Stores the argument where the targets say; false if they do not contain the key. */
bool args_store(const struct arg_table *table, int key, char *arg, struct argp_state *state, void *arguments);

/* Replaces sets by their captures when all arguments are there. */
void args_expand_sets(const struct arg_table *table, struct argp_state *state, void *arguments);
/* Checks the names of all outputs when everything is parsed: see output_check; and none is a file that the arguments name besides. */
void args_check_outputs(const struct arg_table *table, struct argp_state *state, void *arguments);

uint32_t arg_uint(const char *option, const char *text, uint32_t lowest, uint32_t highest, struct argp_state *state);
/* Parses exactly `count` numbers that are separated by commas. */
void arg_numbers(const char *option, const char *text, double *out, size_t count, struct argp_state *state);
/* "X,Y" in whole numbers, of an argument that is no option. */
void arg_pixel(const char *text, int32_t pixel[2], struct argp_state *state);
void arg_size(const char *option, const char *text, uint32_t *width, uint32_t *height, struct argp_state *state);
/* The index of `text` in a NULL-terminated list of names. */
int arg_choice(const char *option, const char *text, const char *const *names, struct argp_state *state);
/* "a, b, c", malloc'd. */
char *join_names(const char *before, const char *const *names);

/* The last component of a path. */
const char *base_name(const char *path);
/* What follows "PATH: " in a message that begins with it, for a row that has the path already; else the message. */
const char *without_path(const char *message, const char *path);
/* Sets the error and returns false. */
bool fail_memory(struct glint_error *err);

/* Prints indented JSON to stdout and releases it. */
enum status print_json(json_t *json);
/* For JSON that is written in pieces, because it is large. Writes a text of JSON to a place that is indented by so many spaces. */
void json_put_text(FILE *out, const char *text, size_t spaces);
/* The same for a value, which it releases; indented by `indent`, with the digits that print_json shows unless that is 1. */
void json_put(FILE *out, json_t *json, size_t indent, size_t spaces);
/* A JSON text of any bytes, such as a path; one that is not UTF-8 cannot be written as JSON. */
json_t *json_text(const char *text);
/* Puts an object whose member `list` is empty, and into that list `count` items, each by a call of `put`, which has to write one value. */
typedef void (*json_put_item)(FILE *out, void *user, size_t i, size_t indent, size_t spaces);
void json_put_list(FILE *out, json_t *object, const char *list, size_t count, json_put_item put, void *user,
                   size_t indent, size_t spaces);
/* A JSON number; null if it is not finite. */
json_t *json_number(double value);
json_t *json_numbers(const double *values, size_t count);

#endif
