/* Runs other programs. What they print goes into files in memory, so that neither side waits for the other to read. */
#include "io/program.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* What is in the file, NUL-terminated. */
static char *contents(int file, const char *program, struct glint_error *err) {
    const off_t size = lseek(file, 0, SEEK_END);
    if (size < 0 || size > PROGRAM_MOST)
        return glint_fail(err, GLINT_ERROR_IO, "%s: printed more than %d bytes", program, PROGRAM_MOST), NULL;
    char *text = calloc(1, (size_t)size + 1);
    if (!text) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory"), NULL;
    for (off_t at = 0; at < size;) {
        const ssize_t n = pread(file, text + at, (size_t)(size - at), at);
        if (n > 0) at += n;
        else if (n == 0 || errno != EINTR) {
            glint_fail(err, GLINT_ERROR_IO, "%s: what it printed: %s", program, n ? strerror(errno) : "cut");
            free(text);
            return NULL;
        }
    }
    return text;
}

static int start(pid_t *process, const char *const *words, const char *folder, const int files[2]) {
    posix_spawn_file_actions_t actions;
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed) return failed;
    if (!failed) failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    for (int i = 0; i < 2 && !failed; i++) failed = posix_spawn_file_actions_adddup2(&actions, files[i], 1 + i);
    if (!failed) failed = posix_spawn_file_actions_addchdir_np(&actions, folder);
    if (!failed) failed = posix_spawnp(process, words[0], &actions, NULL, (char *const *)words, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

static bool end(pid_t process, const char *program, int messages, struct glint_error *err) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", program, strerror(errno));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
    char *text = contents(messages, program, err);
    if (!text) return false;
    size_t length = strlen(text);
    while (length && text[length - 1] == '\n') text[--length] = '\0';
    for (char *p = text; *p; p++)
        if (*p == '\n') *p = ' ';
    if (WIFSIGNALED(status)) glint_fail(err, GLINT_ERROR_IO, "%s: killed by signal %d", program, WTERMSIG(status));
    else
        glint_fail(err, GLINT_ERROR_IO, "%s: exit status %d%s%.400s", program, WEXITSTATUS(status), text[0] ? ": " : "",
                   text);
    free(text);
    return false;
}

char *program_run(const char *const *words, const char *folder, struct glint_error *err) {
    const int files[2] = {memfd_create("stdout", MFD_CLOEXEC), memfd_create("stderr", MFD_CLOEXEC)};
    pid_t process;
    char *text = NULL;
    const int failed = files[0] < 0 || files[1] < 0 ? errno : start(&process, words, folder, files);
    if (failed == ENOENT)
        glint_fail(err, GLINT_ERROR_IO, "%s: there is no such program in $PATH on this machine", words[0]);
    else if (failed) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be run: %s", words[0], strerror(failed));
    else if (end(process, words[0], files[1], err)) text = contents(files[0], words[0], err);
    for (int i = 0; i < 2; i++)
        if (files[i] >= 0) close(files[i]);
    return text;
}
