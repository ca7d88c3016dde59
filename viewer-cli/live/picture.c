/* Pictures of images, heat maps of differences and values of pixels: answers /api/v1/picture, difference and values. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/page/page.h"
#include "draw/view/png_file.h"
#include "draw/view/render.h"
#include "live/answers.h"
#include "live/rows.h"
#include "options/args.h"
#include "record.h"

/* ---- What a query asks for ---- */

static bool query_number(const struct http_request *request, const char *name, double *number, bool *given,
                         struct glint_error *err) {
    const char *text = http_query(request, name);
    char *end = NULL;
    *given = text && *text;
    if (!*given) return true;
    *number = strtod(text, &end);
    return (end != text && !*end && isfinite(*number)) ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a number, found \"%.40s\"", name, text);
}

static bool query_choice(const struct http_request *request, const char *name, const char *const *known, int *choice,
                         struct glint_error *err) {
    const char *text = http_query(request, name);
    *choice = 0;
    if (!text || !*text) return true;
    for (int i = 0; known[i]; i++)
        if (!strcmp(known[i], text)) return *choice = i, true;
    char *list = join_names("", known);
    glint_fail(err, GLINT_ERROR_USAGE, "%s: expected one of %s, found \"%.40s\"", name, list ? list : "a few", text);
    free(list);
    return false;
}

static const char *text_or_null(const char *text) {
    return text && *text ? text : NULL;
}

static bool read_options(const struct http_request *request, struct render_options *options, struct glint_error *err) {
    static const char *const scales[] = {"auto", "linear", "log", NULL};
    struct falsecolor_options *colors = &options->falsecolor;
    int kind = 0, scale = 0;
    bool low = false, high = false, exposure;
    *options = (struct render_options){.zoom = 1, .no_legend = true};
    options->ocio.display = text_or_null(http_query(request, "display"));
    options->ocio.view = text_or_null(http_query(request, "view"));
    if (!query_number(request, "exposure", &options->exposure_ev, &exposure, err) ||
        !query_number(request, "low", &colors->low, &low, err) ||
        !query_number(request, "high", &colors->high, &high, err) ||
        !query_choice(request, "kind", kind_names, &kind, err) || !query_choice(request, "scale", scales, &scale, err))
        return false;
    options->kind = (enum kind)kind;
    colors->scale = (enum scale)scale;
    colors->range_given = low && high;
    if (low != high) return glint_fail(err, GLINT_ERROR_USAGE, "low and high: expected both of them, or none");
    return !colors->range_given || colors->low < colors->high ||
           glint_fail(err, GLINT_ERROR_USAGE, "low and high: expected low < high, found %g and %g", colors->low,
                      colors->high);
}

/* ---- Drawing ---- */

/* A colour picture whose pixels depend on themselves alone. */
struct drawing {
    const struct source *source;
    const struct render_options *options;
    struct picture *picture;
    pthread_mutex_t lock; /* of what follows */
    size_t invalid;
    bool ok;
    struct glint_error err;
};

/* A few rows at a time: their floats stay in the cache, and their memory is used again. */
static void draw_rows(void *user, uint32_t first, uint32_t end) {
    enum { ROWS = 8 };
    struct drawing *d = user;
    struct glint_error err = {0};
    size_t invalid = 0;
    bool ok = true;
    for (uint32_t y = first; ok && y < end; y += ROWS) {
        struct picture part = {0};
        struct legend legend;
        struct source rows = *d->source;
        size_t found = 0;
        rows.height = end - y < ROWS ? end - y : ROWS;
        rows.texels += (size_t)y * rows.width * rows.components;
        ok = render_plain(&part, &legend, &rows, d->options, &found, &err);
        if (ok) picture_paste(d->picture, &part, 0, y);
        invalid += found;
        picture_finish(&part);
    }
    pthread_mutex_lock(&d->lock);
    d->invalid += invalid;
    if (!ok && d->ok) d->ok = false, d->err = err;
    pthread_mutex_unlock(&d->lock);
}

static bool draw_color(struct live *live, struct picture *picture, const struct source *source,
                       struct render_options *options, size_t *invalid, struct glint_error *err) {
    struct drawing drawing = {
        .source = source, .options = options, .picture = picture, .lock = PTHREAD_MUTEX_INITIALIZER, .ok = true};
    const bool converts = !source->display || options->ocio.display || options->ocio.view;
    if (converts && !(options->ocio.ready = live_conversion(live, &options->ocio, err))) return false;
    if (!picture_init(picture, source->width, source->height, COLOR_BACKGROUND, err)) return false;
    rows_share(source->height, draw_rows, &drawing);
    options->ocio.ready = NULL;
    *invalid = drawing.invalid;
    return drawing.ok || glint_fail(err, drawing.err.code, "%s", drawing.err.message);
}

/* As glint view draws it. */
static bool draw(struct live *live, struct picture *picture, struct legend *legend, const struct source *source,
                 struct render_options *options, size_t *invalid, struct glint_error *err) {
    *invalid = 0;
    if (render_kind(source, options) != KIND_COLOR || source->cube)
        return render_plain(picture, legend, source, options, invalid, err);
    *legend = legend_of_color(source);
    return draw_color(live, picture, source, options, invalid, err);
}

/* ---- Answers ---- */

static void answer_png(struct http_answer *answer, const struct picture *picture) {
    struct glint_error err = {0};
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (png_encode(picture, &bytes, &size, &err))
        *answer = (struct http_answer){.type = "image/png", .data = bytes, .size = size};
    else http_error(answer, &err);
}

static json_t *head_json(const struct picture *picture, const struct legend *legend, size_t invalid) {
    const bool ranged = legend_has_scale(legend);
    return json_pack("{s:I, s:I, s:o, s:o, s:I}", "width", (json_int_t)picture->width, "height",
                     (json_int_t)picture->height, "key", legend->kind == KIND_COLOR ? json_null() : page_key(legend),
                     "range", ranged ? json_pack("[f, f]", legend->low, legend->high) : json_null(), "invalid",
                     (json_int_t)invalid);
}

/* The length of the JSON, the JSON, and the pixels. */
static void answer_raw(struct http_answer *answer, const struct picture *picture, const struct legend *legend,
                       size_t invalid) {
    json_t *head = head_json(picture, legend, invalid);
    char *text = head ? record_text(head, JSON_COMPACT) : NULL;
    const size_t length = text ? strlen(text) : 0, padded = (length + 3) / 4 * 4;
    const size_t pixels = (size_t)picture->width * picture->height * 4;
    uint8_t *data = text ? malloc(4 + padded + pixels) : NULL;
    json_decref(head);
    if (data) {
        for (int k = 0; k < 4; k++) data[k] = (uint8_t)(padded >> (8 * k));
        memcpy(data + 4, text, length);
        memset(data + 4 + length, ' ', padded - length);
        memcpy(data + 4 + padded, picture->rgba, pixels);
        *answer = (struct http_answer){.type = "application/octet-stream", .data = data, .size = 4 + padded + pixels};
    } else http_refuse(answer, 500, "memory", "out of memory");
    free(text);
}

struct counting {
    const struct source *source;
    pthread_mutex_t lock;
    size_t invalid;
};

static void count_rows(void *user, uint32_t first, uint32_t end) {
    struct counting *c = user;
    const struct source *s = c->source;
    const uint32_t channels = s->components < 3 ? s->components : 3;
    size_t invalid = 0;
    for (size_t i = (size_t)first * s->width; i < (size_t)end * s->width; i++) {
        bool bad = false;
        for (uint32_t k = 0; k < channels; k++) bad |= !isfinite(s->texels[i * s->components + k]);
        invalid += bad;
    }
    pthread_mutex_lock(&c->lock);
    c->invalid += invalid;
    pthread_mutex_unlock(&c->lock);
}

/* Pixels of a colour image that are NaN or infinite. */
static size_t count_invalid(const struct source *source) {
    struct counting counting = {source, PTHREAD_MUTEX_INITIALIZER, 0};
    rows_share(source->height, count_rows, &counting);
    return counting.invalid;
}

/* `whole`: the image of which the source is every n-th texel, or the source itself; all of its texels are checked. */
static void answer_picture(struct live *live, const struct http_request *request, const struct source *source,
                           const struct source *whole, struct render_options *options, struct http_answer *answer) {
    struct picture picture = {0};
    struct legend legend = {0};
    struct glint_error err = {0};
    static const char *const formats[] = {"png", "raw", NULL};
    size_t invalid = 0;
    int format = 0;
    if (!query_choice(request, "format", formats, &format, &err) ||
        !draw(live, &picture, &legend, source, options, &invalid, &err))
        http_error(answer, &err);
    else if (format == 1 && whole != source) answer_raw(answer, &picture, &legend, count_invalid(whole));
    else if (format == 1) answer_raw(answer, &picture, &legend, invalid);
    else answer_png(answer, &picture);
    picture_finish(&picture);
}

/* Every n-th texel of the image in both directions: enough for a colour picture that is shown smaller. The ranges of false colours are
   those of all texels, so that these pictures stay whole. */
static bool take_every(const struct source *source, uint32_t every, struct source *few, struct glint_error *err) {
    const uint32_t n = source->components;
    *few = *source;
    few->width = (source->width + every - 1) / every;
    few->height = (source->height + every - 1) / every;
    few->texels = malloc(((size_t)few->width * few->height * n + 1) * sizeof(float));
    if (!few->texels) return fail_memory(err);
    for (uint32_t y = 0; y < few->height; y++)
        for (uint32_t x = 0; x < few->width; x++)
            memcpy(few->texels + ((size_t)y * few->width + x) * n,
                   source->texels + ((size_t)y * every * source->width + (size_t)x * every) * n, n * sizeof(float));
    return true;
}

static void answer_source(struct live *live, const struct http_request *request, const struct source *source,
                          struct render_options *options, struct http_answer *answer) {
    enum { MOST = 64 };
    double every = 1;
    bool given;
    struct glint_error err = {0};
    struct source few;
    if (!query_number(request, "every", &every, &given, &err)) http_error(answer, &err);
    else if (!(every >= 1 && every <= MOST && every == floor(every)))
        http_refuse(answer, 400, "usage", "every: expected a whole number from 1 to 64");
    else if (every == 1 || source->cube || render_kind(source, options) != KIND_COLOR)
        answer_picture(live, request, source, source, options, answer);
    else if (take_every(source, (uint32_t)every, &few, &err)) {
        answer_picture(live, request, &few, source, options, answer);
        source_finish(&few);
    } else http_error(answer, &err);
}

void live_answer_picture(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    struct render_options options;
    struct glint_error err = {0};
    struct held *held = NULL;
    if (read_options(request, &options, &err) &&
        (held = runs_take(live, http_query(request, "run"), http_query(request, "image"), &err)))
        answer_source(live, request, &held->source, &options, answer);
    else http_error(answer, &err);
    runs_release(live, held);
}

/* ---- Differences ---- */

/* The texel of the other image that covers the middle of this one's. */
static const float *texel_at(const struct source *s, uint32_t x, uint32_t y, const struct source *of) {
    const uint64_t column = (2 * (uint64_t)x + 1) * s->width / (2 * (uint64_t)of->width),
                   row = (2 * (uint64_t)y + 1) * s->height / (2 * (uint64_t)of->height);
    return s->texels + (row * s->width + column) * s->components;
}

/* |a - b|, 0 for equal values that are not finite. */
static float distance(float a, float b) {
    if (a == b || (isnan(a) && isnan(b))) return 0;
    return fabsf(a - b);
}

static bool make_difference(struct source *difference, const struct source *a, const struct source *b,
                            struct glint_error *err) {
    const struct source *coarse = a->width <= b->width ? a : b, *fine = coarse == a ? b : a;
    const uint32_t channels = coarse->components < fine->components ? coarse->components : fine->components;
    const uint32_t compared = channels > 3 ? 3 : channels;
    *difference = (struct source){.width = coarse->width, .height = coarse->height, .components = 1, .cube = a->cube};
    snprintf(difference->title, sizeof difference->title, "%.200s: difference", a->title);
    snprintf(difference->unit, sizeof difference->unit, "%s", a->unit);
    snprintf(difference->channels[0], sizeof difference->channels[0], "E");
    if (a->cube != b->cube || (a->cube && a->width != b->width))
        return glint_fail(err, GLINT_ERROR_USAGE, "%.100s and %.100s cannot be compared", a->title, b->title);
    if (!(difference->texels = malloc(((size_t)coarse->width * coarse->height + 1) * sizeof(float))))
        return fail_memory(err);
    for (uint32_t y = 0; y < coarse->height; y++)
        for (uint32_t x = 0; x < coarse->width; x++) {
            const float *p = texel_at(coarse, x, y, coarse), *q = texel_at(fine, x, y, coarse);
            float sum = 0;
            for (uint32_t k = 0; k < compared; k++) sum += distance(p[k], q[k]) / (float)compared;
            difference->texels[(size_t)y * coarse->width + x] = sum;
        }
    return true;
}

/* Logarithmic, from a thousandth of the largest difference. */
static void choose_range(const struct source *difference, struct render_options *options) {
    float largest = 0;
    for (size_t i = 0; i < (size_t)difference->width * difference->height; i++)
        if (isfinite(difference->texels[i])) largest = fmaxf(largest, difference->texels[i]);
    options->kind = KIND_AUTO;
    if (options->falsecolor.range_given) return;
    options->falsecolor.range_given = true;
    options->falsecolor.high = largest > 1e-6F ? (double)largest : 1e-6;
    options->falsecolor.low = options->falsecolor.high / 1000;
    if (options->falsecolor.scale == SCALE_AUTO) options->falsecolor.scale = SCALE_LOG;
}

void live_answer_difference(void *user, const struct http_request *request, struct http_answer *answer) {
    struct live *live = user;
    const char *image = http_query(request, "image"), *other = http_query(request, "other_image");
    struct render_options options;
    struct glint_error err = {0};
    struct held *a = NULL, *b = NULL;
    struct source difference = {0};
    if (read_options(request, &options, &err) && (a = runs_take(live, http_query(request, "run"), image, &err)) &&
        (b = runs_take(live, http_query(request, "other"), other ? other : image, &err)) &&
        make_difference(&difference, &a->source, &b->source, &err)) {
        choose_range(&difference, &options);
        answer_source(live, request, &difference, &options, answer);
    } else http_error(answer, &err);
    source_finish(&difference);
    runs_release(live, a);
    runs_release(live, b);
}

/* ---- Values ---- */

/* The texel under a pixel of a picture of w × h pixels; pictures of cube maps are crosses of six faces. False outside of the faces. */
static bool texel_of(const struct source *s, double u, double v, uint32_t *x, uint32_t *y) {
    static const int faces[3][4] = {{-1, -1, 2, -1}, {1, 4, 0, 5}, {-1, -1, 3, -1}};
    const uint32_t width = s->cube ? 4 * s->width : s->width, height = s->cube ? s->height / 2 : s->height;
    uint32_t column = (uint32_t)(u * width), row = (uint32_t)(v * height);
    if (column >= width || row >= height) return false;
    if (s->cube) {
        const uint32_t n = s->width;
        const int face = faces[row / n % 3][column / n];
        if (face < 0) return false;
        row = (row / (3 * n) * 6 + (uint32_t)face) * n + row % n;
        column %= n;
    }
    *x = column;
    *y = row;
    return row < s->height;
}

static json_t *values_json(const struct source *s, double u, double v) {
    uint32_t x, y;
    if (!texel_of(s, u, v, &x, &y)) return json_pack("{s:s}", "error", "the image has no texel here");
    json_t *channels = json_array(), *values = json_array(), *words = json_array();
    for (uint32_t k = 0; k < s->components; k++) {
        const double value = (double)s->texels[((size_t)y * s->width + x) * s->components + k];
        char name[64];
        json_array_append_new(channels, json_string(s->channels[k]));
        json_array_append_new(values, page_number(value));
        json_array_append_new(words, legend_value_name(kind_of(s), value, name) ? json_string(name) : json_null());
    }
    return json_pack("{s:I, s:I, s:o, s:s, s:o, s:o}", "x", (json_int_t)x, "y", (json_int_t)y, "channels", channels,
                     "unit", s->unit, "values", values, "words", words);
}

static json_t *values_of(struct live *live, const json_t *which, double u, double v) {
    struct glint_error err = {0};
    struct held *held = runs_take(live, json_string_value(json_object_get(which, "run")),
                                  json_string_value(json_object_get(which, "image")), &err);
    json_t *json = held ? values_json(&held->source, u, v) : json_pack("{s:o}", "error", http_text(err.message));
    runs_release(live, held);
    return json;
}

void live_answer_values(void *user, const struct http_request *request, struct http_answer *answer) {
    enum { MOST = 8, SIDE = 1 << 20 };
    struct live *live = user;
    struct glint_error err = {0};
    json_int_t x, y;
    const json_t *size = json_object_get(request->body, "size"), *of = json_object_get(request->body, "of");
    const json_int_t width = json_integer_value(json_array_get(size, 0)),
                     height = json_integer_value(json_array_get(size, 1));
    if (!answer_number(request, "x", 0, SIDE, -1, &x, &err) || !answer_number(request, "y", 0, SIDE, -1, &y, &err)) {
        http_error(answer, &err);
        return;
    }
    if (width < 1 || height < 1 || x >= width || y >= height || !json_is_array(of) || json_array_size(of) > MOST) {
        http_refuse(answer, 400, "usage",
                    "expected size: [width, height], x and y inside of it, and of: an array of at most 8 images");
        return;
    }
    json_t *list = json_array(), *which;
    size_t i;
    json_array_foreach(of, i, which) json_array_append_new(
        list, values_of(live, which, ((double)x + 0.5) / (double)width, ((double)y + 0.5) / (double)height));
    answer_json(answer, json_pack("{s:o}", "values", list));
}
