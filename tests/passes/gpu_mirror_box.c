/* Traced distances in mirror_box compared with closed forms. The camera's rays, the mirror floor and the box are computed here in
   double from the attributes of the capture, independently of the shaders. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mirror_box.h"
#include "unit.h"

/* Prints and returns quantiles of the relative error of the marked rays with distances in a range. */
struct errors {
    double median, p99;
    size_t count;
};
static struct errors errors_of(const struct rays *r, const bool *marked, double low, double high, const char *what) {
    size_t count = 0;
    double *errors = malloc((size_t)r->width * r->height * sizeof *errors);
    assert_non_null(errors);
    for (uint32_t i = 0; i < r->width * r->height; ++i) {
        double truth = r->expected[i].distance;
        if (!marked[i] || truth < low || truth >= high) continue;
        errors[count++] = fabs((double)r->travelled[i] - truth) / truth;
    }
    struct errors e = {0, 0, count};
    if (count > 0) e = (struct errors){quantile(errors, count, 0.5), quantile(errors, count, 0.99), count};
    free(errors);
    print_message("# %-52s %6zu rays: median %.4f %%, 99th percentile %.4f %%\n", what, e.count, 100 * e.median,
                  100 * e.p99);
    return e;
}

static struct errors near_and_far(const struct rays *r, const bool *marked, const char *what) {
    char text[128];
    snprintf(text, sizeof text, "%s, contacts nearer than 1 m", what);
    errors_of(r, marked, 0, 1, text);
    snprintf(text, sizeof text, "%s, farther", what);
    errors_of(r, marked, 1, INFINITY, text);
    return errors_of(r, marked, 0, INFINITY, what);
}

static void load_box(struct gpu *gpu) {
    gpu_sample(
        gpu, "mirror_box", "box",
        &(struct glint_sample_options){
            .width = 240, .height = 160, .cube_size = 256, .probes_given = true, .probes = GLINT_PROBES_PERFECT});
    gpu_reset(gpu);
    gpu_set(
        gpu,
        "cubemap_trace.skip_volume=false"); /* the inner volume is the box itself, so that nothing would be marched */
}

static void fine_steps(struct gpu *gpu) {
    gpu_set(gpu, "cubemap_trace.first_step_m=0.05");
    gpu_set(gpu, "cubemap_trace.steps_hq=256");
    gpu_set(gpu, "cubemap_trace.refinements=8");
    gpu_set(gpu, "cubemap_trace.length_m=30");
}

/* Marks rays from the floor that the cube-map trace ended with a hit, and counts the others. */
static bool *cubemap_hits(const struct rays *r, size_t *floor, size_t *missed) {
    bool *marked = calloc((size_t)r->width * r->height, 1);
    assert_non_null(marked);
    *floor = *missed = 0;
    for (uint32_t i = 0; i < r->width * r->height; ++i) {
        if (!r->expected[i].on_floor) continue;
        ++*floor;
        marked[i] = r->cubemap_end[i] == END_hit;
        *missed += !marked[i];
    }
    return marked;
}

static void cube_maps_alone_meet_the_closed_form(void **state) {
    struct gpu *gpu = *state;
    load_box(gpu);
    gpu_set(gpu, "screen_trace.length_m=0");
    fine_steps(gpu);
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t floor, missed;
    bool *marked = cubemap_hits(&r, &floor, &missed);
    struct errors e = near_and_far(&r, marked, "cube maps alone, 256 steps from 0.05 m");
    assert_true(floor > 3000);
    assert_int_equal(missed, 0); /* the box is closed */
    assert_true(e.median <= 0.005 && e.p99 <= 0.03);
    free(marked);
    rays_free(&r);
}

static void cube_maps_alone_with_the_slides_steps(void **state) {
    struct gpu *gpu = *state;
    load_box(gpu);
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t floor, missed;
    bool *marked = cubemap_hits(&r, &floor, &missed);
    struct errors e = near_and_far(&r, marked, "cube maps alone, the slides' 24 steps");
    print_message("# of %zu rays %zu found nothing\n", floor, missed);
    /* The last interval is a step of 0.2 of the distance, halved three times, 2.5 %, and the secant is inside. */
    assert_true(e.median <= 0.025 && missed * 50 < floor);
    free(marked);
    rays_free(&r);
}

static void the_exact_tracer_is_exact(void **state) {
    struct gpu *gpu = *state;
    load_box(gpu);
    gpu_use(gpu, "cubemap_trace=exact");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t floor, missed;
    bool *marked = cubemap_hits(&r, &floor, &missed);
    struct errors e = near_and_far(&r, marked, "exact");
    print_message("# of %zu rays %zu found nothing\n", floor, missed);
    assert_true(floor > 3000 && missed * 1000 < floor);
    assert_true(e.median <= 0.001); /* the requirement for the reference */
    assert_true(e.p99 <= 0.01); /* rays into corners, where a texel covers two walls: half a texel is 0.4 % at 45° */
    free(marked);
    rays_free(&r);
}

/* Skipping cells of coarser levels does not change the ends of rays, with far fewer steps. */
static void the_exact_tracer_may_skip_what_is_far(void **state) {
    struct gpu *gpu = *state;
    struct rays r[2];
    double steps[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        load_box(gpu);
        gpu_use(gpu, "cubemap_trace=exact");
        gpu_use(gpu, "cubemap_mips=plain");
        gpu_set(gpu, "cubemap_mips.join=nearest");
        gpu_set(gpu, "screen_trace.length_m=0");
        if (i == 1) gpu_set(gpu, "cubemap_trace.skip=true");
        gpu_run(gpu);
        r[i] = rays_of(gpu);
        uint32_t *taken = gpu_uints(gpu, "cubemap_steps", NULL, NULL);
        for (uint32_t k = 0; k < r[i].width * r[i].height; ++k) steps[i] += r[i].expected[k].on_floor ? taken[k] : 0;
        free(taken);
    }
    size_t floor, missed, other = 0;
    bool *marked = cubemap_hits(&r[1], &floor, &missed);
    struct errors e = near_and_far(&r[1], marked, "exact, with skips");
    /* the position is accurate to 2^-25 of a texel; in a corner either wall is right */
    for (uint32_t k = 0; k < r[0].width * r[0].height; ++k)
        other += marked[k] && !(fabsf(r[1].travelled[k] / r[0].travelled[k] - 1) < 1e-5F);
    print_message("# %.0f steps instead of %.0f, %zu of %zu rays end elsewhere\n", steps[1], steps[0], other, floor);
    assert_true(missed * 1000 < floor && other * 200 < floor);
    assert_true(e.median <= 0.001 && e.p99 <= 0.01);
    assert_true(4 * steps[1] < steps[0]);
    free(marked);
    rays_free(&r[0]);
    rays_free(&r[1]);
}

/* There is no march inside of an inner volume, and the walls of this one are the box. */
static void an_inner_volume_is_skipped(void **state) {
    struct gpu *gpu = *state;
    size_t steps[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        load_box(gpu);
        gpu_set(gpu, "screen_trace.length_m=0");
        fine_steps(gpu);
        if (i == 1) gpu_set(gpu, "cubemap_trace.skip_volume=true");
        gpu_run(gpu);
        struct rays r = rays_of(gpu);
        size_t floor, missed;
        bool *marked = cubemap_hits(&r, &floor, &missed);
        uint32_t *taken = gpu_uints(gpu, "cubemap_steps", NULL, NULL);
        for (uint32_t k = 0; k < r.width * r.height; ++k) steps[i] += marked[k] ? taken[k] : 0;
        struct errors e = near_and_far(&r, marked, i ? "inner volume skipped" : "inner volume marched");
        assert_true(e.median <= 0.005 && e.p99 <= 0.03 && missed == 0);
        free(taken);
        free(marked);
        rays_free(&r);
    }
    print_message("# %zu steps instead of %zu\n", steps[1], steps[0]);
    assert_true(2 * steps[1] < steps[0]);
}

/* Marks rays from the floor whose end is visible: the box is convex, so that nothing on screen is occluded. */
static bool *screen_hits(const struct rays *r, size_t *visible, size_t *found, size_t *invented) {
    bool *marked = calloc((size_t)r->width * r->height, 1);
    assert_non_null(marked);
    *visible = *found = *invented = 0;
    for (uint32_t i = 0; i < r->width * r->height; ++i) {
        const struct expected *e = &r->expected[i];
        if (!e->on_floor) continue;
        bool seen = e->end_in_front && e->end_uv[0] > 0 && e->end_uv[0] < 1 && e->end_uv[1] > 0 && e->end_uv[1] < 1;
        *visible += seen;
        *found += seen && r->finished[i];
        *invented += !seen && r->finished[i];
        marked[i] = r->finished[i] != 0;
    }
    return marked;
}

static void the_screen_alone_meets_the_closed_form(void **state) {
    struct gpu *gpu = *state;
    const char *const steps[] = {"screen_trace.steps=256", NULL};
    for (int i = 0; i < 2; ++i) {
        load_box(gpu);
        gpu_set(gpu, "cubemap_trace.fallback=black");
        if (steps[i]) gpu_set(gpu, steps[i]);
        gpu_run(gpu);
        struct rays r = rays_of(gpu);
        size_t visible, found, invented;
        bool *marked = screen_hits(&r, &visible, &found, &invented);
        struct errors e =
            near_and_far(&r, marked, steps[i] ? "screen alone, 256 steps" : "screen alone, default steps");
        print_message("# of %zu rays with a visible end %zu ended on screen; %zu others did\n", visible, found,
                      invented);
        if (steps[i]) {
            assert_true(visible > 1000);
            assert_true(e.median <= 0.005 && e.p99 <= 0.03);
            /* ends within a half-resolution texel of the border, or of the surface where they start, may be missed */
            assert_true(found * 100 >= visible * 97 && invented * 100 <= visible);
        }
        free(marked);
        rays_free(&r);
    }
}

/* A narrow view of the floor: most rays leave the screen and continue in cube maps. */
static void load_narrow(struct gpu *gpu) {
    gpu_sample(gpu, "mirror_box", "narrow",
               &(struct glint_sample_options){.width = 240,
                                              .height = 160,
                                              .cube_size = 256,
                                              .probes_given = true,
                                              .probes = GLINT_PROBES_PERFECT,
                                              .fov_y_rad = 0.5,
                                              .camera_given = true,
                                              .eye = {0.6, 1.2, 3.1},
                                              .target = {6.5, 0.0, 2.9}});
    gpu_reset(gpu);
    gpu_set(gpu, "cubemap_trace.skip_volume=false");
}

static void rays_that_leave_the_screen_go_on_from_there(void **state) {
    struct gpu *gpu = *state;
    load_narrow(gpu);
    fine_steps(gpu);
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    bool *left = calloc((size_t)r.width * r.height, 1);
    assert_non_null(left);
    size_t far = 0;
    for (uint32_t i = 0; i < r.width * r.height; ++i) {
        left[i] = r.expected[i].on_floor && !r.finished[i] && r.screen_travelled[i] > 0;
        if (!left[i]) continue;
        far += r.screen_travelled[i] > 0.5f;
        assert_true(r.travelled[i] >= r.screen_travelled[i]);
    }
    assert_true(far > 500);
    struct errors e = near_and_far(&r, left, "left the screen, then cube maps");
    assert_true(e.median <= 0.005 && e.p99 <= 0.03); /* from the surface, not from where they left the screen */
    free(left);
    rays_free(&r);
}

static void the_cube_map_trace_spends_its_length_after_the_screens(void **state) {
    struct gpu *gpu = *state;
    load_narrow(gpu);
    fine_steps(gpu);
    gpu_set(gpu, "cubemap_trace.length_m=1");
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t reached = 0, short_of = 0, wrong = 0;
    for (uint32_t i = 0; i < r.width * r.height; ++i) {
        if (!r.expected[i].on_floor || r.finished[i] || !(r.screen_travelled[i] > 0.5f)) continue;
        double rest = r.expected[i].distance - (double)r.screen_travelled[i];
        bool hit = r.cubemap_end[i] == END_hit;
        reached += rest < 0.95 && hit;
        short_of += rest > 1.05 && !hit;
        wrong += (rest < 0.95 && !hit) || (rest > 1.05 && hit);
    }
    print_message("# a length of 1 m reached %zu walls that a ray from the surface would not, and %zu not; %zu wrong\n",
                  reached, short_of, wrong);
    assert_true(reached > 50 && short_of > 50);
    assert_true(wrong * 100 <= reached + short_of); /* a corner between walls may be cut */
    rays_free(&r);
}

/* Colour from the screen, from the cube maps, and from both in sequence. */
static void the_floor_shows_the_walls_light(void **state) {
    struct gpu *gpu = *state;
    const char *const settings[] = {"screen_trace.length_m=0", "screen_trace.steps=128"};
    for (int i = 0; i < 2; ++i) {
        load_box(gpu);
        fine_steps(gpu);
        gpu_set(gpu, settings[i]);
        gpu_run(gpu);
        struct rays r = rays_of(gpu);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
        double *errors = malloc((size_t)r.width * r.height * 3 * sizeof *errors);
        assert_non_null(errors);
        size_t count = 0;
        for (uint32_t k = 0; k < 3 * r.width * r.height; ++k) {
            const struct expected *e = &r.expected[k / 3];
            if (!e->on_floor) continue;
            double light = wall_light(e->end, (int)(k % 3));
            errors[count++] = fabs((double)color[4 * (k / 3) + k % 3] - light) / light;
        }
        double median = quantile(errors, count, 0.5), p99 = quantile(errors, count, 0.99);
        print_message("# %s: radiance of %zu rays, median %.3f %%, 99th percentile %.2f %%\n", settings[i], count / 3,
                      100 * median, 100 * p99);
        /* Half floats have an error of 0.05 %. That of interpolation, an eighth of a texel squared times the curvature of the light, is
           smaller; at the foot of the walls the black floor is mixed in over one texel. */
        assert_true(count > 9000 && median <= 0.001 && p99 <= 0.02);
        free(color), free(errors);
        rays_free(&r);
    }
}

static void a_thousand_kilometres_change_nothing(void **state) {
    struct gpu *gpu = *state;
    load_box(gpu);
    gpu_run(gpu);
    uint32_t width, height;
    float *here = gpu_floats(gpu, "reflection", &width, &height);
    gpu_sample(gpu, "mirror_box", "moved",
               &(struct glint_sample_options){.width = 240,
                                              .height = 160,
                                              .cube_size = 256,
                                              .probes_given = true,
                                              .probes = GLINT_PROBES_PERFECT,
                                              .offset = {1e6, 0, -1e6}});
    gpu_run(gpu);
    float *there = gpu_floats(gpu, "reflection", NULL, NULL);
    size_t count = 0, lit = 0;
    double *errors = malloc((size_t)width * height * 3 * sizeof *errors);
    assert_non_null(errors);
    for (size_t i = 0; i < (size_t)width * height * 4; ++i) {
        if (i % 4 == 3) continue;
        double a = (double)here[i], b = (double)there[i];
        lit += a > 0;
        errors[count++] = a == b ? 0 : fabs(a - b) / fmax(fabs(a), fabs(b));
    }
    double p99 = quantile(errors, count, 0.99);
    print_message("# moved by 1,000 km: 99th percentile %.3g relative\n", p99);
    assert_true(lit > count / 4);
    assert_true(p99 <= 1e-3);
    free(errors);
    free(here);
    free(there);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_maps_alone_meet_the_closed_form),
        cmocka_unit_test(cube_maps_alone_with_the_slides_steps),
        cmocka_unit_test(the_exact_tracer_is_exact),
        cmocka_unit_test(the_exact_tracer_may_skip_what_is_far),
        cmocka_unit_test(an_inner_volume_is_skipped),
        cmocka_unit_test(the_screen_alone_meets_the_closed_form),
        cmocka_unit_test(rays_that_leave_the_screen_go_on_from_there),
        cmocka_unit_test(the_cube_map_trace_spends_its_length_after_the_screens),
        cmocka_unit_test(the_floor_shows_the_walls_light),
        cmocka_unit_test(a_thousand_kilometres_change_nothing),
    };
    return cmocka_run_group_tests_name("gpu_mirror_box", tests, gpu_set_up, gpu_tear_down);
}
