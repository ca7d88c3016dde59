/* The page of a shot: a folder of runs, one for each frame. Pictures as a player; error and flicker over the frames. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report/shot.h"
#include "draw/view/pixels.h"
#include "options/effect_args.h"
#include "io/output.h"

/* ---- The frames ---- */

bool report_is_shot(const char *folder) {
    char run[4096], shot[4096];
    return snprintf(run, sizeof run, "%s/run.json", folder) < (int)sizeof run &&
           snprintf(shot, sizeof shot, "%s/shot.json", folder) < (int)sizeof shot && access(run, F_OK) != 0 &&
           access(shot, F_OK) == 0;
}

static int by_number(const void *a, const void *b) {
    const struct shot_frame *x = a, *y = b;
    return x->number != y->number ? (x->number > y->number) - (x->number < y->number) : strcmp(x->name, y->name);
}

static bool add_frame(struct shot_report *shot, const char *name, struct glint_error *err) {
    struct shot_frame frame = {0}, *larger;
    char record[4200];
    if (snprintf(frame.folder, sizeof frame.folder, "%s/%s", shot->folder, name) >= (int)sizeof frame.folder)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", shot->folder);
    snprintf(record, sizeof record, "%s/run.json", frame.folder);
    struct stat info;
    if (access(record, F_OK) != 0) return true; /* not complete */
    if (lstat(frame.folder, &info) != 0 || S_ISLNK(info.st_mode))
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected a run, found a symbolic link, which is not followed",
                          frame.folder);
    struct glint_run *run = glint_run_open(frame.folder, err);
    if (!run) return false;
    frame.run = json_loads(glint_run_json(run), 0, NULL);
    glint_run_close(&run);
    snprintf(frame.name, sizeof frame.name, "%s", name);
    frame.number = json_integer_value(json_object_get(frame.run, "frame"));
    larger = realloc(shot->frames, (shot->count + 1) * sizeof *larger);
    if (!larger || !frame.run) {
        json_decref(frame.run);
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    shot->frames = larger;
    shot->frames[shot->count++] = frame;
    return true;
}

/* In the order of their frame numbers. */
static bool read_frames(struct shot_report *shot, struct glint_error *err) {
    DIR *folder = opendir(shot->folder);
    bool ok = folder || glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read", shot->folder);
    for (struct dirent *entry; ok && (entry = readdir(folder));)
        ok = entry->d_name[0] == '.' || add_frame(shot, entry->d_name, err);
    if (folder) closedir(folder);
    if (ok && !shot->count)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: expected the runs of a shot's frames, found none", shot->folder);
    if (shot->count) qsort(shot->frames, shot->count, sizeof *shot->frames, by_number);
    return ok;
}

static void shot_finish(struct shot_report *shot) {
    for (size_t i = 0; i < shot->count; i++) json_decref(shot->frames[i].run);
    free(shot->frames);
}

/* ---- Pictures ---- */

/* Adds the picture of a frame to a track. Values that are no numbers are magenta. */
static bool add_picture(struct shot_report *shot, size_t frame, enum shot_track track, const struct source *source,
                        const struct render_options *options, struct glint_error *err) {
    enum { WIDEST_PX = 960 };
    struct picture picture = {0};
    struct legend legend;
    size_t invalid;
    bool ok = render_plain(&picture, &legend, source, options, &invalid, err) &&
              picture_shrink(&picture, (picture.width + WIDEST_PX - 1) / WIDEST_PX, true, err);
    json_t *file = ok ? page_picture(&picture, PAGE_PICTURE_BYTES / (shot->count * SHOT_TRACKS), err) : NULL;
    if (file)
        json_array_append_new(shot->tracks[track],
                              json_pack("{s:o, s:o}", "file", file, "caption",
                                        json_sprintf("frame %lld: %s", shot->frames[frame].number, source->title)));
    if (file && !shot->keys[track]) shot->keys[track] = page_key(&legend);
    picture_finish(&picture);
    return file != NULL;
}

static bool add_run_image(struct shot_report *shot, size_t frame, enum shot_track track, const char *image,
                          struct glint_error *err) {
    const struct source_choice choice = {.path = shot->frames[frame].folder, .image = image};
    const struct render_options options = {0};
    struct source source;
    const bool ok = source_open(&source, &choice, err) && add_picture(shot, frame, track, &source, &options, err);
    source_finish(&source);
    return ok;
}

/* Where the reflection is off the truth, from 0 to 1. */
static bool add_error_image(struct shot_report *shot, size_t frame, const struct shot_pixels *p,
                            struct glint_error *err) {
    struct glint_pixels difference = {0};
    const struct render_options options = pixels_options();
    bool ok = pixels_difference(&p->found, &p->truth, p->error, p->mask, &difference, err);
    const struct source source = pixels_source(&difference, "error, |found \u2212 true| / (|found| + |true|)");
    ok = ok && add_picture(shot, frame, SHOT_ERROR, &source, &options, err);
    glint_pixels_finish(&difference);
    return ok;
}

static bool add_pictures(struct shot_report *shot, size_t frame, const struct shot_pixels *p, struct glint_error *err) {
    const struct render_options options = {0};
    if (!add_run_image(shot, frame, SHOT_FINAL, NULL, err)) return false;
    if (!p->found.values) return true;
    const struct source found = pixels_source(&p->found, shot->effect->noun), truth = pixels_source(&p->truth, "truth");
    return add_picture(shot, frame, SHOT_RESULT, &found, &options, err) &&
           (!p->truth.values ||
            (add_picture(shot, frame, SHOT_TRUTH, &truth, &options, err) && add_error_image(shot, frame, p, err)));
}

/* ---- All frames, two at a time ---- */

static bool measure(struct shot_report *shot, struct glint_error *err) {
    struct shot_pixels two[2] = {{.error = NULL}};
    bool ok = true;
    for (size_t i = 0; ok && i < shot->count; i++) {
        shot_pixels_finish(&two[0]);
        two[0] = two[1];
        two[1] = (struct shot_pixels){.error = NULL};
        ok = shot_read(shot, i, &two[1], err) && add_pictures(shot, i, &two[1], err) &&
             shot_measure(shot, &shot->frames[i], i ? &two[0] : NULL, &two[1], err);
    }
    for (int k = 0; k < 2; k++) shot_pixels_finish(&two[k]);
    return ok;
}

static void add_player(const struct shot_report *shot, json_t *blocks) {
    const char *const names[SHOT_TRACKS] = {"Final image", shot->effect->title, "Truth", "Error"};
    json_t *tracks = json_array(), *frames = json_array(), *marks = json_array();
    for (int k = 0; k < SHOT_TRACKS; k++)
        if (json_array_size(shot->tracks[k]) == shot->count)
            json_array_append_new(tracks, json_pack("{s:s, s:O, s:O*}", "name", names[k], "pictures", shot->tracks[k],
                                                    "key", shot->keys[k]));
    for (size_t i = 0; i < shot->count; i++) json_array_append_new(frames, shot_frame_name(&shot->frames[i]));
    for (int k = 0; k < SHOT_FIGURES; k++)
        if (shot->worst[k] < shot->count)
            json_array_append_new(marks, json_pack("{s:I, s:s}", "frame", (json_int_t)shot->worst[k], "label",
                                                   k == SHOT_BY_ERROR ? "largest error" : "largest flicker"));
    json_array_append_new(blocks, json_pack("{s:{s:s, s:o, s:o, s:o}}", "player", "title", shot->folder, "frames",
                                            frames, "tracks", tracks, "marks", marks));
}

static void add_facts(const struct shot_report *shot) {
    const json_t *first = shot->frames[0].run, *last = shot->frames[shot->count - 1].run;
    char text[64];
    snprintf(text, sizeof text, "%zu, from %lld to %lld", shot->count, shot->frames[0].number,
             shot->frames[shot->count - 1].number);
    page_fact(shot->document, "frames", text);
    page_fact(shot->document, "first capture", report_text(json_object_get(first, "capture"), "path"));
    page_fact(shot->document, "last capture", report_text(json_object_get(last, "capture"), "path"));
    page_fact(shot->document, "preset", report_text(first, "preset"));
    page_fact(shot->document, "device", report_text(json_object_get(first, "device"), "name"));
}

/* By the first frame. */
static bool find_effect(struct shot_report *shot, const char *name, struct glint_error *err) {
    struct glint_run *run = glint_run_open(shot->frames[0].folder, err);
    shot->effect = run ? effect_of_run(name, run, err) : NULL;
    glint_run_close(&run);
    return shot->effect != NULL;
}

json_t *report_shot(const char *folder, const char *effect, struct glint_error *err) {
    struct shot_report shot = {.folder = folder};
    for (int k = 0; k < SHOT_TRACKS; k++) shot.tracks[k] = json_array();
    bool ok = read_frames(&shot, err) && find_effect(&shot, effect, err) && measure(&shot, err);
    if (ok) {
        char title[400];
        snprintf(title, sizeof title, "%.280s: frames %lld to %lld", folder, shot.frames[0].number,
                 shot.frames[shot.count - 1].number);
        shot.document = page_create(title);
        shot_find_worst(&shot);
        add_facts(&shot);
        json_t *blocks = page_section(shot.document, "Pictures");
        for (size_t i = 1; i < shot.count; i++)
            if (shot.frames[i].number != shot.frames[i - 1].number + 1) {
                page_text(blocks, "note",
                          "The numbers of the frames have gaps: there, change is not from one frame to the next.");
                break;
            }
        add_player(&shot, blocks);
        shot_charts(&shot);
    }
    for (int k = 0; k < SHOT_TRACKS; k++) {
        json_decref(shot.tracks[k]);
        json_decref(shot.keys[k]);
    }
    shot_finish(&shot);
    if (ok) return shot.document;
    json_decref(shot.document);
    return NULL;
}
