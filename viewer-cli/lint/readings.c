/* Other readings: the one under which independent images agree best, and again from there. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "camera_facts.h"
#include "lint.h"

struct lint_finding *lint_add(struct lint_findings *findings, const char *id, const char *likelihood) {
    static struct lint_finding lost;
    struct lint_finding *f = findings->count < LINT_FINDINGS ? &findings->items[findings->count++] : &lost;
    *f = (struct lint_finding){.likelihood = likelihood};
    snprintf(f->id, sizeof f->id, "%s", id);
    return f;
}

void lint_undecided(struct lint_findings *findings, const char *format, ...) {
    va_list arguments;
    if (findings->undecided_count == sizeof findings->undecided / sizeof *findings->undecided) return;
    va_start(arguments, format);
    vsnprintf(findings->undecided[findings->undecided_count++], sizeof *findings->undecided, format, arguments);
    va_end(arguments);
}

static void flip(double sign[3], unsigned axes) {
    for (int i = 0; i < 3; i++)
        if (axes & (1u << i)) sign[i] = -sign[i];
}

static void exchange(int axis[3], int i, int k) {
    const int t = axis[i];
    axis[i] = axis[k];
    axis[k] = t;
}

/* Depth at the far plane, units; 1 where there is none. */
static double far_of(const struct lint_data *data) {
    const double far = camera_facts(&data->frame).far;
    return isfinite(far) ? far : 1;
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

static void apply(const struct lint_data *data, struct lint_reading *r, size_t row) {
    size_t at = 0;
#define READING(id, statement, what, attribute, value)                                                                 \
    if (at++ == row) (void)(statement);
#include "readings_rows.h"
#undef READING
    (void)data;
}

/* The measures that a reading has to do with, by what it is of. */
static unsigned measures_of(const char *id) {
    static const struct {
        const char *of;
        unsigned measures;
    } kinds[] = {{"normal.", 1u << LINT_FACETS},
                 {"motion.", 1u << LINT_MOTION},
                 {"cubemap.", 1u << LINT_CUBEMAPS | 1u << LINT_COLORS},
                 {"lit.", 1u << LINT_COLORS}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strncmp(id, kinds[i].of, strlen(kinds[i].of))) return kinds[i].measures;
    return (1u << LINT_MEASURES) - 1;
}

/* What a reading's share of a measure is worth beside that of another one: nothing that was reached by comparing less. */
static double worth(const struct lint_agreement *a, const struct lint_agreement *other, int m) {
    const double reference = fmax((double)other->count[m], LINT_ENOUGH);
    return a->share[m] * fmin(1, 2 * (double)a->count[m] / reference);
}

/* By how much the second agrees better: the gains of all measures. -1 when any of them loses, 0 when none gains much: it must take
   away half of what does not agree or make it agree more than twice as often, and in more than a few places. */
static double gain(const struct lint_agreement *from, const struct lint_agreement *to, int *most) {
    double sum = 0, largest = 0;
    for (int m = 0; m < LINT_MEASURES; m++) {
        if (from->count[m] < LINT_ENOUGH && to->count[m] < LINT_ENOUGH) continue;
        const double before = worth(from, to, m), after = worth(to, from, m), difference = after - before;
        if (difference < -0.02) return -1;
        sum += difference;
        if (difference <= largest || difference < 0.015) continue;
        if (1 - after > 0.5 * (1 - before) && after < 2.5 * before) continue;
        largest = difference;
        *most = m;
    }
    return largest > 0 ? sum : 0;
}

static void declare(struct lint_finding *f, const struct row *row, const struct lint_data *data,
                    const struct lint_reading *reading) {
    const double *m = data->frame.camera.world_to_view;
    f->attribute = *row->attribute ? row->attribute : NULL;
    f->value = row->value;
    if (!strcmp(row->value, CLIP_Y)) f->value = reading->clip_y == GLINT_CLIP_Y_UP ? "up" : "down";
    if (!strcmp(row->value, CLIP_Z))
        f->value = reading->clip_z == GLINT_CLIP_Z_ZERO_TO_ONE ? "zero_to_one" : "minus_one_to_one";
    f->has_matrix = !strcmp(row->value, INVERSE) || !strcmp(row->value, MIRRORED);
    memcpy(f->matrix, m, sizeof f->matrix);
    for (int i = 0; !strcmp(row->value, MIRRORED) && i < 4; i++) f->matrix[i] = -m[i];
    for (int i = 0; !strcmp(row->value, INVERSE) && i < 3; i++) {
        f->matrix[4 * i + 3] = 0;
        for (int k = 0; k < 3; k++) {
            f->matrix[4 * i + k] = m[4 * k + i];
            f->matrix[4 * i + 3] -= m[4 * k + i] * m[4 * k + 3];
        }
    }
    if (!f->attribute) snprintf(f->mend, sizeof f->mend, "no declaration says so: change the dump");
    else if (f->has_matrix)
        snprintf(f->mend, sizeof f->mend, "%s: %s", f->attribute,
                 !strcmp(row->value, INVERSE) ? "its inverse" : "its first row negated");
    else snprintf(f->mend, sizeof f->mend, "%s = \"%s\"", f->attribute, f->value);
}

static void tell(struct lint_findings *findings, const struct row *row, const struct lint_data *data,
                 const struct lint_reading *reading, const struct lint_agreement *from, const struct lint_agreement *to,
                 int measure, bool alone) {
    const bool clear = to->share[measure] > 0.6 && alone;
    struct lint_finding *f = lint_add(findings, row->id, clear ? "certain" : alone ? "likely" : "possible");
    snprintf(f->what, sizeof f->what, "%s", row->what);
    snprintf(f->evidence, sizeof f->evidence,
             "as declared %.0f %% of %zu comparisons of %s agree, so read %.0f %% of %zu", 100 * from->share[measure],
             from->count[measure], lint_measure_names[measure], 100 * to->share[measure], to->count[measure]);
    declare(f, row, data, reading);
}

/* The best other reading from here; false when none is clearly better. */
static bool step(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                 struct lint_findings *findings) {
    struct lint_agreement best = *agreement;
    struct lint_reading chosen = *reading;
    double most = 0, second = 0;
    size_t found = ROWS;
    int measure = 0;
    for (size_t i = 0; i < ROWS; i++) {
        struct lint_reading other = *reading;
        int m = 0;
        apply(data, &other, i);
        if (!memcmp(&other, reading, sizeof other)) continue;
        const struct lint_agreement a = lint_agree(data, &other, agreement, measures_of(rows[i].id));
        const double better = gain(agreement, &a, &m);
        if (better <= most + 1e-3) {
            second = fmax(second, better);
            continue;
        }
        second = most;
        most = better;
        best = a;
        chosen = other;
        found = i;
        measure = m;
    }
    if (found == ROWS) return false;
    tell(findings, &rows[found], data, &chosen, agreement, &best, measure, second < 0.95 * most);
    *reading = chosen;
    *agreement = best;
    return true;
}

void lint_find_readings(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                        struct lint_findings *findings) {
    enum { MISTAKES = 4 };
    for (int i = 0; i < MISTAKES && step(data, reading, agreement, findings); i++) continue;
}
