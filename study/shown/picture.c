/* The final picture of a run, and its error where transparent surfaces or water cover the opaque ones. */
#include "glint/study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "values.h"

const struct glint_image *glint_study_picture(struct glint_replay *replay) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    const struct glint_image *last = NULL;
    bool composed = false;
    for (size_t i = 0; i < count; i++) {
        composed = composed || glint_pass_role(results[i].pass, GLINT_ROLE_COMPOSED);
        const struct glint_image *image = composed && results[i].shown ? study_radiance(replay, results[i].pass) : NULL;
        if (image) last = image;
    }
    return last;
}

static bool reads_part(const struct glint_pass *pass, const char *part) {
    size_t count = 0;
    const struct glint_row *images = glint_capture_images(&count);
    for (size_t r = 0; r < pass->row_count; r++)
        for (size_t i = 0; pass->rows[r].kind == GLINT_ROW_READ && i < count; i++)
            if (!strcmp(images[i].name, pass->rows[r].name) && !strcmp(images[i].role, part)) return true;
    return false;
}

bool glint_study_reads_part(struct glint_replay *replay, const char *part) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; i < count; i++)
        if (results[i].ran && reads_part(results[i].pass, part)) return true;
    return false;
}

bool glint_study_overlay_error(const struct glint_pixels *picture, struct glint_capture *capture, const char *part,
                               struct glint_image_error *error, struct glint_error *err) {
    static const char *const rgb[] = {"R", "G", "B"}, *const depth[] = {"depth.Z"};
    const struct glint_part_info *scene = glint_capture_find(capture, GLINT_PART_SCENE),
                                 *over = glint_capture_find(capture, part);
    *error = (struct glint_image_error){0};
    if (!scene || !over) return true;
    const size_t pixels = (size_t)scene->width * scene->height;
    struct glint_pixels truth = {scene->width, scene->height, 3, study_channels(capture, scene->name, rgb, 3, err)};
    float *z = truth.values ? study_channels(capture, part, depth, 1, err) : NULL;
    uint8_t *mask = calloc(pixels, 1);
    struct glint_image_errors errors = {0};
    bool ok = z && (mask || glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part));
    for (size_t i = 0; ok && i < pixels; i++) mask[i] = z[i] < INFINITY ? GLINT_CLASS_FIRST : GLINT_CLASS_NONE;
    ok = ok && glint_study_image(picture, &truth, 3, mask, NULL, &errors, err);
    *error = errors.of[0];
    free(mask);
    free(z);
    glint_pixels_finish(&truth);
    return ok;
}
