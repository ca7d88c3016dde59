/* The commands that glint batch cuts into shards: one table of the options of both, so that help, errors and completion know all of them. */
#include "batch/studied.h"

#include <stdlib.h>
#include <string.h>

#include "journal/shard.h"
#include "options/args.h"

const struct command *batch_studied(const char *name) {
    const struct command *command = command_find(name);
    return command && command_option(command, KEY_SHARD) ? command : NULL;
}

char *batch_studied_names(void) {
    const char **names = calloc(command_count + 1, sizeof *names);
    for (size_t i = 0, count = 0; names && i < command_count; i++)
        if (batch_studied(commands[i]->name)) names[count++] = commands[i]->name;
    char *text = names ? join_names("", names) : NULL;
    free(names);
    return text;
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
    whole->one_dash = studied->one_dash;
    whole->numbers = studied->numbers;
    return true;
}
