/* glint: runs the command that the first argument names. */
#include "command.h"

#include <errno.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "complete/complete.h"
#include "glint/replay.h"
#include "io/console.h"
#include "io/memory.h"
#include "io/table.h"
#include "nearest.h"

static void print_help(FILE *out) {
    fputs(
        "Usage: glint COMMAND [OPTION...] [ARGUMENT...]\n"
        "Replays the reflection passes of captured frames offline, and shows every intermediate image.\n\nCommands:\n",
        out);
    struct table *table = table_create((const char *const[]){"<", "<", NULL});
    for (size_t i = 0; i < command_count; i++) {
        table_cell(table, "  %s", commands[i]->name);
        table_cell(table, "%s", commands[i]->summary);
    }
    table_print(table, out);
    table_destroy(&table);
    fputs("\nglint COMMAND --help explains a command, with examples. glint --version prints the version.\n"
          "Start with:\n"
          "  glint sample street -o street.exr\n"
          "  glint replay street.exr -o run\n"
          "  glint view run -o street.png\n",
          out);
}

static enum status unknown_command(const char *name) {
    struct glint_nearest near = glint_nearest_to(name);
    for (size_t i = 0; i < command_count; i++) glint_nearest_offer(&near, commands[i]->name);
    fprintf(stderr, "glint: there is no command %s%s; glint --help lists them\n", name_text(name),
            glint_nearest_text(&near));
    return STATUS_USAGE;
}

static enum status print_man_page(const char *name) {
    const struct command *command = name ? command_find(name) : NULL;
    if (name && !command) return unknown_command(name);
    if (command) man_print_command(command);
    else man_print_program();
    return STATUS_DONE;
}

static enum status help_command(int argc, char **argv) {
    if (argc < 2) {
        print_help(stdout);
        return STATUS_DONE;
    }
    const struct command *command = command_find(argv[1]);
    if (!command) return unknown_command(argv[1]);
    char name[] = "help", option[] = "--help";
    return command->run(2, (char *[]){name, option, NULL});
}

static enum status dispatch(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        return STATUS_USAGE;
    }
    const char *first = argv[1];
    if (!strcmp(first, "--help") || !strcmp(first, "-h") || !strcmp(first, "-?")) return help_command(1, argv);
    if (!strcmp(first, "help")) return help_command(argc - 1, argv + 1);
    if (!strcmp(first, "--version") || !strcmp(first, "-V")) {
        puts("glint " GLINT_VERSION);
        return STATUS_DONE;
    }
    /* Undocumented: the build makes the man pages with the one, and shells complete words with the other. */
    if (!strcmp(first, "--man")) return print_man_page(argc > 2 ? argv[2] : NULL);
    if (!strcmp(first, "--complete")) {
        complete_print(argc - 2, argv + 2);
        return STATUS_DONE;
    }
    if (first[0] == '-') {
        fprintf(stderr, "glint: unknown option %s; options come after the command (glint --help)\n", name_text(first));
        return STATUS_USAGE;
    }
    const struct command *command = command_find(first);
    return command ? command->run(argc - 1, argv + 1) : unknown_command(first);
}

static bool flush_output(void) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return true;
    fprintf(stderr, "glint: cannot write to stdout: %s\n", errno ? strerror(errno) : "not everything could be written");
    return false;
}

int main(int argc, char **argv) {
    setlocale(LC_CTYPE, "");
    if (!console_begin()) {
        fputs("glint: out of memory\n", stderr);
        return STATUS_CHECK;
    }
    memory_begin();
    argp_err_exit_status = STATUS_USAGE;
    const enum status status = dispatch(argc, argv);
    const bool whole = !memory_ran_out(), written = flush_output();
    if (!whole) fputs("glint: out of memory: what was printed may be incomplete\n", stderr);
    memory_end();
    console_end();
    const int result = status == STATUS_DONE && !(whole && written) ? STATUS_CHECK : (int)status;
    if (glint_device_given_up(NULL)) _exit(result); /* exit() would wait for what it still executes */
    return result;
}
