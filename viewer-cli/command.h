/* The definition of a command, from which --help, the man page and the completion derive. */
#ifndef GLINT_VIEWER_COMMAND_H
#define GLINT_VIEWER_COMMAND_H

#include <argp.h>
#include <stddef.h>

#include "glint/common.h"
#include "status.h"

struct example {
    const char *line, *what;
};

struct command {
    const char *name;
    const char *arguments;   /* "F… -o RUN" */
    const char *summary;     /* one line for the list of commands */
    const char *description; /* a paragraph or two */
    const struct argp_option *options;
    const struct arg_target *targets; /* options that need no more than parsing (options/args.h), or NULL */
    bool one_dash;                    /* long options may begin with a single dash */
    bool numbers;                     /* arguments may be negative numbers: -5,3 */
    int usage_status;                 /* of a usage error; 0: STATUS_USAGE */
    const char *operand;              /* what an argument is, such as "capture", if there has to be one; or NULL */
    argp_parser_t parse;              /* of everything else, or NULL */
    const struct example *examples;   /* ends with an entry whose text is NULL */
    /* Values that are known only at run time (encodings, scenes, views), appended to the help of an option; malloc'd,
       NULL for none. The function may be NULL. */
    char *(*values)(int key);
    /* Shards share out rounds of work instead of doing a fixed part: they keep their results in --folder, which is NAME.COMMAND by default for an output
       NAME.json; and with --shard whole the command reads the journals of all. */
    bool rounds;
    enum status (*run)(int argc, char **argv);
};

/* clang-format off */
extern const struct command
    cmd_sample,
    cmd_pack,
    cmd_extract,
    cmd_info,
    cmd_validate,
    cmd_lint,
    cmd_set,
    cmd_crop,
    cmd_strip,
    cmd_plan,
    cmd_replay,
    cmd_live,
    cmd_reference,
    cmd_compare,
    cmd_sweep,
    cmd_merge,
    cmd_batch,
    cmd_blame,
    cmd_tune,
    cmd_stability,
    cmd_probe,
    cmd_explain,
    cmd_diff,
    cmd_check,
    cmd_view,
    cmd_report,
    cmd_export,
    cmd_selftest,
    cmd_passes,
    cmd_devices;
/* clang-format on */
/* All commands in the order of the help. */
extern const struct command *const commands[];
extern const size_t command_count;
const struct command *command_find(const char *name);

/* Parses argv[1…] into `input`, which the command's parse function finds in state->input. Options may follow arguments.
   A usage error prints a message and exits with 2, --help exits with 0. */
void command_parse(const struct command *command, int argc, char **argv, void *input);

/* The options that every command has besides its own. */
extern const struct argp_option command_common[];
/* The option of this key, or NULL. */
const struct argp_option *command_option(const struct command *command, int key);
/* What follows the description of a command that takes sets of captures; "" for others. */
const char *command_about_sets(const struct command *command);
/* An option's help with its run-time values, malloc'd. */
char *command_option_help(const struct command *command, const struct argp_option *option);

/* Prints "glint COMMAND: message" and returns the exit status of the error's code. */
enum status command_fail(const struct command *command, const struct glint_error *err);
/* Prints a message without ending the command. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void command_note(const struct command *command, const char *format, ...);

/* The man pages (mdoc) of the program and of a command, written to stdout from the same tables. */
void man_print_program(void);
void man_print_command(const struct command *command);

#endif
