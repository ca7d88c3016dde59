/* Finds swapped, mirrored and rotated cube-map faces by comparing them with the surfaces on screen. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "capture/cube_face.h"
#include "lint.h"

enum { TURNS = 8 };
static const char *const names[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

struct votes {
    size_t agree[6][6][TURNS],
        beyond[6][6][TURNS]; /* for each face of the format: each stored face in each orientation */
};

static void count_votes(struct votes *votes, const struct lint_data *data, const struct lint_reading *reading, size_t c,
                        const double world[3]) {
    const struct lint_cube *cube = &data->cubes[c];
    double d[3], u, v;
    lint_from_center(data, reading, c, world, d);
    const double away = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(away > 0) || !isfinite(away)) return;
    const int face = cube_face_of(d, &u, &v);
    for (int stored = 0; stored < 6; stored++)
        for (int turn = 0; turn < TURNS; turn++) {
            double tu = u, tv = v;
            lint_turn(turn, &tu, &tv);
            const int shows = lint_shows(reading, cube, lint_texel(cube, stored, tu, tv), d);
            votes->agree[face][stored][turn] += shows > 0;
            votes->beyond[face][stored][turn] += shows < 0;
        }
}

static double share_of(const struct votes *votes, int face, int stored, int turn) {
    const size_t agree = votes->agree[face][stored][turn], all = agree + votes->beyond[face][stored][turn];
    return all ? (double)agree / (double)all : 0;
}

/* Finds a stored face and orientation that matches one face better than as stored; false when none is clearly better. */
static bool find_better_face(const struct votes *votes, int face, int *stored, int *turn) {
    const size_t all = votes->agree[face][face][0] + votes->beyond[face][face][0];
    size_t most = votes->agree[face][face][0];
    double best = share_of(votes, face, face, 0);
    const size_t least = most;
    const double before = best;
    *stored = face;
    *turn = 0;
    for (int s = 0; s < 6; s++)
        for (int t = 0; t < TURNS; t++) {
            const size_t agree = votes->agree[face][s][t];
            if (agree < LINT_ENOUGH / 2 || agree <= most || share_of(votes, face, s, t) <= best) continue;
            most = agree;
            best = share_of(votes, face, s, t);
            *stored = s;
            *turn = t;
        }
    return all >= LINT_ENOUGH / 2 && best >= LINT_MIN_SHARE && 1 - best < 0.5 * (1 - before) && best > before + 0.05 &&
           5 * most > 6 * least;
}

static const char *turn_name(int turn) {
    static const char *const words[TURNS] = {"",
                                             ", mirrored left to right",
                                             ", upside down",
                                             ", rotated by 180°",
                                             ", mirrored across the diagonal",
                                             ", rotated by 90°",
                                             ", rotated by -90°",
                                             ", mirrored across the other diagonal"};
    return words[turn];
}

void lint_find_faces(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                     struct lint_findings *findings) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    struct votes votes = {{{{0}}}, {{{0}}}};
    struct lint_reading other = *reading;
    char text[256] = "";
    size_t length = 0;
    int changed = 0, same_turn = -1, moved = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        double world[3];
        if (!lint_place(data, reading, &eyes.now, data->samples[i], world)) continue;
        for (size_t c = 0; c < data->cube_count; c++)
            if (data->cubes[c].has_distance) count_votes(&votes, data, reading, c, world);
    }
    for (int f = 0; f < 6; f++) {
        if (!find_better_face(&votes, f, &other.face[f], &other.turn[f])) {
            other.face[f] = f;
            other.turn[f] = 0;
            continue;
        }
        const int n = snprintf(text + length, sizeof text - length, "%s%s is stored as %s%s", length ? "; " : "",
                               names[f], names[other.face[f]], turn_name(other.turn[f]));
        length += n > 0 && (size_t)n < sizeof text - length ? (size_t)n : 0;
        same_turn = changed && other.turn[f] != same_turn ? -2 : other.turn[f];
        moved += other.face[f] != f;
        changed++;
    }
    if (!changed) return;
    const struct lint_agreement now = lint_agree(data, &other, NULL, 0);
    const char *id = !moved && same_turn >= 0 ? "cubemap.faces_orientation" : "cubemap.faces_order";
    struct lint_finding *f = lint_add(findings, id, now.share[LINT_CUBEMAPS] > 0.6 ? "certain" : "likely");
    snprintf(f->evidence, sizeof f->evidence, "%s: %.0f %% of %zu comparisons of %s match then, %.0f %% as stored",
             text, 100 * now.share[LINT_CUBEMAPS], now.count[LINT_CUBEMAPS], lint_measure_names[LINT_CUBEMAPS],
             100 * agreement->share[LINT_CUBEMAPS]);
    *reading = other;
    *agreement = now;
}
