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

/* Removes the files of a pass's images that are not in `kept`; failures are harmless: several images share a file. */
static void remove_images(const char *folder, const json_t *pass, const json_t *kept) {
    char path[PATH_SIZE];
    json_t *image;
    size_t i;
    json_array_foreach(json_object_get(pass, "images"), i, image) {
        const char *file = json_string_value(json_object_get(image, "file"));
        const size_t length = file ? strlen(file) : 0;
        if (length < 5 || strchr(file, '/') || strcmp(file + length - 4, ".exr") != 0) continue;
        if (json_object_get(kept, file)) continue;
        snprintf(path, sizeof path, "%s/%s", folder, file);
        unlink(path);
    }
}

/* A run.json, which may be anybody's; NULL if it cannot be read. */
static json_t *load_run(const char *path) {
    char *text = inside_text(path, RUN_JSON_BYTES, NULL);
    json_t *root = text && inside_json_fits(path, text, strlen(text), NULL) ? json_loads(text, 0, NULL) : NULL;
    free(text);
    return root;
}

/* {FILE: true} of a run; NULL if it cannot be read whole. */
static json_t *list_files(const json_t *root) {
    json_t *files = root ? json_object() : NULL, *pass, *image;
    size_t p, i;
    json_array_foreach(json_object_get(root, "passes"), p, pass) {
        json_array_foreach(json_object_get(pass, "images"), i, image) {
            record_set(&files, json_string_value(json_object_get(image, "file")), json_true());
        }
    }
    return files;
}

bool run_remove_images(const char *removed, const char *kept, const char *folder, struct glint_error *err) {
    json_t *old = load_run(removed), *root = kept ? load_run(kept) : NULL;
    json_t *files = kept ? list_files(root) : json_object(), *pass;
    size_t p;
    const bool ok = files || glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read", kept);
    if (ok) {
        json_array_foreach(json_object_get(old, "passes"), p, pass) {
            remove_images(folder, pass, files);
        }
        remove_images(folder, json_object_get(old, "compared"), files);
    }
    json_decref(files);
    json_decref(root);
    json_decref(old);
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
