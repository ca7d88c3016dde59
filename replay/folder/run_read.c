/* Reads run folders. They may come from untrusted sources, so names are checked before they become paths. */
#include "glint/replay.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <jansson.h>

#include "glint/exr.h"
#include "inside.h"
#include "row.h"
#include "run_json.h"
#include "run_writer.h"

/* More than any run has. */
enum { RUN_IMAGES = 4096, IMAGE_TEXELS = 1 << 27 };

struct stored_image {
    struct glint_run_image info;
    const char *file, *part;
};

struct glint_run {
    char *folder, *text;
    json_t *root; /* owns the strings of images */
    struct stored_image *images;
    size_t count;
    struct glint_exr *exr; /* the file last read from */
    const char *open_file;
};

static const char *text_of(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

/* The declaration of the image says so, also for its MIP levels. An image of an unknown pass is judged by its shape. */
static bool holds_cubes(const struct glint_run_image *image) {
    const struct glint_pass *pass = glint_pass_find(image->slot, image->variant);
    const char *level = strstr(image->name, ".level");
    const size_t length = level ? (size_t)(level - image->name) : strlen(image->name);
    for (size_t i = 0; pass && i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (row->kind == GLINT_ROW_WRITE && strlen(row->name) == length && !strncmp(row->name, image->name, length))
            return size_is_cube(row->size);
    }
    return image->height % (6 * image->width) == 0;
}

static bool add_image(struct glint_run *run, const json_t *pass, const json_t *image, struct glint_error *err) {
    if (run->count == RUN_IMAGES)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s/run.json: more than %d images", run->folder, RUN_IMAGES);
    struct stored_image *larger = realloc(run->images, (run->count + 1) * sizeof *larger);
    if (!larger) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", run->folder);
    run->images = larger;
    struct stored_image stored = {.info = {.slot = text_of(pass, "slot"),
                                           .variant = text_of(pass, "variant"),
                                           .name = text_of(image, "name"),
                                           .unit = text_of(image, "unit"),
                                           .meaning = text_of(image, "meaning"),
                                           .channels = text_of(image, "channels"),
                                           .encoding = text_of(image, "encoding")},
                                  .file = text_of(image, "file"),
                                  .part = text_of(image, "part")};
    const json_int_t width = json_integer_value(json_object_get(image, "width")),
                     height = json_integer_value(json_object_get(image, "height"));
    const char *format = text_of(image, "format");
    stored.info.integer = strstr(format, "UI") != NULL;
    for (const char *at = stored.info.channels; *at; at += strcspn(at, " "), at += strspn(at, " "))
        stored.info.components++;
    if (!stored.info.name[0] || stored.info.components < 1 || stored.info.components > 4 || width < 1 ||
        width > 1 << 16 || height < 1 || height > 1 << 19 || width * height > IMAGE_TEXELS)
        return glint_fail(err, GLINT_ERROR_FORMAT,
                          "%s/run.json: slot %s: image %s: expected a name, 1 to 4 channels and a size of at most %d "
                          "texels",
                          run->folder, stored.info.slot, stored.info.name, IMAGE_TEXELS);
    if (!stored.file[0] || strchr(stored.file, '/') || stored.file[0] == '.')
        return glint_fail(err, GLINT_ERROR_FORMAT,
                          "%s/run.json: image %s: expected the name of a file in the folder, found '%s'", run->folder,
                          stored.info.name, stored.file);
    stored.info.width = (uint32_t)width;
    stored.info.height = (uint32_t)height;
    stored.info.cube = holds_cubes(&stored.info);
    run->images[run->count++] = stored;
    return true;
}

static bool parse_run(struct glint_run *run, struct glint_error *err) {
    json_error_t fault;
    json_t *pass, *image;
    size_t p, i;
    if (!inside_json_fits(run->folder, run->text, strlen(run->text), err)) return false;
    run->root = json_loads(run->text, 0, &fault);
    if (!run->root)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json:%d:%d: %s", run->folder, fault.line, fault.column,
                          fault.text);
    const json_int_t format = json_integer_value(json_object_get(run->root, "format"));
    if (format != 1)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s/run.json: expected format 1, found %lld", run->folder,
                          (long long)format);
    if (!json_is_array(json_object_get(run->root, "passes")))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json: expected an array of passes", run->folder);
    json_array_foreach(json_object_get(run->root, "passes"), p, pass) {
        json_array_foreach(json_object_get(pass, "images"), i, image) {
            if (!add_image(run, pass, image, err)) return false;
        }
    }
    /* What a comparison with a better image left. */
    const json_t *compared = json_object_get(run->root, "compared");
    json_array_foreach(json_object_get(compared, "images"), i, image) {
        if (!add_image(run, compared, image, err)) return false;
    }
    return true;
}

static bool check_is_run(const char *folder, const char *path, struct glint_error *err) {
    struct stat info;
    if (stat(folder, &info)) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno));
    if (!S_ISDIR(info.st_mode))
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected a run, which is a folder, found a file", folder);
    return run_writer_recover(folder) || access(path, F_OK) == 0 ||
           glint_fail(err, GLINT_ERROR_IO, "%s: expected a run, found a folder without run.json", folder);
}

struct glint_run *glint_run_open(const char *folder, struct glint_error *err) {
    struct glint_run *run = calloc(1, sizeof *run);
    char path[4096];
    if (!run || !(run->folder = strdup(folder))) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
        free(run);
        return NULL;
    }
    snprintf(path, sizeof path, "%s/run.json", folder);
    if (!check_is_run(folder, path, err) || !(run->text = inside_text(path, RUN_JSON_BYTES, err)) ||
        !parse_run(run, err))
        glint_run_close(&run);
    return run;
}

void glint_run_close(struct glint_run **pointer) {
    struct glint_run *run = *pointer;
    *pointer = NULL;
    if (!run) return;
    if (run->exr) glint_exr_close(&run->exr);
    json_decref(run->root);
    free(run->images);
    free(run->text);
    free(run->folder);
    free(run);
}

const char *glint_run_json(const struct glint_run *run) {
    return run->text;
}
size_t glint_run_image_count(const struct glint_run *run) {
    return run->count;
}
const struct glint_run_image *glint_run_image(const struct glint_run *run, size_t i) {
    return i < run->count ? &run->images[i].info : NULL;
}

const struct glint_run_image *glint_run_find(const struct glint_run *run, const char *name) {
    for (size_t i = 0; i < run->count; i++)
        if (strcmp(run->images[i].info.name, name) == 0) return &run->images[i].info;
    return NULL;
}

static bool open_file(struct glint_run *run, const char *file, struct glint_error *err) {
    char path[4096];
    if (run->exr && strcmp(run->open_file, file) == 0) return true;
    if (run->exr) glint_exr_close(&run->exr);
    snprintf(path, sizeof path, "%s/%s", run->folder, file);
    run->open_file = file;
    run->exr = glint_exr_open(path, &(struct glint_limits){.no_link = true}, err);
    return run->exr != NULL;
}

bool glint_run_read(struct glint_run *run, const struct glint_run_image *image, enum glint_type type, void *out,
                    struct glint_error *err) {
    const struct stored_image *stored = run->images;
    while (stored < run->images + run->count && &stored->info != image) stored++;
    if (stored == run->images + run->count)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: the image does not belong to this run", run->folder);
    if (!open_file(run, stored->file, err)) return false;
    struct channel_names names;
    channel_names(&names, image->channels);
    for (size_t p = 0; p < glint_exr_part_count(run->exr); p++) {
        const struct glint_exr_part_info *part = glint_exr_part(run->exr, p);
        if (strcmp(part->name, stored->part) != 0) continue;
        if (part->width != image->width || part->height != image->height)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s/%s: part %s: expected %u x %u, found %u x %u", run->folder,
                              stored->file, part->name, image->width, image->height, part->width, part->height);
        struct glint_error own = {0};
        if (glint_exr_read(run->exr, p, names.list, names.count, type, out, 0, &own)) return true;
        /* What does not fit the record is the file's fault, not the caller's. */
        return glint_fail(err, own.code == GLINT_ERROR_USAGE ? GLINT_ERROR_FORMAT : own.code, "%s", own.message);
    }
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s/%s: part %s: missing", run->folder, stored->file, stored->part);
}

bool glint_encoding_is_display(const char *encoding) {
    return encoding && !strcmp(encoding, "srgb");
}

void glint_decode_display(float *values, size_t pixels, const char *const *names, size_t channels) {
    for (size_t c = 0; c < channels; c++) {
        if (!names[c][0] || names[c][1] || !strchr("RGB", names[c][0])) continue;
        for (size_t i = 0; i < pixels; i++) values[i * channels + c] = glint_linear_of_srgb(values[i * channels + c]);
    }
}

bool glint_run_read_linear(struct glint_run *run, const struct glint_run_image *image, float *out,
                           struct glint_error *err) {
    struct channel_names names;
    if (!glint_run_read(run, image, GLINT_F32, out, err)) return false;
    channel_names(&names, image->channels);
    if (glint_encoding_is_display(image->encoding))
        glint_decode_display(out, (size_t)image->width * image->height, names.list, names.count);
    return true;
}
