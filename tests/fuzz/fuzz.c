/* What the libFuzzer targets share. */
#include "fuzz.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const struct glint_limits fuzz_limits = {.file_bytes = 1 << 22, .memory_bytes = 8 << 20, .width = 64, .parts = 64};

static char folder[512];

static void remove_folder(void) {
    DIR *files = opendir(folder);
    for (const struct dirent *file; files && (file = readdir(files));) unlinkat(dirfd(files), file->d_name, 0);
    if (files) closedir(files);
    rmdir(folder);
}

void fuzz_must(bool holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "this has to hold, and does not: %s\n", what);
    abort();
}

const char *fuzz_folder(void) {
    if (folder[0]) return folder;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/glint-fuzz-XXXXXX", base && base[0] ? base : "/dev/shm");
    fuzz_must(mkdtemp(folder) != NULL, "a folder can be made");
    atexit(remove_folder);
    return folder;
}

/* The files stay open, as opening takes longer than reading many an input. */
const char *fuzz_file(const char *name, const void *data, size_t size) {
    enum { FILES = 8 };
    static struct {
        const char *name;
        char path[600];
        int fd;
    } files[FILES];
    size_t i = 0;
    while (i < FILES && files[i].name && strcmp(files[i].name, name) != 0) i++;
    fuzz_must(i < FILES, "there are few files");
    if (!files[i].name) {
        snprintf(files[i].path, sizeof files[i].path, "%s/%s", fuzz_folder(), name);
        files[i].fd = open(files[i].path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        fuzz_must(files[i].fd >= 0, "a file can be made");
        files[i].name = name;
    }
    fuzz_must(ftruncate(files[i].fd, (off_t)size) == 0 && pwrite(files[i].fd, data, size, 0) == (ssize_t)size,
              "a file can be written");
    return files[i].path;
}

bool fuzz_reason(bool ok, const struct glint_error *err) {
    fuzz_must(ok || (err->code != GLINT_OK && err->message[0]), "a failure has a code and a message");
    return ok;
}

const char *fuzz_text(const uint8_t *data, size_t size) {
    static char *text;
    static size_t room;
    if (size + 1 > room) {
        room = 2 * size + 64;
        free(text);
        text = malloc(room);
        fuzz_must(text != NULL, "there is memory");
    }
    size_t length = 0;
    for (size_t i = 0; i < size; i++)
        if (data[i]) text[length++] = (char)data[i];
    text[length] = '\0';
    return text;
}
