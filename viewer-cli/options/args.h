/* Small helpers that read arguments; each reports a usage error through argp and does not return then. */
#ifndef GLINT_VIEWER_ARGS_H
#define GLINT_VIEWER_ARGS_H

#include <argp.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "command.h"

/* A growing, NULL-terminated list of the program's own argument strings. */
struct list {
    const char **items;
    size_t count;
};
void list_add(struct list *list, const char *item, struct argp_state *state);
/* Adds the pieces of "a,b,c". Cuts `text` where its commas are. */
void list_split(struct list *list, char *text, struct argp_state *state);
void list_free(struct list *list);
/* NULL for an empty list, as the libraries want it. */
const char *const *list_or_null(const struct list *list);

uint32_t arg_uint(const char *option, const char *text, uint32_t lowest, uint32_t highest, struct argp_state *state);
/* Exactly `count` numbers, separated by commas. */
void arg_numbers(const char *option, const char *text, double *out, size_t count, struct argp_state *state);
void arg_size(const char *option, const char *text, uint32_t *width, uint32_t *height, struct argp_state *state);
/* The place of `text` in a NULL-terminated list of names. */
int arg_choice(const char *option, const char *text, const char *const *names, struct argp_state *state);
/* "a, b, c", malloc'd. */
char *join_names(const char *before, const char *const *names);

/* Prints indented JSON to stdout and releases it. */
enum status print_json(json_t *json);
/* A JSON number, or null where JSON has none. */
json_t *json_number(double value);

#endif
