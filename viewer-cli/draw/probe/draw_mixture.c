/* Draws what a pass averages or blends: texels and sample positions on the picture, and the weight of each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/probe/panels.h"
#include "io/table.h"

enum { PICTURE = 300, GAP = 24, ROW = 17, MOST_ROWS = 10, MOST_PARTS = 128, BAR = 150, TITLE = 40, LAYERS = 4 };

/* A texel or a sample position. */
struct part {
    const struct glint_probe_record *record;
    double x, y, size; /* top left corner in full-resolution pixels; size 0: a position between texels */
    double share;
};
struct mixture {
    struct part parts[MOST_PARTS];
    size_t count;
};

static const char *image_of(const struct glint_probe_record *record) {
    const struct glint_probe_label word = glint_probe_label("image", (float)draw_value(record, "image"));
    return word.name ? word.name : "";
}

/* Texels of coarser levels are drawn as large as the pixels that they cover. */
static struct part part_of(const struct probe *probe, const struct glint_probe_record *record) {
    struct part part = {.record = record};
    if (glint_probe_is(record, "sample")) {
        part.x = draw_value(record, "x"), part.y = draw_value(record, "y");
        return part;
    }
    const double level = strcmp(image_of(record), "reflection_across") == 0 ? 2 : draw_value(record, "level");
    part.size = exp2(isnan(level) ? 0 : level) * (probe->full[0] > probe->half[0] ? 2 : 1);
    part.x = draw_value(record, "texel_x") * part.size, part.y = draw_value(record, "texel_y") * part.size;
    return part;
}

static int compare_shares(const void *a, const void *b) {
    const double x = ((const struct part *)a)->share, y = ((const struct part *)b)->share;
    return (x < y) - (x > y);
}

/* Collects consecutive records with a weight, starting from *at, the largest weight first. */
static void gather_weights(const struct probe *probe, const struct ray_records *records, size_t *at,
                           struct mixture *mixture) {
    double total = 0;
    mixture->count = 0;
    while (*at < records->count && isnan(draw_value(&records->records[*at], "weight"))) ++*at;
    for (; *at < records->count && mixture->count < MOST_PARTS; ++*at) {
        struct part part = part_of(probe, &records->records[*at]);
        const double fraction = draw_value(part.record, "part"), weight = draw_value(part.record, "weight");
        if (isnan(weight)) break;
        part.share = weight * (isnan(fraction) ? 1 : fraction);
        total += part.share;
        mixture->parts[mixture->count++] = part;
    }
    for (size_t i = 0; i < mixture->count; i++) mixture->parts[i].share /= total > 0 ? total : 1;
    qsort(mixture->parts, mixture->count, sizeof mixture->parts[0], compare_shares);
}

/* ---- On the picture ---- */

static void extend_bounds(double low[2], double high[2], double x, double y, double size) {
    low[0] = fmin(low[0], x), low[1] = fmin(low[1], y);
    high[0] = fmax(high[0], x + size), high[1] = fmax(high[1], y + size);
}

static void draw_places(struct drawing *d, const struct mixture *mixture, double left, double height) {
    const uint32_t *full = d->probe->full, *pixel = d->probe->pixel;
    double low[2] = {pixel[0], pixel[1]}, high[2] = {pixel[0] + 1.0, pixel[1] + 1.0};
    for (size_t i = 0; i < mixture->count; i++)
        extend_bounds(low, high, mixture->parts[i].x, mixture->parts[i].y, mixture->parts[i].size);
    const double wide = fmax(fmax((high[0] - low[0]) * 1.3, (high[1] - low[1]) * 1.3 * full[0] / full[1]), 12);
    const double tall = wide * full[1] / full[0], scale = wide / PICTURE;
    const double x = (low[0] + high[0] - wide) / 2, y = (low[1] + high[1] - tall) / 2;
    fprintf(d->out,
            "<svg x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%.1f\" viewBox=\"%.2f %.2f %.2f %.2f\">"
            "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#888\"/><use href=\"#picture\"/>",
            left, d->top, PICTURE, height, x, y, wide, tall, x, y, wide, tall);
    for (size_t i = mixture->count; i-- > 0;) {
        const struct part *p = &mixture->parts[i];
        const double opacity = 0.25 + 0.75 * sqrt(p->share);
        if (p->size > 0)
            fprintf(d->out,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" stroke=\"#ffd23f\" "
                    "stroke-width=\"%.3f\" opacity=\"%.2f\"/>",
                    p->x, p->y, p->size, p->size, (1 + 2.5 * sqrt(p->share)) * scale, opacity);
        else
            fprintf(d->out,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.3f\" fill=\"#ffd23f\" stroke=\"#222\" stroke-width=\"%.3f\" "
                    "opacity=\"%.2f\"/>",
                    p->x, p->y, (3 + 6 * sqrt(p->share)) * scale, scale, opacity);
    }
    fprintf(d->out,
            "<rect x=\"%u\" y=\"%u\" width=\"1\" height=\"1\" fill=\"none\" stroke=\"#fff\" stroke-width=\"%.3f\"/>"
            "</svg>\n",
            pixel[0], pixel[1], 1.5 * scale);
}

/* ---- As bars ---- */

/* Tone maps radiance and encodes it as sRGB. */
static int tone_map(double radiance) {
    const double v = radiance > 0 ? radiance / (1 + radiance) : 0;
    return (int)(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055) + 0.5);
}

static void draw_bar(struct drawing *d, double left, double y, const double rgb[3], double share, const char *text) {
    fprintf(d->out,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"12\" fill=\"#%02x%02x%02x\" class=\"swatch\"/>"
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"12\" class=\"bar\"/>"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\" class=\"tick\">%s %%</text>"
            "<text x=\"%.1f\" y=\"%.1f\" class=\"tick\">",
            left, y, tone_map(rgb[0]), tone_map(rgb[1]), tone_map(rgb[2]), left + 72, y, fmax(share * BAR, 0.5),
            left + 64, y + 10, number_text(round(1000 * share) / 10), left + 72 + BAR + 10, y + 10);
    svg_text(d->out, text);
    fputs("</text>\n", d->out);
}

static void draw_part(struct drawing *d, const struct part *part, double left, double y) {
    const struct glint_probe_record *r = part->record;
    const double rgb[] = {draw_value(r, "r"), draw_value(r, "g"), draw_value(r, "b")};
    const bool place = glint_probe_is(r, "sample");
    char text[160], level[32] = "";
    if (draw_value(r, "level") >= 0) snprintf(level, sizeof level, " level %.0f", draw_value(r, "level"));
    snprintf(text, sizeof text, place ? "%s%s at %.1f,%.1f: %s %s %s" : "%s%s%.0f,%.0f: %s %s %s",
             isnan(draw_value(r, "image")) ? "texel " : image_of(r),
             place      ? ""
             : level[0] ? strcat(level, ", ")
                        : level,
             draw_value(r, place ? "x" : "texel_x"), draw_value(r, place ? "y" : "texel_y"), number_text(rgb[0]),
             number_text(rgb[1]), number_text(rgb[2]));
    draw_bar(d, left, y, rgb, part->share, text);
}

static void draw_heading(struct drawing *d, const struct ray_records *records, const char *what) {
    fprintf(d->out, "<text x=\"24\" y=\"%.1f\" class=\"title\">%s/%s: %s</text>\n", d->top - 10,
            records->records->pass->slot, records->records->pass->variant, what);
}

/* The record after the weights names the texel that they were combined into. */
static void title_of(const struct ray_records *records, size_t next, char *text, size_t size) {
    const struct glint_probe_record *made = next < records->count ? &records->records[next] : NULL;
    if (made && glint_probe_is(made, "result"))
        snprintf(text, size, "%s level %.0f, texel %.0f,%.0f combines", image_of(made), draw_value(made, "level"),
                 draw_value(made, "texel_x"), draw_value(made, "texel_y"));
    else snprintf(text, size, "combines");
}

static void draw_weights(struct drawing *d, const struct ray_records *records, size_t next,
                         const struct mixture *mixture) {
    const bool elsewhere =
        strcmp(image_of(mixture->parts[0].record), "planar_color") == 0; /* an image that is not in screen space */
    const double height = elsewhere ? 0 : PICTURE * (double)d->probe->full[1] / d->probe->full[0];
    const double left = elsewhere ? 24 : 24 + PICTURE + GAP;
    const size_t rows = mixture->count < MOST_ROWS ? mixture->count : MOST_ROWS;
    char text[160];
    title_of(records, next, text, sizeof text);
    draw_heading(d, records, text);
    if (!elsewhere) draw_places(d, mixture, 24, height);
    for (size_t i = 0; i < rows; i++) draw_part(d, &mixture->parts[i], left, d->top + (double)i * ROW);
    if (rows < mixture->count)
        fprintf(d->out, "<text x=\"%.1f\" y=\"%.1f\" class=\"tick\">and %zu more</text>\n", left,
                d->top + (double)rows * ROW + 12, mixture->count - rows);
    d->top += fmax(height, (double)(rows + 1) * ROW) + TITLE;
}

static void draw_layer(struct drawing *d, const struct ray_records *records, const struct glint_probe_record *layer) {
    static const char *const names[][3] = {{"r", "g", "b"}, {"lower_r", "lower_g", "lower_b"}};
    const struct glint_probe_label lower = glint_probe_label("image", (float)draw_value(layer, "lower"));
    const double share =
        (draw_value(layer, "alpha_r") + draw_value(layer, "alpha_g") + draw_value(layer, "alpha_b")) / 3;
    draw_heading(d, records, "blends one layer over another");
    for (int k = 0; k < 2; k++) {
        double rgb[3];
        char text[128];
        for (int c = 0; c < 3; c++) rgb[c] = draw_value(layer, names[k][c]);
        snprintf(text, sizeof text, "%s: %s, %s %s %s", k ? "lower layer" : "upper layer",
                 k ? lower.name ? lower.name : "" : image_of(layer), number_text(rgb[0]), number_text(rgb[1]),
                 number_text(rgb[2]));
        draw_bar(d, 24, d->top + k * ROW, rgb, k ? 1 - share : share, text);
    }
    d->top += 2 * ROW + TITLE;
}

void draw_mixtures(struct drawing *d, const struct ray_records *records) {
    struct mixture mixture;
    for (size_t at = 0, next; at < records->count; at = next) {
        next = at;
        gather_weights(d->probe, records, &next, &mixture);
        for (; at < next; at++)
            if (glint_probe_is(&records->records[at], "layer")) draw_layer(d, records, &records->records[at]);
        const bool place = mixture.count && mixture.parts[0].size == 0; /* one sample between texels is drawn, too */
        if ((mixture.count > 1 || place) && d->uri) draw_weights(d, records, next, &mixture);
    }
}
