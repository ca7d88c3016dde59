/* Draws values as false colours. */
#include "draw/view/falsecolor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/sort.h"
#include "draw/view/colormap.h"

const char *const kind_names[] = {"auto",   "color", "distance", "depth",   "steps", "weight",
                                  "normal", "index", "reason",   "invalid", "raw",   NULL};

enum kind kind_of(const struct source *s) {
    static const char *const indices[] = {"index", "choice", "id", "finished", "class"};
    if (!strcmp(s->unit, "end reason")) return KIND_REASON;
    if (source_channel(s, "R") == 0 && s->components >= 3) return KIND_COLOR;
    bool normal = !strcmp(s->unit, "1") || strstr(s->title, "normal");
    if (source_channel(s, "X") == 0 && s->components >= 3 && normal) return KIND_NORMAL;
    for (size_t i = 0; s->integer && i < sizeof indices / sizeof *indices; i++)
        if (!strcmp(s->channels[0], indices[i])) return KIND_INDEX;
    return KIND_DISTANCE;
}

/* The value that is drawn: the first channel, or the length of a vector. */
static double drawn_value(const struct source *s, size_t texel) {
    const float *v = s->texels + texel * s->components;
    if (s->components >= 2 && source_channel(s, "X") == 0 && source_channel(s, "Y") == 1) {
        double z = s->components >= 3 && source_channel(s, "Z") == 2 ? (double)v[2] : 0;
        return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + z * z);
    }
    return (double)v[0];
}

/* Percentiles of at most 250,000 evenly spaced texels; with `positive`, of those above 0. */
static bool percentiles(const struct source *s, bool positive, const struct falsecolor_options *options, double *low,
                        double *high, struct glint_error *err) {
    const double first = options->percentiles_given ? options->percentiles[0] / 100 : 0.005,
                 last = options->percentiles_given ? options->percentiles[1] / 100 : 0.995;
    size_t texels = (size_t)s->width * s->height, step = texels / 250000 + 1, count = 0;
    float *values = malloc((texels / step + 1) * sizeof *values);
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < texels; i += step) {
        double v = drawn_value(s, i);
        if (isfinite(v) && (!positive || v > 0)) values[count++] = (float)v;
    }
    glint_sort_floats(values, count);
    *low = count ? (double)values[(size_t)((double)(count - 1) * first)] : positive;
    *high = count ? (double)values[(size_t)((double)(count - 1) * last + 0.5)] : 1;
    free(values);
    return true;
}

/* Computes the range of the legend and chooses between a linear and a logarithmic scale. */
static bool choose_scale(struct legend *legend, const struct source *s, const struct falsecolor_options *options,
                         struct glint_error *err) {
    bool length = !strcmp(s->unit, "m"), may = options->scale == SCALE_LOG || (options->scale == SCALE_AUTO && length);
    if (options->range_given) {
        legend->low = options->low;
        legend->high = options->high;
    } else if (!percentiles(s, may, options, &legend->low, &legend->high, err)) return false;
    if (options->scale == SCALE_LOG && !(legend->low > 0))
        return glint_fail(err, GLINT_ERROR_USAGE, "a logarithmic scale needs a positive range");
    bool wide = legend->low > 0 && legend->high > 20 * legend->low;
    legend->logarithmic = options->scale == SCALE_LOG || (may && wide);
    return legend->logarithmic || !may || options->range_given ||
           percentiles(s, false, options, &legend->low, &legend->high, err);
}

static double position(const struct legend *l, double v) {
    if (!(l->high > l->low)) return v > l->low ? 1 : v < l->low ? 0 : 0.5;
    if (!l->logarithmic) return (v - l->low) / (l->high - l->low);
    return v > 0 ? log(v / l->low) / log(l->high / l->low) : 0;
}

static uint8_t to_byte(double v) {
    return (uint8_t)((v > 0 ? v < 1 ? v : 1 : 0) * 255 + 0.5);
}

static struct rgb distance_color(struct legend *l, double v) {
    if (isnan(v)) {
        l->has_invalid = true;
        return COLOR_INVALID;
    }
    if (isinf(v) && v < 0) {
        l->has_none = true;
        return COLOR_NONE;
    }
    if (isinf(v)) {
        l->has_infinite = true;
        return COLOR_SKY;
    }
    if (l->logarithmic && v <= 0) {
        l->has_zero = true;
        return colormap_category(0);
    }
    return colormap_viridis(position(l, v));
}

static struct rgb normal_color(struct legend *l, const float *v) {
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2])) {
        l->has_invalid = true;
        return COLOR_INVALID;
    }
    return (struct rgb){to_byte((double)v[0] * 0.5 + 0.5), to_byte((double)v[1] * 0.5 + 0.5),
                        to_byte((double)v[2] * 0.5 + 0.5)};
}

/* Indices are integers; in images of cube-map indices, 255 is "none". */
static struct rgb index_color(struct legend *l, double v, double share) {
    if (!(v >= 0 && v < 4294967296.0)) {
        l->has_invalid = true;
        return COLOR_INVALID;
    }
    uint32_t index = (uint32_t)v;
    l->shares[index < 256 ? index : 256] += share;
    return index == 255 ? COLOR_BACKGROUND : colormap_category(l->kind == KIND_REASON ? index : index + 1);
}

/* Marks texels with a non-finite channel; all others are grey, by value. */
static struct rgb invalid_color(struct legend *l, const struct source *s, size_t i) {
    for (uint32_t k = 0; k < s->components; k++)
        if (!isfinite(s->texels[i * s->components + k])) {
            l->has_invalid = true;
            return isnan(s->texels[i * s->components + k]) ? COLOR_INVALID : COLOR_INFINITE;
        }
    const uint8_t grey = to_byte(0.35 * position(l, drawn_value(s, i)));
    return (struct rgb){grey, grey, grey};
}

static struct rgb raw_color(struct legend *l, const struct source *s, const float *v) {
    uint8_t c[3];
    for (uint32_t k = 0; k < 3; k++) {
        double value = (double)v[s->components >= 3 ? k : 0];
        if (!isfinite(value)) {
            l->has_invalid = true;
            return COLOR_INVALID;
        }
        c[k] = to_byte(position(l, value));
    }
    return (struct rgb){c[0], c[1], c[2]};
}

static struct rgb texel_color(struct legend *l, const struct source *s, size_t i, double share) {
    const float *v = s->texels + i * s->components;
    switch (l->kind) {
    case KIND_NORMAL:
        return normal_color(l, v);
    case KIND_INDEX:
    case KIND_REASON:
        return index_color(l, (double)v[0], share);
    case KIND_INVALID:
        return invalid_color(l, s, i);
    case KIND_RAW:
        return raw_color(l, s, v);
    default:
        return distance_color(l, drawn_value(s, i));
    }
}

/* Reduces kinds with a fixed scale to the kind that draws them, and sets the scale. */
static enum kind plain_kind(enum kind kind, const struct source *s, struct falsecolor_options *options) {
    const bool free_range = !options->range_given;
    if (kind == KIND_DEPTH && options->scale == SCALE_AUTO) options->scale = SCALE_LOG;
    if (kind == KIND_WEIGHT && free_range) options->high = 1;
    for (size_t i = 0; kind == KIND_STEPS && free_range && i < (size_t)s->width * s->height; i++) {
        const double v = drawn_value(s, i);
        options->high = isfinite(v) ? fmax(options->high, v) : options->high;
    }
    options->range_given = options->range_given || kind == KIND_WEIGHT || kind == KIND_STEPS;
    return kind == KIND_DEPTH || kind == KIND_STEPS || kind == KIND_WEIGHT ? KIND_DISTANCE : kind;
}

bool falsecolor_prepare(struct legend *l, const struct source *s, enum kind kind,
                        const struct falsecolor_options *given, struct glint_error *err) {
    struct falsecolor_options of_kind = *given, *options = &of_kind;
    kind = plain_kind(kind, s, options);
    bool has_unit = *s->unit && strcmp(s->unit, "1") != 0 && kind == KIND_DISTANCE;
    *l = (struct legend){.kind = kind, .low = 0, .high = 1};
    snprintf(l->title, sizeof l->title, "%s%s%s%s", s->title, has_unit ? " (" : "", has_unit ? s->unit : "",
             has_unit ? ")" : "");
    if (kind == KIND_NORMAL && s->components < 3)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s has %u channel%s; normals need three", s->title, s->components,
                          s->components == 1 ? "" : "s");
    if (kind == KIND_RAW && options->range_given) {
        l->low = options->low;
        l->high = options->high;
    }
    return (kind != KIND_DISTANCE && kind != KIND_INVALID) || choose_scale(l, s, options, err);
}

bool falsecolor_draw(struct picture *picture, struct legend *legend, const struct source *source, enum kind kind,
                     const struct falsecolor_options *options, struct glint_error *err) {
    if (!falsecolor_prepare(legend, source, kind, options, err)) return false;
    if (!picture_init(picture, source->width, source->height, COLOR_BACKGROUND, err)) return false;
    size_t texels = (size_t)source->width * source->height;
    for (size_t i = 0; i < texels; i++)
        picture_set(picture, (uint32_t)(i % source->width), (uint32_t)(i / source->width),
                    texel_color(legend, source, i, 1.0 / (double)texels));
    return true;
}
