/* Settings of the march through cube maps that must not change certain values, and the counts of steps and fetches. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "room.h"
#include "unit.h"

enum { HALF = ROOM_SIZE / 2, COUNT = HALF * HALF };
enum { NOT_TRACED, HIT }; /* values of end_reasons.h */

struct rays {
    float *travelled, *normal; /* w of normal is the roughness */
    uint32_t *end, *steps, *fetches;
};

static struct rays rays_of(struct gpu *gpu, const char *const *words) {
    room_load(gpu, false);
    room_arrange(gpu, words);
    gpu_run(gpu);
    return (struct rays){gpu_floats(gpu, "travelled", NULL, NULL), gpu_floats(gpu, "normal_half", NULL, NULL),
                         gpu_uints(gpu, "cubemap_end", NULL, NULL), gpu_uints(gpu, "cubemap_steps", NULL, NULL),
                         gpu_uints(gpu, "cubemap_fetches", NULL, NULL)};
}

static void rays_free(struct rays *rays) {
    free(rays->travelled), free(rays->normal), free(rays->end), free(rays->steps), free(rays->fetches);
}

#define CUBES "screen_trace.length_m=0"

/* A step is one sample: of one texel, or of four texels between which a level of the chain is interpolated. */
static void steps_cost_their_fetches(void **state) {
    static const struct {
        const char *words[9];
        uint32_t a_step;
    } cases[] = {
        {{CUBES, "cubemap_trace.verify=false", "cubemap_trace.fallback=black", NULL}, 1},
        {{CUBES, "cubemap_trace.verify=false", "cubemap_trace.fallback=black", "cubemap_mips=plain",
          "cubemap_trace.rough_level=16", "cubemap_trace.hq_roughness=0", NULL},
         4},
        {{CUBES, "cubemap_trace.verify=false", "cubemap_trace.fallback=black", "cubemap_mips=plain",
          "cubemap_trace.rough_level=16", "cubemap_trace.hq_roughness=0", "cubemap_trace.bilinear=false", NULL},
         1}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        struct rays rays = rays_of(*state, cases[c].words);
        size_t counted = 0, first = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const double level = c ? floor(16 * (double)rays.normal[4 * i + 3]) : 0;
            if (rays.end[i] == NOT_TRACED) assert_true(rays.steps[i] == 0 && rays.fetches[i] == 0);
            else if (level >= 1 || c == 0)
                assert_int_equal(rays.fetches[i], rays.steps[i] * cases[c].a_step), ++counted;
            first += level == 1;
        }
        print_message("# %zu rays of %u fetches a step, %zu of them in the first level\n", counted, cases[c].a_step,
                      first);
        assert_true(counted > COUNT / 2 && (c == 0 || first > 20));
        rays_free(&rays);
    }
}

/* Verification costs one more sample for each refined hit. */
static void verification_costs_a_fetch(void **state) {
    struct rays off = rays_of(*state,
                              (const char *const[]){CUBES, "cubemap_trace.chain=1", "cubemap_trace.fallback=black",
                                                    "cubemap_trace.verify=false", NULL}),
                on = rays_of(*state, (const char *const[]){CUBES, "cubemap_trace.chain=1",
                                                           "cubemap_trace.fallback=black", NULL});
    size_t hits = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        if (on.end[i] != HIT || off.end[i] != HIT || on.steps[i] == 24 || on.steps[i] == 16)
            continue; /* all steps were taken */
        assert_int_equal(off.fetches[i], off.steps[i]);
        assert_int_equal(on.fetches[i], on.steps[i] + 1);
        ++hits;
    }
    assert_true(hits > COUNT / 4);
    rays_free(&off), rays_free(&on);
}

/* A proxy costs fetches for its head, its planes or its sphere, and for testing whether there is sky at its end. The room's cube maps
   have a box and a sphere. */
static void proxies_cost_their_planes(void **state) {
    struct rays rays = rays_of(*state, (const char *const[]){CUBES, "cubemap_trace=box", NULL});
    size_t kinds[2] = {0, 0};
    for (size_t i = 0; i < COUNT; ++i) {
        if (rays.end[i] == NOT_TRACED) continue;
        const bool box = rays.fetches[i] == 7 || rays.fetches[i] == 8;
        assert_true(box || rays.fetches[i] == 2 || rays.fetches[i] == 3);
        ++kinds[box];
    }
    print_message("# %zu rays ask for a box, %zu for a sphere\n", kinds[1], kinds[0]);
    assert_true(kinds[0] > 20 && kinds[1] > 20);
    rays_free(&rays);
}

/* Lookups take no steps. */
static void lookups_take_no_steps(void **state) {
    struct rays rays = rays_of(*state, (const char *const[]){CUBES, "cubemap_trace=lookup", NULL});
    for (size_t i = 0; i < COUNT; ++i) assert_true(rays.steps[i] == 0 && rays.fetches[i] == 0);
    rays_free(&rays);
}

/* Rays of one class do not change by a bit if the parameters of the other class change, and those of the other class do. */
static void classes_have_values_of_their_own(void **state) {
    static const char *const smooth[] = {"cubemap_trace.refinements=7", "cubemap_trace.steps_hq=33",
                                         "cubemap_trace.length_m=140", "cubemap_trace.scale_min=1.05"},
                             *const rough[] = {"cubemap_trace.refinements_lq=7", "cubemap_trace.steps_lq=33",
                                               "cubemap_trace.length_lq_m=140", "cubemap_trace.scale_min_lq=1.05"};
    struct rays plain = rays_of(*state, (const char *const[]){CUBES, "cubemap_trace.hq_roughness=0.3", NULL});
    for (int k = 0; k < 8; ++k) {
        const bool of_rough = k >= 4;
        const char *word = of_rough ? rough[k - 4] : smooth[k];
        struct rays rays = rays_of(*state, (const char *const[]){CUBES, "cubemap_trace.hq_roughness=0.3", word, NULL});
        size_t own = 0, moved = 0, others = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const bool same =
                memcmp(&plain.travelled[i], &rays.travelled[i], sizeof(float)) == 0 && plain.end[i] == rays.end[i];
            if ((plain.normal[4 * i + 3] > 0.3f) != of_rough) others += !same;
            else own += plain.end[i] != NOT_TRACED, moved += !same;
        }
        print_message("# %s: %zu of %zu rays move, %zu others\n", word, moved, own, others);
        assert_true(others == 0 && 2 * moved > own && own > COUNT / 5);
        rays_free(&rays);
    }
    rays_free(&plain);
}

/* The sum of the steps is the length, even if the first step alone were longer. */
static void no_hit_lies_beyond_the_length(void **state) {
    struct rays rays =
        rays_of(*state, (const char *const[]){CUBES, "cubemap_trace.first_step_m=4", "cubemap_trace.length_m=1.5",
                                              "cubemap_trace.length_lq_m=1.5", NULL});
    size_t hits = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        if (rays.end[i] != HIT) continue;
        ++hits;
        assert_true(rays.travelled[i] <= 1.5f * 1.0001f); /* rounding of a sum of floats */
    }
    print_message("# %zu hits within 1.5 m\n", hits);
    assert_true(hits > 50);
    rays_free(&rays);
}

/* An explicit first step is used, however short, and every choice has an effect. */
static void each_choice_changes_rays(void **state) {
    static const char *const choices[] = {
        "first_step_m=0.25", "secant=false", "verify=false",     "bilinear=false",  "step_back=false",
        "mass=radial",       "mass_step=0",  "mass_m=3",         "fallback=lookup", "cocoon_start=surface",
        "depth=captured",    "chain=1",      "clamp_part=0.001", "bias=0.05",       "bias_m=0.2",
        "verify_part=0.2"};
    static const char *const base[] = {CUBES, "cocoon=max", NULL};
    struct rays plain = rays_of(*state, base);
    bool all = true;
    for (size_t k = 0; k < sizeof choices / sizeof *choices; ++k) {
        char word[64];
        snprintf(word, sizeof word, "cubemap_trace.%s", choices[k]);
        struct rays rays = rays_of(*state, (const char *const[]){CUBES, "cocoon=max", word, NULL});
        size_t moved = 0;
        for (size_t i = 0; i < COUNT; ++i)
            moved += memcmp(&plain.travelled[i], &rays.travelled[i], sizeof(float)) != 0 || plain.end[i] != rays.end[i];
        print_message("# %s: %zu rays move\n", word, moved);
        all = all && moved > 0;
        rays_free(&rays);
    }
    rays_free(&plain);
    assert_true(all);
}

/* A cocoon that neither caps the sky nor ends rays has no effect. */
static void captured_depth_ignores_the_cocoon(void **state) {
    static const char *const words[3][6] = {
        {CUBES, "cubemap_trace.fallback=black", "cubemap_trace.depth=captured", NULL},
        {CUBES, "cubemap_trace.fallback=black", "cubemap_trace.depth=captured", "cocoon=max", NULL},
        {CUBES, "cubemap_trace.fallback=black", "cubemap_trace.depth=capped", "cocoon=max", NULL}};
    struct rays rays[3];
    size_t apart[3] = {0};
    for (int k = 0; k < 3; ++k) {
        rays[k] = rays_of(*state, words[k]);
        for (size_t i = 0; i < COUNT; ++i)
            apart[k] += memcmp(&rays[0].travelled[i], &rays[k].travelled[i], sizeof(float)) != 0 ||
                        rays[0].steps[i] != rays[k].steps[i];
    }
    print_message("# captured: %zu rays differ, capped: %zu\n", apart[1], apart[2]);
    assert_true(apart[1] == 0 && apart[2] > 20);
    for (int k = 0; k < 3; ++k) rays_free(&rays[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_cost_their_fetches),          cmocka_unit_test(verification_costs_a_fetch),
        cmocka_unit_test(proxies_cost_their_planes),         cmocka_unit_test(lookups_take_no_steps),
        cmocka_unit_test(classes_have_values_of_their_own),  cmocka_unit_test(no_hit_lies_beyond_the_length),
        cmocka_unit_test(captured_depth_ignores_the_cocoon), cmocka_unit_test(each_choice_changes_rays),
    };
    return cmocka_run_group_tests_name("gpu_march_settings", tests, gpu_set_up, gpu_tear_down);
}
