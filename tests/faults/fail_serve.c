/* The program's beginning: main is counted. With GLINT_FAIL_SERVER ("READ WRITE", two open files) the process that was started does not
   run main itself: for each line that it reads, what is asked for, it forks one that does, with what goes to stdout and stderr in files
   GLINT_FAIL_REPORT.out and .err; it answers "pid PID" at once and "ended STATUS", as waitpid has it, at the end. So linking a program
   with a hundred libraries is paid once. GLINT_FAIL_LOAD names one that is loaded beforehand, too. */
#include "fail.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_BYTES = 4096, LINE_BYTES = 128 };

static int (*program_main)(int, char **, char **);

static void redirect(int to, const char *report, const char *suffix) {
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s%s", report, suffix);
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || dup2(file, to) < 0) _exit(98);
    close(file);
}

/* One line, byte by byte, as nothing is to be buffered that a child would share. */
static bool read_line(int from, char line[LINE_BYTES]) {
    size_t length = 0;
    while (length + 1 < LINE_BYTES && read(from, line + length, 1) == 1 && line[length] != '\n') length++;
    line[length] = '\0';
    return length > 0;
}

/* Returns in children only; what is asked for is in `line`. */
static void serve(int from, int to, const char *report, char line[LINE_BYTES]) {
    while (read_line(from, line)) {
        const pid_t child = fork();
        if (child == 0) {
            close(from);
            close(to);
            redirect(STDOUT_FILENO, report, ".out");
            redirect(STDERR_FILENO, report, ".err");
            return;
        }
        int status = 0;
        dprintf(to, "pid %d\n", (int)child);
        if (child < 0 || waitpid(child, &status, 0) < 0) _exit(98);
        dprintf(to, "ended %d\n", status);
    }
    _exit(0);
}

static int counted_main(int argc, char **argv, char **variables) {
    char line[LINE_BYTES];
    const char *asked = getenv("GLINT_FAIL"), *report = getenv("GLINT_FAIL_REPORT");
    const char *server = getenv("GLINT_FAIL_SERVER"), *library = getenv("GLINT_FAIL_LOAD");
    int from, to;
    if (server && report && sscanf(server, "%d %d", &from, &to) == 2) {
        if (library) dlopen(library, RTLD_NOW | RTLD_GLOBAL);
        serve(from, to, report, line);
        asked = line;
    }
    fail_begin(asked, report);
    const int status = program_main(argc, argv, variables);
    fail_end();
    return status;
}

typedef int start_function(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void),
                           void *);

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld)(void), void *stack);
int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld)(void), void *stack) {
    program_main = main;
    start_function *start;
    *(void **)&start = dlsym(RTLD_NEXT, "__libc_start_main");
    return start(counted_main, argc, argv, init, fini, rtld, stack);
}
