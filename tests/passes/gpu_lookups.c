/* Lookups without a march in mirror_box, compared with the proxies in closed form and with the contents of the cube maps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mirror_box.h"
#include "unit.h"

/* Where a ray through the proxy that a cube map has leaves it; negative: by the direction alone. */
typedef double proxy(const struct glint_cubemap *map, const double start[3], const double direction[3]);

static double out_of_box(const struct glint_cubemap *map, const double start[3], const double direction[3]) {
    (void)map; /* every inner volume is the whole box */
    int axis;
    return leave_box(start, direction, &axis);
}

/* A sphere around the centre whose radius is the mean distance of the six walls: a sixth of the sum of the box's edges for any centre. */
static double out_of_sphere(const struct glint_cubemap *map, const double start[3], const double direction[3]) {
    double from[3], radius = (mirror_box[0] + mirror_box[1] + mirror_box[2]) / 6;
    for (int k = 0; k < 3; ++k) from[k] = start[k] - map->center[k];
    double half = dot3(from, direction), root = half * half - dot3(from, from) + radius * radius;
    return root < 0 ? -1 : -half + sqrt(root);
}

static double endless(const struct glint_cubemap *map, const double start[3], const double direction[3]) {
    (void)map, (void)start, (void)direction;
    return -1;
}

static void lookups_end_on_their_proxies(void **state) {
    struct gpu *gpu = *state;
    static const struct {
        const char *variant;
        proxy *leaves;
        double p99; /* of radiance */
    } lookups[] = {{"cubemap_trace=box", out_of_box, 0.02},
                   {"cubemap_trace=sphere", out_of_sphere, 0.05},
                   {"cubemap_trace=lookup", endless, 0.05}};
    for (int i = 0; i < 3; ++i) {
        gpu_sample(
            gpu, "mirror_box", "box",
            &(struct glint_sample_options){
                .width = 240, .height = 160, .cube_size = 256, .probes_given = true, .probes = GLINT_PROBES_PERFECT});
        gpu_reset(gpu);
        gpu_use(gpu, lookups[i].variant);
        gpu_set(gpu, "screen_trace.length_m=0");
        gpu_run(gpu);
        struct rays r = rays_of(gpu);
        uint32_t *best = gpu_uints(gpu, "cubemap_best", NULL, NULL),
                 *active = gpu_uints(gpu, "active_index", NULL, NULL);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
        double *far = malloc((size_t)r.width * r.height * sizeof *far),
               *light = malloc((size_t)r.width * r.height * 3 * sizeof *light);
        assert_non_null(far);
        assert_non_null(light);
        size_t ended = 0, looked_up = 0, wrong = 0, lit = 0;
        for (uint32_t k = 0; k < r.width * r.height; ++k) {
            const struct expected *e = &r.expected[k];
            if (!e->on_floor) continue;
            char part[32];
            snprintf(part, sizeof part, "cubemap.%03u", active[best[k]]);
            const struct glint_cubemap *map = &glint_capture_find(gpu->capture, part)->cubemap;
            double direction[3], from[3], seen[3];
            for (int c = 0; c < 3; ++c) direction[c] = (e->end[c] - e->start[c]) / e->distance;
            double t = lookups[i].leaves(map, e->start, direction);
            if (t > 0) far[ended++] = fabs((double)r.travelled[k] - t) / fmax(t, 0.1);
            else wrong += !(r.travelled[k] > 3e38f), looked_up++;
            /* The cube map shows the wall behind that point, as seen from its centre. */
            for (int c = 0; c < 3; ++c)
                from[c] = t > 0 ? e->start[c] + t * direction[c] - map->center[c] : direction[c];
            int axis = 0;
            double to_wall = leave_box(map->center, from, &axis);
            for (int c = 0; c < 3; ++c) seen[c] = map->center[c] + to_wall * from[c];
            if (axis == 1 && from[1] < 0) continue; /* the floor, which is black */
            for (uint32_t c = 0; c < 3; ++c) {
                double wall = wall_light(seen, (int)c);
                light[lit++] = fabs((double)color[4 * k + c] - wall) / wall;
            }
        }
        size_t count = ended + looked_up;
        double worst = ended ? quantile(far, ended, 0.999) : 0;
        double median = quantile(light, lit, 0.5), p99 = quantile(light, lit, 0.99);
        print_message("# %s: %zu rays on the proxy, distance off by %.2g (99.9 %%); %zu by direction; radiance off by "
                      "%.3f %%, 99th percentile %.2f %%\n",
                      lookups[i].variant, ended, worst, looked_up, 100 * median, 100 * p99);
        assert_true(count > 3000 && wrong == 0);
        assert_true(i == 2 ? looked_up == count : ended * 2 > count);
        assert_true(worst <= 1e-4); /* floats: 1e-6 m for positions some metres from the camera, over at least 0.1 m */
        assert_true(median <= 0.001 && p99 <= lookups[i].p99);
        free(best), free(active), free(color), free(far), free(light);
        rays_free(&r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lookups_end_on_their_proxies)};
    return cmocka_run_group_tests_name("gpu_lookups", tests, gpu_set_up, gpu_tear_down);
}
