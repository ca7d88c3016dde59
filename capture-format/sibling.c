/* Siblings: files beside a capture that hold its cube maps. */
#include "sibling.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "hash.h"

static bool same_letters(const char *a, const char *b, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (toupper((unsigned char)a[i]) != b[i]) return false;
    return true;
}

/* Names that Windows takes for a device in every folder, whatever follows after a dot. */
static bool is_device_name(const char *name) {
    static const char *const devices[] = {"CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$", "COM#", "LPT#"};
    size_t length = strcspn(name, ".");
    while (length && name[length - 1] == ' ') length--;
    for (size_t i = 0; i < sizeof devices / sizeof *devices; i++) {
        const size_t fixed = strcspn(devices[i], "#");
        if (length < fixed || !same_letters(name, devices[i], fixed)) continue;
        if (!devices[i][fixed] ? length == fixed : length == fixed + 1 && isdigit((unsigned char)name[fixed]))
            return true;
        /* The superscript digits 1, 2 and 3 count as well. */
        const bool superscript =
            length == fixed + 2 && name[fixed] == '\xC2' && strchr("\xB9\xB2\xB3", name[fixed + 1]);
        if (devices[i][fixed] && superscript) return true;
    }
    return false;
}

bool glint_sibling_is_plain(const char *name) {
    const size_t length = strlen(name);
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)name[i] < 32 || name[i] == 127 || strchr("/\\:*?\"<>|", name[i])) return false;
    return length && name[length - 1] != '.' && name[length - 1] != ' ' && !is_device_name(name);
}

char *glint_sibling_path(const char *path, const char *sibling) {
    const size_t folder = glint_path_folder(path);
    char *full = malloc(folder + strlen(sibling) + 1);
    if (!full) return NULL;
    memcpy(full, path, folder);
    strcpy(full + folder, sibling);
    return full;
}

bool glint_hash_sibling(const char *path, const char *sibling, char hex[33], struct glint_error *err) {
    char *full = glint_sibling_path(path, sibling);
    if (!full) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    const glint_file file = glint_file_open(full);
    bool ok =
        file != GLINT_NO_FILE || glint_fail(err, GLINT_ERROR_IO, "%s: sibling of %s: %s", full, path, strerror(errno));
    ok = ok && glint_hash_file(file, full, hex, err);
    if (file != GLINT_NO_FILE) glint_file_close(file);
    free(full);
    return ok;
}
