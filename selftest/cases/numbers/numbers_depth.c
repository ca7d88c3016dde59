/* Encodings of depth, and projections: screen rays compared with a replay in double precision of the stored depths. */
#include "cases/numbers/numbers_depth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct depth_case {
    const char *name, *what;
    struct open_box box;
};

#define DEG (3.14159265358979323846 / 180)
/* clang-format off */
static const struct depth_case cases[] = {
    {"depth in 32 bits of float", "near to far as 0 to 1", {.encodings.depth = GLINT_DEPTH_DEVICE}},
    {"reversed depth in 32 bits of float", "near to far as 1 to 0", {.encodings.depth = GLINT_DEPTH_REVERSED}},
    {"depth in 24 bits", "near to far as 0 to 2^24 - 1", {.encodings.depth = GLINT_DEPTH_DEVICE, .depth_bits = 24}},
    {"reversed depth in 24 bits", "near to far as 2^24 - 1 to 0", {.encodings.depth = GLINT_DEPTH_REVERSED, .depth_bits = 24}},
    {"depth in 16 bits", "near to far as 0 to 65535", {.near_m = 0.3, .encodings.depth = GLINT_DEPTH_DEVICE, .depth_bits = 16}},
    {"reversed depth in 16 bits", "near to far as 65535 to 0", {.near_m = 0.3, .encodings.depth = GLINT_DEPTH_REVERSED, .depth_bits = 16}},
    {"near 10^-3 and far 10^6", "reversed depth", {.near_m = 1e-3, .far_m = 1e6, .encodings.depth = GLINT_DEPTH_REVERSED}},
    {"near 10^-3 and far 10^6, reversed", "depth with few steps for far surfaces", {.near_m = 1e-3, .far_m = 1e6, .encodings.depth = GLINT_DEPTH_DEVICE}},
    {"near 10^-3 and far infinite", "reversed depth without a far plane", {.near_m = 1e-3, .encodings.depth = GLINT_DEPTH_REVERSED_INFINITE}},
    {"far infinite, reversed", "depth whose 1 is infinitely far", {.far_m = INFINITY, .encodings.depth = GLINT_DEPTH_DEVICE}},
    {"field of view of 1 degree", "a telephoto lens", {.target = {5.2, 1e-3, 1e-3}, .fov_y_rad = 1 * DEG}},
    {"field of view of 150 degrees", "the widest of lenses", {.width = 144, .height = 96, .fov_y_rad = 150 * DEG}},
    {"off-centre projection", "half of a picture in two", {.width = 144, .height = 96, .shift = {0.7, -0.4}}},
    {"jittered projection", "a third of a pixel to the right and down", {.jitter_px = {0.33, 0.4}}},
};
/* clang-format on */

/* The ways to trace the image. At half resolution the same pixel of every block is picked, so that texels are evenly spaced, and steps
   are shorter than texels, so that a plane is hit exactly. */
static const struct trace {
    const char *slots, *use, *set;
    double steps; /* half steps of the stored depth by which a texel's surface may be off at its border */
} traces[] = {
    {"", "screen_trace=linear", "screen_trace.steps=256", 1},
    {"\"hiz\": \"nearest\", ", "screen_trace=hiz", "screen_trace.cells=256", 3}, /* its own depth's and two slopes' */
};
static const double BIAS = 0.001; /* relative depth by which a ray must be behind a surface */
static const double ROUNDINGS =
    8.0 / (1 << 24); /* half a float's last bit each: 1/z (5, by Vulkan), and its interpolation */

size_t numbers_depth_count(void) {
    return sizeof cases / sizeof *cases;
}

struct glint_selftest_case numbers_depth_get(size_t i) {
    return (struct glint_selftest_case){
        cases[i].name,
        cases[i].what,
        NULL,
        "of what may be",
        1,
        "depth is decoded in double and rounded once; rays end where the double replay of the stored depths has them, "
        "but for half a step of the depth stored at their end, three in cells with slopes, and eight roundings, over "
        "how "
        "steeply they meet the wall. Hit or not is a tie within a texel of a wall's or the picture's rim"};
}

struct tally {
    const struct open_box *box;
    const struct trace *trace;
    struct glint_selftest_finding *finding;
};

static void record_error(struct tally *t, double error, const double place[2], double found, double expected) {
    t->finding->values++;
    if (error <= t->finding->worst) return;
    t->finding->worst = error;
    snprintf(t->finding->at, sizeof t->finding->at, "pixel %g,%g: found %.9g m, expected %.9g m", place[0] - 0.5,
             place[1] - 0.5, found, expected);
}

/* How far a ray's end moves along the ray if the wall's depth there changes by `step`, including the rounding of screen positions. */
static double end_moves(const struct open_box *c, const struct open_box_ray *ray, double depth, double step) {
    double view[3], corner[3], length = 0;
    const int axis = ray->face / 2;
    open_box_view_ray(c, ray->end_px, view);
    open_box_view_ray(c, (double[2]){c->width, 0}, corner);
    for (int k = 0; k < 3; k++) length += corner[k] * corner[k];
    return (step * fabs(view[axis]) + ROUNDINGS * depth * sqrt(length)) / fabs(ray->direction[axis]);
}

/* The distance of a position from the border of the image in pixels; negative outside. */
static double within(const struct open_box *c, const double place[2]) {
    return fmin(fmin(place[0], c->width - place[0]), fmin(place[1], c->height - place[1]));
}

/* The texels that may determine a position: at half resolution, so up to 3 pixels away. */
struct around {
    bool one_wall, no_wall;
    double nearest, farthest;
};
static struct around look_around(const struct open_box *c, const double place[2], int wall) {
    struct around around = {true, true, INFINITY, 0};
    for (int i = 0; i < 9; i++) {
        int face;
        double depth;
        const double near[2] = {place[0] + 3 * (i % 3 - 1), place[1] + 3 * (i / 3 - 1)};
        const enum open_box_surface seen = open_box_seen(c, near, &depth, &face);
        around.one_wall &= seen == OPEN_BOX_WALL && face == wall;
        around.no_wall &= seen != OPEN_BOX_WALL;
        around.nearest = fmin(around.nearest, depth), around.farthest = fmax(around.farthest, depth);
    }
    return around;
}

/* A ray that hits a visible wall: it must get behind the wall by the bias, on screen. */
static void check_hit(struct tally *t, const struct open_box *c, const double place[2], const struct open_box_ray *ray,
                      bool finished, float travelled) {
    double depth, behind[3], behind_px[2];
    int face;
    open_box_seen(c, ray->end_px, &depth, &face);
    const struct around around = look_around(c, ray->end_px, ray->face);
    const double step = t->trace->steps * open_box_depth_step(c, around.farthest);
    const double past = end_moves(c, ray, depth, 2 * (BIAS * depth + step));
    for (int k = 0; k < 3; k++) behind[k] = ray->end[k] + past * ray->direction[k];
    if (!open_box_seen_at(c, behind, behind_px) || within(c, behind_px) < 2 || within(c, ray->end_px) < 2) return;
    if (!around.one_wall || around.farthest > 2 * around.nearest) return;
    const double error = fabs((double)travelled - ray->distance) / end_moves(c, ray, depth, step);
    record_error(t, finished ? error : (double)INFINITY, place, (double)travelled, ray->distance);
}

/* A ray that ends off screen or in the sky, and passes no wall within a texel of its border. */
static void check_rest(struct tally *t, const struct open_box *c, const double place[2], const struct open_box_ray *ray,
                       bool finished, float travelled) {
    const bool sky = ray->distance == INFINITY, outside = !ray->in_front || within(c, ray->end_px) < -2;
    double over[2];
    if (sky && open_box_seen_at(c, ray->over, over) && !look_around(c, over, 0).no_wall) return;
    if (!outside && (within(c, ray->end_px) < 2 || !look_around(c, ray->end_px, 0).no_wall)) return;
    const bool right = outside ? !finished : finished && travelled > 1e30f;
    record_error(t, right ? 0 : (double)INFINITY, place, (double)travelled, (double)INFINITY);
}

static void check_ray(struct tally *t, const double place[2], float depth_found, bool finished, float travelled) {
    const struct open_box c = open_box_filled(t->box);
    double true_depth;
    int face;
    if (open_box_seen(&c, place, &true_depth, &face) != OPEN_BOX_FLOOR) return;
    const double depth = open_box_decode_depth(&c, (double)open_box_encode_depth(&c, true_depth));
    /* decoding is done in double and rounded once */
    record_error(t, fabs((double)depth_found - depth) / ((1 + 1e-3) * depth * exp2(-24)), place, (double)depth_found,
                 depth);
    const struct open_box_ray ray = open_box_mirror(&c, place, depth);
    const bool hits = ray.distance < INFINITY && ray.in_front && within(&c, ray.end_px) >= -2;
    (hits ? check_hit : check_rest)(t, &c, place, &ray, finished, travelled);
}

static bool check_all(struct pictures *pictures, struct tally *tally, struct glint_error *err) {
    struct picture depth = {0}, pick = {0}, finished = {0}, travelled = {0};
    bool ok = pictures_box(pictures, tally->box, err) && pictures_read(pictures, "depth_half", &depth, err) &&
              pictures_read(pictures, "pick", &pick, err) &&
              pictures_read(pictures, "screen_finished", &finished, err) &&
              pictures_read(pictures, "screen_travelled", &travelled, err);
    const uint32_t scale = ok ? (open_box_filled(tally->box).width + depth.width - 1) / depth.width : 1;
    for (uint32_t y = 0; ok && y < depth.height; y++)
        for (uint32_t x = 0; x < depth.width; x++) {
            const size_t i = (size_t)y * depth.width + x;
            const uint32_t selected = scale == 1 ? 0 : pick.whole[i];
            const double place[2] = {scale * x + (selected & 1) + 0.5, scale * y + (selected >> 1 & 1) + 0.5};
            check_ray(tally, place, depth.values[i], finished.whole[i], travelled.values[i]);
        }
    free(depth.values), free(pick.values), free(finished.values), free(travelled.values);
    return ok;
}

static bool begin_trace(struct pictures *pictures, const struct case_context *context, const struct trace *trace,
                        struct glint_error *err) {
    return pictures_begin(pictures, context, trace->slots, err) &&
           glint_pipeline_use(pictures->pipeline, trace->use, err) &&
           glint_pipeline_set(pictures->pipeline, trace->set, err);
}

bool numbers_depth_check(const struct case_context *context, const struct open_box *box, const char *downsample,
                         struct glint_selftest_finding *finding, struct glint_error *err) {
    bool ok = true;
    for (size_t v = 0; ok && v < sizeof traces / sizeof *traces; v++) {
        struct pictures pictures = {0};
        struct tally tally = {box, &traces[v], finding};
        ok = begin_trace(&pictures, context, &traces[v], err) &&
             glint_pipeline_use(pictures.pipeline, downsample, err) && check_all(&pictures, &tally, err);
        pictures_end(&pictures);
    }
    return ok;
}

bool numbers_depth_run(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err) {
    bool ok = true;
    for (size_t v = 0; ok && v < (context->quick ? 1 : sizeof traces / sizeof *traces); v++) {
        struct pictures pictures = {0};
        ok = begin_trace(&pictures, context, &traces[v], err) &&
             glint_pipeline_set(pictures.pipeline, "downsample.edges=false", err);
        for (size_t i = 0; ok && i < numbers_depth_count(); i++) {
            struct tally tally = {&cases[i].box, &traces[v], &findings[i]};
            if (selected[i]) ok = check_all(&pictures, &tally, err);
        }
        pictures_end(&pictures);
    }
    return ok;
}
