/* Parses the arguments of a command (argp) and reports errors. */
#include "command.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/memory.h"
#include "io/table.h"
#include "nearest.h"
#include "options/args.h"

struct parsing {
    const struct command *command;
    void *input;
};

static error_t command_parse_key(int key, char *arg, struct argp_state *state) {
    const struct parsing *parsing = state->input;
    const struct arg_table table = {parsing->command->targets, parsing->command->options, parsing->command->operand};
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = state->child_inputs[parsing->command->numbers] = state->input;
        return 0;
    case ARGP_KEY_FINI:
        return 0;
    case ARGP_KEY_SUCCESS:
        args_check_outputs(&table, state, parsing->input);
        return 0;
    case ARGP_KEY_NO_ARGS:
        if (parsing->command->operand) argp_error(state, "no %s given", parsing->command->operand);
        break;
    }
    if (key == ARGP_KEY_END) args_expand_sets(&table, state, parsing->input);
    if (args_store(&table, key, arg, state, parsing->input)) return 0;
    if (!parsing->command->parse) return ARGP_ERR_UNKNOWN;
    state->input = parsing->input;
    error_t result = parsing->command->parse(key, arg, state);
    state->input = (void *)parsing;
    return result;
}

/* "-5,3" is parsed as the option 5 with a value, and passed on as an argument. */
static error_t parse_number(int key, char *arg, struct argp_state *state) {
    (void)arg;
    if (key < '0' || key > '9') return ARGP_ERR_UNKNOWN;
    char *whole = state->argv[state->next - 1];
    if (whole[1] != key) argp_error(state, "invalid option -- '%c'", key);
    return command_parse_key(ARGP_KEY_ARG, whole, state);
}
/* clang-format off */
#define DIGIT(key) {NULL, key, "", OPTION_HIDDEN | OPTION_ARG_OPTIONAL, NULL, 0}
static const struct argp_option digits[] = {
    DIGIT('0'), DIGIT('1'), DIGIT('2'), DIGIT('3'), DIGIT('4'),
    DIGIT('5'), DIGIT('6'), DIGIT('7'), DIGIT('8'), DIGIT('9'), {0},
};
/* clang-format on */
static const struct argp numbers = {.options = digits, .parser = parse_number};

/* Options of every command. */
enum { KEY_COLOR = 8192 };
/* clang-format off */
const struct argp_option command_common[] = {
    {"color", KEY_COLOR, "WHEN", 0, "Colour: auto (default: on a terminal, unless NO_COLOR is set), always or never", -1},
    {0},
};
/* clang-format on */

static error_t parse_common(int key, char *arg, struct argp_state *state) {
    if (key != KEY_COLOR) return ARGP_ERR_UNKNOWN;
    console_choose_color(arg_choice("color", arg, console_colors, state));
    return 0;
}
static const struct argp common = {.options = command_common, .parser = parse_common};

char *command_option_help(const struct command *command, const struct argp_option *option) {
    const char *doc = option->doc ? option->doc : "";
    char *values = command->values && option->key ? command->values(option->key) : NULL;
    char *text = NULL;
    if (!values) return strdup(doc);
    if (asprintf(&text, "%s%s", doc, values) < 0) text = NULL;
    free(values);
    return text;
}

const struct argp_option *command_option(const struct command *command, int key) {
    for (const struct argp_option *o = command->options; o->name || o->key || o->doc; o++)
        if (o->key == key) return o;
    return NULL;
}

const char *command_about_sets(const struct command *command) {
    for (const struct arg_target *t = command->targets; t && t->kind; t++)
        if (t->kind == STORES_CAPTURES)
            return " A folder of captures and a set file, which lists them with tags, stand for their captures.";
    return "";
}

static char *examples_text(const struct command *command) {
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f) return NULL;
    fprintf(f, "%s%s\n\nExamples:\n", command->description, command_about_sets(command));
    for (const struct example *e = command->examples; e->line; e++) fprintf(f, "  %s\n      %s\n", e->line, e->what);
    fclose(f);
    return text;
}

/* argp prints the wrapped table's help through this filter, which adds run-time values to options and the examples at the end. */
static char *filter(int key, const char *text, void *input) {
    const struct parsing *parsing = input;
    if (!parsing) return (char *)text;
    const struct command *command = parsing->command;
    if (key == ARGP_KEY_HELP_POST_DOC) return examples_text(command);
    const struct argp_option *option = key > 0 && key < ARGP_KEY_HELP_PRE_DOC ? command_option(command, key) : NULL;
    return option && text ? command_option_help(command, option) : (char *)text;
}

/* ---- Unknown options ---- */

static const char *const from_argp[] = {"help", "usage", NULL};

/* Offers the long options; whether one is `name`, which may be abbreviated. */
static bool offer_options(const struct argp_option *options, const char *name, struct glint_nearest *near,
                          bool *argument) {
    bool known = false;
    for (const struct argp_option *o = options; o->name || o->key || o->doc; o++) {
        if (!o->name) continue;
        glint_nearest_offer(near, o->name);
        known |= !strncmp(o->name, name, strlen(name));
        *argument |= !strcmp(o->name, name) && o->arg && !(o->flags & OPTION_ARG_OPTIONAL);
    }
    return known;
}

/* "glint COMMAND: " on stderr, in colour. */
static void print_name(const struct command *command, enum mark mark) {
    mark_begin(stderr, mark);
    fprintf(stderr, "glint %s:", command->name);
    mark_end(stderr, mark);
    fputc(' ', stderr);
}

/* argp's message on an unknown long option, with the option that is meant. Whatever is in doubt is left to argp. */
static void check_long_options(const struct command *command, int argc, char **argv) {
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++) {
        const bool one = command->one_dash && argv[i][0] == '-' && argv[i][1] != '-' &&
                         isalpha((unsigned char)argv[i][1]) && argv[i][2];
        char name[64];
        bool known = false, argument = false;
        if (!one && strncmp(argv[i], "--", 2) != 0) continue;
        const char *text = argv[i] + (one ? 1 : 2);
        snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
        struct glint_nearest near = glint_nearest_to(name);
        known = offer_options(command->options, name, &near, &argument);
        known |= offer_options(command_common, name, &near, &argument);
        for (size_t k = 0; from_argp[k]; k++) {
            glint_nearest_offer(&near, from_argp[k]);
            known |= !strncmp(from_argp[k], name, strlen(name));
        }
        if (known) {
            i += argument && !strchr(argv[i], '='); /* what follows is its value */
            continue;
        }
        if (one) continue; /* short options may be joined */
        print_name(command, MARK_FAIL);
        fprintf(stderr, "unrecognized option '--%s'", name_text(name));
        if (near.best) fprintf(stderr, " (did you mean --%s?)", near.best);
        fprintf(stderr, "\nTry `glint %s --help' for more information.\n", command->name);
        exit(argp_err_exit_status);
    }
}

void command_parse(const struct command *command, int argc, char **argv, void *input) {
    struct parsing parsing = {command, input};
    const struct argp_child children[] = {{&common, 0, NULL, 0}, {command->numbers ? &numbers : NULL, 0, NULL, 0}, {0}};
    char name[64], doc[512];
    snprintf(name, sizeof name, "glint %s", command->name);
    snprintf(doc, sizeof doc, "%s.\v-", command->summary); /* what follows \v is replaced by the filter */
    doc[0] = (char)toupper((unsigned char)doc[0]);
    struct argp argp = {.options = command->options,
                        .parser = command_parse_key,
                        .args_doc = command->arguments,
                        .doc = doc,
                        .children = children,
                        .help_filter = filter};
    const unsigned flags = (command->one_dash ? ARGP_LONG_ONLY : 0) | (command->numbers ? ARGP_IN_ORDER : 0);
    char *first = argv[0];
    argv[0] = name;
    if (command->usage_status) argp_err_exit_status = command->usage_status;
    check_long_options(command, argc, argv);
    error_t failed = argp_parse(&argp, argc, argv, flags, NULL, &parsing);
    argv[0] = first;
    if (failed) {
        fprintf(stderr, "glint %s: %s\n", command->name, strerror(failed));
        exit(argp_err_exit_status);
    }
}

/* "glint COMMAND: message" on stderr. */
__attribute__((format(printf, 3, 0))) static void say(const struct command *command, enum mark mark, const char *format,
                                                      va_list args) {
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    print_name(command, mark);
    fprintf(stderr, "%s\n", name_text(text));
}

static void fail(const struct command *command, const char *format, ...) {
    va_list args;
    va_start(args, format);
    say(command, MARK_FAIL, format, args);
    va_end(args);
}

enum status command_fail(const struct command *command, const struct glint_error *err) {
    /* What is said of a file may be only because memory was lacking; main tells that. */
    if (memory_ran_out() && err->code != GLINT_ERROR_MEMORY) return STATUS_CHECK;
    fail(command, "%s", err->message[0] ? err->message : "failed without a message");
    switch (err->code) {
    case GLINT_ERROR_USAGE:
        return STATUS_USAGE;
    case GLINT_ERROR_INTERRUPTED:
        return STATUS_INTERRUPTED;
    default:
        return STATUS_CHECK;
    }
}

void command_note(const struct command *command, const char *format, ...) {
    va_list args;
    va_start(args, format);
    say(command, MARK_WARN, format, args);
    va_end(args);
}
