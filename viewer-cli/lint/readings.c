/* Searches the conventions under which independent images match best: the best single change first, then further changes from there. */
#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "capture/camera_facts.h"
#include "lint.h"

void lint_undecided(struct lint_findings *findings, const char *format, ...) {
    va_list arguments;
    if (findings->undecided_count == sizeof findings->undecided / sizeof *findings->undecided) return;
    va_start(arguments, format);
    vsnprintf(findings->undecided[findings->undecided_count++], sizeof *findings->undecided, format, arguments);
    va_end(arguments);
}

static void negate_axes(double sign[3], unsigned axes) {
    for (int i = 0; i < 3; i++)
        if (axes & (1u << i)) sign[i] = -sign[i];
}

static void exchange(int axis[3], int i, int k) {
    const int t = axis[i];
    axis[i] = axis[k];
    axis[k] = t;
}

/* Distance of the far plane in engine units; 1 where the projection has none. */
static double far_of(const struct lint_data *data) {
    const double far = camera_facts(&data->frame).far;
    return isfinite(far) ? far : 1;
}

/* With a factor of 1, pre-exposed is linear. */
static enum glint_color_encoding pre_exposed(const struct lint_data *data, enum glint_color_encoding otherwise) {
    return data->frame.pre_exposure == 1 ? otherwise : GLINT_COLOR_PRE_EXPOSED;
}

/* Values that are known only at run time. */
#define CLIP_Y "?clipY"
#define CLIP_Z "?clipZ"
#define INVERSE "?inverse"
#define MIRRORED "?mirrored"

static const struct row {
    const char *id, *what, *attribute, *value;
} rows[] = {
#define READING(id, statement, what, attribute, value) {id, what, attribute, value},
#include "readings_rows.h"
#undef READING
};
enum { ROWS = sizeof rows / sizeof *rows };

static void apply_reading(const struct lint_data *data, struct lint_reading *r, size_t row) {
    size_t at = 0;
#define READING(id, statement, what, attribute, value)                                                                 \
    if (at++ == row) (void)(statement);
#include "readings_rows.h"
#undef READING
    (void)data;
}

/* What cameras and depth are judged by. A mirrored camera and mirrored faces of the sky look alike, and colours match at fewer places than
   depth, so that they add no certainty. */
static const unsigned ALL_MEASURES = (1u << LINT_MEASURES) - 1 - (1u << LINT_SKY) - (1u << LINT_LIGHT);

/* The measures that a convention can influence, as bits. */
static unsigned measures_of(const char *id) {
    static const struct {
        const char *of;
        unsigned measures;
    } kinds[] = {{"depth.swapped", ALL_MEASURES | 1u << LINT_LIGHT}, /* light tells these two apart */
                 {"camera.swapped", ALL_MEASURES | 1u << LINT_LIGHT},
                 {"lit.swapped", 1u << LINT_LIGHT | 1u << LINT_BEFORE},
                 {"normal.", 1u << LINT_FACETS},
                 {"motion.", 1u << LINT_MOTION},
                 {"cubemap.", 1u << LINT_CUBEMAPS | 1u << LINT_COLORS},
                 {"lit.", 1u << LINT_COLORS | 1u << LINT_BEFORE | 1u << LINT_LIGHT | 1u << LINT_SKY},
                 {"sky.", 1u << LINT_SKY}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strncmp(id, kinds[i].of, strlen(kinds[i].of))) return kinds[i].measures;
    return ALL_MEASURES;
}

double lint_worth(const struct lint_agreement *a, const struct lint_agreement *other, int m) {
    const double reference = fmax((double)other->count[m], LINT_ENOUGH);
    return a->share[m] * fmin(1, 2 * (double)a->count[m] / reference);
}

/* The probability that a fair coin shows heads at least this often. */
static double tail(size_t heads, size_t throws) {
    double probability = pow(0.5, (double)throws), sum = 0;
    for (size_t k = 0; k <= throws; k++) {
        if (k >= heads) sum += probability;
        probability *= (double)(throws - k) / (double)(k + 1);
    }
    return sum;
}

/* Whether the second reading of normals is right where the first is not, by a sign test of pairs: what counts is each sample that matches under
   one of them alone. The samples of surfaces that face one way are no independent draws, since a reading turns all of their normals alike: a
   wrong one may match there, as it does on foliage with the ground's normals. So each direction throws a coin, by the sum of its samples. Where
   the first reading is right, the second is ahead in half of the directions at most. All rows together err once in a hundred captures. */
static bool is_ahead(const struct lint_agreement *from, const struct lint_agreement *to) {
    int ahead[LINT_DIRECTIONS] = {0};
    size_t better = 0, decided = 0;
    for (size_t i = 0; i < LINT_SAMPLES; i++) {
        const struct lint_facing first = from->facing[i], second = to->facing[i];
        if (first.agrees && second.agrees) ahead[first.direction] += (second.agrees - first.agrees) / 2;
    }
    for (size_t d = 0; d < LINT_DIRECTIONS; d++) {
        better += ahead[d] > 0;
        decided += ahead[d] != 0;
    }
    return tail(better, decided) < 0.01 / ROWS;
}

static bool is_compared(const struct lint_agreement *from, const struct lint_agreement *to, int m) {
    return from->count[m] >= LINT_ENOUGH || to->count[m] >= LINT_ENOUGH;
}

static bool gets_worse(const struct lint_agreement *from, const struct lint_agreement *to, int m) {
    return is_compared(from, to, m) && lint_worth(to, from, m) - lint_worth(from, to, m) < -0.02;
}

/* Where so much of the sky matches, its reading is right: what is brighter than all texels around it, as next to the sun between large ones, never
   does, but under a curve that spreads them. */
static const double SKY_MATCHES = 0.9;

/* By how much the second agreement is better: the sum over all measures. -1 when any measure gets worse. 0 when no measure gains
   much: at least one must halve its mismatches or more than double its matches, by more than a few samples, or be proven by pairs. */
static double gain(const struct lint_agreement *from, const struct lint_agreement *to, int *most) {
    double sum = 0, largest = 0;
    for (int m = 0; m < LINT_MEASURES; m++) {
        if (!is_compared(from, to, m)) continue;
        if (gets_worse(from, to, m)) return -1;
        const double before = lint_worth(from, to, m), after = lint_worth(to, from, m), difference = after - before;
        sum += difference;
        if (difference <= largest || difference < 0.015) continue;
        if (m == LINT_SKY && before > SKY_MATCHES) continue;
        if (1 - after > 0.5 * (1 - before) && after < 2.5 * before && !(m == LINT_FACETS && is_ahead(from, to)))
            continue;
        largest = difference;
        *most = m;
    }
    return largest > 0 ? sum : 0;
}

static void corrected_matrix(bool inverse, const double *m, double out[16]) {
    memcpy(out, m, 16 * sizeof *out);
    for (int i = 0; !inverse && i < 4; i++) out[i] = -m[i];
    for (int i = 0; inverse && i < 3; i++) {
        out[4 * i + 3] = 0;
        for (int k = 0; k < 3; k++) {
            out[4 * i + k] = m[4 * k + i];
            out[4 * i + 3] -= m[4 * k + i] * m[4 * k + 3];
        }
    }
}

static bool is_matrix(const struct row *row) {
    return !strcmp(row->value, INVERSE) || !strcmp(row->value, MIRRORED);
}

static void describe_remedy(const struct row *row, const char *value, bool previous, char text[240]) {
    if (!*row->attribute) snprintf(text, 240, "no attribute can declare this: change the dump");
    else if (is_matrix(row))
        snprintf(text, 240, "%s%s: %s", row->attribute, previous ? " and glint.previousWorldToView" : "",
                 !strcmp(row->value, INVERSE) ? "its inverse" : "its first row negated");
    else if (*value == '?') snprintf(text, 240, "%s = the other value", row->attribute);
    else snprintf(text, 240, "%s = \"%s\"", row->attribute, value);
}

static void declare(struct lint_finding *f, const struct row *row, const struct lint_data *data,
                    const struct lint_reading *reading) {
    f->value = row->value;
    if (!strcmp(row->value, CLIP_Y)) f->value = reading->clip_y == GLINT_CLIP_Y_UP ? "up" : "down";
    if (!strcmp(row->value, CLIP_Z))
        f->value = reading->clip_z == GLINT_CLIP_Z_ZERO_TO_ONE ? "zero_to_one" : "minus_one_to_one";
    const bool inverse = !strcmp(row->value, INVERSE);
    f->has_matrix = is_matrix(row);
    f->has_previous = f->has_matrix && data->frame.has_previous && !reading->inverse_current;
    if (f->has_matrix) corrected_matrix(inverse, data->frame.camera.world_to_view, f->matrix);
    if (f->has_previous) corrected_matrix(inverse, data->frame.previous.world_to_view, f->previous);
    describe_remedy(row, f->value, f->has_previous, f->remedy);
}

/* ---- What can be found ---- */

static void describe_measures(unsigned measures, char *text, size_t size) {
    const bool all = (measures & ALL_MEASURES) == ALL_MEASURES, light = measures & 1u << LINT_LIGHT;
    size_t length = (size_t)snprintf(text, size, "%s",
                                     !all    ? "comparison of "
                                     : light ? "all comparisons but the last"
                                             : "all comparisons but the last two");
    for (int m = 0; m < LINT_MEASURES && !all; m++)
        if (measures & 1u << m)
            length += (size_t)snprintf(text + length, size - length, "%s%s", measures & ((1u << m) - 1) ? "; of " : "",
                                       lint_measure_names[m]);
}

bool lint_known(size_t i, struct lint_known *known) {
    static const struct {
        const char *id, *what, *measured, *remedy, *attribute;
        enum lint_pixels pixels;
    } others[] = {
#define FINDING(id, what, measured, remedy, attribute, pixels) {id, what, measured, remedy, attribute, pixels},
#include "findings_rows.h"
#undef FINDING
    };
    if (i >= ROWS + sizeof others / sizeof *others) return false;
    if (i < ROWS) {
        *known = (struct lint_known){.id = rows[i].id, .what = rows[i].what, .attribute = rows[i].attribute};
        describe_measures(measures_of(rows[i].id), known->measured, sizeof known->measured);
        describe_remedy(&rows[i], rows[i].value, false, known->remedy);
        return true;
    }
    i -= ROWS;
    *known = (struct lint_known){others[i].id, others[i].what, others[i].attribute, others[i].pixels, "", ""};
    snprintf(known->measured, sizeof known->measured, "%s", others[i].measured);
    snprintf(known->remedy, sizeof known->remedy, "%s", others[i].remedy);
    return true;
}

struct lint_finding *lint_add(struct lint_findings *findings, const char *id, const char *likelihood) {
    static struct lint_finding lost;
    struct lint_finding *f = findings->count < LINT_FINDINGS ? &findings->items[findings->count++] : &lost;
    struct lint_known known;
    for (size_t i = 0; lint_known(i, &known) && strcmp(known.id, id) != 0;) i++;
    *f = (struct lint_finding){.likelihood = likelihood, .attribute = *known.attribute ? known.attribute : NULL};
    snprintf(f->id, sizeof f->id, "%s", id);
    snprintf(f->what, sizeof f->what, "%s", known.what);
    snprintf(f->remedy, sizeof f->remedy, "%s", known.remedy);
    f->pixels = known.pixels;
    return f;
}

/* ---- The best other convention ---- */

/* A reading that was tried: which row (or CENTERS, SKY_SCALE), and how well the images match under it. */
enum { CENTERS = ROWS, SKY_SCALE, NONE };
struct candidate {
    size_t row, also; /* `also`: a second row, for two mistakes of which neither shows alone */
    struct lint_reading reading;
    struct lint_agreement agreement;
    double gain;
    int measure; /* the one that gains most */
};
struct contest {
    struct candidate best, second;
};

static void consider(struct contest *contest, const struct lint_agreement *from, struct candidate *c) {
    c->gain = gain(from, &c->agreement, &c->measure);
    if (!(c->gain > 0) || c->agreement.share[c->measure] < LINT_MIN_SHARE) return;
    /* of two depth buffers, one may be wrong in another way: swapped, both must match */
    if (c->reading.swapped_depth && c->agreement.share[LINT_BEFORE] < 0.6) return;
    /* another row led to the same reading */
    if (!memcmp(&c->reading, &contest->best.reading, sizeof c->reading)) return;
    if (c->gain > contest->best.gain + 1e-3) {
        contest->second = contest->best;
        contest->best = *c;
    } else if (c->gain > contest->second.gain) contest->second = *c;
}

/* Takes the measures whose bits are set in `which`, the cheap ones first. Once one of them gets worse, the reading has lost, and the rest need
   not be known. */
static void measure_and_consider(const struct lint_data *data, unsigned which, struct contest *contest,
                                 const struct lint_agreement *from, struct candidate *c) {
    static const enum lint_measure order[] = {LINT_MOTION, LINT_SKY,      LINT_BEFORE, LINT_LIGHT,
                                              LINT_FACETS, LINT_CUBEMAPS, LINT_COLORS};
    static_assert(sizeof order / sizeof *order == LINT_MEASURES, "each measure has its place");
    c->agreement = *from;
    for (size_t i = 0; i < LINT_MEASURES; i++) {
        if (!(which & 1u << order[i])) continue;
        lint_measure(data, &c->reading, order[i], &c->agreement);
        if (gets_worse(from, &c->agreement, (int)order[i])) return;
    }
    consider(contest, from, c);
}

static const char *what_of(const struct candidate *c) {
    return c->row < ROWS ? rows[c->row].what : "cube-map centres are wrong";
}

/* Images stored bottom first match when NDC y is flipped, but then the top of the image points down in the world. */
static bool bottom_first(const struct lint_data *data, const struct lint_reading *reading) {
    static const int axis_of[6] = {1, 2, 0, 1, 2, 0};
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    const int up = (int)data->frame.up;
    const double top = (reading->clip_y == GLINT_CLIP_Y_UP ? 1 : -1) * (eyes.now.b < 0 ? -1 : 1);
    return top * (up < 3 ? 1 : -1) * eyes.now.rotation[3 + axis_of[up]] < -0.5;
}

static void add_finding(struct lint_findings *findings, const struct contest *contest, size_t row,
                        const struct lint_data *data, const struct lint_agreement *from) {
    const struct candidate *c = &contest->best;
    const int m = c->measure;
    const bool alone = contest->second.gain<0.95 * c->gain, clear = c->agreement.share[m]> 0.6 && alone;
    const bool turned = row < ROWS && !strcmp(rows[row].id, "camera.clip_y") && bottom_first(data, &c->reading);
    const char *id = row == CENTERS ? "cubemap.center" : turned ? "picture.bottom_first" : rows[row].id;
    struct lint_finding *f = lint_add(findings, id, clear ? "certain" : alone ? "likely" : "possible");
    snprintf(f->evidence, sizeof f->evidence,
             "%.0f %% of %zu comparisons of %s match as declared, %.0f %% of %zu under this convention",
             100 * from->share[m], from->count[m], lint_measure_names[m], 100 * c->agreement.share[m],
             c->agreement.count[m]);
    if (!alone) snprintf(f->either, sizeof f->either, "%s", what_of(&contest->second));
    if (row == CENTERS) lint_describe_centers(data, &c->reading, f);
    else if (!turned) declare(f, &rows[row], data, &c->reading);
}

static void try_rows(const struct lint_data *data, const struct lint_reading *reading,
                     const struct lint_agreement *agreement, struct contest *contest) {
    for (size_t i = 0; i < ROWS; i++) {
        struct candidate c = {.row = i, .also = NONE, .reading = *reading};
        apply_reading(data, &c.reading, i);
        if (!memcmp(&c.reading, reading, sizeof c.reading)) continue;
        measure_and_consider(data, measures_of(rows[i].id), contest, agreement, &c);
    }
}

/* Normals may deviate from the declaration in two ways at once, such as (n + 1) / 2 in view space: then neither change alone improves
   the match, except a little by chance. */
static void try_pairs_of_normals(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *agreement, struct contest *contest) {
    const double alone = fmax(agreement->share[LINT_FACETS], contest->best.agreement.share[LINT_FACETS]);
    struct contest pairs = *contest;
    if (agreement->count[LINT_FACETS] < LINT_ENOUGH || alone > 0.6) return;
    for (size_t i = 0; i < ROWS; i++)
        for (size_t k = i + 1; k < ROWS && !strncmp(rows[i].id, "normal.", 7); k++) {
            struct candidate c = {.row = i, .also = k, .reading = *reading};
            struct lint_reading first;
            if (strncmp(rows[k].id, "normal.", 7) != 0) continue;
            apply_reading(data, &c.reading, i);
            first = c.reading;
            apply_reading(data, &c.reading, k);
            if (!memcmp(&c.reading, &first, sizeof first) || !memcmp(&first, reading, sizeof first)) continue;
            measure_and_consider(data, 1u << LINT_FACETS, &pairs, agreement, &c);
        }
    const double together = pairs.best.agreement.share[LINT_FACETS];
    if (pairs.best.gain > contest->best.gain && together > 0.6 && together > alone + 0.15) *contest = pairs;
}

static double agreeing(const struct lint_agreement *a, int measure) {
    return a->share[measure] * (double)a->count[measure];
}

/* lint_search_centers judges each centre separately. One cube map of many changes few of all comparisons, and from a wrong centre many
   samples seem occluded and are not compared, so it suffices that more samples match than before. */
static void try_centers(const struct lint_data *data, const struct lint_reading *reading,
                        const struct lint_agreement *agreement, struct contest *contest) {
    static const double nowhere[LINT_CUBES][3];
    struct candidate c = {.row = CENTERS, .also = NONE};
    if (agreement->count[LINT_CUBEMAPS] < LINT_ENOUGH || memcmp(reading->center_offset, nowhere, sizeof nowhere) != 0 ||
        !lint_search_centers(data, reading, &c.reading))
        return;
    c.agreement = lint_agree(data, &c.reading, agreement, 1u << LINT_CUBEMAPS | 1u << LINT_COLORS);
    consider(contest, agreement, &c);
    if (contest->best.row != NONE || agreeing(&c.agreement, LINT_CUBEMAPS) <= agreeing(agreement, LINT_CUBEMAPS) ||
        agreeing(&c.agreement, LINT_COLORS) < agreeing(agreement, LINT_COLORS))
        return;
    c.gain = 1e-3;
    c.measure = LINT_CUBEMAPS;
    contest->best = c;
}

static bool is_curved(const struct lint_reading *r) {
    return (r->lit == GLINT_COLOR_SRGB) != (r->sky == GLINT_COLOR_SRGB);
}

/* A sky that is drawn brighter or darker than its cube map is no mistake. If it has few colours, a factor can explain as much as the sRGB
   curve: then neither is proven. */
static void try_sky_scale(const struct lint_data *data, const struct lint_reading *reading,
                          const struct lint_agreement *agreement, struct contest *contest) {
    struct candidate c = {.row = SKY_SCALE, .also = NONE, .reading = *reading};
    const struct candidate *best = &contest->best;
    if (agreement->count[LINT_SKY] < LINT_ENOUGH || (best->row != NONE && best->measure != LINT_SKY)) return;
    c.reading.sky_scale *= lint_sky_scale(data, reading);
    c.agreement = lint_agree(data, &c.reading, agreement, 1u << LINT_SKY);
    c.gain = gain(agreement, &c.agreement, &c.measure);
    const double missed = 1 - c.agreement.share[LINT_SKY], least = 1 - best->agreement.share[LINT_SKY];
    const bool only = best->row == NONE,
               as_good = is_curved(&best->reading) != is_curved(reading) && missed <= 2 * least + 0.02;
    if (c.gain > 0 && c.agreement.share[LINT_SKY] >= LINT_MIN_SHARE && (only || as_good)) contest->best = c;
}

/* Takes the best other reading from here; false when none is clearly better. */
static bool apply_best_reading(const struct lint_data *data, struct lint_reading *reading,
                               struct lint_agreement *agreement, struct lint_findings *findings) {
    struct contest contest = {.best = {.row = NONE}, .second = {.row = NONE}};
    try_rows(data, reading, agreement, &contest);
    try_pairs_of_normals(data, reading, agreement, &contest);
    try_centers(data, reading, agreement, &contest);
    try_sky_scale(data, reading, agreement, &contest);
    if (contest.best.row == NONE) return false;
    if (contest.best.row != SKY_SCALE) add_finding(findings, &contest, contest.best.row, data, agreement);
    if (contest.best.also != NONE) add_finding(findings, &contest, contest.best.also, data, agreement);
    *reading = contest.best.reading;
    *agreement = lint_agree(data, reading, NULL, 0);
    return true;
}

void lint_find_readings(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                        struct lint_findings *findings) {
    enum { MISTAKES = 4 };
    for (int i = 0; i < MISTAKES && apply_best_reading(data, reading, agreement, findings); i++) continue;
}
