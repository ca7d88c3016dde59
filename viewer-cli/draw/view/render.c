/* Renders a source as a picture. */
#include "draw/view/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "io/memory.h"

/* RGBA with the exposure applied; a single channel becomes grey. */
static float *linear_rgba(const struct source *s, double exposure_ev) {
    size_t texels = (size_t)s->width * s->height;
    float *rgba = malloc(texels * 4 * sizeof *rgba), scale = (float)exp2(exposure_ev);
    for (size_t i = 0; rgba && i < texels; i++) {
        const float *v = s->texels + i * s->components;
        for (uint32_t k = 0; k < 3; k++) rgba[4 * i + k] = v[s->components >= 3 ? k : 0] * scale;
        rgba[4 * i + 3] = 1;
    }
    return rgba;
}

static bool invalid_color(const struct source *s, size_t i) {
    for (uint32_t k = 0; k < 3 && k < s->components; k++)
        if (!isfinite(s->texels[i * s->components + k])) return true;
    return false;
}

/* IEC 61966-2-1. */
static float srgb_of_linear(float v) {
    return v <= 0.0031308F ? 12.92F * v : 1.055F * powf(v, 1 / 2.4F) - 0.055F;
}

/* What was encoded for a display is shown as it was, without another tone curve, unless a transform is asked for by name. */
static bool to_display(const struct source *s, const struct render_options *options, float *rgba,
                       struct glint_error *err) {
    const struct ocio_options *ocio = &options->ocio;
    if (!s->display || ocio->input || ocio->display || ocio->view)
        return ocio_apply(ocio, rgba, s->width, s->height, err);
    for (size_t i = 0; i < (size_t)s->width * s->height; i++)
        for (size_t k = 0; k < 3; k++) rgba[4 * i + k] = srgb_of_linear(rgba[4 * i + k]);
    return true;
}

static uint8_t to_byte(float v) {
    return (uint8_t)((v > 0 ? v < 1 ? v : 1 : 0) * 255 + 0.5F);
}

static bool draw_color(struct picture *picture, const struct source *s, const struct render_options *options,
                       size_t *invalid, struct glint_error *err) {
    float *rgba = linear_rgba(s, options->exposure_ev);
    if (!rgba) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    bool ok = to_display(s, options, rgba, err) && picture_init(picture, s->width, s->height, COLOR_BACKGROUND, err);
    *invalid = 0;
    for (size_t i = 0; ok && i < (size_t)s->width * s->height; i++) {
        bool bad = invalid_color(s, i);
        *invalid += bad;
        struct rgb c = {to_byte(rgba[4 * i]), to_byte(rgba[4 * i + 1]), to_byte(rgba[4 * i + 2])};
        picture_set(picture, (uint32_t)(i % s->width), (uint32_t)(i / s->width), bad ? COLOR_INVALID : c);
    }
    free(rgba);
    return ok;
}

enum kind render_kind(const struct source *source, const struct render_options *options) {
    return options->kind == KIND_AUTO ? kind_of(source) : options->kind;
}

bool render_range(const struct source *source, const struct render_options *options, double range[2],
                  struct glint_error *err) {
    const enum kind kind = render_kind(source, options);
    struct legend legend = {.kind = kind};
    if (kind == KIND_COLOR) return true;
    if (!falsecolor_prepare(&legend, source, kind, &options->falsecolor, err)) return false;
    if (legend.kind != KIND_DISTANCE) return true;
    range[0] = fmin(range[0], legend.low);
    range[1] = fmax(range[1], legend.high);
    return true;
}

bool render_plain(struct picture *picture, struct legend *legend, const struct source *source,
                  const struct render_options *options, size_t *invalid, struct glint_error *err) {
    const enum kind kind = render_kind(source, options);
    *invalid = 0;
    bool ok = kind == KIND_COLOR ? draw_color(picture, source, options, invalid, err)
                                 : falsecolor_draw(picture, legend, source, kind, &options->falsecolor, err);
    if (kind == KIND_COLOR) *legend = legend_of_color(source);
    if (ok && source->cube && !options->faces)
        ok = options->latlong ? picture_latlong(picture, err) : picture_cross(picture, err);
    if (ok && options->has_crop) ok = picture_crop(picture, options->crop, err);
    return ok;
}

/* Applies zoom and legend if requested. */
static bool finish_picture(struct picture *picture, const struct legend *legend, const struct render_options *options,
                           struct glint_error *err) {
    return picture_zoom(picture, options->zoom, err) &&
           (legend->kind == KIND_COLOR || options->no_legend || legend_add(picture, legend, err));
}

bool render(struct picture *picture, const struct source *source, const struct render_options *options, size_t *invalid,
            struct glint_error *err) {
    struct legend legend;
    return render_plain(picture, &legend, source, options, invalid, err) &&
           finish_picture(picture, &legend, options, err);
}

enum { LEVELS_MAX = 16 };

/* Draws one of the coarser levels; false without an error if the image has no such level. */
static bool render_level(struct picture *picture, const struct source_choice *choice, const struct source *finest,
                         size_t number, const struct render_options *options, size_t *invalid,
                         struct glint_error *err) {
    char name[300];
    struct source_choice of_level = *choice;
    struct source source;
    struct legend unused;
    struct glint_error none = {0};
    size_t found = 0;
    snprintf(name, sizeof name, "%.280s.level%zu", finest->title, number);
    of_level.image = name;
    if (!source_open(&source, &of_level, &none)) {
        if (none.code == GLINT_ERROR_MEMORY) memory_note(); /* there may be such a level */
        return false;
    }
    const bool ok = render_plain(picture, &unused, &source, options, &found, err);
    *invalid += found;
    source_finish(&source);
    return ok;
}

bool render_levels(struct picture *picture, const struct source *finest, const struct source_choice *choice,
                   const struct render_options *options, size_t *invalid, struct glint_error *err) {
    struct picture levels[LEVELS_MAX] = {{0}};
    struct render_options same = *options;
    struct legend legend;
    size_t count = 1;
    bool ok = render_plain(&levels[0], &legend, finest, options, invalid, err);
    same.falsecolor.range_given = legend.low < legend.high;
    same.falsecolor.low = legend.low;
    same.falsecolor.high = legend.high;
    while (ok && count < LEVELS_MAX && render_level(&levels[count], choice, finest, count, &same, invalid, err))
        count++;
    ok = ok && err->code == GLINT_OK;
    if (ok && count == 1)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: image %s has one level", choice->path, finest->title);
    ok = ok && picture_chain(picture, levels, count, err) && finish_picture(picture, &legend, options, err);
    for (size_t i = 0; i < LEVELS_MAX; i++) picture_finish(&levels[i]);
    return ok;
}
