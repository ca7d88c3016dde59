/* The options of commands that compare images, and the output of the metrics. */
#include "options/metric_args.h"

#include <math.h>
#include <string.h>

#include "options/args.h"
#include "io/table.h"

void metric_args_complete(int argc, char **argv) {
    static char written_out[] = "--metrics=default";
    for (int i = 1; i < argc; i++) {
        const bool is = !strcmp(argv[i], "--metrics") || !strcmp(argv[i], "-metrics");
        if (is && (i + 1 == argc || argv[i + 1][0] == '-')) argv[i] = written_out;
    }
}

error_t metric_args_parse(int key, char *arg, struct argp_state *state, struct glint_metric_options *options) {
    struct glint_error err = {0};
    switch (key) {
    case KEY_METRICS:
        if (!strcmp(arg, "default")) options->metrics = GLINT_METRICS_ALL & ~(1u << GLINT_METRIC_HDR_FLIP);
        else if (!glint_metrics_parse(arg, &options->metrics, &err)) argp_error(state, "--metrics: %s", err.message);
        return 0;
    case KEY_PPD:
        arg_numbers("ppd", arg, &options->ppd, 1, state);
        if (!(options->ppd > 0)) argp_error(state, "--ppd=%s: expected a number above 0", arg);
        return 0;
    case KEY_PEAK:
        arg_numbers("peak", arg, &options->peak, 1, state);
        if (!(options->peak > 0)) argp_error(state, "--peak=%s: expected a number above 0", arg);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

char *metric_args_values(int key) {
    const char *names[GLINT_METRIC_COUNT + 1] = {NULL};
    for (size_t i = 0; i < GLINT_METRIC_COUNT; i++) names[i] = glint_metric(i)->name;
    return key == KEY_METRICS ? join_names("", names) : NULL;
}

void metric_args_default(struct glint_metric_options *options) {
    if (options->metrics == 0) options->metrics = GLINT_METRICS_ALL & ~(1u << GLINT_METRIC_HDR_FLIP);
    if (options->resamples == 0) options->resamples = GLINT_RESAMPLES;
}

/* Whether any row has the metric. */
static bool has_metric(const struct glint_metric_table *t, size_t metric) {
    for (size_t i = 0; i < t->count; i++)
        if (!isnan(t->rows[i].of[metric].value)) return true;
    return false;
}

/* Without noise of the truth, the figures that are corrected for it equal the others and are not printed. */
static bool is_printed(const struct glint_metric_table *t, size_t metric) {
    bool clean = metric == GLINT_METRIC_CLEAN_RMSE || metric == GLINT_METRIC_CLEAN_RELATIVE_MSE;
    return has_metric(t, metric) && !(clean && !(t->rows[0].truth_noise > 0));
}

static bool has_pixels(const struct glint_metric_row *row) {
    return row->pixels + row->invalid > 0;
}

static void value_cell(struct table *table, double value) {
    if (isnan(value)) table_cell(table, "-");
    else if (isinf(value)) table_cell(table, value > 0 ? "∞" : "-∞");
    else table_cell(table, "%.5f", value);
}

static void print_all(const struct glint_metric_table *t) {
    static const char *const titles[] = {"<metric", ">value", ">95 % from", ">to", "<", NULL};
    struct table *table = table_create(titles);
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
        if (!is_printed(t, k)) continue;
        const struct glint_figure *figure = &t->rows[0].of[k];
        table_cell(table, "%s", glint_metric(k)->title);
        value_cell(table, figure->value);
        value_cell(table, figure->low);
        value_cell(table, figure->high);
        table_cell(table, "%s", glint_metric(k)->what);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_assumed(const struct glint_metric_table *t) {
    printf("epsilon %g", t->epsilon);
    if (has_metric(t, GLINT_METRIC_PSNR)) printf(", peak %.5g", t->peak);
    if (has_metric(t, GLINT_METRIC_SSIM) || has_metric(t, GLINT_METRIC_FLIP))
        printf(", exposure %g f-stops", t->exposure);
    if (has_metric(t, GLINT_METRIC_FLIP) || has_metric(t, GLINT_METRIC_HDR_FLIP))
        printf(", %.4g pixels a degree", t->ppd);
    if (t->exposures)
        printf(", HDR-ꟻLIP over %u exposures from %.2f to %.2f f-stops", t->exposures, t->start_exposure,
               t->stop_exposure);
    if (t->rows[0].truth_noise > 0) printf(", noise of the reference image %.5f", t->rows[0].truth_noise);
    if (t->resamples)
        printf("; intervals from %u resamplings of tiles of %u × %u pixels", t->resamples, t->tile_px, t->tile_px);
    putchar('\n');
}

static void print_classes(const struct glint_metric_table *t) {
    const char *titles[6 + GLINT_METRIC_COUNT] = {"<by", "<", ">pixels", ">mean"};
    char texts[GLINT_METRIC_COUNT][48];
    size_t columns = 4;
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
        if (!is_printed(t, k)) continue;
        snprintf(texts[k], sizeof texts[k], ">%s", glint_metric(k)->title);
        titles[columns++] = texts[k];
    }
    titles[columns] = ">invalid";
    struct table *table = table_create(titles);
    const char *set = "";
    for (size_t i = 0; i < t->count; i++) {
        const struct glint_metric_row *row = &t->rows[i];
        if (!has_pixels(row)) continue;
        table_cell(table, "%s", strcmp(row->set, set) ? row->set : "");
        set = row->set;
        table_cell(table, "%s", i ? row->name : "");
        table_cell(table, "%llu", (unsigned long long)row->pixels);
        value_cell(table, row->truth_mean);
        for (size_t k = 0; k < GLINT_METRIC_COUNT; k++)
            if (is_printed(t, k)) value_cell(table, row->of[k].value);
        table_cell(table, "%llu", (unsigned long long)row->invalid);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

void metrics_print(const struct glint_metric_table *table) {
    print_all(table);
    print_assumed(table);
    putchar('\n');
    print_classes(table);
}

static json_t *row_json(const struct glint_metric_table *t, const struct glint_metric_row *row) {
    json_t *json =
        json_pack("{s:I, s:I, s:o, s:o}", "pixels", (json_int_t)row->pixels, "invalid", (json_int_t)row->invalid,
                  "truth_mean", json_number(row->truth_mean), "truth_noise", json_number(row->truth_noise));
    json_t *intervals = json_object();
    for (size_t k = 0; k < GLINT_METRIC_COUNT; k++) {
        const struct glint_figure *figure = &row->of[k];
        if (!has_metric(t, k)) continue;
        json_object_set_new(json, glint_metric(k)->name, json_number(figure->value));
        if (!isnan(figure->low))
            json_object_set_new(intervals, glint_metric(k)->name,
                                json_pack("[o, o]", json_number(figure->low), json_number(figure->high)));
    }
    json_object_set_new(json, "interval", intervals);
    return json;
}

json_t *metrics_json(const struct glint_metric_table *t) {
    json_t *surfaces = json_array(), *classes = json_array();
    for (size_t i = 0; i < t->count; i++) {
        const struct glint_metric_row *row = &t->rows[i];
        if (!has_pixels(row)) continue;
        bool surface = i == 0 || !strcmp(row->set, t->rows[1].set);
        json_t *json = row_json(t, row);
        if (!surface) json_object_set_new(json, "set", json_string(row->set));
        json_object_set_new(json, surface ? "surfaces" : "class", json_string(row->name));
        json_array_append_new(surface ? surfaces : classes, json);
    }
    return json_pack("{s:f, s:f, s:f, s:f, s:{s:I, s:f, s:f}, s:{s:f, s:I, s:I, s:I}, s:{s:I, s:I}, s:o, s:o}",
                     "epsilon", t->epsilon, "peak", t->peak, "ppd", t->ppd, "exposure", t->exposure, "hdr_flip",
                     "exposures", (json_int_t)t->exposures, "start", t->start_exposure, "stop", t->stop_exposure,
                     "intervals", "confidence", 0.95, "resamples", (json_int_t)t->resamples, "tile_px",
                     (json_int_t)t->tile_px, "seed", (json_int_t)t->seed, "invalid", "found",
                     (json_int_t)t->invalid_found, "answer", (json_int_t)t->invalid_truth, "surfaces", surfaces,
                     "classes", classes);
}

static uint64_t cross_at(const struct glint_classes *columns, const uint64_t *table, size_t row, size_t column) {
    return table[(row + 1) * (columns->count + 1) + column + 1];
}

void cross_print(const struct glint_classes *rows, const struct glint_classes *columns, const uint64_t *cross) {
    const char *titles[GLINT_CLASSES + 3] = {"<"};
    char texts[GLINT_CLASSES][64];
    uint64_t all = 0;
    for (size_t c = 0; c < columns->count; c++) {
        snprintf(texts[c], sizeof texts[c], ">%s", columns->names[c]);
        titles[c + 1] = texts[c];
        for (size_t r = 0; r < rows->count; r++) all += cross_at(columns, cross, r, c);
    }
    struct table *table = table_create(titles);
    for (size_t r = 0; r < rows->count; r++) {
        table_cell(table, "%s", rows->names[r]);
        for (size_t c = 0; c < columns->count; c++)
            table_cell(table, "%.2f %%", all ? 100 * (double)cross_at(columns, cross, r, c) / (double)all : 0);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

json_t *cross_json(const struct glint_classes *rows, const struct glint_classes *columns, const uint64_t *cross) {
    json_t *json = json_object();
    for (size_t r = 0; r < rows->count; r++) {
        json_t *row = json_object();
        for (size_t c = 0; c < columns->count; c++)
            json_object_set_new(row, columns->names[c], json_integer((json_int_t)cross_at(columns, cross, r, c)));
        json_object_set_new(json, rows->names[r], row);
    }
    return json;
}
