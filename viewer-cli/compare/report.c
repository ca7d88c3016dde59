/* The results of glint compare as printed tables. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/compare.h"
#include "io/table.h"

/* "0.093 of 97.2 %" */
static void error_cell(struct table *table, const struct showing *s, size_t k) {
    if (!s->ran || s->judged[k] == 0) table_cell(table, "–");
    else if (!s->compared) table_cell(table, "%.1f %%", 100 * showing_coverage(s, k));
    else if (s->own.of[k].pixels == 0) table_cell(table, "none");
    else table_cell(table, "%.3f (%.1f %%)", s->own.of[k].symmetric, 100 * showing_coverage(s, k));
}

static void time_cell(struct table *table, const struct contest_time *time) {
    if (time->n == 0 || time->max <= 0) table_cell(table, "–");
    else table_cell(table, "%.3f", time->median);
}

static double shared_error(const struct showing *s) {
    return s->compared && s->shared.of[0].pixels ? s->shared.of[0].symmetric : (double)INFINITY;
}

/* `best`: the least error over the pixels that all presets cover. */
static void print_showing(struct table *table, const struct showing *s, size_t classes, double best) {
    for (size_t k = 1; k <= classes; k++) error_cell(table, s, k);
    error_cell(table, s, 0);
    if (isfinite(shared_error(s))) table_cell(table, "%.3f", shared_error(s));
    else table_cell(table, "–");
    if (isfinite(best) && shared_error(s) <= best) table_mark(table, MARK_GOOD);
    for (int k = 0; k < 2; k++)
        if (s->ran && s->steps_px > 0) table_cell(table, "%.1f", k ? s->fetches_px : s->steps_px);
        else table_cell(table, "–");
    time_cell(table, &s->frame);
    time_cell(table, &s->cubemaps);
}

const struct showing *contest_showing(const struct contest_table *t, size_t capture, size_t preset) {
    return &contest_log_showings(t->log, capture)[preset];
}

static void print_errors(const struct contest_table *t) {
    static const char *const costs[] = {">all", ">shared", ">steps/px", ">fetches/px", ">ms", ">cube maps, ms", NULL};
    const struct glint_effect *effect = t->contest->effect;
    const size_t classes = glint_effect_class_count(effect);
    const char *titles[2 + GLINT_EFFECT_CLASSES + sizeof costs / sizeof *costs] = {"<capture", "<preset"};
    char names[GLINT_EFFECT_CLASSES][64];
    for (size_t k = 0; k < classes; k++) {
        snprintf(names[k], sizeof names[k], ">%s", glint_effect_class_name(effect, k + 1));
        titles[2 + k] = names[k];
    }
    memcpy(&titles[2 + classes], costs, sizeof costs);
    struct table *table = table_create(titles);
    for (size_t k = 0; k < t->shown_count; k++) {
        const size_t c = t->shown[k];
        double best = INFINITY;
        for (size_t p = 0; p < t->contest->count; p++) best = fmin(best, shared_error(contest_showing(t, c, p)));
        for (size_t p = 0; p < t->contest->count; p++) {
            table_cell(table, "%s", base_name(t->captures[c]));
            table_cell(table, "%s", t->contest->contestants[p].label);
            print_showing(table, contest_showing(t, c, p), classes, best);
        }
    }
    printf("Error of the %s against the truth (mean of |found - truth| / (found + truth), 0 to 1) over the covered "
           "pixels, with the coverage in parentheses: the share of the judged pixels for which the preset finds one. "
           "shared: error over the pixels that all presets cover; steps and fetches of all rays per pixel of the "
           "picture:\n\n",
           effect->noun);
    table_print(table, stdout);
    table_destroy(&table);
}

static const struct glint_end_row *same_end(const struct showing *s, const struct glint_end_row *row) {
    for (size_t i = 0; s->ran && i < s->ends.count; i++)
        if (!strcmp(s->ends.rows[i].tracer, row->tracer) && !strcmp(s->ends.rows[i].reason, row->reason))
            return &s->ends.rows[i];
    return NULL;
}

/* A row of an end reason of one tracer, over all presets. */
static void print_end(struct table *table, const struct contest_table *t, size_t capture,
                      const struct glint_end_row *row) {
    table_cell(table, "%s", base_name(t->captures[capture]));
    table_cell(table, "%s", row->tracer);
    table_cell(table, "%s", row->text);
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct glint_end_row *r = same_end(contest_showing(t, capture, p), row);
        if (!r) table_cell(table, "–");
        else if (!isfinite(r->error)) table_cell(table, "%.1f %%", 100 * r->share);
        else table_cell(table, "%.1f %%, %.3f", 100 * r->share, r->error);
    }
}

/* Each end reason once per capture and tracer, in the order in which presets list them. */
static void fill_ends(struct table *table, const struct contest_table *t, size_t capture, const char *tracer) {
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct showing *s = contest_showing(t, capture, p);
        for (size_t i = 0; s->ran && i < s->ends.count; i++) {
            const struct glint_end_row *row = &s->ends.rows[i];
            bool listed = strcmp(row->tracer, tracer) != 0;
            for (size_t before = 0; before < p && !listed; before++)
                listed = same_end(contest_showing(t, capture, before), row) != NULL;
            if (!listed) print_end(table, t, capture, row);
        }
    }
}

enum { TRACERS = 16 };
struct tracers {
    char names[TRACERS][64];
    size_t count;
};

static void add_tracer(struct tracers *tracers, const char *name) {
    for (size_t n = 0; n < tracers->count; n++)
        if (!strcmp(tracers->names[n], name)) return;
    if (tracers->count < TRACERS) snprintf(tracers->names[tracers->count++], sizeof *tracers->names, "%s", name);
}

/* The tracers of all presets. */
static struct tracers list_tracers(const struct contest_table *t) {
    struct tracers tracers = {.count = 0};
    for (size_t k = 0; k < t->shown_count; k++)
        for (size_t p = 0; p < t->contest->count; p++) {
            const struct showing *s = contest_showing(t, t->shown[k], p);
            for (size_t i = 0; s->ran && i < s->ends.count; i++) add_tracer(&tracers, s->ends.rows[i].tracer);
        }
    return tracers;
}

static void print_ends(const struct contest_table *t) {
    const struct tracers tracers = list_tracers(t);
    const size_t presets = t->contest->count;
    const char **titles = calloc(presets + 4, sizeof *titles);
    char(*names)[LABEL_SIZE + 1] = calloc(presets + 1, sizeof *names);
    if (tracers.count && titles && names) {
        static const char *const first[] = {"<capture", "<tracer", "<end reason"};
        memcpy(titles, first, sizeof first);
        for (size_t p = 0; p < presets; p++) {
            snprintf(names[p], sizeof names[p], ">%s", t->contest->contestants[p].label);
            titles[3 + p] = names[p];
        }
        struct table *table = table_create(titles);
        for (size_t k = 0; k < t->shown_count; k++)
            for (size_t n = 0; n < tracers.count; n++) fill_ends(table, t, t->shown[k], tracers.names[n]);
        puts("\nEnd reasons: share of all rays, and the error of the covered pixels whose rays ended so:\n");
        table_print(table, stdout);
        table_destroy(&table);
    }
    free(names);
    free(titles);
}

/* The other table compares opaque surfaces only; this one compares water and glass in the final image. */
static void print_over(const struct contest_table *t) {
    static const char *const titles[] = {"<capture", "<preset", "<part", ">pixels", ">error", "<", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < t->shown_count * t->contest->count; i++) {
        const size_t c = t->shown[i / t->contest->count], p = i % t->contest->count;
        const struct showing *s = contest_showing(t, c, p);
        for (int k = 0; k < CONTEST_OVER; k++) {
            if (!s->ran || s->over[k].error.pixels == 0) continue;
            table_cell(table, "%s", base_name(t->captures[c]));
            table_cell(table, "%s", t->contest->contestants[p].label);
            table_cell(table, "%s", contest_over[k]);
            table_cell(table, "%llu", (unsigned long long)s->over[k].error.pixels);
            table_cell(table, "%.3f", s->over[k].error.symmetric);
            table_cell(table, "%s", s->over[k].drawn ? "" : "not drawn");
        }
    }
    if (!table_is_empty(table)) {
        puts("\nFinal image against the capture's scene, where water or glass covers opaque surfaces:\n");
        table_print(table, stdout);
    }
    table_destroy(&table);
}

static void print_notes(const struct contest_table *t) {
    for (size_t k = 0; k < t->shown_count; k++)
        for (size_t p = 0; p < t->contest->count; p++) {
            const size_t c = t->shown[k];
            const struct showing *s = contest_showing(t, c, p);
            const char *notes = s->notes ? s->notes : "";
            uint64_t invalid = s->own.of[0].invalid;
            if (!s->failure[0] && !notes[0] && !invalid) continue;
            printf("\n%s, %s: ", name_text(base_name(t->captures[c])), name_text(t->contest->contestants[p].label));
            if (s->failure[0])
                printf("%s%s%s", s->ran ? "no error: " : "failed: ", name_text(s->failure), notes[0] ? "; " : "");
            if (invalid) printf("NaN or infinite in %llu pixels%s", (unsigned long long)invalid, notes[0] ? "; " : "");
            fputs(name_text(notes), stdout);
        }
    putchar('\n');
}

void contest_print(const struct contest_table *t) {
    const struct glint_device_info *device = glint_device_get_info(t->contest->device);
    if (t->rows) printf("The %zu captures with the largest errors, of %zu.\n\n", t->shown_count, t->capture_count);
    print_errors(t);
    printf("\ntimes: median of %u alternating rounds on %s%s\n", t->contest->rounds, device->name,
           device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    print_over(t);
    print_ends(t);
    print_notes(t);
}
