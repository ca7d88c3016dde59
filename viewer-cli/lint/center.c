/* Searches the position that a cube map was rendered from: the centre for which its distances match the depth buffer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/cube_face.h"
#include "lint.h"

/* Smaller cube maps tolerate more than a tenth of the distance in lint_shows: they match from anywhere. */
enum { PLACES = 1024, ACROSS = 7, LEAST_SIZE = 32 };

struct search {
    const struct lint_data *data;
    const struct lint_reading *reading;
    double (*places)[3];
    size_t count;
    float *nearest,
        *farthest; /* for each texel of the current cube map: the range of distances of the texel and its neighbours on the face */
    struct lint_reading tried;
};

/* A texel of a surface at a grazing angle covers a range of distances, about that of its neighbours: a position anywhere in this range
   matches. */
static void fill_distance_ranges(struct search *s, size_t c) {
    const struct lint_cube *cube = &s->data->cubes[c];
    const size_t n = cube->size;
    for (size_t i = 0; i < 6 * n * n; i++) {
        const size_t x = i % n, y = i / n % n;
        const size_t around[5] = {i, x ? i - 1 : i, x + 1 < n ? i + 1 : i, y ? i - n : i, y + 1 < n ? i + n : i};
        s->nearest[i] = s->farthest[i] = cube->texels[5 * i + 4];
        for (int k = 1; k < 5; k++) {
            s->nearest[i] = fminf(s->nearest[i], cube->texels[5 * around[k] + 4]);
            s->farthest[i] = fmaxf(s->farthest[i], cube->texels[5 * around[k] + 4]);
        }
    }
}

/* How well a cube map's distances match from a centre: the mean over all positions of a value that falls from 1 for equal distances to
   0 at the tolerance, so that the best centre is in the middle of all acceptable ones. Occluded positions count as 0: a centre that
   sees fewer of them explains less. Positions are left out once the mean can no longer reach `least`: then only that is known. */
static double match_score(struct search *s, size_t c, const double offset[3], double least) {
    const struct lint_cube *cube = &s->data->cubes[c];
    const double enough = least * (double)s->count - 1e-6; /* beyond all rounding of the sum */
    double sum = 0;
    memcpy(s->tried.center_offset[c], offset, sizeof s->tried.center_offset[c]);
    for (size_t i = 0; i < s->count && sum + (double)(s->count - i) >= enough; i++) {
        double d[3], u, v;
        lint_from_center(s->data, &s->tried, c, s->places[i], d);
        const double away = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), slack = away * (0.02 + 3.0 / cube->size);
        if (!(away > slack)) continue;
        const int face = cube_face_of(d, &u, &v);
        lint_turn(s->tried.turn[face], &u, &v);
        const float *texel = lint_texel(cube, s->tried.face[face], u, v);
        const size_t at = (size_t)(texel - cube->texels) / 5;
        const double factor = texel[4] > 0 && isfinite(texel[4])
                                  ? lint_cube_distance(&s->tried, texel, d, away) / (double)texel[4]
                                  : s->tried.cube_scale;
        const double under = (double)s->nearest[at] * factor - away, over = away - (double)s->farthest[at] * factor;
        const double off = lint_larger(0, lint_larger(under, over));
        sum += lint_larger(0, 1 - off / slack);
    }
    return sum / (double)s->count;
}

/* Searches a lattice around an offset and moves the offset to the best point. */
static double search_lattice(struct search *s, size_t c, double step, int reach, double best, double offset[3]) {
    const double from[3] = {offset[0], offset[1], offset[2]};
    for (int x = -reach; x <= reach; x++)
        for (int y = -reach; y <= reach; y++)
            for (int z = -reach; z <= reach; z++) {
                const double o[3] = {from[0] + x * step, from[1] + y * step, from[2] + z * step};
                const double found = match_score(s, c, o, best);
                if (found <= best) continue;
                best = found;
                memcpy(offset, o, sizeof o);
            }
    return best;
}

/* The geometric mean of the distances to all positions, and the harmonic mean, by which a shift converts to a mean angle. */
static void typical_distances(const struct search *s, size_t c, double *typical, double *near) {
    double logs = 0, inverses = 0;
    for (size_t i = 0; i < s->count; i++) {
        double d[3];
        lint_from_center(s->data, s->reading, c, s->places[i], d);
        const double away = fmax(1e-9, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        logs += log(away);
        inverses += 1 / away;
    }
    *typical = exp(logs / (double)s->count);
    *near = (double)s->count / inverses;
}

/* Moving a centre along a street or a wall changes almost nothing: drops the components of the offset that do not improve the match. */
static void shorten_offset(struct search *s, size_t c, double *best, double offset[3]) {
    for (int k = 0; k < 3; k++) {
        double o[3] = {offset[0], offset[1], offset[2]};
        o[k] = 0;
        const double found = match_score(s, c, o, *best - 0.01);
        if (found < *best - 0.01) continue;
        *best = found;
        offset[k] = 0;
    }
}

/* Tries offsets up to three eighths of the typical distance, then refines. A cube map that sees few of the visible surfaces, such as
   one in another room, matches them from some wrong centre too: an offset is reported only if almost all positions match with it and
   far fewer did without. */
static void search_cube_center(struct search *s, size_t c) {
    const double none[3] = {0, 0, 0}, most = 0.85;
    double offset[3] = {0, 0, 0}, typical, near;
    typical_distances(s, c, &typical, &near);
    double step = typical / (ACROSS + 1);
    fill_distance_ranges(s, c);
    const double before = match_score(s, c, none, 0);
    double best = before;
    if (before < most) {
        best = search_lattice(s, c, step, ACROSS / 2, best, offset);
        for (; step > typical / 256; step /= 2) best = search_lattice(s, c, step / 2, 1, best, offset);
        shorten_offset(s, c, &best, offset);
    }
    /* offsets below the tolerance of the lookup cannot be distinguished from none */
    const double length = sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
    const bool clear =
        length > near * (0.02 + 1.0 / s->data->cubes[c].size) && best >= most && 1 - best < 0.5 * (1 - before);
    memcpy(s->tried.center_offset[c], clear ? offset : none, sizeof offset);
}

bool lint_search_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_reading *other) {
    struct search s = {.data = data, .reading = reading, .tried = *reading};
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    bool moved = false;
    size_t texels = 0;
    for (size_t c = 0; c < data->cube_count; c++)
        if (texels < 6 * (size_t)data->cubes[c].size * data->cubes[c].size)
            texels = 6 * (size_t)data->cubes[c].size * data->cubes[c].size;
    s.places = malloc(PLACES * sizeof *s.places);
    s.nearest = malloc(texels * sizeof *s.nearest + 1);
    s.farthest = malloc(texels * sizeof *s.farthest + 1);
    const bool ready = s.places && s.nearest && s.farthest;
    for (size_t i = 0; ready && i < data->sample_count && s.count < PLACES; i++)
        s.count += lint_place(data, reading, &eyes.now, data->samples[i], s.places[s.count]);
    for (size_t c = 0; c < data->cube_count && s.count >= LINT_ENOUGH; c++) {
        if (!data->cubes[c].has_distance || data->cubes[c].size < LEAST_SIZE) continue;
        search_cube_center(&s, c);
        moved = moved || memcmp(s.tried.center_offset[c], reading->center_offset[c], sizeof s.tried.center_offset[c]);
    }
    free(s.places);
    free(s.nearest);
    free(s.farthest);
    *other = s.tried;
    return moved;
}

void lint_describe_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_finding *f) {
    double mean[3] = {0, 0, 0}, largest = 0;
    size_t count = 0, length = 0;
    char names[160] = "";
    for (size_t c = 0; c < data->cube_count; c++) {
        const double *o = reading->center_offset[c];
        if (o[0] == 0 && o[1] == 0 && o[2] == 0) continue;
        for (int k = 0; k < 3; k++) mean[k] += o[k];
        count++;
        const int n = snprintf(names + length, sizeof names - length, "%s%s by (%.3g, %.3g, %.3g)", length ? "; " : "",
                               data->cubes[c].name, o[0], o[1], o[2]);
        if (n > 0 && (size_t)n < sizeof names - length) length += (size_t)n;
        else names[length] = '\0';
    }
    for (int k = 0; k < 3; k++) mean[k] /= (double)count;
    for (size_t c = 0; c < data->cube_count; c++) {
        const double *o = reading->center_offset[c];
        if (o[0] == 0 && o[1] == 0 && o[2] == 0) continue;
        largest = fmax(largest, sqrt(pow(o[0] - mean[0], 2) + pow(o[1] - mean[1], 2) + pow(o[2] - mean[2], 2)));
    }
    const double by = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    /* the same offset for all is one mistake */
    if (count > 1 && largest < 0.5 * by)
        snprintf(f->what, sizeof f->what, "the centres of %zu cube maps are wrong by about (%.3g, %.3g, %.3g) units",
                 count, mean[0], mean[1], mean[2]);
    else snprintf(f->what, sizeof f->what, "cube-map centres are wrong: %s", names);
}
