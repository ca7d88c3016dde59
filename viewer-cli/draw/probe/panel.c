#include "draw/probe/panel.h"

#include <math.h>

#include "io/table.h"

static double axis_position(const struct panel_axis *axis, double value) {
    if (axis->scale == PANEL_LOG) return log(fmax(value, 1e-30) / axis->low) / log(axis->high / axis->low);
    if (axis->scale == PANEL_INVERSE) return (1 / axis->low - 1 / value) / (1 / axis->low - 1 / axis->high);
    return (value - axis->low) / (axis->high - axis->low);
}

/* Coordinates far outside of a panel are clamped, as SVG viewers do not render very large numbers. */
static double clamp_position(double part) {
    return fmin(fmax(part, -2), 3);
}

double panel_x(const struct panel *panel, double value) {
    return panel->left + panel->width * clamp_position(axis_position(&panel->x, value));
}
double panel_y(const struct panel *panel, double value) {
    return panel->top + panel->height * (1 - clamp_position(axis_position(&panel->y, value)));
}
bool panel_shows(const struct panel *panel, double x) {
    const double part = axis_position(&panel->x, x);
    return part >= -1e-9 && part <= 1 + 1e-9;
}

void svg_text(FILE *out, const char *text) {
    for (text = name_text(text); *text; text++) {
        if (*text == '&') fputs("&amp;", out);
        else if (*text == '<') fputs("&lt;", out);
        else if (*text == '>') fputs("&gt;", out);
        else if (*text == '"') fputs("&quot;", out);
        else if (*text == '\'') fputs("&#39;", out);
        else fputc(*text, out);
    }
}

static void draw_label(const struct panel *p, double x, double y, const char *anchor, const char *style,
                       const char *text) {
    fprintf(p->out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor, style);
    svg_text(p->out, text);
    fputs("</text>\n", p->out);
}

static void draw_tick(const struct panel *p, bool is_x, double value) {
    const double at = is_x ? panel_x(p, value) : panel_y(p, value), right = p->left + p->width,
                 bottom = p->top + p->height;
    if (is_x) fprintf(p->out, "<path d=\"M%.1f %.1fV%.1f\" class=\"grid\"/>", at, p->top, bottom);
    else fprintf(p->out, "<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>", p->left, at, right);
    draw_label(p, is_x ? at : p->left - 7, is_x ? bottom + 16 : at + 4, is_x ? "middle" : "end", "class=\"tick\"",
               isinf(value) ? "sky" : number_text(value));
}

static double rounded_step(double span, int most) {
    const double raw = span / most, unit = pow(10, floor(log10(raw)));
    return raw / unit <= 1 ? unit : raw / unit <= 2 ? 2 * unit : raw / unit <= 5 ? 5 * unit : 10 * unit;
}

/* Ticks are at 1, 2 and 5 times powers of ten, except where labels would overlap. */
static void ticks_by_decades(const struct panel *p, bool is_x, const struct panel_axis *axis, double apart_px) {
    const double high = isinf(axis->high) ? axis->low * 1e6 : axis->high;
    double last = -1e9;
    for (double decade = pow(10, floor(log10(axis->low))); decade <= high; decade *= 10)
        for (int i = 0; i < 3; i++) {
            const double value = decade * (i == 0 ? 1 : i == 1 ? 2 : 5);
            const double at = is_x ? panel_x(p, value) : -panel_y(p, value);
            if (value < axis->low || value > high || at - last < apart_px) continue;
            if (isinf(axis->high) && -panel_y(p, INFINITY) - at < apart_px) continue;
            draw_tick(p, is_x, value);
            last = at;
        }
    if (isinf(axis->high)) draw_tick(p, is_x, INFINITY);
}

static void ticks(const struct panel *p, bool is_x) {
    const struct panel_axis *axis = is_x ? &p->x : &p->y;
    const bool narrow = !isinf(axis->high) && axis->high < 4 * axis->low;
    if (axis->scale != PANEL_LINEAR && !narrow) {
        ticks_by_decades(p, is_x, axis, is_x ? 44 : 22);
        return;
    }
    const double step = rounded_step(axis->high - axis->low, is_x ? 12 : 6);
    for (double value = ceil(axis->low / step) * step; value <= axis->high * (1 + 1e-9); value += step)
        draw_tick(p, is_x, fabs(value) < 1e-9 * step ? 0 : value);
}

void panel_begin(const struct panel *p, const char *title, const char *subtitle) {
    const double bottom = p->top + p->height;
    draw_label(p, p->left - 52, p->top - 30, "start", "class=\"title\"", title);
    draw_label(p, p->left - 52, p->top - 12, "start", "class=\"tick\"", subtitle);
    fprintf(p->out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"area\"/>\n", p->left, p->top,
            p->width, p->height);
    ticks(p, true);
    ticks(p, false);
    draw_label(p, p->left + p->width / 2, bottom + 36, "middle", "class=\"axis\"", p->x.name);
    fprintf(p->out, "<g transform=\"translate(%.1f %.1f) rotate(-90)\"><text text-anchor=\"middle\" class=\"axis\">",
            p->left - 46, p->top + p->height / 2);
    svg_text(p->out, p->y.name);
    fprintf(p->out,
            "</text></g>\n<svg x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" viewBox=\"%.1f %.1f %.1f %.1f\">\n",
            p->left, p->top, p->width, p->height, p->left, p->top, p->width, p->height);
}

void panel_end(const struct panel *p) {
    fputs("</svg>\n", p->out);
}

void panel_line(const struct panel *p, const double (*points)[2], size_t count, const char *style) {
    bool open = false;
    fputs("<path d=\"", p->out);
    for (size_t i = 0; i < count; i++) {
        const bool known = !isnan(points[i][0]) && !isnan(points[i][1]);
        if (known) fprintf(p->out, "%c%.1f %.1f", open ? 'L' : 'M', panel_x(p, points[i][0]), panel_y(p, points[i][1]));
        open = known;
    }
    fprintf(p->out, "\" %s/>\n", style);
}

void panel_solid(const struct panel *p, const double (*points)[2], size_t count, const char *style) {
    if (count == 0) return;
    fprintf(p->out, "<path d=\"M%.1f %.1f", panel_x(p, points[0][0]), p->top);
    for (size_t i = 0; i < count; i++)
        fprintf(p->out, "L%.1f %.1f", panel_x(p, points[i][0]),
                isnan(points[i][1]) ? p->top : panel_y(p, points[i][1]));
    fprintf(p->out, "L%.1f %.1fZ\" %s/>\n", panel_x(p, points[count - 1][0]), p->top, style);
}

void panel_mark(const struct panel *p, double x, double y, double radius, const char *style, const char *hint) {
    if (!isfinite(x) || isnan(y)) return;
    fprintf(p->out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" %s><title>", panel_x(p, x), panel_y(p, y), radius,
            style);
    svg_text(p->out, hint);
    fputs("</title></circle>\n", p->out);
}

void panel_across(const struct panel *p, double x, int row, const char *text, const char *color) {
    if (!panel_shows(p, x)) return;
    const double at = panel_x(p, x);
    const bool right = at > p->left + 0.6 * p->width;
    char style[96];
    fprintf(p->out,
            "<path d=\"M%.1f %.1fV%.1f\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"/>\n",
            at, p->top, p->top + p->height, color);
    snprintf(style, sizeof style, "class=\"tick\" style=\"fill:%s\"", color);
    draw_label(p, right ? at - 5 : at + 5, p->top + 14 + 15 * row, right ? "end" : "start", style, text);
}
