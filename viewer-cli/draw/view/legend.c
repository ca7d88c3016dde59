/* The legend below a false-colour picture. */
#include "draw/view/falsecolor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "draw/view/colormap.h"
#include "draw/view/text.h"

enum { FONT_PX = 13, LINE_PX = 20, MARGIN_PX = 10, LEAST_WIDTH_PX = 360 };

static const char *const reasons[] = {
#define REASON(name, text) #name,
#include "shared/end_reasons.h"
#undef REASON
};

void legend_label(struct legend *legend, const char *label) {
    char title[sizeof legend->title];
    const size_t length = strcspn(label, "/");
    snprintf(title, sizeof title, "%.*s: %.250s", (int)(length < 140 ? length : 140), label, legend->title);
    memcpy(legend->title, title, sizeof title);
}

bool legend_value_name(enum kind kind, double value, char name[64]) {
    const bool reason = kind == KIND_REASON && value >= 0 && value < (double)(sizeof reasons / sizeof *reasons);
    const bool none = kind == KIND_INDEX && value == 255;
    if (!reason && !none) return false;
    snprintf(name, 64, "%s", reason ? reasons[(size_t)value] : "none");
    for (char *p = name; (p = strchr(p, '_')) != NULL;) *p = ' '; /* "left screen", short enough for narrow pictures */
    return true;
}

/* ---- Items ---- */

static void add_item(struct legend_items *items, struct rgb color, double share, const char *text) {
    struct legend_item *item = &items->of[items->count++];
    *item = (struct legend_item){.color = color, .share = share};
    snprintf(item->text, sizeof item->text, "%s", text);
}

static void add_shares(struct legend_items *items, const struct legend *l) {
    for (uint32_t i = 0; i < 257; i++) {
        char name[64];
        if (l->shares[i] <= 0) continue;
        if (!legend_value_name(l->kind, i, name)) snprintf(name, sizeof name, i == 256 ? "others" : "%u", i);
        const uint32_t category = l->kind == KIND_REASON ? i : i + 1;
        add_item(items, l->kind == KIND_INDEX && i == 255 ? COLOR_BACKGROUND : colormap_category(category),
                 l->shares[i], name);
    }
}

void legend_list(const struct legend *l, struct legend_items *items) {
    items->count = 0;
    if (l->kind == KIND_INDEX || l->kind == KIND_REASON) add_shares(items, l);
    if (l->kind == KIND_NORMAL) {
        add_item(items, (struct rgb){255, 128, 128}, -1, "+X");
        add_item(items, (struct rgb){128, 255, 128}, -1, "+Y");
        add_item(items, (struct rgb){128, 128, 255}, -1, "+Z");
    }
    if (l->has_zero) add_item(items, colormap_category(0), -1, "0 or less");
    if (l->has_none) add_item(items, COLOR_NONE, -1, "not compared");
    if (l->has_infinite) add_item(items, COLOR_SKY, -1, "infinite (sky)");
    if (l->kind == KIND_INVALID) {
        add_item(items, COLOR_INVALID, -1, "NaN");
        add_item(items, COLOR_INFINITE, -1, "infinite");
    } else if (l->has_invalid) add_item(items, COLOR_INVALID, -1, l->kind == KIND_DISTANCE ? "NaN" : "NaN or infinite");
}

bool legend_has_scale(const struct legend *l) {
    return l->kind == KIND_DISTANCE || l->kind == KIND_RAW;
}

/* ---- Drawing ---- */

/* The position of the next item; items wrap at the width of the picture. */
struct flow {
    struct text *text;
    struct picture *picture; /* NULL: measure only */
    int x, y, width;
};

static void draw_legend_item(struct flow *flow, struct rgb color, const char *label) {
    int width = 18 + text_measure(flow->text, label) + 16;
    if (flow->x > MARGIN_PX && flow->x + width > flow->width) {
        flow->x = MARGIN_PX;
        flow->y += LINE_PX;
    }
    if (flow->picture) {
        picture_fill(flow->picture, flow->x, flow->y + 4, 12, 12, (struct rgb){0x60, 0x64, 0x6c});
        picture_fill(flow->picture, flow->x + 1, flow->y + 5, 10, 10, color);
        text_draw(flow->text, flow->picture, flow->x + 18, flow->y + 15, label, COLOR_TEXT);
    }
    flow->x += width;
}

static void title(struct flow *flow, const char *string) {
    if (flow->picture) text_draw(flow->text, flow->picture, MARGIN_PX, flow->y + 15, string, COLOR_TEXT);
    flow->y += LINE_PX;
    flow->x = MARGIN_PX;
}

/* Formats the value at a position of the bar with enough digits to tell neighbouring ticks apart. */
static void tick_label(const struct legend *l, double t, char label[32]) {
    double v = l->logarithmic ? l->low * pow(l->high / l->low, t) : l->low + (l->high - l->low) * t;
    snprintf(label, 32, "%.3g", fabs(v) < 1e-12 * fmax(fabs(l->low), fabs(l->high)) ? 0 : v);
}

/* The largest number of ticks whose labels do not overlap. The outermost labels are moved inwards by half their width. */
static int intervals_that_fit(const struct flow *flow, const struct legend *l, int width) {
    int intervals = 4, widest = 0;
    for (int i = 0; i <= intervals; i++) {
        char label[32];
        tick_label(l, (double)i / intervals, label);
        const int own = text_measure(flow->text, label);
        widest = own > widest ? own : widest;
    }
    while (intervals > 1 && (3 * widest / 2 + FONT_PX / 2) * intervals > width) intervals /= 2;
    return intervals;
}

static void bar(struct flow *flow, const struct legend *l) {
    int width = flow->width - 2 * MARGIN_PX;
    const int intervals = flow->picture ? intervals_that_fit(flow, l, width) : 0;
    for (int x = 0; flow->picture && x < width; x++) {
        double t = (double)x / (width - 1);
        uint8_t grey = (uint8_t)(t * 255 + 0.5);
        picture_fill(flow->picture, MARGIN_PX + x, flow->y, 1, 12,
                     l->kind == KIND_RAW ? (struct rgb){grey, grey, grey} : colormap_viridis(t));
    }
    flow->y += 12;
    for (int i = 0; flow->picture && i <= intervals; i++) {
        char label[32];
        int x = MARGIN_PX + (width - 1) * i / intervals;
        tick_label(l, (double)i / intervals, label);
        int half = text_measure(flow->text, label) / 2;
        int left = x - half < MARGIN_PX ? MARGIN_PX : x - half;
        if (x + half > flow->width - MARGIN_PX) left = flow->width - MARGIN_PX - 2 * half;
        picture_fill(flow->picture, x, flow->y, 1, 4, COLOR_TEXT);
        text_draw(flow->text, flow->picture, left, flow->y + 17, label, COLOR_TEXT);
    }
    flow->y += LINE_PX + 2;
}

/* Draws the legend, or measures it if flow->picture is NULL. flow->y ends below the last line. */
static void lay_out_legend(struct flow *flow, const struct legend *l) {
    struct legend_items items;
    legend_list(l, &items);
    title(flow, l->title);
    if (legend_has_scale(l)) bar(flow, l);
    for (size_t i = 0; i < items.count; i++) {
        const struct legend_item *item = &items.of[i];
        char label[96];
        if (item->share < 0) snprintf(label, sizeof label, "%s", item->text);
        else snprintf(label, sizeof label, "%s  %.1f %%", item->text, item->share * 100);
        draw_legend_item(flow, item->color, label);
    }
    if (flow->x > MARGIN_PX) flow->y += LINE_PX;
    flow->y += MARGIN_PX / 2;
}

struct legend legend_of_color(const struct source *source) {
    struct legend legend = {.kind = KIND_COLOR};
    snprintf(legend.title, sizeof legend.title, "%s", source->title);
    return legend;
}

bool legend_add(struct picture *picture, const struct legend *legend, struct glint_error *err) {
    struct picture canvas;
    uint32_t width = picture->width < LEAST_WIDTH_PX ? LEAST_WIDTH_PX : picture->width;
    struct flow flow = {.x = MARGIN_PX, .width = (int)width};
    flow.text = text_create(FONT_PX, err);
    if (!flow.text) return false;
    int top = (int)picture->height + MARGIN_PX / 2;
    flow.y = top;
    lay_out_legend(&flow, legend);
    bool ok = picture_init(&canvas, width, (uint32_t)flow.y, COLOR_BACKGROUND, err);
    if (ok) {
        picture_paste(&canvas, picture, 0, 0);
        flow = (struct flow){flow.text, &canvas, MARGIN_PX, top, (int)width};
        lay_out_legend(&flow, legend);
        picture_finish(picture);
        *picture = canvas;
    }
    text_destroy(&flow.text);
    return ok;
}
