/* Traced distances in mirror_box against closed forms. The camera's rays, the mirror floor and the box are computed here
   from the capture's attributes in double; nothing of the shaders is used. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "gpu.h"

static const double box[3] = {8, 4, 6};

/* The values of end reasons, as the diagnostics hold them. */
enum {
#define REASON(name, ...) END_##name,
#include "shared/end_reasons.h"
#undef REASON
};

/* One ray that starts on the mirror floor. */
struct expected {
    double distance;   /* to the wall or ceiling it meets */
    double end[3];     /* where that is, in the world */
    double end_uv[2];  /* where the end would be seen */
    bool end_in_front; /* of the camera */
    bool on_floor;
};

static double dot3(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct camera {
    double eye[3], rows[3][3], front; /* rows of the rotation, sign of view z in front */
    double scale[2], shift[2];        /* ndc = view/depth · scale + shift */
};

static struct camera camera_of(const struct glint_frame *frame) {
    struct camera c = {.front = frame->camera.view_to_clip[14]};
    const double *v = frame->camera.world_to_view, *p = frame->camera.view_to_clip;
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) {
            c.rows[r][k] = v[4 * r + k];
            c.eye[k] -= v[4 * r + k] * v[4 * r + 3];
        }
    for (int k = 0; k < 2; ++k) {
        c.scale[k] = p[5 * k];
        c.shift[k] = p[4 * k + 2] * c.front;
    }
    return c;
}

/* Distance along a ray from inside the box to its inside. */
static double leave_box(const double from[3], const double direction[3], int *axis) {
    double nearest = INFINITY;
    for (int k = 0; k < 3; ++k) {
        double t = ((direction[k] > 0 ? box[k] : 0) - from[k]) / direction[k];
        if (direction[k] == 0 || t >= nearest) continue;
        nearest = t;
        *axis = k;
    }
    return nearest;
}

static struct expected expect(const struct camera *c, double u, double v) {
    struct expected e = {0};
    const double ndc[2] = {2 * u - 1, 1 - 2 * v};
    double view[3] = {(ndc[0] - c->shift[0]) / c->scale[0], (ndc[1] - c->shift[1]) / c->scale[1], c->front};
    double ray[3], point[3];
    for (int k = 0; k < 3; ++k) ray[k] = c->rows[0][k] * view[0] + c->rows[1][k] * view[1] + c->rows[2][k] * view[2];
    double length = sqrt(dot3(ray, ray));
    for (int k = 0; k < 3; ++k) ray[k] /= length;
    int axis = 0;
    double t = leave_box(c->eye, ray, &axis);
    e.on_floor = axis == 1 && ray[1] < 0;
    if (!e.on_floor) return e;
    for (int k = 0; k < 3; ++k) point[k] = c->eye[k] + t * ray[k];
    point[1] = 0;
    ray[1] = -ray[1];
    e.distance = leave_box(point, ray, &axis);
    double from_eye[3], seen[3];
    for (int k = 0; k < 3; ++k) {
        e.end[k] = point[k] + e.distance * ray[k];
        from_eye[k] = e.end[k] - c->eye[k];
    }
    for (int k = 0; k < 3; ++k) seen[k] = dot3(c->rows[k], from_eye);
    double depth = seen[2] * c->front;
    e.end_in_front = depth > 0;
    e.end_uv[0] = 0.5 + 0.5 * (seen[0] / depth * c->scale[0] + c->shift[0]);
    e.end_uv[1] = 0.5 - 0.5 * (seen[1] / depth * c->scale[1] + c->shift[1]);
    return e;
}

/* Everything about the last run's rays. */
struct rays {
    uint32_t width, height; /* half resolution */
    float *travelled, *screen_travelled;
    uint32_t *finished, *screen_end, *cubemap_end;
    struct expected *expected;
};

static struct rays rays_of(struct gpu *gpu) {
    struct rays r = {0};
    uint32_t full_width, full_height;
    float *depth = gpu_floats(gpu, "composed", &full_width, &full_height);
    free(depth);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL);
    r.travelled = gpu_floats(gpu, "travelled", &r.width, &r.height);
    r.screen_travelled = gpu_floats(gpu, "screen_travelled", NULL, NULL);
    r.finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    r.screen_end = gpu_uints(gpu, "screen_end", NULL, NULL);
    r.cubemap_end = gpu_uints(gpu, "cubemap_end", NULL, NULL);
    r.expected = calloc((size_t)r.width * r.height, sizeof *r.expected);
    assert_non_null(r.expected);
    struct camera camera = camera_of(glint_capture_frame(gpu->capture));
    for (uint32_t i = 0; i < r.width * r.height; ++i) {
        double x = 2 * (i % r.width) + (pick[i] & 1) + 0.5, y = 2 * (i / r.width) + (pick[i] >> 1) + 0.5;
        r.expected[i] = expect(&camera, x / full_width, y / full_height);
    }
    free(pick);
    return r;
}

static void rays_free(struct rays *r) {
    free(r->travelled);
    free(r->screen_travelled);
    free(r->finished);
    free(r->screen_end);
    free(r->cubemap_end);
    free(r->expected);
}

/* Prints and returns quantiles of the relative error over the marked rays with distances in a range. */
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

static void load(struct gpu *gpu) {
    gpu_sample(
        gpu, "mirror_box", "box",
        &(struct glint_sample_options){
            .width = 240, .height = 160, .cube_size = 256, .probes_given = true, .probes = GLINT_PROBES_PERFECT});
    gpu_reset(gpu);
    gpu_set(gpu, "cubemap_trace.skip_volume=false"); /* the inner volume is the box itself: nothing would be marched */
}

static void fine_steps(struct gpu *gpu) {
    gpu_set(gpu, "cubemap_trace.first_step_m=0.05");
    gpu_set(gpu, "cubemap_trace.steps_hq=256");
    gpu_set(gpu, "cubemap_trace.refinements=8");
    gpu_set(gpu, "cubemap_trace.length_m=30");
}

/* Floor rays that the cube-map trace ended with a hit; the others are counted. */
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
    load(gpu);
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
    load(gpu);
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t floor, missed;
    bool *marked = cubemap_hits(&r, &floor, &missed);
    struct errors e = near_and_far(&r, marked, "cube maps alone, the slides' 24 steps");
    print_message("# of %zu rays %zu found nothing\n", floor, missed);
    /* The last bracket is a step of 0.2 of the distance halved three times, 2.5 %, and the secant lies inside. */
    assert_true(e.median <= 0.025 && missed * 50 < floor);
    free(marked);
    rays_free(&r);
}

static void the_exact_tracer_is_exact(void **state) {
    struct gpu *gpu = *state;
    load(gpu);
    gpu_use(gpu, "cubemap_trace=exact");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_run(gpu);
    struct rays r = rays_of(gpu);
    size_t floor, missed;
    bool *marked = cubemap_hits(&r, &floor, &missed);
    struct errors e = near_and_far(&r, marked, "exact");
    print_message("# of %zu rays %zu found nothing\n", floor, missed);
    assert_true(floor > 3000 && missed * 1000 < floor);
    assert_true(e.median <= 0.001); /* what is asked of the reference */
    assert_true(e.p99 <= 0.01); /* rays into corners, where a texel holds two walls: half a texel is 0.4 % at 45° */
    free(marked);
    rays_free(&r);
}

/* Inside an inner volume nothing is marched, and the walls of this one are the box itself. */
static void an_inner_volume_is_skipped(void **state) {
    struct gpu *gpu = *state;
    size_t steps[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        load(gpu);
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

/* Floor rays whose end is seen: the box is convex, so that nothing is hidden inside the picture. */
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
        load(gpu);
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
            /* Ends within a half-resolution texel of the border, or of the surface they start from, may be lost. */
            assert_true(found * 100 >= visible * 97 && invented * 100 <= visible);
        }
        free(marked);
        rays_free(&r);
    }
}

/* A narrow view of the floor: most rays leave it, and go on from there. */
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
    assert_true(e.median <= 0.005 && e.p99 <= 0.03); /* from the surface, not from where they left */
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
    assert_true(wrong * 100 <= reached + short_of); /* a kink between walls may be cut short */
    rays_free(&r);
}

/* The walls' light, as the scene states it. */
static double wall_light(const double p[3], int component) {
    if (component == 0) return 0.55 + 0.35 * sin(1.3 * p[0] + 0.7 * p[1]);
    if (component == 1) return 0.50 + 0.35 * sin(1.1 * p[1] + 0.9 * p[2]);
    return 0.55 + 0.35 * sin(1.2 * p[2] - 0.8 * p[0]);
}

/* Colour from the screen and from the cube maps, each alone and one after the other. */
static void the_floor_shows_the_walls_light(void **state) {
    struct gpu *gpu = *state;
    const char *const settings[] = {"screen_trace.length_m=0", "screen_trace.steps=128"};
    for (int i = 0; i < 2; ++i) {
        load(gpu);
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
        /* Half floats hold 0.05 %. Interpolation errs by an eighth of a texel squared times the light's curvature, less
           than that; at the foot of the walls it mixes in the floor, which is black, over one texel. */
        assert_true(count > 9000 && median <= 0.001 && p99 <= 0.02);
        free(color), free(errors);
        rays_free(&r);
    }
}

static void a_thousand_kilometres_change_nothing(void **state) {
    struct gpu *gpu = *state;
    load(gpu);
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
        cmocka_unit_test(an_inner_volume_is_skipped),
        cmocka_unit_test(the_screen_alone_meets_the_closed_form),
        cmocka_unit_test(rays_that_leave_the_screen_go_on_from_there),
        cmocka_unit_test(the_cube_map_trace_spends_its_length_after_the_screens),
        cmocka_unit_test(the_floor_shows_the_walls_light),
        cmocka_unit_test(a_thousand_kilometres_change_nothing),
    };
    return cmocka_run_group_tests_name("gpu_mirror_box", tests, gpu_set_up, gpu_tear_down);
}
