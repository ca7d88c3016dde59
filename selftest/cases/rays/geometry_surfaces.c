/* Surfaces that rays start from: the pixel that is picked in a block, and the normals that are drawn around its normal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/rays/rays_lists.h"
#include "glint/sort.h"
#include "oracles/depth_traversal.h"
#include "oracles/plane_scene.h"

enum { WIDE = 97, HIGH = 61 };

/* The results of downsampling at full resolution, in world space. */
struct drawn {
    uint32_t width, height;
    float *depth_m, *normal, *jittered, *cone, *inverse;
    struct depth_grid grid;
};

static bool drawn_get(struct drawn *d, struct case_run *run) {
    d->depth_m = case_run_floats(run, "depth_half", &d->width, &d->height);
    d->inverse = case_run_floats(run, "inverse_half", NULL, NULL);
    d->normal = case_run_floats(run, "normal_half", NULL, NULL);
    d->jittered = case_run_floats(run, "normal_jittered", NULL, NULL);
    d->cone = case_run_floats(run, "cone_half", NULL, NULL);
    if (run->ok)
        depth_grid_init(&d->grid, glint_capture_frame(run->capture), d->width, d->height, d->depth_m, d->normal);
    return run->ok;
}

static void drawn_free(struct drawn *d) {
    free(d->depth_m);
    free(d->inverse);
    free(d->normal);
    free(d->jittered);
    free(d->cone);
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A pixel's unit normal, the drawn normal and the direction to the viewer; false if the pixel has no ray. */
struct pixel {
    double normal[3], drawn[3], to_viewer[3],
        height; /* height: of the ray that the drawn normal leads to, over the surface */
};

static bool pixel_of(const struct drawn *d, uint32_t i, struct pixel *p) {
    struct depth_ray ray;
    if (!depth_ray_init(&ray, &d->grid, i % d->width, i / d->width)) return false;
    const double length = sqrt(dot(ray.origin, ray.origin));
    memset(p->to_viewer, 0, sizeof p->to_viewer);
    for (uint32_t k = 0; k < 3; k++) {
        p->normal[k] = (double)d->normal[4 * i + k];
        p->drawn[k] = (double)d->jittered[4 * i + k];
        for (int r = 0; r < 3; r++) p->to_viewer[k] -= d->grid.rows[r][k] * ray.origin[r] / length;
    }
    p->height = 2 * dot(p->drawn, p->to_viewer) / dot(p->drawn, p->drawn) * dot(p->drawn, p->normal) -
                dot(p->to_viewer, p->normal);
    return true;
}

static bool run_surface(struct case_run *run, const struct replay_case *c, double roughness, struct drawn *d) {
    const struct plane_scene scene = {.rays = (enum plane_scene_rays)c->number, .seed = 1000, .roughness = roughness};
    const struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
    case_run_pipeline(run, c->use);
    case_run_plain(run, &plain);
    return drawn_get(d, run);
}

/* ---- Normals ---- */

static void check_smooth(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const float roughness = strstr(c->name, "1e-6") ? 1e-6f : 0;
    struct drawn d = {0};
    if (run_surface(run, c, (double)roughness, &d))
        for (uint32_t i = 0; i < d.width * d.height; i++) {
            struct pixel p;
            if (!pixel_of(&d, i, &p)) continue;
            double error =
                fmax(fabs(sqrt(dot(p.normal, p.normal)) - 1), fabs((double)d.inverse[i] * (double)d.depth_m[i] - 1));
            for (uint32_t k = 0; k < 3; k++) error = fmax(error, fabs(p.drawn[k] - p.normal[k]));
            error = fmax(error, (double)d.cone[i]);
            if (d.jittered[4 * i + 3] != roughness) error = INFINITY;
            if (roughness == 0 && memcmp(&d.normal[4 * i], &d.jittered[4 * i], 3 * sizeof(float))) error = INFINITY;
            finding_compare(finding, error, "pixel %u,%u: found %.9g %.9g %.9g, expected %.9g %.9g %.9g", i % d.width,
                            i / d.width, p.drawn[0], p.drawn[1], p.drawn[2], p.normal[0], p.normal[1], p.normal[2]);
        }
    drawn_free(&d);
}

/* No drawn normal reflects a ray below the surface, and no cone reaches below it; most drawn normals differ from the surface's. */
static void check_horizon(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    size_t others = 0, all = 0;
    for (int step = 1; step <= 4; step++) {
        struct drawn d = {0};
        if (run_surface(run, c, 0.25 * step, &d))
            for (uint32_t i = 0; i < d.width * d.height; i++) {
                struct pixel p;
                if (!pixel_of(&d, i, &p)) continue;
                const double cone = (double)d.cone[i];
                all++;
                others += 1 - dot(p.normal, p.drawn) > 1e-6;
                double error = fmax(-p.height, sin(fmin(cone, 1.5707963)) - p.height);
                error = fmax(error, fabs(dot(p.drawn, p.drawn) - 1));
                finding_compare(finding, error,
                                "pixel %u,%u, roughness %g: a ray %.9g above its surface, with a cone of %.9g",
                                i % d.width, i / d.width, 0.25 * step, p.height, cone);
            }
        drawn_free(&d);
    }
    if (run->ok && 2 * others < all) finding_compare(finding, INFINITY, "%zu of %zu normals are drawn", others, all);
}

/* The Kolmogorov distance of values from the uniform distribution in [0, 1]. */
static double unevenness(double *values, size_t count) {
    double most = 0;
    glint_sort_doubles(values, count);
    for (size_t i = 0; i < count; i++)
        most = fmax(
            most, fmax(fabs((double)i / (double)count - values[i]), fabs((double)(i + 1) / (double)count - values[i])));
    return most;
}

/* GGX of roughness 1 seen from above has visible normals with density cos θ/π, so that cos² θ is uniform in [0, 1], as is the azimuth. Normals beyond
   45° reflect below the horizon and are drawn again. */
static void check_roughest(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    struct drawn d = {0};
    double *values = malloc(2 * (size_t)WIDE * HIGH * sizeof *values);
    size_t n = 0;
    if (values && run_surface(run, c, 1, &d)) {
        for (uint32_t i = 0; i < d.width * d.height; i++) {
            struct pixel p;
            if (!pixel_of(&d, i, &p)) continue;
            const double cosine = dot(p.normal, p.drawn), *axis = p.normal;
            const double side[3] = {axis[1], -axis[0], 0}, wide = hypot(side[0], side[1]);
            const double up[3] = {axis[2] * axis[0], axis[2] * axis[1], -wide * wide};
            values[n] = 2 * cosine * cosine - 1;
            values[WIDE * HIGH + n++] =
                0.5 + atan2(dot(up, p.drawn), dot(side, p.drawn)) / (2 * 3.14159265358979323846);
        }
        finding_compare(finding, unevenness(values, n), "squared cosines of %zu normals", n);
        finding_compare(finding, unevenness(values + WIDE * HIGH, n), "azimuths of %zu normals", n);
        finding->values = 2 * n;
    }
    free(values);
    drawn_free(&d);
}

/* ---- Which pixel represents a block ---- */

/* The pixel that is picked in a block of inverse depths, which are 0 for sky and -1 outside of the picture. A gap of a twentieth divides the block in
   two sides, of which the one with more pixels counts, or the near one if both are equal; of two diagonals every other block takes the far one. */
static uint32_t pick_of(const double inverse[4], uint32_t x, uint32_t y, uint32_t frame) {
    static const uint32_t preferred[4] = {0, 3, 1, 2};
    double near = 0, far = INFINITY;
    bool nearer[4], is_near = true, in[4];
    uint32_t count = 0, nears = 0;
    for (int i = 0; i < 4; i++) {
        in[i] = inverse[i] >= 0;
        if (in[i]) near = fmax(near, inverse[i]), far = fmin(far, inverse[i]), count++;
    }
    for (int i = 0; i < 4; i++) nears += nearer[i] = in[i] && 2 * inverse[i] > near + far;
    if (near > 1.05 * far) {
        is_near = 2 * nears >= count;
        if (nears == 2 && nearer[0] == nearer[3]) is_near = (x + y) % 2 == 0;
        for (int i = 0; i < 4; i++) in[i] = in[i] && nearer[i] == is_near;
    }
    for (uint32_t i = 0; i < 4; i++)
        if (in[preferred[frame % 4] ^ i]) return preferred[frame % 4] ^ i;
    return 0;
}

static void check_pick(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    static const char *const channels[1] = {"depth.Z"};
    const struct plane_scene scene = {
        .rays = RAYS_ANY, .stipples = c->number == 1, .rails = c->number == 2, .seed = 2000};
    struct plain plain = plane_scene_capture(&scene, WIDE, HIGH);
    float *full = malloc((size_t)WIDE * HIGH * sizeof *full);
    case_run_pipeline(run, c->use);
    for (plain.frame = 4; plain.frame < 8; plain.frame++) {
        uint32_t width = 0, height = 0;
        case_run_plain(run, &plain);
        uint32_t *pick = case_run_uints(run, "pick", &width, &height);
        float *depth_m = case_run_floats(run, "depth_half", NULL, NULL);
        run->ok = run->ok && full &&
                  glint_capture_read(run->capture, glint_capture_find(run->capture, "gbuffer"), channels, 1, GLINT_F32,
                                     full, 0, run->err);
        for (uint32_t i = 0; run->ok && i < width * height; i++) {
            double inverse[4];
            for (uint32_t k = 0; k < 4; k++) {
                const uint32_t x = 2 * (i % width) + (k & 1), y = 2 * (i / width) + (k >> 1);
                inverse[k] = x < WIDE && y < HIGH ? 1 / (double)full[y * WIDE + x] : -1;
            }
            const uint32_t place = pick_of(inverse, i % width, i / width, plain.frame);
            const float of_it = full[(2 * (i / width) + (place >> 1)) * WIDE + 2 * (i % width) + (place & 1)];
            const uint32_t expected = place + (isinf(of_it) ? 8 : 0); /* the sky reflects nothing */
            finding_compare(finding, pick[i] == expected && depth_m[i] == of_it ? 0 : INFINITY,
                            "frame %u, block %u,%u: found %u at %.9g m, expected %u at %.9g m", plain.frame, i % width,
                            i / width, pick[i], (double)depth_m[i], expected, (double)of_it);
        }
        free(pick);
        free(depth_m);
    }
    free(full);
}

/* clang-format off */
#define DRAWN "downsample=none "
#define KOLMOGOROV "1.95/sqrt(4500), which one of a thousand samples of the true distribution passes"
static const struct replay_case items[] = {
    {"roughness 0", "the normal itself, and no cone", "absolute", 4.8e-7, "four times 2^-23: Vulkan grants 2.5 ULP to a division, 2 to an inverse square root", check_smooth, DRAWN, RAYS_ANY, false},
    {"roughness 1e-6", "normals that round to the surface's own normal", "absolute", 7.2e-7, "the same, and three rounded products of a tangent frame and their sums", check_smooth, DRAWN, RAYS_ANY, false},
    {"roughness 1", "GGX from above: uniform squared cosines, uniform azimuths", "Kolmogorov's distance", 0.029, KOLMOGOROV, check_roughest, DRAWN, RAYS_BACK, false},
    {"drawn rays above the horizon", "GGX at grazing views, with half of its lobe as cones", "absolute", 2e-6, "sums of products of unit vectors, 2^-24 each; the arcs near a right angle", check_horizon, DRAWN "downsample.share=0.5", RAYS_GRAZING, false},
    {"drawn rays above the horizon, Blinn-Phong", "half-vectors at grazing views", "absolute", 2e-6, "sums of products of unit vectors, 2^-24 each", check_horizon, DRAWN "downsample.ndf=blinn_phong downsample.share=0.5", RAYS_GRAZING, false},
    {"drawn rays above the horizon, around the mirror's", "rays drawn around the reflection at grazing views", "absolute", 2e-6, "sums of products of unit vectors, 2^-24 each", check_horizon, DRAWN "downsample.lobe=reflection", RAYS_GRAZING, false},
    {"stippled blocks", "checks, columns and rows of two depths: which of four pixels is picked", "blocks", 0, "comparisons alone", check_pick, "downsample=pick", 1, false},
    {"blocks with rails", "one pixel of four is of the rail", "blocks", 0, "comparisons alone", check_pick, "downsample=pick", 2, false},
    {"blocks at edges", "of boards at all angles", "blocks", 0, "comparisons alone", check_pick, "downsample=pick", 0, false},
};
/* clang-format on */

const struct replay_case_list geometry_surfaces = {items, sizeof items / sizeof *items};
