/* Every switch has an effect: if it is changed, some image of the room changes. */
#include <stdlib.h>
#include <string.h>

#include "room.h"
#include "unit.h"

enum { WORDS = 16 };
static const char *const images[] = {"travelled",      "reflection_half",      "reflection_blurred",
                                     "reflection",     "reflection_sharp",     "composed",
                                     "composed_water", "composed_transparent", NULL};

struct way {
    const char *base[WORDS], *switches[WORDS]; /* NULL ends both */
};
#define CUBES "screen_trace.length_m=0"
static const struct way ways[] = {
    {{"downsample=pick", "screen_trace.dither=false"},
     {"screen_trace.dither=true", "screen_trace.interpolate=false", "screen_trace.refine=false",
      "screen_trace.verify=false", "screen_trace.back_faces=false", "screen_trace.pass_behind=true",
      "screen_trace.sky=false", "screen_trace.growth=1", "screen_trace.first_step=0.01", "downsample.edges=false",
      "downsample.alternate=false", "resolve.filter_color=false", "resolve.check_depth=true", "compose.fresnel=false"}},
    {{"screen_trace=hiz", "hiz=nearest", "downsample=none"},
     {"screen_trace.pass_behind=false", "screen_trace.sky=false", "screen_trace.solid=0", "screen_trace.cells_lq=24",
      "screen_trace.thickness_m=0.2", "screen_trace.length_m=2", "screen_trace.max_roughness=0.2",
      "downsample.min_weight=1"}},
    {{"screen_trace=linear_binary", "downsample=none"},
     {"screen_trace.dither=false", "screen_trace.refinements=1", "screen_trace.sky=true", "screen_trace.bias=0.05"}},
    {{"screen_trace=dda", "downsample=pick", "downsample.jitter=true", "downsample.share=0.5", "lit_mips=cone",
      "sky_mips=prefilter", "cubemap_mips=prefilter", "blur=plus", "upscale=best_match", "resolve_sharp=hit"},
     {"downsample.shuffle=false", "downsample.horizon=false", "downsample.lobe=reflection",
      "downsample.ndf=blinn_phong", "downsample.pattern=white", "downsample.cone_factor=0",
      "resolve.cone_cubemap=false", "resolve.cone_screen=false", "cubemap_mips.reach=0", "lit_mips.reach=0",
      "sky_mips.reach=0", "blur.brdf=false", "upscale.around=false", "resolve_sharp.blend=0"}},
    {{CUBES, "cocoon=max", "cubemap_select=score", "cubemap_trace.cocoon_start=surface", "cubemap_trace.mass_m=0"},
     {"cubemap_trace.max_roughness=0.2", "cocoon.reach=0", "cocoon.maximum=samples", "cubemap_select.visibility=0",
      "cubemap_select.distance=0", "cubemap_select.direction=0", "cubemap_trace.random_scale=true"}},
    {{CUBES, "cocoon=max", "cocoon.size=8"}, {"cocoon.cap_sky=false"}}, /* finer levels than the cocoon's */
    {{CUBES, "cubemap_trace=box"}, {"cubemap_trace.sky=false", "cubemap_trace.grow_m=0.3"}},
    {{CUBES, "cubemap_trace=exact"}, {"cubemap_trace.interpolate=false", "cubemap_trace.occluded=stop"}},
    {{"downsample=mips", "downsample.jitter=true", "screen_trace=dda", "blur=upscale_blur", "blur.width=1",
      "upscale=edges"},
     {"blur.edges=false", "blur.radius=1", "upscale.lobes=false", "downsample.edges=false"}},
    {{"screen_trace=dda", "resolve=blurred", "compose=contribution"},
     {"resolve.viewer=false", "resolve.edge=false", "resolve.back_face=false", "resolve.blur=0",
      "compose.modulate=false", "compose.brdf=false"}},
    {{"screen_trace=dda", "water=combine", "transparent_downsample=nearest", "transparent_screen_trace=linear",
      "transparent_cubemap_trace=march", "transparent_resolve=hit", "transparency=trace"},
     {"water.refraction=false", "water.depth=false", "water.fresnel=false", "water.environment=false",
      "transparency.fresnel=false", "transparent_cubemap_trace.secant=false", "transparent_downsample.jitter=false"}},
};

/* The images of a run, one after the other. */
struct images {
    float *values;
    size_t count;
};

static struct images images_of(struct gpu *gpu, const char *const *base, const char *word) {
    const char *words[WORDS + 1] = {NULL};
    size_t n = 0;
    struct images all = {NULL, 0};
    for (; base[n]; ++n) words[n] = base[n];
    words[n] = word;
    room_arrange(gpu, words);
    gpu_run(gpu);
    for (size_t i = 0; images[i]; ++i) {
        const struct glint_image *image = glint_replay_find_image(gpu->replay, images[i]);
        if (!image) continue;
        const size_t count = (size_t)image->width * image->height * image->components;
        float *values = gpu_floats(gpu, images[i], NULL, NULL);
        all.values = realloc(all.values, (all.count + count) * sizeof *all.values);
        assert_non_null(all.values);
        memcpy(all.values + all.count, values, count * sizeof *values);
        all.count += count;
        free(values);
    }
    return all;
}

static void no_switch_is_void(void **state) {
    struct gpu *gpu = *state;
    size_t voids = 0, count = 0;
    room_load(gpu, false);
    for (size_t w = 0; w < sizeof ways / sizeof *ways; ++w) {
        struct images plain = images_of(gpu, ways[w].base, NULL);
        for (const char *const *word = ways[w].switches; *word; ++word, ++count) {
            struct images turned = images_of(gpu, ways[w].base, *word);
            assert_int_equal(turned.count, plain.count);
            size_t moved = 0;
            for (size_t i = 0; i < plain.count; ++i)
                moved += memcmp(&plain.values[i], &turned.values[i], sizeof(float)) != 0;
            if (!moved) print_message("# void beside %s: %s\n", ways[w].base[0], *word);
            voids += !moved;
            free(turned.values);
        }
        free(plain.values);
    }
    print_message("# %zu switches, %zu of them void\n", count, voids);
    assert_int_equal(voids, 0);
}

/* Some only refine results, so that most of the images stays similar. */
static void refinements_change_little(void **state) {
    struct gpu *gpu = *state;
    static const struct {
        const char *base[4], *word, *image;
    } cases[] = {
        {{"downsample=none", "screen_trace=dda"}, "resolve.filter_color=false", "reflection_half"},
        {{"downsample=none", "screen_trace.dither=false"}, "screen_trace.interpolate=false", "screen_travelled"},
        {{"downsample=none", "screen_trace=linear_binary"}, "screen_trace.dither=false", "screen_travelled"},
        {{CUBES, "cubemap_trace=exact"}, "cubemap_trace.interpolate=false", "travelled"}};
    room_load(gpu, false);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        float *values[2];
        const char *words[5] = {cases[c].base[0], cases[c].base[1], NULL};
        size_t count = 0, used = 0;
        for (int turned = 0; turned < 2; ++turned) {
            words[2] = turned ? cases[c].word : NULL;
            room_arrange(gpu, words);
            gpu_run(gpu);
            const struct glint_image *image = glint_replay_find_image(gpu->replay, cases[c].image);
            count = (size_t)image->width * image->height * image->components;
            values[turned] = gpu_floats(gpu, cases[c].image, NULL, NULL);
        }
        double *apart = malloc(count * sizeof *apart);
        assert_non_null(apart);
        for (size_t i = 0; i < count; ++i) {
            const double a = (double)values[0][i], b = (double)values[1][i];
            if (a > 0 && a < 1e30) apart[used++] = b < 1e30 ? (a > b ? a - b : b - a) / (a + b) : 1;
        }
        const double median = quantile(apart, used, 0.5);
        print_message("# %s: %zu values, half of them within %.3f\n", cases[c].word, used, median);
        assert_true(used > count / 10 && median < 0.1);
        free(values[0]), free(values[1]), free(apart);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_switch_is_void),
                                       cmocka_unit_test(refinements_change_little)};
    return cmocka_run_group_tests_name("gpu_switches", tests, gpu_set_up, gpu_tear_down);
}
