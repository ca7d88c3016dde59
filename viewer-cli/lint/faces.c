/* Finds swapped, mirrored and rotated faces: of cube maps by the surfaces on screen, of the sky by its pixels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "capture/cube_face.h"
#include "lint.h"

static const char *const names[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

static void count_votes(struct lint_votes *votes, const struct lint_data *data, const struct lint_reading *reading,
                        size_t c, const double world[3]) {
    const struct lint_cube *cube = &data->cubes[c];
    double d[3], u, v;
    lint_from_center(data, reading, c, world, d);
    const double away = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(away > 0) || !isfinite(away)) return;
    const int face = cube_face_of(d, &u, &v);
    const float *turned[LINT_TURNS];
    for (int turn = 0; turn < LINT_TURNS; turn++) {
        double tu = u, tv = v;
        lint_turn(turn, &tu, &tv);
        turned[turn] = lint_texel(cube, 0, tu, tv);
    }
    const size_t face_floats = (size_t)5 * cube->size * cube->size;
    for (int stored = 0; stored < 6; stored++)
        for (int turn = 0; turn < LINT_TURNS; turn++) {
            const int shows = lint_shows(reading, cube, turned[turn] + (size_t)stored * face_floats, d, away);
            votes->agree[face][stored][turn] += shows > 0;
            votes->beyond[face][stored][turn] += shows < 0;
        }
}

static double share_of(const struct lint_votes *votes, int face, int stored, int turn) {
    const size_t agree = votes->agree[face][stored][turn], all = agree + votes->beyond[face][stored][turn];
    return all ? (double)agree / (double)all : 0;
}

/* Finds a stored face and orientation that matches one face better than as stored, at this many times as many samples; false when none is
   clearly better. */
static bool find_better_face(const struct lint_votes *votes, int face, double factor, int *stored, int *turn) {
    const size_t all = votes->agree[face][face][0] + votes->beyond[face][face][0];
    size_t most = votes->agree[face][face][0];
    double best = share_of(votes, face, face, 0);
    const size_t least = most;
    const double before = best;
    *stored = face;
    *turn = 0;
    for (int i = 0; i < 6; i++) /* of faces that match as well, the face itself */
        for (int t = 0; t < LINT_TURNS; t++) {
            const int s = (face + i) % 6;
            const size_t agree = votes->agree[face][s][t];
            if (agree < LINT_ENOUGH / 2 || agree <= most || share_of(votes, face, s, t) <= best) continue;
            most = agree;
            best = share_of(votes, face, s, t);
            *stored = s;
            *turn = t;
        }
    return all >= LINT_ENOUGH / 2 && best >= LINT_MIN_SHARE && 1 - best < 0.5 * (1 - before) && best > before + 0.05 &&
           (double)most > factor * (double)least;
}

static const char *turn_name(int turn) {
    static const char *const words[LINT_TURNS] = {"",
                                                  ", mirrored left to right",
                                                  ", upside down",
                                                  ", rotated by 180°",
                                                  ", mirrored across the diagonal",
                                                  ", rotated by 90°",
                                                  ", rotated by -90°",
                                                  ", mirrored across the other diagonal"};
    return words[turn];
}

/* What the votes say of all faces: how many are stored as another one or turned, in words. */
struct verdict {
    int face[6], turn[6], changed, moved, same_turn;
    char text[256];
};

static struct verdict judge(const struct lint_votes *votes, double factor) {
    struct verdict v = {.same_turn = -1};
    for (int f = 0; f < 6; f++) {
        if (find_better_face(votes, f, factor, &v.face[f], &v.turn[f])) continue;
        v.face[f] = f;
        v.turn[f] = 0;
    }
    return v;
}

static bool is_changed(const struct verdict *v, int face) {
    return v->face[face] != face || v->turn[face] != 0;
}

static void describe(struct verdict *v) {
    size_t length = 0;
    for (int f = 0; f < 6; f++) {
        if (!is_changed(v, f)) continue;
        const int n = snprintf(v->text + length, sizeof v->text - length, "%s%s is stored as %s%s", length ? "; " : "",
                               names[f], names[v->face[f]], turn_name(v->turn[f]));
        length += n > 0 && (size_t)n < sizeof v->text - length ? (size_t)n : 0;
        v->same_turn = v->changed && v->turn[f] != v->same_turn ? -2 : v->turn[f];
        v->moved += v->face[f] != f;
        v->changed++;
    }
}

/* ---- What speaks for a change of faces ---- */

enum { CELLS = 16 }; /* along each side of a face, or its texels if they are fewer */

/* In how many more cells of each face do surfaces match after the change than before? Samples of one texel are one observation: a texel at the
   border of a roof may disagree with all of them. */
static void count_cells(const struct verdict *v, const struct lint_data *data, const struct lint_reading *reading,
                        const struct lint_cube *cube, int cells[6]) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    const size_t c = (size_t)(cube - data->cubes);
    const uint32_t side = cube->size < CELLS ? cube->size : CELLS;
    int matches[6][CELLS * CELLS] = {{0}};
    struct lint_reading other = *reading;
    memcpy(other.face, v->face, sizeof v->face);
    memcpy(other.turn, v->turn, sizeof v->turn);
    for (size_t i = 0; i < data->sample_count; i++) {
        double world[3], d[3], u, w;
        const float *texel;
        if (!lint_place(data, reading, &eyes.now, data->samples[i], world)) continue;
        lint_from_center(data, reading, c, world, d);
        const int face = cube_face_of(d, &u, &w);
        int *cell = &matches[face][lint_texel_along(w, side) * side + lint_texel_along(u, side)];
        *cell += (lint_sees(data, &other, c, world, &texel) > 0) - (lint_sees(data, reading, c, world, &texel) > 0);
    }
    for (int f = 0; f < 6; f++)
        for (size_t i = 0; i < CELLS * CELLS; i++) cells[f] += (matches[f][i] > 0) - (matches[f][i] < 0);
}

/* Takes back the changes that may be chance. A wrong texel matches a surface by chance with about the probability q that a distance between 0
   and twice the surface's lies within the tolerance of lint_shows: three quarters for faces of four texels a side, a fifteenth for 64. Of the
   changes that are tried for six faces none may then match all of n cells by chance but once in a thousand captures:
   6 · (6 · LINT_TURNS - 1) · qⁿ < 1/1000, with a q for each cube map. */
static void doubt(struct verdict *v, const struct lint_data *data, const struct lint_reading *reading) {
    const double enough = log(1000. * 6 * (6 * LINT_TURNS - 1));
    double evidence[6] = {0};
    int changed = 0;
    for (int f = 0; f < 6; f++) changed += is_changed(v, f);
    if (!changed) return;
    for (size_t c = 0; c < data->cube_count; c++) {
        int cells[6] = {0};
        if (!data->cubes[c].has_distance) continue;
        count_cells(v, data, reading, &data->cubes[c], cells);
        for (int f = 0; f < 6; f++) evidence[f] -= cells[f] * log(lint_tolerance(&data->cubes[c]));
    }
    for (int f = 0; f < 6; f++) {
        if (evidence[f] >= enough) continue;
        v->face[f] = f;
        v->turn[f] = 0;
    }
}

static void add_faces(const struct verdict *v, const char *of, enum lint_measure m, const struct lint_agreement *stored,
                      const struct lint_agreement *now, struct lint_findings *findings) {
    char id[48];
    snprintf(id, sizeof id, "%s.%s", of, !v->moved && v->same_turn >= 0 ? "faces_orientation" : "faces_order");
    struct lint_finding *f = lint_add(findings, id, now->share[m] > 0.6 ? "certain" : "likely");
    snprintf(f->evidence, sizeof f->evidence, "%s: %.0f %% of %zu comparisons of %s match then, %.0f %% as stored",
             v->text, 100 * now->share[m], now->count[m], lint_measure_names[m], 100 * stored->share[m]);
}

static void find_cube_faces(const struct lint_data *data, struct lint_reading *reading,
                            struct lint_agreement *agreement, struct lint_findings *findings) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct lint_votes votes = {{{{0}}}, {{{0}}}};
    struct lint_reading other = *reading;
    for (size_t i = 0; i < data->sample_count; i++) {
        double world[3];
        if (!lint_place(data, reading, &eyes.now, data->samples[i], world)) continue;
        for (size_t c = 0; c < data->cube_count; c++)
            if (data->cubes[c].has_distance) count_votes(&votes, data, reading, c, world);
    }
    struct verdict v = judge(&votes, 1.2);
    doubt(&v, data, reading);
    describe(&v);
    if (!v.changed) return;
    memcpy(other.face, v.face, sizeof v.face);
    memcpy(other.turn, v.turn, sizeof v.turn);
    const struct lint_agreement now = lint_agree(data, &other, NULL, 0);
    add_faces(&v, "cubemap", LINT_CUBEMAPS, agreement, &now, findings);
    *reading = other;
    *agreement = now;
}

/* Skies differ by clouds and hour, so most of what is seen must match; but they are smooth, so that much of a mirrored one matches, too. */
static void find_sky_faces(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                           struct lint_findings *findings) {
    struct lint_votes votes = {{{{0}}}, {{{0}}}};
    struct lint_reading other = *reading;
    if (agreement->count[LINT_SKY] < LINT_ENOUGH) return;
    lint_sky_votes(data, reading, &votes);
    struct verdict v = judge(&votes, 1.05);
    describe(&v);
    memcpy(other.sky_face, v.face, sizeof v.face);
    memcpy(other.sky_turn, v.turn, sizeof v.turn);
    const struct lint_agreement now = lint_agree(data, &other, agreement, 1u << LINT_SKY);
    if (!v.changed || now.share[LINT_SKY] < 0.6) return;
    add_faces(&v, "sky", LINT_SKY, agreement, &now, findings);
    *reading = other;
    *agreement = now;
}

void lint_find_faces(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                     struct lint_findings *findings) {
    find_cube_faces(data, reading, agreement, findings);
    find_sky_faces(data, reading, agreement, findings);
}
