/* Lists of rays by class: their order compared with an independent one, and the bits of tracers that process them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { LIST_WIDTH = 256, CLASSES = 2, RANGES_AT = 128 };

/* Tiles exceed the image, whose half resolution is 83 × 47. */
static void load_street(struct gpu *gpu) {
    gpu_sample(gpu, "street", "street", &(struct glint_sample_options){.width = 166, .height = 94, .cube_size = 32});
    gpu_reset(gpu);
    gpu_use(gpu, "cubemap_select=score");
}

static void with_lists(struct gpu *gpu) {
    gpu_use(gpu, "classify=tiles");
    gpu_use(gpu, "classify_unfinished=tiles");
}

/* The class of a pixel by definition; CLASSES: no ray. */
static int class_of(const float *depth, const float *normal, const uint32_t *finished, uint32_t i) {
    const float *n = &normal[4 * i];
    double length2 = (double)(n[0] * n[0]) + (double)(n[1] * n[1]) + (double)(n[2] * n[2]);
    if (!(depth[i] > 0 && depth[i] < 3e38f && length2 > 0.25 && length2 < 4)) return CLASSES;
    if (finished && finished[i]) return CLASSES;
    return n[3] <= 0.1f ? 0 : 1;
}

/* The next item of a list must be this one. */
static void expect_item(const uint32_t *list, uint32_t *place, uint32_t item) {
    if (list[LIST_WIDTH + *place] != item)
        fail_msg("item %u: expected %x, found %x", *place, item, list[LIST_WIDTH + *place]);
    ++*place;
}

/* Compares a list with all texels of half resolution as tiles, rough ones first and those without a ray last: by regions of 32 x 32, in
   each by columns of strips of eight. Counts the texels of each class. */
static void expect_list(struct gpu *gpu, const char *name, bool unfinished, uint32_t counts[CLASSES]) {
    static const int order[] = {1, 0, CLASSES};
    uint32_t width, height, list_width, list_height;
    float *depth = gpu_floats(gpu, "depth_half", &width, &height),
          *normal = gpu_floats(gpu, "normal_jittered", NULL, NULL);
    uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    uint32_t *list = gpu_uints(gpu, name, &list_width, &list_height), place = 0, shown = 0;
    const uint32_t across = (width + 31) / 32, regions = across * ((height + 31) / 32);
    assert_int_equal(list_width, LIST_WIDTH);
    memset(counts, 0, CLASSES * sizeof *counts);
    for (int k = 0; k <= CLASSES; ++k) {
        shown = place;
        for (uint32_t i = 0; i < regions * 1024; ++i) {
            const uint32_t region = i / 1024, x = region % across * 32 + i / 256 % 4 * 8 + i % 8,
                           y = region / across * 32 + i / 8 % 32;
            if (x >= width || y >= height) continue;
            const int class = class_of(depth, normal, unfinished ? finished : NULL, y * width + x);
            if (class != order[k]) continue;
            expect_item(list, &place, y << 16 | x);
            if (class < CLASSES) ++counts[class];
        }
    }
    const uint32_t first[] = {0, shown, counts[1]}, size[] = {shown, place - shown, counts[0]};
    for (uint32_t range = 0; range < 3; ++range) {
        assert_int_equal(list[RANGES_AT + 2 * range], first[range]);
        assert_int_equal(list[RANGES_AT + 2 * range + 1], size[range]);
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t header[4] = {(size[range] + (16u << i) - 1) / (16u << i), 1, 1, size[range]};
            assert_memory_equal(&list[12 * range + 4 * i], header, sizeof header);
        }
    }
    assert_true(LIST_WIDTH + place <= list_width * list_height);
    free(list);
    free(finished);
    free(normal);
    free(depth);
}

static void lists_hold_each_ray_once_by_class_and_region(void **state) {
    struct gpu *gpu = *state;
    uint32_t screen[CLASSES], cubemaps[CLASSES];
    load_street(gpu);
    with_lists(gpu);
    gpu_run(gpu);
    expect_list(gpu, "screen_list", false, screen);
    expect_list(gpu, "cubemap_list", true, cubemaps);
    print_message("# screen: %u smooth, %u rough; cube maps: %u smooth, %u rough\n", screen[0], screen[1], cubemaps[0],
                  cubemaps[1]);
    assert_true(screen[0] > 100 && screen[1] > 100);
    assert_true(cubemaps[0] > 50 && cubemaps[1] > 50);
    assert_true(cubemaps[0] < screen[0] && cubemaps[1] < screen[1]);
}

static void one_texel_makes_one_workgroup(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint32_t counts[CLASSES];
    plain_capture(gpu_path(gpu, "one", path),
                  &(struct plain){.width = 2, .height = 2, .roughness = 0.5f, .fov_y_degrees = 60});
    gpu_load(gpu, "one");
    gpu_reset(gpu);
    with_lists(gpu);
    gpu_run(gpu);
    expect_list(gpu, "screen_list", false, counts);
    assert_true(counts[0] == 0 && counts[1] == 1);
}

/* Catches: wrong counts if an invocation processes several regions. */
static void more_regions_than_invocations(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint32_t counts[CLASSES];
    plain_capture(gpu_path(gpu, "large", path),
                  &(struct plain){.width = 4200, .height = 196, .roughness = 0.05f, .fov_y_degrees = 20});
    gpu_load(gpu, "large");
    gpu_reset(gpu);
    with_lists(gpu);
    gpu_run(gpu); /* 66 x 4 regions */
    expect_list(gpu, "screen_list", false, counts);
    assert_int_equal(counts[0], 2100 * 98);
}

/* Replays an image of the same size in which every pixel has a ray, so that images of the next run do not begin as zeros. */
static void fill_memory(struct gpu *gpu) {
    char path[256];
    plain_capture(gpu_path(gpu, "wall", path), &(struct plain){.width = 166, .height = 94, .fov_y_degrees = 60});
    gpu_load(gpu, "wall");
    gpu_reset(gpu);
    gpu_run(gpu);
}

/* Catches: rays that are missing in a list, stale values in pixels outside of it, and arithmetic that depends on the other rays of a
   workgroup. */
static void lists_change_no_bit(void **state) {
    struct gpu *gpu = *state;
    static const char *const images[] = {"screen_travelled", "screen_finished", "screen_end",    "screen_steps",
                                         "cubemap_best",     "travelled",       "cubemap_index", "cubemap_end",
                                         "cubemap_steps",    "cubemap_fetches", "composed"};
    enum { IMAGES = sizeof images / sizeof images[0] };
    static const char *const settings[] = {"cubemap_trace.fallback=cocoon", "cubemap_trace.depth=capped",
                                           "cubemap_trace.rough_level=3"};
    float *whole[IMAGES];
    for (int round = 0; round < 4; ++round) {
        const int i = round % 2;
        fill_memory(gpu);
        load_street(gpu);
        if (round >= 2) {
            gpu_use(gpu, "hiz=nearest");
            gpu_use(gpu, "screen_trace=hiz");
        }
        gpu_use(gpu, "cocoon=max");
        gpu_use(gpu, "cubemap_mips=plain");
        for (size_t k = 0; k < sizeof settings / sizeof settings[0]; ++k) gpu_set(gpu, settings[k]);
        if (i > 0) with_lists(gpu);
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
                free(whole[k]);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_hold_each_ray_once_by_class_and_region),
        cmocka_unit_test(one_texel_makes_one_workgroup),
        cmocka_unit_test(more_regions_than_invocations),
        cmocka_unit_test(lists_change_no_bit),
    };
    return cmocka_run_group_tests_name("gpu_classify", tests, gpu_set_up, gpu_tear_down);
}
