/* Writes the results of glint stability as a run folder of layers. */
#include "stability/stability.h"

#include <stdio.h>
#include <stdlib.h>

#include "glint/exr.h"
#include "journal/journal.h"
#include "draw/view/png_file.h"
#include "draw/view/render.h"
#include "io/output.h"
#include "record.h"

enum { LAYERS = 3 };

/* The entry of one part in run.json. */
static json_t *part_json(const char *file, const char *name, const char *channels, const char *unit,
                         const char *meaning, uint32_t width, uint32_t height, bool integer) {
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:s}", "name", name, "file", file, "part", name,
                     "channels", channels, "unit", unit, "meaning", meaning, "width", (int)width, "height", (int)height,
                     "format", integer ? "R32UI" : "R32F");
}

/* ---- One file for each pass ---- */

struct layers {
    struct glint_exr_channel channels[LAYERS];
    float *flips;
};

static bool fill_layers(struct layers *layers, struct glint_exr_part *part, const struct glint_stability_image *image,
                        struct glint_error *err) {
    const size_t texels = (size_t)image->width * image->height;
    const char *const names[] = {"amplification", "change", "flips"};
    if (!(layers->flips = malloc(texels * sizeof *layers->flips)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < texels; i++) layers->flips[i] = image->flips[i];
    const float *const data[] = {image->amplification, image->change, layers->flips};
    size_t count = 0;
    for (int k = 0; k < LAYERS; k++)
        if (data[k])
            layers->channels[count++] =
                (struct glint_exr_channel){.name = names[k], .stored = GLINT_STORED_FLOAT, .data = data[k]};
    *part = (struct glint_exr_part){.name = image->name,
                                    .width = image->width,
                                    .height = image->height,
                                    .channels = layers->channels,
                                    .channel_count = count};
    return true;
}

static bool write_pass(const char *folder, const struct glint_stability *s, const struct glint_stability_pass *pass,
                       json_t *passes, struct glint_error *err) {
    struct glint_exr_part *parts = calloc(s->image_count, sizeof *parts);
    struct layers *layers = calloc(s->image_count, sizeof *layers);
    char file[128], path[4096];
    size_t count = 0;
    json_t *images = json_array();
    bool ok = (parts && layers) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    snprintf(file, sizeof file, "%02zu-%s.exr", pass->place, pass->pass->slot);
    for (size_t i = 0; ok && i < s->image_count; i++) {
        const struct glint_stability_image *image = &s->images[i];
        if (image->pass != pass->pass) continue;
        ok = fill_layers(&layers[count], &parts[count], image, err);
        json_array_append_new(
            images, part_json(file, image->name, image->discrete ? "flips" : "amplification change flips", "1",
                              image->discrete ? "number of replays with a different decision"
                                              : "relative change divided by that of the inputs; root mean "
                                                "square of the relative change; number of "
                                                "replays with a different decision",
                              image->width, image->height, false));
        count++;
    }
    ok = ok && journal_path(folder, file, path, err) && glint_exr_write(path, parts, count, 0, err);
    json_array_append_new(passes, json_pack("{s:s, s:s, s:b, s:o}", "slot", pass->pass->slot, "variant",
                                            pass->pass->variant, "ran", 1, "images", images));
    for (size_t i = 0; layers && i < count; i++) free(layers[i].flips);
    free(layers);
    free(parts);
    return ok;
}

/* ---- Layers over all passes ---- */

static bool write_all(const char *folder, const struct glint_stability *s, json_t *passes, struct glint_error *err) {
    static const char file[] = "stability.exr";
    const struct {
        const char *name, *channel, *meaning;
        const void *data;
        bool integer;
    } maps[] = {
        {"last", "amplification", "amplification of the image of the last pass", s->amplification, false},
        {"start", "index", "number of the first pass above the bound; 0: none", s->start, true},
        {"flip_start", "index", "number of the first pass with a different decision; 0: none", s->flip_start, true},
    };
    enum { MAPS = sizeof maps / sizeof *maps };
    struct glint_exr_channel channels[MAPS];
    struct glint_exr_part parts[MAPS];
    char path[4096];
    json_t *images = json_array();
    for (size_t i = 0; i < MAPS; i++) {
        channels[i] = (struct glint_exr_channel){.name = maps[i].channel,
                                                 .stored = maps[i].integer ? GLINT_STORED_UINT : GLINT_STORED_FLOAT,
                                                 .data = maps[i].data};
        parts[i] = (struct glint_exr_part){
            .name = maps[i].name, .width = s->width, .height = s->height, .channels = &channels[i], .channel_count = 1};
        json_array_append_new(images, part_json(file, maps[i].name, maps[i].channel, "1", maps[i].meaning, s->width,
                                                s->height, maps[i].integer));
    }
    json_array_append_new(
        passes, json_pack("{s:s, s:s, s:b, s:o}", "slot", "stability", "variant", "all", "ran", 1, "images", images));
    return journal_path(folder, file, path, err) && glint_exr_write(path, parts, MAPS, 0, err);
}

static bool write_text(const char *folder, const char *name, json_t *json, struct glint_error *err) {
    char path[4096];
    char *text = json ? record_text(json, JSON_INDENT(1)) : NULL;
    const bool ok = (text || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
                    journal_path(folder, name, path, err) && output_text(path, text, err);
    free(text);
    json_decref(json);
    return ok;
}

/* The amplification of every image over the picture on one scale, and where it starts. */
static bool write_sheet(const char *folder, const struct glint_stability *s, struct glint_error *err) {
    const struct render_options options = {
        .falsecolor = {.scale = SCALE_LOG, .range_given = true, .low = 0.1, .high = 1000}};
    const char *const *runs = &folder;
    const char **images = calloc(s->image_count + 4, sizeof *images);
    struct picture sheet = {0};
    char path[4096];
    size_t count = 0;
    if (!images) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    images[count++] = "last";
    images[count++] = "start";
    images[count++] = "flip_start";
    for (size_t i = 0; i < s->image_count; i++)
        if (s->images[i].amplification && s->images[i].per_pixel) images[count++] = s->images[i].name;
    const bool ok = render_sheet(&sheet, runs, 1, images, false, &options, err) &&
                    journal_path(folder, "stability.png", path, err) && png_file_write(path, &sheet, err);
    picture_finish(&sheet);
    free(images);
    return ok;
}

/* Everything into the folder of a run that is being written. */
static bool write_files(const char *folder, const struct stability_report *report, struct glint_error *err) {
    const struct glint_stability *s = report->stability;
    json_t *passes = json_array();
    bool ok = true;
    for (size_t i = 0; ok && i < s->pass_count; i++) ok = write_pass(folder, s, &s->passes[i], passes, err);
    ok = ok && write_all(folder, s, passes, err) && write_text(folder, "stability.json", stability_json(report), err);
    json_t *run = json_pack("{s:i, s:{s:s}, s:s, s:O}", "format", 1, "tool", "name", "glint stability", "preset",
                            report->preset, "passes", passes);
    json_decref(passes);
    if (!ok) {
        json_decref(run);
        return false;
    }
    return write_text(folder, "run.json", run, err) && write_sheet(folder, s, err);
}

bool stability_write(const char *folder, const struct stability_report *report, struct glint_error *err) {
    struct glint_run_writer *writer = glint_run_writer_open(folder, err);
    const char *inside = writer ? glint_run_writer_begin(writer, err) : NULL;
    const bool ok = inside && write_files(inside, report, err) && glint_run_writer_commit(writer, err);
    glint_run_writer_close(&writer);
    return ok;
}
