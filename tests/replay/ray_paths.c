#include "ray_paths.h"

#include <math.h>
#include <stdio.h>

#include "unit.h"

/* The surface of a pixel relative to the world's origin, and the unit direction of its mirror ray. Inverts the rows (a 0 c 0), (0 b d
   0), (0 0 0 ±1) of the projection, and the rotation. */
static void mirror_ray(const struct glint_frame *frame, const double uv[2], const float *surface, double origin[3],
                       double direction[3]) {
    const double *clip = frame->camera.view_to_clip, *m = frame->camera.world_to_view, front = clip[14],
                 depth = (double)surface[0];
    const double y = frame->clip_y == GLINT_CLIP_Y_DOWN ? 2 * uv[1] - 1 : 1 - 2 * uv[1];
    const double ray[3] = {(2 * uv[0] - 1 - clip[2] * front) / clip[0], (y - clip[6] * front) / clip[5], front};
    double seen[3], length = 0, along = 0, normal2 = 0;
    for (int k = 0; k < 3; k++) {
        seen[k] = origin[k] = 0;
        for (int r = 0; r < 3; r++)
            seen[k] += m[4 * r + k] * ray[r], origin[k] += m[4 * r + k] * (depth * ray[r] - m[4 * r + 3]);
        length += seen[k] * seen[k];
        along += seen[k] * (double)surface[1 + k];
        normal2 += (double)surface[1 + k] * (double)surface[1 + k];
    }
    for (int k = 0; k < 3; k++) direction[k] = (seen[k] - 2 * along / normal2 * (double)surface[1 + k]) / sqrt(length);
}

static unsigned face_of(const double v[3]) {
    unsigned axis = 0;
    for (unsigned k = 1; k < 3; k++)
        if (fabs(v[k]) > fabs(v[axis])) axis = k;
    return 2 * axis + (v[axis] < 0);
}

void check_ray_paths(const struct glint_survey *survey, const char *path) {
    static const char *const names[] = {"depth.Z", "normal.X", "normal.Y", "normal.Z", "material.metalness"};
    static float pixels[PATHS_WIDTH * PATHS_HEIGHT][5];
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    const bool read = capture && glint_capture_read(capture, glint_capture_find(capture, "gbuffer"), names, 5,
                                                    GLINT_F32, pixels, 0, &err);
    if (!read) fail_msg("%s", err.message);
    uint32_t come_to = 0;
    for (uint32_t i = 0; i < survey->active_traced; i++) {
        const struct glint_survey_cubemap *map = &survey->active[i];
        char name[32];
        snprintf(name, sizeof name, "cubemap.%03u", map->number);
        const struct glint_part_info *part = glint_capture_find(capture, name);
        assert_non_null(part);
        unsigned faces = 0;
        for (int p = 0; p < PATHS_WIDTH * PATHS_HEIGHT; p++) {
            if (!(pixels[p][4] > 0)) continue;
            const double uv[2] = {(p % PATHS_WIDTH + 0.5) / PATHS_WIDTH, (p / PATHS_WIDTH + 0.5) / PATHS_HEIGHT};
            double origin[3], direction[3], at[3];
            mirror_ray(glint_capture_frame(capture), uv, pixels[p], origin, direction);
            for (double t = 0; t < 1e5; t = 1.05 * t + 0.01) {
                for (int k = 0; k < 3; k++) at[k] = origin[k] + t * direction[k] - part->cubemap.center[k];
                faces |= 1u << face_of(at);
            }
        }
        assert_int_equal(faces & ~map->crossed, 0);
        for (; faces; faces &= faces - 1) come_to++;
    }
    assert_true(come_to > 0 && glint_survey_faces(survey, GLINT_SURVEY_CROSSED) <= come_to + 2);
    glint_capture_close(&capture);
}
