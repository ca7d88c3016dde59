/* Checks cube maps by themselves: sky texels follow the format, and the inner volume is empty. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lint.h"

struct sky {
    size_t texels;                              /* of cube maps with distances */
    size_t clear, solid, infinite;              /* texels with A = 0; with A = 1; at infinite distance */
    size_t colored, solid_infinite, clear_near; /* A = 0 but not black; A = 1 at infinity; A = 0 at a finite distance */
    size_t against;                             /* alpha contradicts distance (or colour) about sky */
    size_t clear_at_0;                          /* of clear_near: at distance 0 */
    bool elsewhere;                             /* some pixels are in a sibling file, which --fix does not copy */
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

/* Whether --fix does what the remedy asks for. */
static void say_whether_fixed(struct lint_finding *f, const struct sky *s) {
    const size_t length = strlen(f->remedy);
    if (s->elsewhere) f->pixels = LINT_NO_PIXELS;
    snprintf(f->remedy + length, sizeof f->remedy - length, "%s",
             s->elsewhere ? "; the pixels are in a sibling file, which --fix does not change" : "; --fix does this");
}

/* Filtering leaves single wrong texels; a mistake of the engine affects more than one in a hundred. */
static bool is_common(size_t found, size_t of) {
    return found > 0 && 100 * found > of;
}

static void check_sky_texels(const struct lint_data *data, struct lint_findings *findings) {
    const struct sky s = sky_of(data);
    struct lint_finding *f;
    if (s.texels >= LINT_ENOUGH && 10 * s.against >= 9 * s.texels) {
        f = lint_add(findings, "cubemap.sky_inverted", "certain");
        snprintf(f->evidence, sizeof f->evidence, "alpha contradicts the other channels about sky at %zu of %zu texels",
                 s.against, s.texels);
        return;
    }
    if (is_common(s.solid_infinite, s.infinite)) {
        f = lint_add(findings, "cubemap.sky_alpha", "certain");
        snprintf(f->evidence, sizeof f->evidence, "%zu of %zu texels at infinite distance have alpha 1%s",
                 s.solid_infinite, s.infinite, s.solid == s.texels ? ", as have all texels" : "");
        say_whether_fixed(f, &s);
    }
    if (is_common(s.clear_near, s.clear)) {
        f = lint_add(findings, "cubemap.sky_distance", "certain");
        snprintf(f->evidence, sizeof f->evidence,
                 "%zu of %zu texels with alpha 0 have a finite distance, which is 0 for %zu of them", s.clear_near,
                 s.clear, s.clear_at_0);
        say_whether_fixed(f, &s);
    }
    if (is_common(s.colored, s.clear)) {
        f = lint_add(findings, "cubemap.sky_color", "certain");
        snprintf(f->evidence, sizeof f->evidence, "%zu of %zu texels with alpha 0 are not black", s.colored, s.clear);
        say_whether_fixed(f, &s);
    }
}

/* ---- Inner volumes ---- */

/* How deep a position, relative to the centre, is inside the volume; negative or 0 outside. */
static double depth_within(const struct glint_cubemap *map, const double p[3]) {
    double within = INFINITY, square = 0;
    for (int k = 0; k < 3; k++) {
        if (map->inner == GLINT_VOLUME_BOX)
            within = lint_smaller(within, lint_smaller(p[k] - map->box_min[k], map->box_max[k] - p[k]));
        square += pow(p[k] - map->sphere_center[k], 2);
    }
    if (map->inner == GLINT_VOLUME_SPHERE) within = map->sphere_radius - sqrt(square);
    for (uint32_t i = 0; map->inner == GLINT_VOLUME_HULL && i < map->plane_count; i++) {
        const double *n = map->planes[i], length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        within = lint_smaller(within, -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] + n[3]) / length);
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

/* Uses the cube map's own distances: objects that move through the volume are not in it when the cube map is rendered. */
static void check_inner_volumes(const struct lint_data *data, struct lint_findings *findings) {
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
            /* rounding or filtering may move a wall at the border into the volume: the tolerance is that of lint_shows */
            inside += depth_within(&cube->map, p) > (double)cube->texels[5 * i + 4] * (0.02 + 3.0 / cube->size);
        }
        /* one texel in a hundred is an object of 0.2 m at a distance of 1 m */
        if (all < LINT_ENOUGH || 100 * inside <= all) continue;
        const int n = snprintf(names + length, sizeof names - length, "%s%s %.0f %%", length ? ", " : "", cube->name,
                               100 * (double)inside / (double)all);
        if (n > 0 && (size_t)n < sizeof names - length) length += (size_t)n;
        else names[length] = '\0';
        worst = fmax(worst, (double)inside / (double)all);
        maps++;
    }
    if (!maps) return;
    struct lint_finding *f = lint_add(findings, "cubemap.inner_volume", worst > 0.05 ? "certain" : "likely");
    snprintf(f->evidence, sizeof f->evidence, "share of texels inside the cube map's own inner volume: %s", names);
}

void lint_find_cubes(const struct lint_data *data, struct lint_findings *findings) {
    check_sky_texels(data, findings);
    check_inner_volumes(data, findings);
}
