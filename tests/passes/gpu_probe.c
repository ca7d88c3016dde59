/* Probed pixels of the street: the recorded values equal those that the run computed, and recording does not change an image. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/probe.h"
#include "gpu.h"
#include "probed.h"
#include "unit.h"

/* ---- Runs ---- */

static const char *const ways[][PROBED_WORDS] = {
    {"screen_trace=linear", "cubemap_trace=march"},
    {"screen_trace=linear_binary", "cubemap_trace=exact"},
    {"screen_trace=linear_facets", "cubemap_trace=box"},
    {"hiz=nearest", "screen_trace=hiz", "cubemap_trace=sphere"},
    {"screen_trace=dda", "cubemap_trace=lookup"},
    {"screen_trace=dda", "cubemap_convert=dual_paraboloid", "cubemap_trace=dual_paraboloid"},
    {"screen_trace.length_m=0", "cocoon=max", "cubemap_trace.rough_level=4"},
    {"screen_trace.length_m=0", "cubemap_mips=plain", "cubemap_trace.rough_level=4", "cubemap_trace.depth=captured"},
    {"screen_trace.length_m=0", "cubemap_mips=plain", "cubemap_mips.join=nearest", "cubemap_trace=exact",
     "cubemap_trace.skip=true"},
};
enum { WAYS = sizeof ways / sizeof ways[0] };

/* ---- Consistency of a trace with the images ---- */

static void check_depth(const struct glint_probe_record *record, const struct images *images) {
    const uint32_t x = record_number(record, "texel_x"), y = record_number(record, "texel_y");
    if (glint_probe_is(record, "screen_texel"))
        assert_kept_value(record, "depth_m", find_kept(images, "depth_half"), x, y, 0);
    if (glint_probe_is(record, "screen_cell")) {
        const struct kept *hiz = level_of(images, "hiz", record_number(record, "level"));
        assert_kept_value(record, "nearest", hiz, x, y, 0);
        assert_kept_value(record, "farthest", hiz, x, y, 1);
    }
    if (!glint_probe_is(record, "cubemap_texel")) return;
    const struct glint_probe_label of = glint_probe_label("image", glint_probe_value(record, "image"));
    assert_non_null(of.name);
    const struct kept *image = level_of(images, of.name, record_number(record, "level"));
    const uint32_t faces = 6 * record_number(record, "cubemap_index") + record_number(record, "face");
    assert_kept_value(record, "texel_m", image, x, y + faces * image->width, 0);
}

/* The last step of a tracer, its end, and the images must agree. */
struct last {
    const struct glint_probe_record *step;
    uint32_t steps;
};

static bool is_hit(const struct glint_probe_record *record, const char *unit, const char *value) {
    const struct glint_probe_label word = glint_probe_label(unit, glint_probe_value(record, value));
    return word.name && strcmp(word.name, "hit") == 0;
}

static bool counts_steps(const struct glint_probe_record *end) {
    return strcmp(end->pass->variant, "linear_binary") != 0 && strcmp(end->pass->variant, "march") != 0;
}

static void check_end(const struct glint_probe_record *end, const struct last *last, const struct images *images,
                      uint32_t x, uint32_t y) {
    const bool screen = glint_probe_is(end, "screen_end");
    const struct kept *far = find_kept(images, screen ? "screen_travelled" : "travelled");
    assert_kept_value(end, "travelled_m", far, x, y, 0);
    if (!screen)
        assert_int_equal(record_number(end, "cubemap_index"), bits_at(find_kept(images, "cubemap_index"), x, y, 0));
    assert_int_equal(record_number(end, "end"),
                     bits_at(find_kept(images, screen ? "screen_end" : "cubemap_end"), x, y, 0));
    assert_int_equal(record_number(end, "steps"),
                     bits_at(find_kept(images, screen ? "screen_steps" : "cubemap_steps"), x, y, 0));
    if (counts_steps(end)) assert_int_equal(record_number(end, "steps"), last->steps);
    if (!is_hit(end, "end reason", "end") || !last->step) return;
    assert_true(is_hit(last->step, "decision", "decision"));
    assert_kept_value(last->step, "travelled_m", far, x, y, 0);
}

/* The start of a ray, and its direction: equal after transformation to world space. */
struct start {
    double from[3], along_m, far_m;
};

static struct start start_of(const struct glint_probe_record *record) {
    static const char *const names[][3] = {{"x", "y", "z"}, {"direction_x", "direction_y", "direction_z"}};
    struct start start = {0};
    double square = 0;
    for (int k = 0; k < 3; k++) {
        start.from[k] = (double)glint_probe_value(record, names[0][k]);
        start.along_m += start.from[k] * (double)glint_probe_value(record, names[1][k]);
        square += start.from[k] * start.from[k];
    }
    start.far_m = sqrt(square);
    return start;
}

static void check_ray(const struct glint_probe_record *screen, const struct glint_probe_record *cube) {
    const struct start view = start_of(screen), world = start_of(cube);
    assert_near_sum(world.far_m, view.far_m, view.far_m);
    assert_near_sum(world.along_m, view.along_m, view.far_m);
}

/* The depths of the ray are those of its points. */
static void check_depths_of_ray(const struct glint_probe_record *record, const struct glint_probe_record *ray) {
    static const char *const ways[2] = {"from_m", "travelled_m"}, *const depths[2] = {"ray_from_m", "ray_m"};
    for (int k = 0; k < 2; k++) {
        const double way = (double)glint_probe_value(record, ways[k]), z = (double)glint_probe_value(ray, "z"),
                     part = way * (double)glint_probe_value(ray, "direction_z");
        if (way < 1e4) /* 1/z is linear on screen, so that far away depths are rounded */
            assert_true(fabs((double)glint_probe_value(record, depths[k]) - fabs(z + part)) < 1e-3 * (fabs(z) + way));
    }
}

/* A ray misses the proxy, or is within it for some distance, up to its end. */
static bool crosses_proxy(const struct glint_probe_record *record) {
    const float enters = glint_probe_value(record, "enters_m"), leaves = glint_probe_value(record, "leaves_m");
    assert_true(enters != leaves);
    return enters < leaves;
}

struct tally {
    size_t traces, rays, depths, screen_hits, cube_hits, proxies;
};

static void check_trace(const struct glint_probe_trace *trace, const struct images *images, const uint32_t pixel[2],
                        struct tally *tally) {
    struct last last = {0};
    const struct glint_probe_record *ray = NULL;
    assert_int_equal(trace->dropped, 0);
    tally->traces += trace->count > 0;
    for (size_t i = 0; i < trace->count; i++) {
        const struct glint_probe_record *record = &trace->records[i];
        if (ray && (glint_probe_is(record, "screen_texel") || glint_probe_is(record, "screen_cell")))
            check_depths_of_ray(record, ray);
        const bool texel = glint_probe_is(record, "screen_texel") || glint_probe_is(record, "cubemap_texel");
        check_depth(record, images);
        if (glint_probe_is(record, "cubemap_proxy")) tally->proxies += crosses_proxy(record);
        if (glint_probe_is(record, "screen_ray")) ray = record;
        if (glint_probe_is(record, "cubemap_ray") && ray) check_ray(ray, record), tally->rays++;
        if (texel || glint_probe_is(record, "screen_cell")) {
            const struct glint_probe_label word = glint_probe_label("decision", glint_probe_value(record, "decision"));
            assert_non_null(word.name);
            last.step = record;
            last.steps += strcmp(word.name, "sky") != 0 || glint_probe_is(record, "cubemap_texel");
            tally->depths++;
        }
        const bool screen = glint_probe_is(record, "screen_end");
        if (!screen && !glint_probe_is(record, "cubemap_end")) continue;
        check_end(record, &last, images, pixel[0] / 2, pixel[1] / 2);
        *(screen ? &tally->screen_hits : &tally->cube_hits) += is_hit(record, "end reason", "end");
        last = (struct last){0};
    }
}

static void test_stories(void **state) {
    struct gpu *gpu = *state;
    static uint32_t pixels[PIXELS][2];
    static struct images plain, probed;
    size_t rays = 0, proxies = 0;
    probed_scene(gpu, "street");
    draw_pixels(pixels);
    for (size_t w = 0; w < WAYS; w++) {
        struct tally tally = {0};
        struct glint_error err = {0};
        arrange_pipeline(gpu, ways[w]);
        probed_run(gpu, NULL, false, &plain);
        probed_run(gpu, pixels, false, &probed);
        same_images(&plain, &probed);
        for (size_t i = 0; i < PIXELS; i++) {
            struct glint_probe_trace trace;
            require(glint_replay_probe(gpu->replay, i, &trace, &err), &err);
            check_trace(&trace, &plain, pixels[i], &tally);
            free(trace.records);
        }
        print_message("# %s: %zu stories, %zu depths, hits %zu on screen, %zu in cube maps\n", ways[w][0], tally.traces,
                      tally.depths, tally.screen_hits, tally.cube_hits);
        assert_true(tally.traces == PIXELS && tally.cube_hits + tally.screen_hits > 0);
        rays += tally.rays, proxies += tally.proxies;
        free_images(&plain);
        free_images(&probed);
    }
    assert_true(rays > 0 && proxies > 100);
}

/* ---- Records of later passes sum up to the pass's result ---- */

/* The weighted mean of the records equals the image, if there are any. */
static size_t check_mixture(const struct glint_probe_trace *trace, const char *slot, const struct kept *image,
                            const uint32_t at[2]) {
    static const char *const channels[] = {"r", "g", "b"};
    double sum[3] = {0}, total = 0, largest = 0;
    size_t count = 0, i = 0;
    for (const struct glint_probe_record *record; (record = next_record(trace, slot, "neighbour", &i)); count++) {
        const double weight = (double)glint_probe_value(record, "weight");
        total += weight;
        for (int c = 0; c < 3; c++) {
            const double part = weight * (double)glint_probe_value(record, channels[c]);
            sum[c] += part;
            largest = fmax(largest, fabs(part));
        }
    }
    for (uint32_t c = 0; c < 3 && total > 0; c++)
        assert_near_sum(sum[c] / total, held(image, at, c), largest * (double)count / total);
    return count;
}

/* A single colour is the result of the ray. Where a cube map shows some sky, both colours are recorded. */
static size_t check_color(const struct glint_probe_trace *trace, const struct kept *image, const uint32_t at[2]) {
    static const char *const channels[] = {"r", "g", "b"};
    size_t i = 0;
    const struct glint_probe_record *first = next_record(trace, "resolve", "color", &i);
    if (!first || next_record(trace, "resolve", "color", &i)) return 0;
    for (uint32_t c = 0; c < 3; c++) assert_kept_value(first, channels[c], image, at[0], at[1], c);
    return 1;
}

static size_t check_composed(const struct glint_probe_trace *trace, const struct images *images, const uint32_t at[2]) {
    static const char *const channels[] = {"r", "g", "b"};
    size_t i = 0;
    const struct glint_probe_record *weight = next_record(trace, "compose", "reflectance", &i);
    for (uint32_t c = 0; c < 3 && weight; c++) {
        const double lit = held(find_kept(images, "lit"), at, c), w = (double)glint_probe_value(weight, channels[c]);
        const double sum = lit + w * held(find_kept(images, "reflection"), at, c);
        assert_near_sum(sum, held(find_kept(images, "composed"), at, c), sum);
    }
    return weight != NULL;
}

static void test_sums(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    static uint32_t pixels[PIXELS][2];
    static struct images images;
    size_t blurred = 0, joined = 0, upscaled = 0, colored = 0, composed = 0;
    probed_scene(gpu, "street");
    draw_pixels(pixels);
    static const char *const words[PROBED_WORDS] = {"screen_trace=dda", "blur=plus", "temporal=rough",
                                                    "upscale=best_match", "resolve.fog=false"};
    arrange_pipeline(gpu, words);
    probed_run(gpu, pixels, true, &images);
    for (size_t i = 0; i < PIXELS; i++) {
        struct glint_probe_trace trace;
        const uint32_t texel[2] = {pixels[i][0] / 2, pixels[i][1] / 2};
        require(glint_replay_probe(gpu->replay, i, &trace, &err), &err);
        blurred += check_mixture(&trace, "blur", find_kept(&images, "reflection_blurred"), texel) > 1;
        joined += check_mixture(&trace, "temporal", find_kept(&images, "reflection_temporal"), texel) > 1;
        upscaled += check_mixture(&trace, "upscale", find_kept(&images, "reflection"), pixels[i]) == 1;
        colored += check_color(&trace, find_kept(&images, "reflection_half"), texel);
        composed += check_composed(&trace, &images, pixels[i]);
        free(trace.records);
    }
    free_images(&images);
    print_message("# %zu blurred, %zu joined, %zu upscaled, %zu colours, %zu composed\n", blurred, joined, upscaled,
                  colored, composed);
    assert_true(blurred > 100 && joined > 100 && upscaled > 100 && colored > 100 && composed > 100);
}

static void test_errors(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    struct glint_probe_trace trace;
    static const uint32_t outside[][2] = {{3, 3}, {WIDTH, 3}}, one[][2] = {{3, 3}};
    probed_scene(gpu, "street");
    gpu_reset(gpu);
    struct glint_replay_options options = {.probes = outside, .probe_count = 2};
    assert_false(glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err));
    assert_non_null(strstr(err.message, "street.exr: pixel 160,3: outside of the picture of 160 x 90 pixels"));
    options = (struct glint_replay_options){.probes = one, .probe_count = 1, .repeat = 2};
    assert_false(glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err));
    options.repeat = 0;
    assert_true(glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err));
    assert_false(glint_replay_probe(gpu->replay, 1, &trace, &err));
    assert_true(glint_replay_run(gpu->replay, gpu->pipeline, NULL, NULL, NULL, &err));
    assert_false(glint_replay_probe(gpu->replay, 0, &trace, &err));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stories), cmocka_unit_test(test_sums),
                                       cmocka_unit_test(test_errors)};
    return cmocka_run_group_tests_name("gpu_probe", tests, gpu_set_up, gpu_tear_down);
}
