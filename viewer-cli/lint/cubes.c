/* What a cube map must hold by itself: what stands under sky, and nothing within its inner volume. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lint.h"

struct sky {
    size_t texels;                              /* of cube maps with distances */
    size_t clear, solid, infinite;              /* A is 0; A is 1; the distance is infinite */
    size_t colored, solid_infinite, clear_near; /* A is 0 and not black; A is 1 at infinity; A is 0 and a distance */
    size_t against;                             /* alpha on one side, the texel's other values on the other */
    size_t clear_at_0;                          /* of clear_near: the distance is 0 */
    bool elsewhere;                             /* some pixels stand in a sibling, which no copy of this file mends */
};

static struct sky sky_of(const struct lint_data *data) {
    struct sky s = {0};
    for (size_t c = 0; c < data->cube_count; c++) {
        const struct lint_cube *cube = &data->cubes[c];
        s.elsewhere = s.elsewhere || cube->elsewhere;
        for (size_t i = 0; i < (size_t)cube->size * cube->size * 6; i++) {
            const float *t = cube->texels + 5 * i;
            const bool clear = t[3] == 0, solid = t[3] == 1, infinite = cube->has_distance && isinf(t[4]),
                       black = t[0] == 0 && t[1] == 0 && t[2] == 0;
            const bool sky = cube->has_distance ? infinite : black;
            s.texels++;
            s.clear += clear;
            s.solid += solid;
            s.infinite += infinite;
            s.colored += clear && !black;
            s.solid_infinite += solid && infinite;
            s.clear_near += clear && cube->has_distance && !infinite;
            s.clear_at_0 += clear && cube->has_distance && t[4] == 0;
            s.against += sky ? t[3] >= 0.5f : t[3] < 0.5f;
        }
    }
    return s;
}

static const char *mends(struct lint_finding *f, const struct sky *s, enum lint_pixels pixels, const char *what) {
    if (!s->elsewhere) f->pixels = pixels;
    snprintf(f->mend, sizeof f->mend, "%s%s", what,
             s->elsewhere ? "; the pixels stand in a sibling, and --fix leaves that as it is" : "; --fix does");
    return f->mend;
}

/* A rounding of a filter leaves single texels; what an engine forgot is everywhere: more than one in a hundred. */
static bool many(size_t found, size_t of) {
    return found > 0 && 100 * found > of;
}

static void under_sky(const struct lint_data *data, struct lint_findings *findings) {
    const struct sky s = sky_of(data);
    struct lint_finding *f;
    if (s.texels >= LINT_ENOUGH && 10 * s.against >= 9 * s.texels) {
        f = lint_add(findings, "cubemap.sky_inverted", "certain");
        snprintf(f->evidence, sizeof f->evidence,
                 "alpha and what the texels hold disagree about sky at %zu of %zu texels", s.against, s.texels);
        snprintf(f->mend, sizeof f->mend, "no declaration says so: write 1 - alpha");
        return;
    }
    if (many(s.solid_infinite, s.infinite)) {
        f = lint_add(findings, "cubemap.sky_alpha", "certain");
        snprintf(f->evidence, sizeof f->evidence, "%zu of %zu texels at infinite distance have alpha 1%s",
                 s.solid_infinite, s.infinite, s.solid == s.texels ? "; so have all texels" : "");
        mends(f, &s, LINT_CLEAR_INFINITE, "write alpha 0 and black where the distance is infinite");
    }
    if (many(s.clear_near, s.clear)) {
        f = lint_add(findings, "cubemap.sky_distance", "certain");
        snprintf(f->evidence, sizeof f->evidence, "%zu of %zu texels with alpha 0 have a distance, %zu of them 0",
                 s.clear_near, s.clear, s.clear_at_0);
        mends(f, &s, LINT_FAR_SKY, "write a distance of +inf where alpha is 0");
    }
    if (many(s.colored, s.clear)) {
        f = lint_add(findings, "cubemap.sky_color", "certain");
        snprintf(f->evidence, sizeof f->evidence, "%zu of %zu texels with alpha 0 are not black", s.colored, s.clear);
        mends(f, &s, LINT_BLACK_SKY, "write black where alpha is 0: the sky has a cube map of its own");
    }
}

/* ---- Inner volumes ---- */

/* How far a place, relative to the centre, lies within the volume; not positive outside. */
static double depth_within(const struct glint_cubemap *map, const double p[3]) {
    double within = INFINITY, square = 0;
    for (int k = 0; k < 3; k++) {
        if (map->inner == GLINT_VOLUME_BOX) within = fmin(within, fmin(p[k] - map->box_min[k], map->box_max[k] - p[k]));
        square += pow(p[k] - map->sphere_center[k], 2);
    }
    if (map->inner == GLINT_VOLUME_SPHERE) within = map->sphere_radius - sqrt(square);
    for (uint32_t i = 0; map->inner == GLINT_VOLUME_HULL && i < map->plane_count; i++) {
        const double *n = map->planes[i], length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        within = fmin(within, -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] + n[3]) / length);
    }
    return within;
}

static void texel_place(const struct lint_cube *cube, size_t i, double p[3]) {
    const size_t n = cube->size, face = i / (n * n);
    const double s = 2 * ((double)(i % n) + 0.5) / (double)n - 1, t = 2 * ((double)(i / n % n) + 0.5) / (double)n - 1;
    const double d[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    const double scale = (double)cube->texels[5 * i + 4] / sqrt(1 + s * s + t * t);
    for (int k = 0; k < 3; k++) p[k] = d[face][k] * scale;
}

/* By the cube map's own distances: what moves through the volume is not in it when the cube map is rendered. */
static void inner_volumes(const struct lint_data *data, struct lint_findings *findings) {
    char names[200] = "";
    size_t length = 0, maps = 0;
    double worst = 0;
    for (size_t c = 0; c < data->cube_count; c++) {
        const struct lint_cube *cube = &data->cubes[c];
        size_t all = 0, inside = 0;
        if (!cube->has_distance || cube->map.inner == GLINT_VOLUME_NONE) continue;
        for (size_t i = 0; i < (size_t)cube->size * cube->size * 6; i++) {
            double p[3];
            if (!isfinite(cube->texels[5 * i + 4]) || cube->texels[5 * i + 3] == 0) continue;
            texel_place(cube, i, p);
            all++;
            /* a wall on the volume's rim may be rounded, or filtered, into it: by what lint_shows lets pass */
            inside += depth_within(&cube->map, p) > (double)cube->texels[5 * i + 4] * (0.02 + 3.0 / cube->size);
        }
        /* one texel in a hundred is a thing of a fifth of a metre at a metre's distance */
        if (all < LINT_ENOUGH || 100 * inside <= all) continue;
        const int n = snprintf(names + length, sizeof names - length, "%s%s %.0f %%", length ? ", " : "", cube->name,
                               100 * (double)inside / (double)all);
        if (n > 0 && (size_t)n < sizeof names - length) length += (size_t)n;
        else names[length] = '\0';
        worst = fmax(worst, (double)inside / (double)all);
        maps++;
    }
    if (!maps) return;
    struct lint_finding *f = lint_add(findings, "cubemap.inner_full", worst > 0.05 ? "certain" : "likely");
    snprintf(f->evidence, sizeof f->evidence, "of what these cube maps show lies within their own volumes: %s", names);
    snprintf(f->mend, sizeof f->mend,
             "glint.inner is not the room's box: make it so small that nothing is in it, or \"none\"");
}

void lint_find_cubes(const struct lint_data *data, struct lint_findings *findings) {
    under_sky(data, findings);
    inner_volumes(data, findings);
}
