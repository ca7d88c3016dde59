/* Pictures of studies as files. */
#include "journal/drawing.h"

#include <unistd.h>

#include "draw/view/pixels.h"
#include "draw/view/png_file.h"
#include "glint/study.h"
#include "journal/journal.h"

bool drawing_write(const char *folder, const char *name, const struct glint_pixels *pixels, const char *title,
                   struct glint_error *err) {
    char path[4096];
    struct picture picture = {0};
    const bool ok = journal_path(folder, name, path, err) && pixels_draw(&picture, pixels, title, NULL, err) &&
                    png_file_write(path, &picture, err);
    picture_finish(&picture);
    return ok;
}

bool drawing_write_picture(struct glint_judge *judge, const char *folder, const char *name, struct glint_error *err) {
    struct glint_replay *replay = glint_judge_replay(judge);
    const struct glint_image *image = glint_study_picture(replay);
    struct glint_pixels pixels = {0};
    if (!image) return true;
    const bool ok = pixels_read(replay, image, &pixels, err) && drawing_write(folder, name, &pixels, "", err);
    glint_pixels_finish(&pixels);
    return ok;
}

bool drawing_write_error(struct glint_judge *judge, enum glint_target target, const struct glint_pipeline *pipeline,
                         const struct glint_pixels *result, const char *folder, const char *name, const char *title,
                         struct glint_error *err) {
    struct glint_pixels error = {0};
    const float *noise;
    const struct glint_pixels *answer = glint_judge_target(judge, target, pipeline, &noise, NULL, NULL, err);
    const bool ok = answer && pixels_difference(result, answer, noise, glint_judge_labels(judge), &error, err) &&
                    drawing_write(folder, name, &error, title, err);
    glint_pixels_finish(&error);
    return ok;
}

void drawing_add(json_t *pictures, const char *folder, const char *name, const char *caption, bool beside) {
    char path[4096];
    struct glint_error ignored = {0};
    if (!journal_path(folder, name, path, &ignored) || access(path, F_OK) != 0) return;
    json_t *picture = json_pack("{s:s, s:s}", "file", name, "caption", caption);
    if (beside) json_object_set_new(picture, "beside", json_true());
    json_array_append_new(pictures, picture);
}
