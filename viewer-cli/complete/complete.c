/* Completion: finds what the word at the cursor is, from the tables of options. */
#include "complete/complete.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/studied.h"
#include "io/console.h"
#include "shown.h"

void complete_offer(struct completion *c, const char *candidate, const char *about) {
    if (strncmp(candidate, c->typed, strlen(c->typed)) != 0 || !shown_is_plain(candidate)) return;
    for (size_t i = 0; i < c->offered_count; i++)
        if (!strcmp(c->offered[i], candidate)) return;
    char **more = realloc(c->offered, (c->offered_count + 1) * sizeof *more);
    if (!more) return;
    c->offered = more;
    c->offered[c->offered_count++] = strdup(candidate);
    /* The first sentence of a description, on one line. */
    const char *end = about ? about : "";
    while (*end && *end != '\n' && *end != '\t' && !((*end == '.' || *end == ':' || *end == ';') && end[1] == ' '))
        end++;
    char text[512];
    snprintf(text, sizeof text, "%.*s", about ? (int)(end - about) : 0, about ? about : "");
    printf("%s%s\t%s\n", c->before, candidate, name_text(text));
}

void complete_finish(struct completion *c, size_t bytes) {
    const size_t length = strlen(c->before);
    snprintf(c->before + length, sizeof c->before - length, "%.*s", (int)bytes, c->typed);
    c->typed += bytes;
}

static bool ends(const struct argp_option *o) {
    return !o->name && !o->key && !o->doc && !o->group;
}

static const struct argp_option *long_option(const struct command *command, const char *name, size_t length) {
    const struct argp_option *const tables[] = {command->options, command_common};
    for (size_t t = 0; t < 2; t++)
        for (const struct argp_option *o = tables[t]; !ends(o); o++)
            if (o->name && strlen(o->name) == length && !strncmp(o->name, name, length)) return o;
    return NULL;
}

/* The option that takes the word after `word` as its value, or NULL. */
static const struct argp_option *expects_value(const struct command *command, const char *word) {
    const struct argp_option *o = NULL;
    if (word[0] != '-' || !word[1]) return NULL;
    if (word[1] == '-') o = long_option(command, word + 2, strlen(word + 2));
    else if (command->one_dash) o = long_option(command, word + 1, strlen(word + 1));
    if (!o && word[1] != '-' && !word[2]) o = command_option(command, (unsigned char)word[1]);
    return o && o->arg && !(o->flags & OPTION_ARG_OPTIONAL) ? o : NULL;
}

/* Values that the help of the option lists, "a, b, c", or else what its placeholder says. */
static void complete_value(struct completion *c, const struct command *command, const struct argp_option *option) {
    char *values = command->values ? command->values(option->key) : NULL, *rest = values;
    const char *dots = strstr(option->arg, ",...");
    const char *comma = dots ? strrchr(c->typed, ',') : NULL;
    if (comma) complete_finish(c, (size_t)(comma + 1 - c->typed));
    for (char *value; values && (value = strsep(&rest, ",")) != NULL;) complete_offer(c, value + (*value == ' '), NULL);
    if (!values || strchr(option->arg, '|')) complete_placeholder(c, option->arg);
    free(values);
}

static void offer_options(struct completion *c, const struct argp_option *options) {
    char text[128];
    for (const struct argp_option *o = options; !ends(o); o++) {
        if (!o->name) continue;
        snprintf(text, sizeof text, "--%s%s", o->name, o->arg && !(o->flags & OPTION_ARG_OPTIONAL) ? "=" : "");
        complete_offer(c, text, o->doc);
    }
}

static void complete_options(struct completion *c, const struct command *command) {
    offer_options(c, command->options);
    offer_options(c, command_common);
    complete_offer(c, "--help", "explain the command");
}

/* Whether the word is an argument, not an option or its value. */
static bool is_argument(const struct completion *c, const struct command *command, size_t i) {
    const bool number = command->numbers && c->words[i][0] == '-' && strspn(c->words[i] + 1, "0123456789") > 0;
    return (c->words[i][0] != '-' || !c->words[i][1] || number) && !(i > 1 && expects_value(command, c->words[i - 1]));
}

/* The n-th argument by the command's usage: "F X,Y -o OUT" has two, and one that ends in "..." is repeated. */
static void complete_argument(struct completion *c, const struct command *command) {
    size_t n = 0;
    char usage[256], last[256] = "", *rest = usage;
    for (size_t i = 1; i < c->count; i++) n += is_argument(c, command, i);
    snprintf(usage, sizeof usage, "%s", command->arguments);
    for (char *word; (word = strsep(&rest, " ")) != NULL && word[0] != '-' && strncmp(word, "[-", 2) != 0 &&
                     strcmp(word, "|") != 0;) {
        char *inside = word + (word[0] == '[' && word[strlen(word) - 1] == ']');
        if (inside != word) word[strlen(word) - 1] = '\0';
        snprintf(last, sizeof last, "%s", inside);
        if (n-- == 0) {
            complete_placeholder(c, inside);
            return;
        }
    }
    char *dots = strstr(last, "...");
    if (dots) complete_placeholder(c, last);
}

static void complete_command(struct completion *c) {
    complete_offer(c, "help", "explain a command");
    for (size_t i = 0; i < command_count; i++) complete_offer(c, commands[i]->name, commands[i]->summary);
    if (c->typed[0] != '-') return;
    complete_offer(c, "--help", "list the commands");
    complete_offer(c, "--version", "print the version");
}

static void complete_of_command(struct completion *c, const struct command *command) {
    const char *word = c->typed, *equals = strchr(word, '=');
    const struct argp_option *option = c->count > 1 ? expects_value(command, c->words[c->count - 1]) : NULL;
    if (option) complete_value(c, command, option);
    else if (word[0] == '-' && word[1] == '-' && equals) {
        if (!(option = long_option(command, word + 2, (size_t)(equals - word) - 2)) || !option->arg) return;
        complete_finish(c, (size_t)(equals + 1 - word));
        complete_value(c, command, option);
    } else if (word[0] == '-') complete_options(c, command);
    else complete_argument(c, command);
}

/* The command that is cut into shards has options, too. */
static void complete_batch(struct completion *c) {
    const struct command *studied = c->count > 1 ? batch_studied(c->words[1]) : NULL;
    struct command whole;
    if (!studied) complete_of_command(c, &cmd_batch);
    else if (batch_widen(&cmd_batch, studied, &whole)) {
        complete_of_command(c, &whole);
        free((struct argp_option *)whole.options);
    }
}

void complete_print(int count, char *const words[]) {
    if (count < 1) return;
    console_plain(true); /* tabs separate */
    struct completion c = {.words = (const char *const *)words, .count = (size_t)count - 1, .typed = words[count - 1]};
    const struct command *command = c.count ? command_find(c.words[0]) : NULL;
    if (!c.count || (c.count == 1 && !strcmp(c.words[0], "help"))) complete_command(&c);
    else if (command == &cmd_batch) complete_batch(&c);
    else if (command) complete_of_command(&c, command);
    for (size_t i = 0; i < c.offered_count; i++) free(c.offered[i]);
    free(c.offered);
}
