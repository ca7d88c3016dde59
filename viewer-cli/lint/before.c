/* Reprojects this frame's surfaces into the previous frame and compares depth or colour there. This needs no motion vectors, and it is
   the only measure that notices errors which leave all directions unchanged, such as a wrong scale of depth. */
#include <math.h>
#include <string.h>

#include "lint.h"

/* 1/depth is linear on a plane, so bilinear interpolation of four texels is exact there. The 4×4 texels around the position must lie on
   one plane: second differences of 5e-4 leave an interpolation error of at most 1.3e-4. */
static bool plane_depth(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        const double place[2], double *depth) {
    const double fx = floor(place[0] - 0.5), fy = floor(place[1] - 0.5);
    if (!(fx >= 1 && fy >= 1 && fx + 2 < data->width && fy + 2 < data->height)) return false;
    const double u = place[0] - 0.5 - fx, v = place[1] - 0.5 - fy;
    double d[4][4];
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++) {
            if (!lint_depth_before(data, reading, view, (uint32_t)(fx - 1 + x), (uint32_t)(fy - 1 + y), &d[y][x]))
                return false;
            d[y][x] = 1 / d[y][x];
        }
    const double largest = 5e-4 * d[1][1];
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 2; i++)
            if (fabs(d[k][i] - 2 * d[k][i + 1] + d[k][i + 2]) > largest ||
                fabs(d[i][k] - 2 * d[i + 1][k] + d[i + 2][k]) > largest)
                return false;
    *depth = 1 / ((1 - v) * ((1 - u) * d[1][1] + u * d[1][2]) + v * ((1 - u) * d[2][1] + u * d[2][2]));
    return true;
}

static double largest_of(const double v[3]) {
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

static struct lint_tally compare_depths(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    /* engines store camera positions as floats, which are exact to 2^-24 of their size */
    const double misplaced = ldexp(largest_of(eyes.now.position) + largest_of(eyes.before.position), -23);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i], x = pixel % data->width, y = pixel / data->width;
        double world[3], place[2], expected, found, now;
        if (!lint_depth(data, reading, &eyes.now, x, y, &now) || !lint_place(data, reading, &eyes.now, pixel, world) ||
            !lint_project(data, reading, &eyes.before, world, place, &expected) ||
            !plane_depth(data, reading, &eyes.before, place, &found))
            continue;
        const double rounding = 2 * lint_depth_error(data, reading, &eyes.now, x, y, now) * expected / now;
        lint_count(&tally, fabs(found - expected) <= 2e-4 * expected + rounding + misplaced);
    }
    return tally;
}

static bool alike(const float *a, const float *b, double share) {
    for (int k = 0; k < 3; k++)
        if (fabs((double)a[k] - (double)b[k]) > share * ((double)a[k] + (double)b[k]) + 2e-3) return false;
    return true;
}

/* A sample that moved, its colours at the same pixel in both frames, and the colour where it was in the previous one. */
struct seen {
    const float *now, *there;
    float before[3];
};

static bool seen_before(const struct lint_data *data, const struct lint_reading *reading, const struct lint_eyes *eyes,
                        uint32_t pixel, struct seen *s) {
    const float *of[2] = {data->lit, data->before_lit};
    const float *before = of[!reading->swapped_lit];
    double world[3], place[2], moved[2], depth;
    if (!lint_moved(data, reading, eyes, pixel, moved) || !(hypot(moved[0], moved[1]) > LINT_MOVES_PX) ||
        !lint_place(data, reading, &eyes->now, pixel, world) ||
        !lint_project(data, reading, &eyes->before, world, place, &depth))
        return false;
    const double fx = floor(place[0] - 0.5), fy = floor(place[1] - 0.5);
    if (!(fx >= 0 && fy >= 0 && fx + 1 < data->width && fy + 1 < data->height)) return false;
    *s = (struct seen){of[reading->swapped_lit] + 3 * (size_t)pixel, before + 3 * (size_t)pixel, {0, 0, 0}};
    for (int corner = 0; corner < 4; corner++) {
        const double u = place[0] - 0.5 - fx, v = place[1] - 0.5 - fy;
        const double weight = (corner & 1 ? u : 1 - u) * (corner & 2 ? v : 1 - v);
        const size_t at = ((size_t)fy + (corner & 2 ? 1 : 0)) * data->width + (size_t)fx + (corner & 1);
        for (int k = 0; k < 3; k++) s->before[k] += (float)(weight * (double)before[3 * at + (size_t)k]);
    }
    return true;
}

/* Compares only samples that moved and whose colour changed at the same pixel: others match under any camera. */
static struct lint_tally compare_previous_colors(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        struct seen s;
        if (seen_before(data, reading, &eyes, data->samples[i], &s) && !alike(s.now, s.there, 0.15))
            lint_count(&tally, alike(s.now, s.before, 0.05));
    }
    return tally;
}

static bool has_previous(const struct lint_data *data) {
    return data->frame.has_previous && !data->frame.cut;
}

struct lint_tally lint_light(const struct lint_data *data, const struct lint_reading *reading) {
    if (!has_previous(data) || !data->before_lit || !data->before_depth) return (struct lint_tally){0, 0};
    return compare_previous_colors(data, reading);
}

struct lint_tally lint_same_light(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_tally tally = {0, 0};
    for (size_t i = 0; i < data->sample_count && has_previous(data) && data->before_lit; i++) {
        struct seen s;
        if (seen_before(data, reading, &eyes, data->samples[i], &s) && !alike(s.there, s.before, 0.15))
            lint_count(&tally, !memcmp(s.now, s.there, sizeof s.before));
    }
    return tally;
}

struct lint_tally lint_before(const struct lint_data *data, const struct lint_reading *reading) {
    if (!has_previous(data)) return (struct lint_tally){0, 0};
    if (data->before_depth) return compare_depths(data, reading);
    if (data->before_lit) return compare_previous_colors(data, reading);
    return (struct lint_tally){0, 0};
}
