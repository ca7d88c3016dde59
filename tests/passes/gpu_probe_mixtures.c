/* Probed pixels of passes that average or blend: the weighted records sum up to the pass's result, each recorded colour equals its
   image, and recording does not change an image. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "probed.h"
#include "unit.h"

static const char *const rgb[] = {"r", "g", "b"}, *const below[] = {"lower_r", "lower_g", "lower_b"};

static double recorded(const struct glint_probe_record *record, const char *name) {
    return (double)glint_probe_value(record, name);
}

static const struct kept *image_of(const struct glint_probe_record *record, const struct images *images) {
    const struct glint_probe_label of = glint_probe_label("image", glint_probe_value(record, "image"));
    const float level = glint_probe_value(record, "level"); /* NaN: the record has none */
    assert_non_null(of.name);
    return level_of(images, of.name, level > 0 ? (uint32_t)level : 0);
}

/* The weighted mean of colours. */
struct mean {
    double sum[3], total, largest;
    size_t count;
};

static void mean_add(struct mean *mean, const struct glint_probe_record *record, double part) {
    const double weight = recorded(record, "weight");
    for (int c = 0; c < 3; c++) {
        mean->sum[c] += weight * recorded(record, rgb[c]);
        mean->largest = fmax(mean->largest, fabs(weight * recorded(record, rgb[c])));
    }
    mean->total += weight * part;
    mean->count++;
}

static void mean_is(const struct mean *mean, const struct glint_probe_record *record) {
    assert_true(mean->total > 0);
    for (int c = 0; c < 3; c++)
        assert_near_sum(mean->sum[c] / mean->total, recorded(record, rgb[c]),
                        mean->largest * (double)mean->count / mean->total);
}

/* The colour between texels. Devices may interpolate with weights of eight bits, so that each axis may be off by 1/256 of the
   difference of the texels. */
static void check_between(const struct glint_probe_record *record, const struct images *images, double x, double y) {
    const struct kept *image = image_of(record, images);
    const double corner[2] = {floor(x - 0.5), floor(y - 0.5)}, part[2] = {x - 0.5 - corner[0], y - 0.5 - corner[1]};
    for (uint32_t c = 0; c < 3; c++) {
        double sum = 0, low = INFINITY, high = -INFINITY;
        for (int k = 0; k < 4; k++) {
            const double u = fmin(fmax(corner[0] + (k & 1), 0), image->width - 1);
            const double v = fmin(fmax(corner[1] + (k >> 1), 0), image->height - 1);
            const double texel = held(image, (uint32_t[]){(uint32_t)u, (uint32_t)v}, c);
            sum += (k & 1 ? part[0] : 1 - part[0]) * (k >> 1 ? part[1] : 1 - part[1]) * texel;
            low = fmin(low, texel), high = fmax(high, texel);
        }
        const double tolerance = (high - low) * 2 / 256 + fabs(high) * 0x1p-20;
        if (!(fabs(sum - recorded(record, rgb[c])) <= tolerance))
            fail_msg("%s at %g,%g is %.9g, recorded %.9g", image->name, x, y, sum, recorded(record, rgb[c]));
    }
}

/* The blend of a layer's two colours. */
struct layered {
    double color[3], largest;
};
static struct layered layered(const struct glint_probe_record *layer) {
    static const char *const share[] = {"alpha_r", "alpha_g", "alpha_b"};
    struct layered made = {0};
    for (int c = 0; c < 3; c++) {
        const double s = recorded(layer, share[c]);
        assert_true(s >= 0 && s <= 1);
        made.color[c] = (1 - s) * recorded(layer, below[c]) + s * recorded(layer, rgb[c]);
        made.largest = fmax(made.largest, fmax(fabs(recorded(layer, below[c])), fabs(recorded(layer, rgb[c]))));
    }
    return made;
}

static void layered_is(const struct layered *made, const struct kept *image, const uint32_t at[2]) {
    for (uint32_t c = 0; c < 3; c++) assert_near_sum(made->color[c], held(image, at, c), made->largest);
}

static void same_rgb(const struct glint_probe_record *record, const char *const names[3], const struct kept *image,
                     uint32_t x, uint32_t y) {
    for (uint32_t c = 0; c < 3; c++) assert_kept_value(record, names[c], image, x, y, c);
}

/* The trace of one pixel, and all images of its run. */
struct recorded_pixel {
    const struct glint_probe_trace *trace;
    const struct images *images;
    const uint32_t *pixel, *texel;
};
static const struct glint_probe_record *next(const struct recorded_pixel *p, const char *slot, const char *kind,
                                             size_t *at) {
    return next_record(p->trace, slot, kind, at);
}

/* ---- Passes: each check returns the number of recorded mixtures with several parts ---- */

static size_t check_blurred(const struct recorded_pixel *p) {
    struct mean mean = {0};
    size_t at = 0;
    const struct glint_probe_record *record;
    while ((record = next(p, "resolve", "sample", &at))) {
        check_between(record, p->images, recorded(record, "x"), recorded(record, "y"));
        mean_add(&mean, record, 1);
    }
    for (uint32_t c = 0; c < 3 && mean.count; c++)
        assert_near_sum(mean.sum[c] / mean.total, held(find_kept(p->images, "reflection_half"), p->texel, c),
                        mean.largest * (double)mean.count / mean.total);
    at = 0;
    assert_non_null(record = next(p, "resolve", "attenuation", &at));
    static const char *const parts[] = {"viewer", "edge", "back_face", "foreground"};
    for (uint32_t k = 0; k < 4; k++)
        assert_kept_value(record, parts[k], find_kept(p->images, "attenuation"), p->texel[0], p->texel[1], k);
    assert_kept_value(record, "contribution", find_kept(p->images, "contribution"), p->texel[0], p->texel[1], 0);
    return mean.count > 1;
}

static size_t check_contribution(const struct recorded_pixel *p) {
    size_t at = 0;
    const struct glint_probe_record *layer = next(p, "compose", "layer", &at);
    if (!layer) return 0;
    const struct layered made = layered(layer);
    same_rgb(layer, rgb, find_kept(p->images, "reflection"), p->pixel[0], p->pixel[1]);
    same_rgb(layer, below, find_kept(p->images, "lit"), p->pixel[0], p->pixel[1]);
    layered_is(&made, find_kept(p->images, "composed"), p->pixel);
    return recorded(layer, "alpha_r") > 0;
}

static size_t check_kf2(const struct recorded_pixel *p) {
    return check_blurred(p) + check_contribution(p);
}

/* The chain is sampled between texels and levels, also with weights of eight bits: three axes. */
static size_t check_mips(const struct recorded_pixel *p) {
    struct mean mean = {0};
    double weights = 0, high = 0;
    size_t at = 0;
    for (const struct glint_probe_record *tap; (tap = next(p, "blur", "tap", &at));) {
        const uint32_t x = record_number(tap, "texel_x"), y = record_number(tap, "texel_y");
        same_rgb(tap, rgb, image_of(tap, p->images), x, y);
        assert_kept_value(tap, "part", image_of(tap, p->images), x, y, 3);
        mean_add(&mean, tap, recorded(tap, "part"));
        weights += recorded(tap, "weight");
        for (int c = 0; c < 3; c++) high = fmax(high, recorded(tap, rgb[c]));
    }
    if (!mean.count) return 0;
    assert_near_sum(weights, 1, (double)mean.count);
    for (uint32_t c = 0; c < 3 && mean.total > 0; c++) {
        const double found = held(find_kept(p->images, "reflection_blurred"), p->texel, c);
        /* Both sums have this error, and the quotient that of both. */
        const double tolerance = 3.0 / 256 * (high + fabs(found)) / mean.total + fabs(found) * 0x1p-20;
        if (!(fabs(mean.sum[c] / mean.total - found) <= tolerance))
            fail_msg("recorded %.9g, found %.9g", mean.sum[c] / mean.total, found);
    }
    return mean.count > 4; /* of two levels */
}

/* Taps that a texel of a level is computed from, or of a layer over another one: images that later passes do not overwrite must equal
   the records. */
static size_t check_levels(const struct recorded_pixel *p) {
    enum { TAPS = 64 };
    const struct glint_probe_record *taps[TAPS], *layer = NULL;
    struct mean mean = {0};
    size_t mixtures = 0, levels = 0;
    for (size_t i = 0; i < p->trace->count; i++) {
        const struct glint_probe_record *record = &p->trace->records[i];
        if (strcmp(record->pass->slot, "blur") != 0) continue;
        if (glint_probe_is(record, "tap")) {
            assert_in_range(mean.count, 0, TAPS - 1);
            taps[mean.count] = record;
            mean_add(&mean, record, recorded(record, "part"));
            continue;
        }
        const bool over = glint_probe_is(record, "layer");
        for (size_t t = 0; t < mean.count; t++) {
            const struct kept *image = image_of(taps[t], p->images);
            if (over || strcmp(image->name, "reflection_across") == 0 || recorded(taps[t], "level") == 0)
                same_rgb(taps[t], rgb, image, record_number(taps[t], "texel_x"), record_number(taps[t], "texel_y"));
        }
        if (mean.count && !(over && recorded(record, "alpha_r") == 0)) mean_is(&mean, record);
        mixtures += mean.count > 1;
        mean = (struct mean){0};
        if (over) layer = record;
        else if (layer) {
            const struct layered made = layered(layer);
            for (int c = 0; c < 3; c++) assert_near_sum(made.color[c], recorded(record, rgb[c]), made.largest);
            same_rgb(record, rgb, image_of(record, p->images), record_number(record, "texel_x"),
                     record_number(record, "texel_y"));
            layer = NULL;
            levels++;
        }
    }
    if (layer) {
        const struct layered made = layered(layer);
        layered_is(&made, find_kept(p->images, "reflection_blurred"), p->texel);
    }
    assert_in_range(levels, 0, 1);
    return mixtures;
}

static size_t check_planar(const struct recorded_pixel *p) {
    size_t at = 0;
    const struct glint_probe_record *record;
    const struct kept *map = find_kept(p->images, "planar_depth"),
                      *mirrored = find_kept(p->images, "planar_reflection");
    while ((record = next(p, "planar", "mirrored_depth", &at))) {
        const double x = recorded(record, "at_x"), y = recorded(record, "at_y");
        bool found = false; /* by a position that is accurate to 1/256 of a texel */
        for (int k = 0; k < 4; k++) {
            const double u = fmin(fmax(floor(x + (k & 1 ? 1 : -1) / 256.0), 0), map->width - 1);
            const double v = fmin(fmax(floor(y + (k >> 1 ? 1 : -1) / 256.0), 0), map->height - 1);
            const double depth_m = held(map, (uint32_t[]){(uint32_t)u, (uint32_t)v}, 0);
            found |= depth_m == recorded(record, "depth_m");
        }
        if (!found) fail_msg("planar_depth at %g,%g does not hold %g", x, y, recorded(record, "depth_m"));
    }
    at = 0;
    if (!(record = next(p, "planar", "sample", &at))) return 0;
    check_between(record, p->images, recorded(record, "x"), recorded(record, "y"));
    same_rgb(record, rgb, mirrored, p->pixel[0], p->pixel[1]);
    assert_kept_value(record, "weight", mirrored, p->pixel[0], p->pixel[1], 3);
    return 1;
}

/* Water over the bottom, the planar map over the surroundings, and both combined. */
static size_t check_water(const struct recorded_pixel *p) {
    const struct glint_probe_record *record, *layers[3];
    size_t at = 0, count = 0;
    while ((record = next(p, "water", "bottom", &at)))
        assert_kept_value(record, "thickness_m", find_kept(p->images, "water_normal"), record_number(record, "texel_x"),
                          record_number(record, "texel_y"), 3);
    for (at = 0; (record = next(p, "water", "layer", &at)); layers[count++] = record) assert_in_range(count, 0, 2);
    if (count == 0) return 0;
    assert_int_equal(count, 3);
    at = 0;
    const struct glint_probe_record *sample = next(p, "water", "sample", &at);
    if (sample) check_between(sample, p->images, recorded(sample, "x"), recorded(sample, "y"));
    for (int c = 0; c < 3; c++) {
        const double bottom =
            sample ? recorded(sample, rgb[c]) : held(find_kept(p->images, "composed"), p->pixel, (uint32_t)c);
        assert_true(recorded(layers[0], rgb[c]) == bottom);
    }
    same_rgb(layers[0], below, find_kept(p->images, "water_color"), p->pixel[0], p->pixel[1]);
    same_rgb(layers[1], rgb, find_kept(p->images, "planar_reflection"), p->pixel[0], p->pixel[1]);
    for (int c = 0; c < 3; c++) /* nothing lies behind what the planar map covers whole */
        assert_true(recorded(layers[1], "alpha_r") < 1 || recorded(layers[1], below[c]) == 0);
    const struct layered through = layered(layers[0]), mirrored = layered(layers[1]), all = layered(layers[2]);
    for (int c = 0; c < 3; c++) {
        assert_near_sum(through.color[c], recorded(layers[2], below[c]), through.largest);
        assert_near_sum(mirrored.color[c], recorded(layers[2], rgb[c]), mirrored.largest);
    }
    layered_is(&all, find_kept(p->images, "composed_water"), p->pixel);
    return 1;
}

static size_t check_lake(const struct recorded_pixel *p) {
    return check_planar(p) + check_water(p);
}

static size_t check_transparency(const struct recorded_pixel *p) {
    const struct glint_probe_record *record, *layers[2];
    struct mean mean = {0};
    size_t at = 0, count = 0;
    while ((record = next(p, "transparency", "neighbour", &at))) {
        same_rgb(record, rgb, find_kept(p->images, "transparent_reflection"), record_number(record, "texel_x"),
                 record_number(record, "texel_y"));
        mean_add(&mean, record, 1);
    }
    for (at = 0; (record = next(p, "transparency", "layer", &at)); layers[count++] = record)
        assert_in_range(count, 0, 1);
    if (count == 0) return 0;
    assert_int_equal(count, 2);
    if (mean.count) mean_is(&mean, layers[1]);
    same_rgb(layers[0], rgb, find_kept(p->images, "transparent_color"), p->pixel[0], p->pixel[1]);
    same_rgb(layers[0], below, find_kept(p->images, "composed"), p->pixel[0], p->pixel[1]);
    const struct layered through = layered(layers[0]), all = layered(layers[1]);
    for (int c = 0; c < 3; c++) assert_near_sum(through.color[c], recorded(layers[1], below[c]), through.largest);
    layered_is(&all, find_kept(p->images, "composed_transparent"), p->pixel);
    return mean.count > 1;
}

/* ---- Pipelines ---- */

static const struct way {
    const char *scene;
    size_t (*require)(const struct recorded_pixel *pixel);
    const char *words[PROBED_WORDS];
} ways[] = {
    {"street", check_kf2, {"downsample.share=0", "screen_trace=dda", "resolve=blurred", "compose=contribution"}},
    {"street", check_mips, {"downsample.share=0", "screen_trace=dda", "blur=mips"}},
    {"street", check_levels, {"downsample=mips", "screen_trace=dda", "blur=upscale_blur", "blur.width=4"}},
    {"street", check_levels, {"downsample=mips_sparse", "screen_trace=dda", "blur=upscale_blur"}},
    {"lake", check_lake, {"planar=lookup", "water=combine"}},
    {"glasshouse",
     check_transparency,
     {"transparent_downsample=nearest", "transparent_screen_trace=linear", "transparent_cubemap_trace=march",
      "transparent_resolve=hit", "transparency=trace"}},
};

static void mixtures(struct gpu *gpu, const struct way *way) {
    static uint32_t pixels[PIXELS][2];
    static struct images plain, probed;
    struct glint_error err = {0};
    size_t told_of = 0;
    probed_scene(gpu, way->scene);
    arrange_pipeline(gpu, way->words);
    draw_pixels(pixels);
    for (int floats = 0; floats < 2;
         floats++) { /* in the second run images are floats, so that stored and computed values are equal */
        free_images(&probed);
        probed_run(gpu, NULL, floats, &plain);
        probed_run(gpu, pixels, floats, &probed);
        same_images(&plain, &probed);
        free_images(&plain);
    }
    for (size_t i = 0; i < PIXELS; i++) {
        struct glint_probe_trace trace;
        const uint32_t texel[2] = {pixels[i][0] / 2, pixels[i][1] / 2};
        require(glint_replay_probe(gpu->replay, i, &trace, &err), &err);
        assert_int_equal(trace.dropped, 0);
        told_of += way->require(&(struct recorded_pixel){&trace, &probed, pixels[i], texel});
        free(trace.records);
    }
    free_images(&probed);
    print_message("# %zu mixtures\n", told_of);
    assert_true(told_of > 50);
}

static void test_blurred(void **state) {
    mixtures(*state, &ways[0]);
}
static void test_mips(void **state) {
    mixtures(*state, &ways[1]);
}
static void test_levels(void **state) {
    mixtures(*state, &ways[2]);
}
static void test_sparse_levels(void **state) {
    mixtures(*state, &ways[3]);
}
static void test_lake(void **state) {
    mixtures(*state, &ways[4]);
}
static void test_transparency(void **state) {
    mixtures(*state, &ways[5]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_blurred), cmocka_unit_test(test_mips),
                                       cmocka_unit_test(test_levels),  cmocka_unit_test(test_sparse_levels),
                                       cmocka_unit_test(test_lake),    cmocka_unit_test(test_transparency)};
    return cmocka_run_group_tests_name("gpu_probe_mixtures", tests, gpu_set_up, gpu_tear_down);
}
