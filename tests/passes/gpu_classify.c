/* Lists of pixels by class: their order against one made here, and the bits of what is traced over them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu.h"
#include "plain_capture.h"

enum { LIST_WIDTH = 256, CLASSES = 2 };
static const uint32_t no_item = 0xFFFFFFFF;

/* Tiles that end inside the picture: half of it is 83 × 47. */
static void load_street(struct gpu *gpu) {
    gpu_sample(gpu, "street", "street", &(struct glint_sample_options){.width = 166, .height = 94, .cube_size = 32});
    gpu_reset(gpu);
    gpu_use(gpu, "cubemap_select=score");
}

static void with_lists(struct gpu *gpu, bool by_block) {
    gpu_use(gpu, by_block ? "classify=blocks" : "classify=tiles");
    gpu_use(gpu, by_block ? "classify_unfinished=blocks" : "classify_unfinished=tiles");
}

/* Class of a pixel by its definition; CLASSES: no ray. */
static int class_of(const float *depth, const float *normal, const uint32_t *finished, uint32_t i) {
    const float *n = &normal[4 * i];
    double length2 = (double)(n[0] * n[0]) + (double)(n[1] * n[1]) + (double)(n[2] * n[2]);
    if (!(depth[i] > 0 && depth[i] < 3e38f && length2 > 0.25 && length2 < 4)) return CLASSES;
    if (finished && finished[i]) return CLASSES;
    return n[3] <= 0.1f ? 0 : 1;
}

/* The bits of `i` that stand at even places. */
static uint32_t even_bits(uint32_t i) {
    return (i & 1) | (i >> 1 & 2) | (i >> 2 & 4);
}

/* Item `place` of a list being walked must be this one. */
static void expect_item(const uint32_t *list, uint32_t *place, uint32_t item) {
    if (list[LIST_WIDTH + *place] != item)
        fail_msg("item %u: expected %x, found %x", *place, item, list[LIST_WIDTH + *place]);
    ++*place;
}

/* Walks block by block of 32 x 32 pixels, in it square by square of 4 x 4 in Morton order, once for each class in all or in
   each block, and compares item by item. Returns how many pixels each class has. */
static void expect_list(struct gpu *gpu, const char *name, bool unfinished, bool by_block, uint32_t counts[CLASSES]) {
    uint32_t width, height, list_width, list_height;
    float *depth = gpu_floats(gpu, "depth_half", &width, &height),
          *normal = gpu_floats(gpu, "normal_jittered", NULL, NULL);
    uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    uint32_t *list = gpu_uints(gpu, name, &list_width, &list_height), place = 0;
    const uint32_t across = (width + 31) / 32, blocks = across * ((height + 31) / 32), walks = by_block ? blocks : 1;
    assert_int_equal(list_width, LIST_WIDTH);
    memset(counts, 0, CLASSES * sizeof *counts);
    for (uint32_t walk = 0; walk < walks; ++walk) {
        for (int class = 0; class < CLASSES; ++class) {
            for (uint32_t i = walk * 1024; i < (by_block ? walk + 1 : blocks) * 1024; ++i) {
                const uint32_t block = i / 1024, square = i / 16 % 64;
                uint32_t x = block % across * 32 + 4 * even_bits(square) + i % 4,
                         y = block / across * 32 + 4 * even_bits(square >> 1) + i / 4 % 4;
                if (x >= width || y >= height) continue;
                if (class_of(depth, normal, unfinished ? finished : NULL, y * width + x) != class) continue;
                expect_item(list, &place, y << 16 | x);
                ++counts[class];
            }
            while (!by_block && place % 64) expect_item(list, &place, no_item);
        }
        while (by_block && place < 1024 * (walk + 1)) expect_item(list, &place, no_item);
    }
    const uint32_t tiles = (width + 7) / 8 * ((height + 7) / 8);
    const uint32_t header[4] = {place / 64 > tiles ? place / 64 : tiles, 1, 1, place};
    assert_memory_equal(list, header, sizeof header);
    assert_true(LIST_WIDTH + place <= list_width * list_height);
    free(list);
    free(finished);
    free(normal);
    free(depth);
}

static void lists_hold_each_ray_once_by_class_and_block(void **state) {
    struct gpu *gpu = *state;
    uint32_t screen[2][CLASSES], cubemaps[2][CLASSES];
    for (int by_block = 0; by_block < 2; ++by_block) {
        load_street(gpu);
        with_lists(gpu, by_block);
        gpu_run(gpu);
        expect_list(gpu, "screen_list", false, by_block, screen[by_block]);
        expect_list(gpu, "cubemap_list", true, by_block, cubemaps[by_block]);
    }
    print_message("# screen: %u smooth, %u rough; cube maps: %u smooth, %u rough\n", screen[0][0], screen[0][1],
                  cubemaps[0][0], cubemaps[0][1]);
    assert_true(screen[0][0] > 100 && screen[0][1] > 100);
    assert_true(cubemaps[0][0] > 50 && cubemaps[0][1] > 50);
    assert_true(cubemaps[0][0] < screen[0][0] && cubemaps[0][1] < screen[0][1]);
    assert_memory_equal(screen[0], screen[1], sizeof screen[0]);
    assert_memory_equal(cubemaps[0], cubemaps[1], sizeof cubemaps[0]);
}

static void one_pixel_makes_one_workgroup(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint32_t counts[CLASSES];
    plain_capture(gpu_path(gpu, "one", path),
                  &(struct plain){.width = 2, .height = 2, .roughness = 0.5f, .fov_y_degrees = 60});
    gpu_load(gpu, "one");
    gpu_reset(gpu);
    with_lists(gpu, false);
    gpu_run(gpu);
    expect_list(gpu, "screen_list", false, false, counts);
    assert_true(counts[0] == 0 && counts[1] == 1);
}

/* Catches: counts of blocks beyond the first one for each invocation. */
static void more_blocks_than_invocations(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint32_t counts[CLASSES];
    plain_capture(gpu_path(gpu, "large", path),
                  &(struct plain){.width = 600, .height = 520, .roughness = 0.05f, .fov_y_degrees = 60});
    gpu_load(gpu, "large");
    gpu_reset(gpu);
    for (int by_block = 0; by_block < 2; ++by_block) {
        with_lists(gpu, by_block);
        gpu_run(gpu); /* 10 x 9 blocks */
        expect_list(gpu, "screen_list", false, by_block, counts);
        assert_int_equal(counts[0], 300 * 260);
    }
}

/* A replay of as large a picture in which every pixel has a ray, so that what is not written of the next one's images is not 0. */
static void fill_memory(struct gpu *gpu) {
    char path[256];
    plain_capture(gpu_path(gpu, "wall", path), &(struct plain){.width = 166, .height = 94, .fov_y_degrees = 60});
    gpu_load(gpu, "wall");
    gpu_reset(gpu);
    gpu_run(gpu);
}

/* Catches: rays that a list loses, pixels outside it that keep what was in memory, arithmetic that depends on which
   rays share a workgroup. */
static void lists_change_no_bit(void **state) {
    struct gpu *gpu = *state;
    static const char *const images[] = {"screen_travelled", "screen_finished", "screen_end",    "screen_steps",
                                         "cubemap_best",     "travelled",       "cubemap_index", "cubemap_end",
                                         "cubemap_steps",    "cubemap_fetches", "composed"};
    enum { IMAGES = sizeof images / sizeof images[0] };
    static const char *const settings[] = {"cubemap_trace.fallback=cocoon", "cubemap_trace.depth=capped",
                                           "cubemap_trace.rough_level=3"};
    float *whole[IMAGES];
    for (int round = 0; round < 6; ++round) {
        const int i = round % 3;
        fill_memory(gpu);
        load_street(gpu);
        if (round >= 3) {
            gpu_use(gpu, "hiz=nearest");
            gpu_use(gpu, "screen_trace=hiz");
        }
        gpu_use(gpu, "cocoon=max");
        gpu_use(gpu, "cubemap_mips=plain");
        for (size_t k = 0; k < sizeof settings / sizeof settings[0]; ++k) gpu_set(gpu, settings[k]);
        if (i > 0) with_lists(gpu, i == 2);
        gpu_run(gpu);
        for (size_t k = 0; k < IMAGES; ++k) {
            uint32_t width, height;
            bool is_float = k == 0 || k == 5 || k == 10;
            void *found = is_float ? (void *)gpu_floats(gpu, images[k], &width, &height)
                                   : (void *)gpu_uints(gpu, images[k], &width, &height);
            size_t bytes = 4 * (size_t)width * height * (k == 10 ? 4 : 1);
            if (i == 0) whole[k] = found;
            else {
                if (memcmp(found, whole[k], bytes) != 0) fail_msg("%s differs", images[k]);
                free(found);
                if (i == 2) free(whole[k]);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_hold_each_ray_once_by_class_and_block),
        cmocka_unit_test(one_pixel_makes_one_workgroup),
        cmocka_unit_test(more_blocks_than_invocations),
        cmocka_unit_test(lists_change_no_bit),
    };
    return cmocka_run_group_tests_name("gpu_classify", tests, gpu_set_up, gpu_tear_down);
}
