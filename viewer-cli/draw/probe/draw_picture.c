/* Draws the ray on the pipeline's final image, as a whole and enlarged around its steps. */
#include <math.h>
#include <stdio.h>

#include "draw/page/page.h"
#include "draw/probe/panels.h"
#include "draw/view/pixels.h"
#include "draw/view/render.h"

enum { GAP = 16, TITLE = 40, MAX_WIDTH = 1600, MAX_BYTES = 600000 };

json_t *draw_encode_picture(const struct probe *probe, struct glint_error *err) {
    const struct probe_image *image = &probe->own.picture;
    const struct glint_pixels pixels = {image->width, image->height, image->components, image->texels};
    const struct source source = pixels_source(&pixels, "composed");
    const struct render_options options = {.kind = KIND_COLOR};
    struct picture picture = {0};
    struct legend legend;
    size_t invalid;
    json_t *text = NULL;
    if (render_plain(&picture, &legend, &source, &options, &invalid, err) &&
        picture_shrink(&picture, 1 + image->width / MAX_WIDTH, true, err))
        text = page_picture(&picture, MAX_BYTES, err);
    picture_finish(&picture);
    return text;
}

void draw_define(struct drawing *d) {
    if (d->uri)
        fprintf(d->out,
                "<defs><image id=\"picture\" width=\"%u\" height=\"%u\" preserveAspectRatio=\"none\" "
                "style=\"image-rendering:pixelated\" href=\"%s\"/></defs>\n",
                d->probe->full[0], d->probe->full[1], json_string_value(d->uri));
}

/* The enlarged part of the image: all steps with a margin, in the aspect ratio of the image. */
struct window {
    double x, y, width, height;
};
static struct window window_of(const struct ray_records *records, const uint32_t full[2]) {
    const struct glint_probe_record *ray = ray_records_last(records, "screen_ray");
    double low[2] = {draw_value(ray, "start_x"), draw_value(ray, "start_y")}, high[2] = {low[0], low[1]};
    for (size_t i = 0; i < records->count; i++)
        for (int k = 0; k < 2 && draw_is_screen_step(&records->records[i]); k++) {
            const double at = draw_value(&records->records[i], k ? "y" : "x");
            low[k] = fmin(low[k], at), high[k] = fmax(high[k], at);
        }
    const double part = fmin(fmax(fmax((high[0] - low[0]) / full[0], (high[1] - low[1]) / full[1]) * 1.2, 0.1), 1);
    struct window w = {.width = part * full[0], .height = part * full[1]};
    w.x = fmin(fmax((low[0] + high[0] - w.width) / 2, 0), full[0] - w.width);
    w.y = fmin(fmax((low[1] + high[1] - w.height) / 2, 0), full[1] - w.height);
    return w;
}

/* Draws the window at x, `width` wide, with the steps of the ray. `scale` is the number of image pixels per unit of the drawing. */
static void draw_window(const struct drawing *d, const struct ray_records *records, double x, double width,
                        const struct window *w) {
    const double height = width * w->height / w->width, scale = w->width / width;
    fprintf(d->out,
            "<svg x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" viewBox=\"%.2f %.2f %.2f %.2f\">"
            "<use href=\"#picture\"/><path d=\"",
            x, d->top - TITLE, width, height, w->x, w->y, w->width, w->height);
    const struct glint_probe_record *ray = ray_records_last(records, "screen_ray");
    fprintf(d->out, "M%.2f %.2f", draw_value(ray, "start_x"), draw_value(ray, "start_y"));
    for (size_t i = 0; i < records->count; i++)
        if (draw_is_screen_step(&records->records[i]))
            fprintf(d->out, "L%.2f %.2f", draw_value(&records->records[i], "x"), draw_value(&records->records[i], "y"));
    fprintf(d->out, "\" fill=\"none\" stroke=\"#fff\" stroke-width=\"%.3f\" opacity=\"0.8\"/>", 1.5 * scale);
    for (size_t i = 0; i < records->count; i++)
        if (draw_is_screen_step(&records->records[i]))
            fprintf(d->out,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.3f\" fill=\"%s\" stroke=\"#fff\" stroke-width=\"%.3f\"/>",
                    draw_value(&records->records[i], "x"), draw_value(&records->records[i], "y"), 3.5 * scale,
                    draw_decision_color(&records->records[i]), 0.8 * scale);
    fprintf(d->out,
            "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" stroke=\"#fff\" "
            "stroke-width=\"%.3f\"/></svg>\n",
            draw_value(ray, "start_x") - 4 * scale, draw_value(ray, "start_y") - 4 * scale, 8 * scale, 8 * scale,
            2 * scale);
}

void draw_picture(struct drawing *d, const struct ray_records *records, double left, double width) {
    const uint32_t *full = d->probe->full;
    const struct glint_probe_record *ray = ray_records_last(records, "screen_ray");
    if (!d->uri || !ray) return;
    const struct window whole = {0, 0, full[0], full[1]}, near = window_of(records, full);
    const double each = (width - GAP) / 2, height = each * full[1] / full[0], scale = each / full[0];
    draw_window(d, records, left, each, &whole);
    draw_window(d, records, left + each + GAP, each, &near);
    fprintf(
        d->out,
        "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#fff\" opacity=\"0.7\"/>\n",
        left + near.x * scale, d->top - TITLE + near.y * scale, near.width * scale, near.height * scale);
    d->top += height + 20;
}
