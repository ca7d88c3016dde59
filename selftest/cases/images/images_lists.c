/* Cases of work_list.glsl and list_maker.glsl: lists of tiles, and the texels that invocations take from them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cases/images/image_case_lists.h"
#include "harness/image_case.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

/* ---- Images with a random class for each pixel: sky, smooth or rough, in patches of 1 up to all pixels ---- */

struct kind {
    uint32_t width, height;
    double sky, smooth;
};
static const struct kind kinds[] = {
    {1, 1, 0, 1},        {7, 3, 0.3, 0.5}, {64, 64, 0, 0},  {65, 33, 0.9, 0.1}, {100, 70, 0.5, 0.5},
    {257, 40, 0.1, 0.9}, {300, 260, 0, 1}, {40, 130, 1, 0}, /* more blocks than a workgroup has invocations; nothing */
};
enum { KINDS = sizeof kinds / sizeof *kinds, CLASSES = 2, ITEMS = 256 };
enum { TILE = 2 /* pixels, either way */, STRIP = 8 /* tiles */, COLUMNS = 4 /* strips of a region */, ROWS = 32 };

static int class_of(const struct kind *kind, uint32_t x, uint32_t y) {
    if (noise(1, y << 16 | x) < kind->sky) return CLASSES;
    return noise(2, y << 16 | x) < kind->smooth ? 0 : 1;
}

static void paint(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) {
        const int class = class_of(plain->user, (uint32_t)(i % plain->width), (uint32_t)(i / plain->width));
        values[PLAIN_DEPTH * pixels + i] = class == CLASSES ? INFINITY : 5;
        values[PLAIN_ROUGHNESS * pixels + i] = class == 0 ? 0.1f : 0.11f;
        values[PLAIN_SPECULAR * pixels + i] = 0.5f;
    }
}

static bool run_lists(struct frames *frames, const struct kind *kind, const char *const *passes,
                      const char *const *settings, const char *shader, struct glint_error *err) {
    const struct plain plain = {.width = kind->width,
                                .height = kind->height,
                                .fov_y_degrees = 60,
                                .spoil = paint,
                                .compression = GLINT_NONE,
                                .user = kind};
    char path[4096];
    snprintf(path, sizeof path, "%s/list.exr", frames->context->folder);
    return plain_write(path, &plain, err) && frames_pipeline(frames, passes, settings, err) &&
           (!shader || frames_shader(frames, "screen_trace", shader, err)) && frames_run_capture(frames, path, err);
}

static void *read_list(struct frames *frames, const char *name, enum glint_type type, size_t *values,
                       struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(frames->replay, name);
    *values = image ? (size_t)image->width * image->height * image->components : 0;
    void *out = image ? malloc(*values * sizeof(uint32_t)) : NULL;
    if (!image) glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s", name);
    else if (!out) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else if (!glint_replay_read_image(frames->replay, image, type, out, err)) free(out), out = NULL;
    return out;
}

static const char *const with_classes[] = {"classify_tiles=shown", "temporal.min_roughness=0.105", NULL};
static const char *const of_rays[] = {"classify=tiles", "downsample.jitter=false", NULL};
static const char *const whole_texels[] = {"classify_tiles=shown", "downsample.jitter=false", NULL};
static const char *const half_texels[] = {"classify_tiles=shown", "downsample=pick", "downsample.jitter=false", NULL};

/* In the order of the list: rough, rough and smooth, smooth, empty. */
static int kind_of_tile(const struct kind *kind, uint32_t column, uint32_t row) {
    bool has[CLASSES + 1] = {false};
    for (uint32_t y = TILE * row; y < TILE * row + TILE && y < kind->height; y++)
        for (uint32_t x = TILE * column; x < TILE * column + TILE && x < kind->width; x++)
            has[class_of(kind, x, y)] = true;
    return has[1] ? has[0] : has[0] ? 2 : 3;
}

/* Compares the list of an image's tiles with its definition. */
static void compare_tiles(const uint32_t *list, size_t picture, struct glint_selftest_finding *finding) {
    const struct kind *kind = &kinds[picture];
    const uint32_t across = (kind->width + TILE - 1) / TILE, down = (kind->height + TILE - 1) / TILE;
    const uint32_t count = across * down, columns = (across + STRIP - 1) / STRIP, row_strips = ROWS * columns;
    uint32_t ends[4], at = 0;
    for (int class = 0; class < 4; ends[class ++] = at)
        for (uint32_t tile = 0; tile < STRIP * columns * (down + ROWS); tile++) { /* strips by columns */
            const uint32_t strip = tile / STRIP, x = strip / ROWS % columns * STRIP + tile % STRIP,
                           y = strip / row_strips * ROWS + strip % ROWS;
            if (x >= across || y >= down || kind_of_tile(kind, x, y) != class) continue;
            const uint32_t item = y << 16 | x;
            image_compare(finding, list[ITEMS + at], item, item, "picture %zu, tile %u", picture, at);
            at++;
        }
    for (uint32_t i = 0; i < 6; i++) { /* visible, smooth, rough, each followed by the rest */
        const uint32_t first[] = {0, ends[2], ends[0], ends[2], 0, ends[1]};
        const uint32_t end[] = {ends[2], count, ends[2], count + ends[0], ends[1], count};
        const uint32_t found[] = {list[128 + 2 * i], list[129 + 2 * i], list[12 * i],
                                  list[12 * i + 4],  list[12 * i + 8],  list[12 * i + 10]};
        const uint32_t tiles = end[i] - first[i],
                       expected[] = {first[i], tiles, (tiles + 15) / 16, (tiles + 31) / 32, (tiles + 63) / 64, 1};
        for (int w = 0; w < 6; w++)
            image_compare(finding, found[w], expected[w], expected[w], "picture %zu, range %u", picture, i);
    }
}

static bool check_tiles(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                        struct glint_error *err) {
    static const char *const shown[] = {"classify_tiles", NULL}, *const rays[] = {"downsample", "classify", NULL};
    const bool traced = which->with == of_rays;
    bool ok = true;
    for (size_t k = 0; ok && k < KINDS; k++) {
        const size_t tiles = (size_t)((kinds[k].width + TILE - 1) / TILE) * ((kinds[k].height + TILE - 1) / TILE);
        size_t room = 0;
        ok = run_lists(frames, &kinds[k], traced ? rays : shown, which->with, NULL, err);
        uint32_t *list = ok ? read_list(frames, traced ? "screen_list" : "tile_list", GLINT_U32, &room, err) : NULL;
        ok = list && (ITEMS + tiles <= room ||
                      glint_fail(err, GLINT_ERROR_DEVICE, "self-test: a list of %zu words is too short", room));
        if (ok) compare_tiles(list, k, finding);
        free(list);
    }
    return ok;
}

#define TEXELS                                                                                                         \
    "ivec2 at = tile_texel(reduction(frame.size));\n"                                                                  \
    "    if (all(lessThan(at, imageSize(screen_travelled))))\n"                                                        \
    "        imageStore(screen_travelled, at, vec4(float(at.x) + 512.0 * float(at.y) + (tile_works ? 0.25 : 0.5)))"

static bool check_texels(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const shown[] = {"classify_tiles", "downsample", "screen_trace", NULL}, *const rays[] = {
                                                                                                   "downsample",
                                                                                                   "classify",
                                                                                                   "screen_trace",
                                                                                                   NULL};
    char *shader = image_shader("linear",
                                "#include \"shared/camera.glsl\"\n"
                                "#define LIST_WORD(place) (has_screen_list ? texelFetch(screen_list, place).x : "
                                "texelFetch(tile_list, place).x)\n"
                                "#include \"shared/work_list.glsl\"\n"
                                "void main() {\n    %s;\n}\n",
                                which->glsl);
    bool ok = shader || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; ok && k < KINDS; k++) {
        const uint32_t scale = which->with == half_texels ? 2 : 1, width = (kinds[k].width + scale - 1) / scale;
        size_t count = 0;
        ok = run_lists(frames, &kinds[k], which->with == of_rays ? rays : shown, which->with, shader, err);
        float *found = ok ? read_list(frames, "screen_travelled", GLINT_F32, &count, err) : NULL;
        ok = found != NULL;
        for (size_t i = 0; ok && i < count; i++) {
            const uint32_t x = (uint32_t)i % width, y = (uint32_t)i / width;
            const bool works = kind_of_tile(&kinds[k], x * scale / TILE, y * scale / TILE) < 3;
            const double expected = x + 512.0 * y + (works ? 0.25 : 0.5);
            image_compare(finding, (double)found[i], expected, expected, "picture %zu, texel %u,%u", k, x, y);
        }
        free(found);
    }
    free(shader);
    return ok;
}

#define TAKEN "tile_texel(scale): tile_count(), workgroup_index()"
#define TILES                                                                                                          \
    "make_list(list, phase, scale): mark_region(list, scale), place_region(list), header_word(place, ends), "          \
    "kind_of(tile, found), tile_at(tile), place_of(tile), those_of(word, kind), set_word(lane, word), "                \
    "number_in(words), class_of(texel), kinds_place(region), counts_place(region), tile_grid(), region_count(), "      \
    "workgroup_index()"

/* clang-format off */
static const struct image_case list[] = {
    {{"list of tiles", "eight pictures from 1 x 1 on, with empty ones: tiles sorted by their classes, in the order of regions and columns, and the ranges that passes use", TILES, "words", 0, "integers"}, check_tiles, NULL, with_classes},
    {{"list of rays", "the same for lists of rays", TILES, "words", 0, "integers"}, check_tiles, NULL, of_rays},
    {{"texels of tiles", "each texel exactly once, in a tile with reflections or in the rest", TAKEN, "texels", 0, "integers"}, check_texels, TEXELS, whole_texels},
    {{"texels of tiles at half resolution", "the same for blocks of 2 x 2", TAKEN, "texels", 0, "integers"}, check_texels, TEXELS, half_texels},
    {{"texels of a list of rays", "the same for the list of rays", TAKEN, "texels", 0, "integers"}, check_texels, TEXELS, of_rays},
};
/* clang-format on */

const struct image_list images_lists = {list, sizeof list / sizeof *list};
