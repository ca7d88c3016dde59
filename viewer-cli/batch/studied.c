/* The commands that glint batch cuts into shards: one table, and one of the options of both, so that help, errors and completion know all of them. */
#include "batch/studied.h"

#include <stdlib.h>
#include <string.h>

static const struct command *const studied_commands[] = {&cmd_sweep};

const struct command *batch_studied(const char *name) {
    for (size_t i = 0; i < sizeof studied_commands / sizeof *studied_commands; i++)
        if (!strcmp(studied_commands[i]->name, name)) return studied_commands[i];
    return NULL;
}

static bool ends(const struct argp_option *o) {
    return !o->name && !o->key && !o->doc && !o->group;
}

static size_t count_options(const struct argp_option *o) {
    size_t count = 0;
    while (!ends(&o[count])) count++;
    return count;
}

static bool has(const struct argp_option *options, const struct argp_option *option) {
    for (; !ends(options); options++)
        if ((option->key && options->key == option->key) ||
            (option->name && options->name && !strcmp(options->name, option->name)))
            return true;
    return false;
}

bool batch_widen(const struct command *batch, const struct command *studied, struct command *whole) {
    const size_t own = count_options(batch->options), more = count_options(studied->options);
    struct argp_option *options = calloc(own + more + 1, sizeof *options);
    if (!options) return false;
    memcpy(options, batch->options, own * sizeof *options);
    for (size_t i = 0, count = own; i < more; i++)
        if (!has(batch->options, &studied->options[i])) options[count++] = studied->options[i];
    *whole = *batch;
    whole->options = options;
    whole->values = studied->values;
    return true;
}
