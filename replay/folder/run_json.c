/* Writes and removes run.json, which is written last and so marks a run folder as complete. */
#include "run_json.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "complete.h"
#include "glint/replay.h"
#include "inside.h"
#include "record.h"

enum { PATH_SIZE = 4096 };

/* Removes the files of a pass's images; failures are harmless: several images share a file. */
static void remove_images(const char *folder, const json_t *pass) {
    char path[PATH_SIZE];
    json_t *image;
    size_t i;
    json_array_foreach(json_object_get(pass, "images"), i, image) {
        const char *file = json_string_value(json_object_get(image, "file"));
        const size_t length = file ? strlen(file) : 0;
        if (length < 5 || strchr(file, '/') || strcmp(file + length - 4, ".exr") != 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, file);
        unlink(path);
    }
}

bool glint_run_remove(const char *folder, struct glint_error *err) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/run.json", folder);
    char *text = inside_text(path, 1 << 24, NULL);
    json_t *root = text && inside_json_fits(path, text, strlen(text), NULL) ? json_loads(text, 0, NULL) : NULL, *pass;
    size_t p;
    bool ok = unlink(path) == 0 || errno == ENOENT || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (ok) {
        json_array_foreach(json_object_get(root, "passes"), p, pass) remove_images(folder, pass);
        remove_images(folder, json_object_get(root, "compared"));
    }
    json_decref(root);
    free(text);
    return ok;
}

bool run_write_json(const char *folder, const json_t *root, struct glint_error *err) {
    char path[PATH_SIZE];
    struct complete_file out;
    if (snprintf(path, sizeof path, "%s/run.json", folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    if (!complete_open(&out, path, err)) return false;
    char *text = record_text(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    bool ok = text || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    if (ok && !glint_file_write(out.file, text, strlen(text), 0))
        ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    free(text);
    return complete_close(&out, ok, false, err);
}

bool glint_run_write_json(const char *folder, const char *text, struct glint_error *err) {
    json_error_t fault;
    json_t *root = json_loads(text, 0, &fault);
    const bool ok = root ? run_write_json(folder, root, err)
                         : glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json: %s", folder, fault.text);
    json_decref(root);
    return ok;
}
