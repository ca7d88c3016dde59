/* A room and the same room with x and y exchanged, seen by a camera that looks along z: their images are mirror images about the
   diagonal. This holds for every variant that treats both axes equally. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "room.h"
#include "unit.h"

static const char *const images[] = {"screen_travelled",
                                     "travelled",
                                     "reflection_half",
                                     "reflection_blurred",
                                     "reflection_temporal",
                                     "reflection",
                                     "reflection_sharp",
                                     "composed",
                                     "composed_water",
                                     "composed_transparent",
                                     "transparent_depth_half",
                                     "transparent_reflection",
                                     "transparent_travelled",
                                     "transparent_screen_travelled",
                                     NULL};

struct way {
    const char *what;
    const char *words[16]; /* slot=variant, slot.parameter=value, terminated by NULL */
};

/* The values of all images that exist, one after the other. */
static float *values_of(struct gpu *gpu, const struct way *way, bool second, size_t *count, size_t ends[16]) {
    float *all = NULL;
    room_load(gpu, second);
    room_arrange(gpu, way->words);
    gpu_run(gpu);
    *count = 0;
    for (size_t n = 0; images[n]; ++n) {
        const struct glint_image *image = glint_replay_find_image(gpu->replay, images[n]);
        const size_t components = image ? image->components : 0, size = image ? image->width : 0;
        float *values = image ? gpu_floats(gpu, images[n], NULL, NULL) : NULL;
        all = realloc(all, (*count + size * size * components + 1) * sizeof *all);
        assert_non_null(all);
        for (size_t i = 0; i < size * size; ++i) {
            const size_t x = i % size, y = i / size, from = second ? (size - 1 - x) * size + size - 1 - y : i;
            memcpy(all + *count + i * components, values + from * components, components * sizeof *all);
        }
        *count += size * size * components;
        ends[n] = *count;
        free(values);
    }
    return all;
}

/* Both use the same arithmetic with terms in another order, so that decisions by the last bit may differ: where surfaces meet, and
   where a step ends exactly on one. This affects a small fraction of the pixels; treating axes differently changes most. */
static const double ties = 0.02;

/* The error of filtered values: texture units quantise weights and may truncate the position between two texels, so that a position and
   its mirror image differ by a step in three weights: across, down, between levels. Colours and alpha are in [0, 1]. Half a step is
   measured as the distance to the centre of the nearer of two steps. */
static double filter_slack(struct gpu *gpu) {
    double half_step = 0;
    uint32_t width, height;
    room_load(gpu, false);
    room_arrange(gpu, (const char *const[]){"screen_trace=dda", NULL});
    gpu_shader(gpu, "resolve", "../filter.comp");
    gpu_run(gpu);
    float *off = gpu_floats(gpu, "reflection_half", &width, &height);
    for (size_t i = 0; i < (size_t)width * height; ++i) half_step = fmax(half_step, (double)off[4 * i]);
    free(off);
    print_message("# weights of the filter: off by %.2g\n", half_step);
    assert_true(half_step <= 1.0 / 32); /* Vulkan requires at least four bits */
    return 3 * 2 * half_step;
}

static void check(struct gpu *gpu, const struct way *way, double slack) {
    size_t counts[2], ends[16];
    float *first = values_of(gpu, way, false, &counts[0], ends), *second = values_of(gpu, way, true, &counts[1], ends);
    assert_int_equal(counts[0], counts[1]);
    bool same = true;
    for (size_t n = 0, i = 0; images[n]; ++n) {
        size_t apart = 0, full = 0, from = i;
        for (; i < ends[n]; ++i) {
            const double a = (double)first[i], b = (double)second[i];
            full += a != 0;
            apart += !(a == b || fabs(a - b) <= 1e-3 * (fabs(a) + fabs(b)) + 1e-5 + slack || (isnan(a) && isnan(b)));
        }
        if (i == from) continue;
        const double part = (double)apart / (double)(i - from);
        print_message("# %s: %s: %.2f %% differ\n", way->what, images[n], 100 * part);
        same = same && part <= ties && (full > 0 || n == 0); /* screen rays may have no length */
    }
    free(first), free(second);
    assert_true(same);
}

#define CUBES "screen_trace.length_m=0"
static const struct way ways[] = {
    {"linear trace", {"screen_trace.dither=false"}},
    {"bisection", {"screen_trace=linear_binary", "screen_trace.dither=false"}},
    {"pyramid", {"screen_trace=hiz", "hiz=nearest"}},
    {"every texel", {"screen_trace=dda", "classify=tiles", "classify_unfinished=tiles"}},
    {"coarse classes", {"screen_trace=dda", "classify=coarse", "resolve=blurred", "compose=contribution"}},
    {"cube maps", {CUBES, "cocoon=max", "cubemap_select=score"}},
    {"exact", {CUBES, "cubemap_trace=exact", "cubemap_mips=plain"}},
    {"boxes", {CUBES, "cubemap_trace=box"}},
    {"spheres", {CUBES, "cubemap_trace=sphere"}},
    {"directions", {CUBES, "cubemap_trace=lookup"}},
    {"paraboloids", {CUBES, "cubemap_convert=dual_paraboloid", "cubemap_trace=dual_paraboloid"}},
    {"cones",
     {"screen_trace=dda", "downsample.jitter=true", "downsample.share=0", "lit_mips=cone", "sky_mips=prefilter",
      "cubemap_mips=prefilter"}},
    {"cross", {"screen_trace=dda", "blur=plus", "temporal=rough", "temporal.extra=false", "upscale=best_match"}},
    {"levels", {"screen_trace=dda", "blur=mips", "downsample.jitter=true", "downsample.share=0", "temporal=outliers"}},
    {"sharp", {"screen_trace=dda", "resolve_sharp=hit", "temporal_sharp=clamped", "upscale=best_match"}},
    {"sheets",
     {"screen_trace=dda", "water=combine", "transparent_downsample=nearest", "transparent_screen_trace=linear",
      "transparent_cubemap_trace=march", "transparent_resolve=hit", "transparency=trace",
      "transparent_downsample.jitter=false", "transparent_screen_trace.dither=false",
      "transparent_cubemap_trace.random_scale=false", "transparent_resolve.fog=false"}},
};

enum { WAYS = sizeof ways / sizeof *ways };

static void each_way(void **state) {
    const double slack = filter_slack(*state);
    for (size_t i = 0; i < WAYS; ++i) check(*state, &ways[i], slack);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_way)};
    return cmocka_run_group_tests_name("gpu_swapped", tests, gpu_set_up, gpu_tear_down);
}
