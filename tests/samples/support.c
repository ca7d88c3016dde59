/* Based on the text of the format and on Vulkan's table, not on the tested code. */
#define _XOPEN_SOURCE 700
#include "support.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int folder_make(void **state) {
    char path[] = "/tmp/glint-samples-XXXXXX";
    *state = mkdtemp(path) ? strdup(path) : NULL;
    return *state ? 0 : -1;
}

static int drop(const char *path, UNUSED const struct stat *status, UNUSED int flag, UNUSED struct FTW *place) {
    return remove(path);
}

int folder_remove(void **state) {
    int result = nftw(*state, drop, 8, FTW_DEPTH | FTW_PHYS);
    free(*state);
    return result;
}

const char *in_folder(void **state, const char *name) {
    static char paths[8][512];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", (const char *)*state, name);
    return path;
}

void write_sample(const char *scene, const char *path, const struct glint_sample_options *options) {
    struct glint_error err = {0};
    if (!glint_sample_write(scene, path, options, NULL, NULL, &err)) fail_msg("%s: %s", scene, err.message);
}

struct glint_capture *open_capture(const char *path) {
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

float *read_part(struct glint_capture *capture, const char *part, const char *channels, uint32_t *width,
                 uint32_t *height) {
    struct glint_error err = {0};
    const struct glint_part_info *info = glint_capture_find(capture, part);
    if (!info) fail_msg("no part %s", part);
    char words[256];
    const char *names[16];
    size_t count = 0;
    snprintf(words, sizeof words, "%s", channels);
    for (char *word = strtok(words, " "); word && count < 16; word = strtok(NULL, " ")) names[count++] = word;
    float *values = malloc((size_t)info->width * info->height * count * sizeof *values);
    assert_non_null(values);
    if (!glint_capture_read(capture, info, names, count, GLINT_F32, values, 1, &err)) fail_msg("%s", err.message);
    if (width) *width = info->width;
    if (height) *height = info->height;
    return values;
}

/* view = R·world + t, so that the eye is -Rᵀ·t. */
void camera_eye(const struct glint_camera *camera, double eye[3]) {
    const double *m = camera->world_to_view;
    for (int i = 0; i < 3; i++) eye[i] = -(m[i] * m[3] + m[4 + i] * m[7] + m[8 + i] * m[11]);
}

void camera_ray(const struct glint_camera *camera, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                double direction[3]) {
    const double *m = camera->world_to_view, *p = camera->view_to_clip;
    double w = p[14]; /* clip w = ±view z; one unit ahead is view z = ±1 with the same sign */
    double ndc_x = 2 * (x + 0.5) / width - 1, ndc_y = 1 - 2 * (y + 0.5) / height;
    double view[3] = {(ndc_x - p[2] * w) / p[0], (ndc_y - p[6] * w) / p[5], w};
    for (int i = 0; i < 3; i++) direction[i] = m[i] * view[0] + m[4 + i] * view[1] + m[8 + i] * view[2];
}

void camera_project(const struct glint_camera *camera, const double point[3], double uv[2]) {
    const double *m = camera->world_to_view, *p = camera->view_to_clip;
    double view[4] = {0, 0, 0, 1}, clip[4] = {0};
    for (int r = 0; r < 3; r++)
        view[r] = m[4 * r] * point[0] + m[4 * r + 1] * point[1] + m[4 * r + 2] * point[2] + m[4 * r + 3];
    for (int r = 0; r < 4; r++)
        for (int k = 0; k < 4; k++) clip[r] += p[4 * r + k] * view[k];
    uv[0] = 0.5 + 0.5 * clip[0] / clip[3];
    uv[1] = 0.5 - 0.5 * clip[1] / clip[3];
}

/* Vulkan, "Cube Map Face Selection": by the major axis and its sign, the axes (1 x, 2 y, 3 z) of sc and tc. */
static const int table[6][3] = {{1, -3, -2}, {-1, 3, -2}, {2, 1, 3}, {-2, 1, -3}, {3, 1, -2}, {-3, -1, -2}};

void vulkan_texel(uint32_t face, uint32_t x, uint32_t y, uint32_t size, double direction[3]) {
    const double values[3] = {1, 2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1};
    for (int i = 0; i < 3; i++) {
        int axis = table[face][i];
        direction[abs(axis) - 1] = axis < 0 ? -values[i] : values[i];
    }
}

void vulkan_select(const double direction[3], uint32_t size, uint32_t *face, uint32_t *x, uint32_t *y) {
    int major = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(direction[i]) > fabs(direction[major])) major = i;
    *face = 2 * (uint32_t)major + (direction[major] < 0);
    uint32_t texel[2];
    for (int i = 1; i < 3; i++) {
        int axis = table[*face][i];
        double c = direction[abs(axis) - 1] * (axis < 0 ? -1 : 1);
        double at = 0.5 * (c / fabs(direction[major]) + 1) * size;
        texel[i - 1] = at <= 0 ? 0 : at >= size ? size - 1 : (uint32_t)at;
    }
    *x = texel[0];
    *y = texel[1];
}

bool same_bytes(const char *a, const char *b) {
    FILE *files[2] = {fopen(a, "rb"), fopen(b, "rb")};
    bool same = files[0] && files[1];
    while (same) {
        char blocks[2][4096];
        size_t n = fread(blocks[0], 1, 4096, files[0]), k = fread(blocks[1], 1, 4096, files[1]);
        same = n == k && !memcmp(blocks[0], blocks[1], n);
        if (n < 4096) break;
    }
    for (int i = 0; i < 2; i++)
        if (files[i]) fclose(files[i]);
    return same;
}
