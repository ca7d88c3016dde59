/* Generates the man pages from the tables that --help prints. */
#include "command.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

/* Prints text in mdoc: control characters are escaped, and each sentence begins a new line. */
static void print_text(const char *text) {
    bool start = true;
    for (const char *p = text; *p; p++) {
        if (start && (*p == '.' || *p == '\'')) fputs("\\&", stdout);
        start = false;
        if (*p == '\\') fputs("\\e", stdout);
        else if (*p == '-') fputs("\\-", stdout);
        else if (*p == '\n') {
            /* mdoc has macros for paragraphs; blank lines are an error */
            while (p[1] == '\n') p++;
            fputs("\n.Pp\n", stdout);
            start = true;
        } else if ((*p == '.' || *p == '?') && p[1] == ' ' && isupper((unsigned char)p[2])) {
            printf("%c\n", *p);
            p++;
            start = true;
        } else fputc(*p, stdout);
    }
    fputc('\n', stdout);
}

static bool ends(const struct argp_option *o) {
    return !o->name && !o->key && !o->doc && !o->group;
}

/* .It Fl o , Fl -output Ns = Ns Ar FILE */
static void print_option(const struct command *command, const struct argp_option *o) {
    bool optional = o->flags & OPTION_ARG_OPTIONAL;
    fputs(".It ", stdout);
    if (o->key > 0 && o->key < 128 && isgraph(o->key)) printf("Fl %c%s", o->key, o->name ? " , " : "");
    if (o->name) {
        printf("Fl \\-%s", o->name);
        if (o->arg) printf(optional ? " Ns Op = Ns Ar %s" : " Ns = Ns Ar %s", o->arg);
    }
    fputc('\n', stdout);
    char *help = command_option_help(command, o);
    print_text(help ? help : "");
    free(help);
}

static void print_head(const char *title) {
    printf(".\\\" Made by glint --man from the tables of --help.\n.Dd November 26, 2026\n.Dt %s 1\n.Os\n.Sh NAME\n",
           title);
}

void man_print_command(const struct command *command) {
    char title[64];
    snprintf(title, sizeof title, "GLINT-%s", command->name);
    for (char *p = title; *p; p++) *p = (char)toupper((unsigned char)*p);
    print_head(title);
    printf(".Nm glint\\-%s\n.Nd ", command->name);
    print_text(command->summary);
    printf(".Sh SYNOPSIS\n.Nm glint %s\n.Op Ar option ...\n.Ar ", command->name);
    print_text(command->arguments[0] ? command->arguments : "\\&");
    printf(".Sh DESCRIPTION\n");
    print_text(command->description);
    if (command_about_sets(command)[0]) print_text(command_about_sets(command));
    printf(".Pp\nThe options are:\n.Bl -tag -width Ds\n");
    for (const struct argp_option *o = command->options; !ends(o); o++)
        if (o->name) print_option(command, o);
    for (const struct argp_option *o = command_common; !ends(o); o++) print_option(command, o);
    printf(".El\n.Pp\nOptions may follow arguments.\nEnvironment variables and exit status are those of\n.Xr glint 1 "
           ".\n.Sh EXAMPLES\n");
    for (const struct example *e = command->examples; e->line; e++) {
        if (e != command->examples) printf(".Pp\n");
        printf(".Dl ");
        print_text(e->line);
        printf(".Pp\n");
        print_text(e->what);
    }
    printf(".Sh SEE ALSO\n.Xr glint 1\n");
}

void man_print_program(void) {
    print_head("GLINT");
    printf(".Nm glint\n.Nd replay the reflection passes of captured frames offline\n"
           ".Sh SYNOPSIS\n.Nm\n.Ar command\n.Op Ar option ...\n.Op Ar argument ...\n"
           ".Nm\n.Fl \\-help | \\-version\n"
           ".Sh DESCRIPTION\n"
           "An engine dumps one frame (G\\-buffer, lit colour, cube maps, camera) into a multi\\-part OpenEXR file, a "
           "capture.\n.Nm\n"
           "runs any subset of the reflection passes on it with Vulkan and writes every intermediate image back.\n"
           "Results go to standard output, messages to standard error; commands that report have\n.Fl \\-json .\n"
           ".Pp\nThe commands, each with a page of its own:\n.Bl -tag -width Ds\n");
    for (size_t i = 0; i < command_count; i++) {
        printf(".It Xr glint\\-%s 1\n", commands[i]->name);
        print_text(commands[i]->summary);
    }
    printf(".El\n"
           ".Sh ENVIRONMENT\n.Bl -tag -width GLINT_DISPATCH_LIMIT\n"
           ".It Ev GLINT_CACHE\nThe folder in which results for cube maps and traced references are kept; none "
           "disables it.\n"
           ".It Ev GLINT_CACHE_GIB\nHow much it may hold, in GiB (default 4).\n"
           ".It Ev GLINT_DEVICE\nThe device to use: its index or a part of its name.\n"
           ".It Ev GLINT_DISPATCH_LIMIT\nThe seconds that the device may take for a pass.\n"
           ".It Ev GLINT_PASSES\nA folder whose shaders replace the built-in ones, such as a source tree's\n.Pa "
           "passes/\n"
           "that is being edited.\nFiles that it does not contain, and the declarations, stay built in.\n"
           ".It Ev GLINT_PRESETS\nA folder with presets, searched before the installed one.\n"
           ".It Ev GLINT_VALIDATION\n1 enables the Khronos validation layer.\n"
           ".It Ev NO_COLOR\nIf set, no colour unless\n.Fl \\-color\nasks for it.\n"
           ".It Ev OCIO\nThe OpenColorIO configuration for\n.Nm glint view .\n.El\n"
           ".Sh EXIT STATUS\n.Bl -tag -width 130\n"
           ".It 0\nDone.\n.It 1\nA check failed, or the input is bad.\n.It 2\nWrong usage.\nOf\n.Nm glint selftest "
           ":\nthe cases could not be run.\n"
           ".It 130\nInterrupted; no incomplete files are left.\n.El\n"
           ".Sh SEE ALSO\n.Xr exrheader 1 ,\n.Xr oiiotool 1\n");
}
