/* Checks of single images: normals have unit length, sky has no depth, motion fits the cameras. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "lint.h"

static double median(double *values, size_t count) {
    glint_sort_doubles(values, count);
    return count ? values[count / 2] : 0;
}

static bool is_surface(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                       uint32_t pixel) {
    double depth;
    return lint_depth(data, reading, view, pixel % data->width, pixel / data->width, &depth);
}

/* ---- Normals ---- */

static void check_normal_lengths(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_view *view, struct lint_findings *findings) {
    static double lengths[LINT_SAMPLES];
    size_t count = 0, off = 0;
    const bool unorm = reading->normal == GLINT_NORMAL_UNORM;
    if (data->two_channels || (!unorm && reading->normal != GLINT_NORMAL_SIGNED)) return;
    for (size_t i = 0; i < data->sample_count; i++) {
        if (!is_surface(data, reading, view, data->samples[i])) continue;
        const float *v = data->normal + 3 * (size_t)data->samples[i];
        double sum = 0;
        for (int k = 0; k < 3; k++) sum += pow(unorm ? 2 * (double)v[k] - 1 : (double)v[k], 2);
        lengths[count++] = sqrt(sum);
        off += fabs(sqrt(sum) - 1) > 0.05;
    }
    if (count < LINT_ENOUGH || off < count / 2) return;
    struct lint_finding *f = lint_add(findings, "normal.length", "certain");
    snprintf(f->evidence, sizeof f->evidence,
             "the length of %zu of %zu normals differs from 1 by more than 0.05; the median length is %.4g", off, count,
             median(lengths, count));
}

/* ---- Sky ---- */

static void check_sky_depth(const struct lint_data *data, struct lint_findings *findings) {
    const size_t pixels = (size_t)data->width * data->height;
    double largest = 0, next = 0;
    size_t infinite = 0, at_largest = 0;
    if (data->encodings.depth != GLINT_DEPTH_VIEW_LINEAR) return;
    for (size_t i = 0; i < pixels; i++) {
        const double z = (double)data->depth[i];
        infinite += isfinite(z) ? 0 : 1;
        if (isfinite(z)) largest = fmax(largest, z);
    }
    for (size_t i = 0; i < pixels; i++) {
        const double z = (double)data->depth[i];
        at_largest += z == largest;
        if (isfinite(z) && z < largest) next = fmax(next, z);
    }
    if (infinite || at_largest < pixels / 500 + 16 || !(largest > 1.2 * next)) return;
    struct lint_finding *f = lint_add(findings, "depth.sky_value", "likely");
    snprintf(f->evidence, sizeof f->evidence,
             "%zu pixels have exactly the depth %.9g, the next largest depth is %.9g, and no pixel is infinite",
             at_largest, largest, next);
}

/* ---- Motion and the previous camera ---- */

struct movement {
    size_t compared, stored, expected,
        zero; /* samples that move as stored; that move by both cameras; whose motion is exactly 0 */
};

static struct movement movement_of(const struct lint_data *data, const struct lint_reading *reading) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct movement m = {0, 0, 0, 0};
    for (size_t i = 0; i < data->sample_count; i++) {
        double moved[2], found[2];
        if (!lint_moved(data, reading, &eyes, data->samples[i], moved)) continue;
        lint_motion(data, reading, data->samples[i], found);
        m.compared++;
        m.stored += hypot(found[0], found[1]) > LINT_MOVES_PX;
        m.zero += found[0] == 0 && found[1] == 0;
        m.expected += hypot(moved[0], moved[1]) > LINT_MOVES_PX;
    }
    return m;
}

static bool same_camera(const struct glint_frame *frame) {
    double largest = 0;
    for (int i = 0; i < 16; i++)
        largest = fmax(largest, fabs(frame->camera.world_to_view[i] - frame->previous.world_to_view[i]));
    return largest == 0;
}

/* Number of samples whose depth differs between the two frames. */
static size_t depth_changed(const struct lint_data *data) {
    size_t changed = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        const double now = (double)data->depth[data->samples[i]], before = (double)data->before_depth[data->samples[i]];
        changed += isfinite(now) && isfinite(before) && fabs(now - before) > 2e-3 * fabs(now);
    }
    return changed;
}

/* Without motion vectors, the depth of the previous frame shows whether the previous camera is right. */
static void check_previous_depth(const struct lint_data *data, const struct lint_agreement *agreement,
                                 struct lint_findings *findings) {
    const double share = agreement->share[LINT_BEFORE];
    if (agreement->count[LINT_BEFORE] < LINT_ENOUGH || !data->before_depth) return;
    const bool same = same_camera(&data->frame) && 2 * depth_changed(data) > agreement->count[LINT_BEFORE];
    if (share >= (same ? 0.5 : LINT_MIN_SHARE)) return;
    struct lint_finding *f =
        lint_add(findings, same ? "previous.same" : "previous.unexplained", same ? "certain" : "possible");
    snprintf(f->evidence, sizeof f->evidence, "%.0f %% of %zu comparisons of %s agree%s", 100 * share,
             agreement->count[LINT_BEFORE], lint_measure_names[LINT_BEFORE],
             same ? "; both cameras are equal, but the two depth buffers differ" : "");
}

static void check_motion(const struct lint_data *data, const struct lint_reading *reading,
                         const struct lint_agreement *agreement, struct lint_findings *findings) {
    const size_t known = findings->count;
    if (data->frame.cut) return;
    const struct movement m = data->has_motion ? movement_of(data, reading) : (struct movement){0, 0, 0, 0};
    const char *id = NULL;
    if (!data->has_motion) lint_undecided(findings, "motion: the capture contains no motion vectors");
    if (m.compared >= LINT_ENOUGH && m.stored > m.compared / 2 && !data->frame.has_previous) id = "previous.missing";
    else if (m.compared >= LINT_ENOUGH && m.stored > m.compared / 2 && m.expected < m.compared / 20)
        id = "previous.same";
    else if (m.compared >= LINT_ENOUGH && m.expected > m.compared / 2 && m.zero > m.compared * 19 / 20)
        id = "motion.zero";
    else if (m.compared >= LINT_ENOUGH && m.expected > m.compared / 2 && agreement->share[LINT_MOTION] < LINT_MIN_SHARE)
        id = "motion.unexplained";
    if (m.compared >= LINT_ENOUGH && m.expected < m.compared / 20 && !id)
        lint_undecided(findings, "the sign and unit of motion: the camera did not move");
    if (id) {
        struct lint_finding *f = lint_add(findings, id, strcmp(id, "motion.unexplained") ? "certain" : "possible");
        snprintf(f->evidence, sizeof f->evidence,
                 "of %zu samples, %zu move by more than %.2f pixels as stored and %zu by reprojection; the stored "
                 "motion of %zu is 0",
                 m.compared, m.stored, LINT_MOVES_PX, m.expected, m.zero);
    }
    if (findings->count == known) check_previous_depth(data, agreement, findings);
}

/* ---- Up ---- */

static void check_up_axis(const struct lint_data *data, const struct lint_reading *reading,
                          const struct lint_view *view, struct lint_findings *findings) {
    static const int axis_of[6] = {1, 2, 0, 1, 2, 0};
    static const char *const values[6] = {"+y", "+z", "+x", "-y", "-z", "-x"};
    const double y_up = reading->clip_y == GLINT_CLIP_Y_UP ? 1 : -1, turn = (view->b < 0 ? -1 : 1) * y_up;
    double upward[6];
    size_t floors[6] = {0}, surfaces = 0;
    int best = 0;
    for (int a = 0; a < 6; a++) {
        upward[a] = turn * (a < 3 ? 1 : -1) * view->rotation[3 + axis_of[a]];
        if (upward[a] > upward[best]) best = a;
    }
    for (size_t i = 0; i < data->sample_count; i++) {
        double n[3];
        if (!is_surface(data, reading, view, data->samples[i]) ||
            !lint_normal(data, reading, view, data->samples[i], n))
            continue;
        surfaces++;
        for (int a = 0; a < 6; a++) floors[a] += (a < 3 ? 1 : -1) * n[axis_of[a]] > 0.95;
    }
    const int declared = (int)data->frame.up;
    const bool level = fabs(view->rotation[axis_of[best]]) < 0.02;
    if (best == declared || upward[best] < 0.75 || upward[declared] > 0.6 || !level || surfaces < LINT_ENOUGH ||
        floors[best] < surfaces / 50)
        return;
    struct lint_finding *f = lint_add(findings, "camera.up", "likely");
    snprintf(f->what, sizeof f->what, "the up axis is %s, not %s", values[best], values[declared]);
    snprintf(
        f->evidence, sizeof f->evidence,
        "the up direction of the image is %.2f along %s and %.2f along %s, the horizon is level for %s, and %.0f %% of "
        "the surfaces face it",
        upward[best], values[best], upward[declared], values[declared], values[best],
        100 * (double)floors[best] / (double)surfaces);
    f->value = values[best];
    snprintf(f->remedy, sizeof f->remedy, "glint.up = \"%s\"", values[best]);
}

/* ---- Images that match under no convention ---- */

static void check_unexplained(const struct lint_agreement *a, struct lint_findings *findings) {
    static const struct {
        int measure;
        double share; /* with normal maps, few normals equal those of the depth buffer */
        const char *id;
    } rows[] = {{LINT_FACETS, 0.08, "normal.unexplained"}, {LINT_CUBEMAPS, 0.3, "cubemap.unexplained"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const int m = rows[i].measure;
        if (a->count[m] < LINT_ENOUGH || a->share[m] > rows[i].share) continue;
        struct lint_finding *f = lint_add(findings, rows[i].id, "possible");
        snprintf(f->evidence, sizeof f->evidence, "%.0f %% of %zu comparisons of %s agree", 100 * a->share[m],
                 a->count[m], lint_measure_names[m]);
    }
    for (int m = 0; m < LINT_MEASURES; m++)
        if (a->count[m] < LINT_ENOUGH && m != LINT_MOTION && m != LINT_BEFORE && m != LINT_LIGHT)
            lint_undecided(findings, "%s: too few samples can be compared (%zu)", lint_measure_names[m], a->count[m]);
}

/* Cube maps that were rendered under other lighting, such as another time of day, are not a mistake of the dump. */
static void check_lighting(const struct lint_agreement *a, const struct lint_reading *reading,
                           struct lint_findings *findings) {
    if (a->count[LINT_SKY] >= LINT_ENOUGH && a->share[LINT_SKY] < 0.5)
        lint_undecided(findings,
                       "why the sky in lit and the sky cube map match at only %.0f %% of the samples under every known "
                       "convention: clouds, fog or the time of day may differ",
                       100 * a->share[LINT_SKY]);
    if (a->count[LINT_SKY] >= LINT_ENOUGH && reading->sky_scale != 1)
        lint_undecided(
            findings,
            "why the sky in lit is %.3g times as bright as the sky cube map: the exposure may differ, or one "
            "of the two may be encoded in another way",
            reading->sky_scale);
    if (a->count[LINT_COLORS] < LINT_ENOUGH || a->share[LINT_COLORS] >= LINT_MIN_SHARE) return;
    lint_undecided(
        findings,
        "why lit and the cube-map colours match at only %.0f %% of the samples under every known convention: the "
        "lighting or the exposure may differ, or one of the two images may be wrong",
        100 * a->share[LINT_COLORS]);
}

void lint_find_values(const struct lint_data *data, const struct lint_reading *reading,
                      const struct lint_agreement *agreement, struct lint_findings *findings) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    check_normal_lengths(data, reading, &eyes.now, findings);
    check_sky_depth(data, findings);
    lint_find_cubes(data, findings);
    lint_find_light(data, reading, findings);
    check_motion(data, reading, agreement, findings);
    check_up_axis(data, reading, &eyes.now, findings);
    check_unexplained(agreement, findings);
    check_lighting(agreement, reading, findings);
    lint_undecided(findings,
                   "whether roughness is squared or inverted: no other image of a capture depends on roughness");
    lint_undecided(findings, "the length of a unit (metresPerUnit): all lengths are in the same unit");
}
