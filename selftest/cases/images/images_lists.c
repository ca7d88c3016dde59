/* Cases of compact.glsl, work_list.glsl and tiles.glsl: lists of pixels and tiles, and what invocations take from them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/images/image_case_lists.h"
#include "harness/image_case.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

/* ---- Pictures whose every pixel's class is drawn: sky, smooth or rough, in patches of 1 to all ---- */

struct kind {
    uint32_t width, height;
    double sky, smooth;
};
static const struct kind kinds[] = {
    {1, 1, 0, 1},        {7, 3, 0.3, 0.5}, {64, 64, 0, 0},  {65, 33, 0.9, 0.1}, {100, 70, 0.5, 0.5},
    {257, 40, 0.1, 0.9}, {300, 260, 0, 1}, {40, 130, 1, 0}, /* more blocks than a workgroup has invocations; nothing */
};
enum { KINDS = sizeof kinds / sizeof *kinds, CLASSES = 2, ITEMS = 256 };
enum { WIDE = 2, HIGH = 2, STRIP = 16 };    /* pixels of a tile, and of a strip */
enum { REGION_WIDE = 4, REGION_HIGH = 16 }; /* strips */
static const uint32_t no_item = 0xFFFFFFFF;

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

/* ---- The list by its definition ---- */

static uint32_t even_bits(uint32_t i) {
    return (i & 1) | (i >> 1 & 2) | (i >> 2 & 4);
}

struct items {
    uint32_t *item;
    size_t count;
};
static void fill_up(struct items *items, size_t count) {
    while (items->count < count) items->item[items->count++] = no_item;
}
/* Pixels of a class in blocks of 32 x 32, there in squares of 4 x 4 in Morton order. */
static void add_class(const struct kind *kind, int class, uint32_t first, uint32_t last, struct items *items) {
    const uint32_t across = (kind->width + 31) / 32;
    for (uint32_t i = first * 1024; i < last * 1024; i++) {
        const uint32_t block = i / 1024, square = i / 16 % 64;
        const uint32_t x = block % across * 32 + 4 * even_bits(square) + i % 4;
        const uint32_t y = block / across * 32 + 4 * even_bits(square >> 1) + i / 4 % 4;
        if (x < kind->width && y < kind->height && class_of(kind, x, y) == class)
            items->item[items->count++] = y << 16 | x;
    }
}
static bool make_items(const struct kind *kind, bool by_block, struct items *items, struct glint_error *err) {
    const uint32_t blocks = (kind->width + 31) / 32 * ((kind->height + 31) / 32);
    *items = (struct items){calloc((size_t)blocks * 1024 + 128, sizeof *items->item), 0};
    if (!items->item) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t block = 0; by_block && block < blocks; block++) {
        for (int class = 0; class < CLASSES; class ++) add_class(kind, class, block, block + 1, items);
        fill_up(items, (size_t)(block + 1) * 1024);
    }
    for (int class = 0; !by_block && class < CLASSES; class ++) {
        add_class(kind, class, 0, blocks, items);
        fill_up(items, (items->count + 63) / 64 * 64);
    }
    return true;
}

static const char *const with_tiles[] = {"classify=tiles", "downsample.jitter=false", NULL};
static const char *const with_blocks[] = {"classify=blocks", "downsample.jitter=false", NULL};
static const char *const without[] = {"downsample.jitter=false", NULL};

static bool check_list(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                       struct glint_error *err) {
    static const char *const passes[] = {"downsample", "classify", NULL};
    const bool by_block = which->with == with_blocks;
    bool ok = true;
    for (size_t k = 0; ok && k < KINDS; k++) {
        struct items items = {NULL, 0};
        size_t room = 0;
        ok = make_items(&kinds[k], by_block, &items, err) &&
             run_lists(frames, &kinds[k], passes, which->with, NULL, err);
        uint32_t *list = ok ? read_list(frames, "screen_list", GLINT_U32, &room, err) : NULL;
        ok = list && (ITEMS + items.count <= room ||
                      glint_fail(err, GLINT_ERROR_DEVICE, "self-test: a list of %zu words is too short", room));
        const uint32_t tiles = (kinds[k].width + 7) / 8 * ((kinds[k].height + 7) / 8),
                       groups = (uint32_t)items.count / 64;
        const uint32_t header[4] = {groups > tiles ? groups : tiles, 1, 1, (uint32_t)items.count};
        for (size_t i = 0; ok && i < 4; i++)
            image_compare(finding, list[i], header[i], header[i], "picture %zu, word %zu", k, i);
        for (size_t i = 0; ok && i < items.count; i++)
            image_compare(finding, list[ITEMS + i], items.item[i], items.item[i], "picture %zu, item %zu", k, i);
        free(list);
        free(items.item);
    }
    return ok;
}

/* ---- Which pixels the invocations take: each once, with a list and without one ---- */

#define TAKES                                                                                                          \
    "ivec2 size = imageSize(screen_travelled), pixel = own_pixel(size);\n"                                             \
    "    bool has = inside(pixel, size) && texelFetch(depth_half, pixel, 0).x < 1e30;\n"                               \
    "    if (!has && inside(pixel, size)) imageStore(screen_travelled, pixel, vec4(-1.0));\n"                          \
    "    if (has_list()) pixel = listed_pixel(screen_list), has = inside(pixel, size);\n"                              \
    "    uint item = item_of(pixel);\n"                                                                                \
    "    if (has) imageStore(screen_travelled, pixel, vec4(float(item & 0xFFFFu) + 4096.0 * float(item >> 16u)))"

static bool check_pixels(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const all[] = {"downsample", "classify", "screen_trace", NULL};
    static const char *const two[] = {"downsample", "screen_trace", NULL};
    char *shader =
        image_shader("linear", "#include \"shared/work_list.glsl\"\nvoid main() {\n    %s;\n}\n", which->glsl);
    bool ok = shader || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; ok && k < KINDS; k++) {
        size_t count = 0;
        ok = run_lists(frames, &kinds[k], which->with == without ? two : all, which->with, shader, err);
        float *found = ok ? read_list(frames, "screen_travelled", GLINT_F32, &count, err) : NULL;
        ok = found != NULL;
        for (size_t i = 0; ok && i < count; i++) {
            const uint32_t x = (uint32_t)i % kinds[k].width, y = (uint32_t)i / kinds[k].width;
            const double expected = class_of(&kinds[k], x, y) < CLASSES ? x + 4096.0 * y : -1;
            image_compare(finding, (double)found[i], expected, expected, "picture %zu, pixel %u,%u", k, x, y);
        }
        free(found);
    }
    free(shader);
    return ok;
}

/* ---- Tiles of 2 x 2 pixels, and on some devices strips ---- */

/* In the order of the list: rough, rough and smooth, smooth, nothing. */
static int kind_of_tile(const struct kind *kind, uint32_t wide, uint32_t column, uint32_t row) {
    bool has[CLASSES + 1] = {false};
    for (uint32_t y = HIGH * row; y < HIGH * row + HIGH && y < kind->height; y++)
        for (uint32_t x = wide * column; x < wide * column + wide && x < kind->width; x++)
            has[class_of(kind, x, y)] = true;
    return has[1] ? has[0] : has[0] ? 2 : 3;
}

static const char *const with_classes[] = {"classify_tiles=shown", "temporal.min_roughness=0.105", NULL};
static const char *const whole_texels[] = {"classify_tiles=shown", "downsample.jitter=false", NULL};
static const char *const half_texels[] = {"classify_tiles=shown", "downsample=pick", "downsample.jitter=false", NULL};

/* Of a list of tiles, with its maker's notes. */
static size_t words_of(const struct kind *kind, uint32_t wide) {
    const uint32_t regions_wide = (kind->width + REGION_WIDE * STRIP - 1) / (REGION_WIDE * STRIP),
                   regions_high = (kind->height + REGION_HIGH * HIGH - 1) / (REGION_HIGH * HIGH);
    const uint32_t tiles = REGION_WIDE * REGION_HIGH * (STRIP / wide);
    return ITEMS + (size_t)regions_wide * regions_high * (tiles + tiles / 8 + 2);
}

/* The list of one picture's tiles by its definition. */
static void compare_tiles(const uint32_t *list, size_t picture, uint32_t wide, struct glint_selftest_finding *finding) {
    const struct kind *kind = &kinds[picture];
    const uint32_t each = STRIP / wide, across = (kind->width + wide - 1) / wide,
                   down = (kind->height + HIGH - 1) / HIGH;
    const uint32_t count = across * down, columns = (across + each - 1) / each, strips = REGION_HIGH * columns;
    uint32_t ends[4], at = 0;
    for (int class = 0; class < 4; ends[class ++] = at)
        for (uint32_t tile = 0; tile < each * columns * (down + REGION_HIGH); tile++) { /* strips by columns */
            const uint32_t strip = tile / each, x = strip / REGION_HIGH % columns * each + tile % each,
                           y = strip / strips * REGION_HIGH + strip % REGION_HIGH;
            if (x >= across || y >= down || kind_of_tile(kind, wide, x, y) != class) continue;
            const uint32_t item = y << 16 | x;
            image_compare(finding, list[ITEMS + at], item, item, "picture %zu, tile %u of %u", picture, at, wide);
            at++;
        }
    for (uint32_t i = 0; i < 6; i++) { /* shown, smooth, rough, each with the rest behind it */
        const uint32_t first[] = {0, ends[2], ends[0], ends[2], 0, ends[1]};
        const uint32_t end[] = {ends[2], count, ends[2], count + ends[0], ends[1], count};
        const uint32_t found[] = {list[128 + 2 * i], list[129 + 2 * i], list[12 * i], list[12 * i + 8],
                                  list[12 * i + 10]};
        const uint32_t tiles = end[i] - first[i], two = 2 * each, eight = 8 * each,
                       expected[] = {first[i], tiles, (tiles + two - 1) / two, (tiles + eight - 1) / eight, 1};
        for (int w = 0; w < 5; w++)
            image_compare(finding, found[w], expected[w], expected[w], "picture %zu, range %u of %u", picture, i, wide);
    }
}

static bool check_tiles(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                        struct glint_error *err) {
    static const char *const passes[] = {"classify_tiles", NULL};
    const bool strips = glint_device_get_info(frames->context->device)->tile_wide == STRIP;
    bool ok = true;
    for (size_t k = 0; ok && k < KINDS; k++) {
        const size_t next = words_of(&kinds[k], WIDE), words = strips ? next + words_of(&kinds[k], STRIP) : next;
        size_t room = 0;
        ok = run_lists(frames, &kinds[k], passes, which->with, NULL, err);
        uint32_t *list = ok ? read_list(frames, "tile_list", GLINT_U32, &room, err) : NULL;
        ok = list && (words <= room ||
                      glint_fail(err, GLINT_ERROR_DEVICE, "self-test: a list of %zu words is too short", room));
        if (ok) compare_tiles(list, k, WIDE, finding);
        if (ok && strips) compare_tiles(list + next, k, STRIP, finding);
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
    static const char *const passes[] = {"classify_tiles", "downsample", "screen_trace", NULL};
    char *shader = image_shader("linear",
                                "#include \"shared/camera.glsl\"\n#include \"shared/tiles.glsl\"\n"
                                "void main() {\n    %s;\n}\n",
                                which->glsl);
    bool ok = shader || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t k = 0; ok && k < KINDS; k++) {
        const uint32_t scale = which->with == half_texels ? 2 : 1, width = (kinds[k].width + scale - 1) / scale;
        size_t count = 0;
        ok = run_lists(frames, &kinds[k], passes, which->with, shader, err);
        float *found = ok ? read_list(frames, "screen_travelled", GLINT_F32, &count, err) : NULL;
        ok = found != NULL;
        for (size_t i = 0; ok && i < count; i++) {
            const uint32_t x = (uint32_t)i % width, y = (uint32_t)i / width;
            const bool works = kind_of_tile(&kinds[k], WIDE, x * scale / WIDE, y * scale / HIGH) < 3;
            const double expected = x + 512.0 * y + (works ? 0.25 : 0.5);
            image_compare(finding, (double)found[i], expected, expected, "picture %zu, texel %u,%u", k, x, y);
        }
        free(found);
    }
    free(shader);
    return ok;
}

#define TILES "tile_grid(size), tile_count(size), region_count(size), list_begin()"
#define COMPACT                                                                                                        \
    "compact(marked, list): mark_block(list), place_block(marked, list), add_up(marked), write_header(list, total), "  \
    "gather_items(marks), marks_of_square(), count_of(marks), pack(counts), unpack(counts), square_corner(), "         \
    "class_of(pixel), counts_place(block), marks_place(block), block_count(), workgroup_index()"
#define BLOCKS "list_block(list): gather_items(marks_of_square()), write_header(list, total)"

/* clang-format off */
static const struct image_case list[] = {
    {{"compacted list", "eight pictures from 1 x 1, empty ones too: class by class in the order of blocks and squares, filled up", COMPACT, "words", 0, "integers"}, check_list, NULL, with_tiles},
    {{"list of blocks", "the same block by block", BLOCKS, "words", 0, "integers"}, check_list, NULL, with_blocks},
    {{"pixels without a list", "each invocation its own", TAKES, "pixels", 0, "integers"}, check_pixels, TAKES, without},
    {{"pixels of a compacted list", "every one that is listed once, and the others by their own place", TAKES, "pixels", 0, "integers"}, check_pixels, TAKES, with_tiles},
    {{"pixels of a list of blocks", "the same, with room between the blocks", TAKES, "pixels", 0, "integers"}, check_pixels, TAKES, with_blocks},
    {{"list of tiles", "tiles by the classes that they hold, in the order of the picture's regions and of their columns, and the ranges of them that passes run over", TILES, "words", 0, "integers"}, check_tiles, NULL, with_classes},
    {{"texels of tiles", "each once, in a tile that shows reflections or in the rest", TEXELS, "texels", 0, "integers"}, check_texels, TEXELS, whole_texels},
    {{"texels of tiles at half resolution", "the same of blocks of 2 x 2", TEXELS, "texels", 0, "integers"}, check_texels, TEXELS, half_texels},
};
/* clang-format on */

const struct image_list images_lists = {list, sizeof list / sizeof *list};
