/* The options of commands that compare images: the metrics and their parameters. */
#ifndef GLINT_VIEWER_METRIC_ARGS_H
#define GLINT_VIEWER_METRIC_ARGS_H

#include <argp.h>
#include <jansson.h>

#include "glint/metrics.h"

enum { KEY_METRICS = 640, KEY_PPD, KEY_PEAK };

/* clang-format off */
#define METRIC_OPTIONS \
    {"metrics", KEY_METRICS, "NAME,...", 0, "Image metrics to print, or all (default, also without names: all but hdr_flip): ", 0}, \
    {"ppd",     KEY_PPD,     "N",        0, "Pixels per degree of visual angle, for flip and hdr_flip (default 67: a screen 3840 pixels wide, seen from a distance equal to its width)", 0}, \
    {"peak",    KEY_PEAK,    "N",        0, "Peak value for psnr (default: the highest value of the reference image)", 0}
/* clang-format on */

/* `--metrics` without names, at the end or before another option, chooses the default: writes that out before argp asks for names. */
void metric_args_complete(int argc, char **argv);
/* Reads one of METRIC_OPTIONS; ARGP_ERR_UNKNOWN for any other key. */
error_t metric_args_parse(int key, char *arg, struct argp_state *state, struct glint_metric_options *options);
/* The names of the metrics, for the help of KEY_METRICS; malloc'd, NULL for other keys. */
char *metric_args_values(int key);
/* Sets what is not set to the defaults of commands: metrics, resamples, seed. */
void metric_args_default(struct glint_metric_options *options);

/* Prints the chosen metrics of all pixels with their intervals, and those of each class that has pixels. */
void metrics_print(const struct glint_metric_table *table);
/* {"epsilon", "peak", …, "surfaces": [row…], "classes": [row…]}: the rows of the set `surface`, beginning with all
   pixels, and the rows of the other sets. */
json_t *metrics_json(const struct glint_metric_table *table);

/* How often each label of `rows` coincides with each label of `columns`, in per cent of the pixels with both, where `mask` is not 0. */
void cross_print(const struct glint_classes *rows, const struct glint_classes *columns, const uint64_t *table);
json_t *cross_json(const struct glint_classes *rows, const struct glint_classes *columns, const uint64_t *table);

#endif
