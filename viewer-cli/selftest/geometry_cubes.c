/* Rays through cube maps of distances, every one of a picture against a replay in double precision (cube_march.h) of the
   texels that the pass read. Ties as in geometry_screen.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clutter.h"
#include "cube_march.h"
#include "geometry.h"
#include "walk.h"

enum { WIDE = 61, HIGH = 37, CUBE = 24, FINE_CUBE = 160, COARSE_CUBE = 4, WAYS = 24 };
static const double direction_rounding = 5e-7, gap_rounding = 5e-7;

/* ---- Scenes ---- */

enum scene { ROOM, PILLARS, SKY, SPECK };
/* A room around the camera; positions in the world. The first centre is the camera itself. */
static const double room_low[3] = {-2.5, -3, -4}, room_high[3] = {7.5, 3.4, 5};
static const double centers[CUBES_MOST][3] = {{3.108, -0.356, -0.06}, {-1.1, -1.2, -2}, {5.3, 1.1, 2.1}, {1.4, 2, 3.3}};

static double leave_room(const double from[3], const double d[3]) {
    double t = INFINITY;
    for (int k = 0; k < 3; k++)
        if (d[k] != 0) t = fmin(t, ((d[k] > 0 ? room_high[k] : room_low[k]) - from[k]) / d[k]);
    return t;
}

static void color(const double d[3], bool sky, float out[5]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(0.5 + 0.4 * d[k]);
    out[3] = sky ? 0 : 1;
}

static void room(uint32_t number, const double d[3], float out[5]) {
    color(d, false, out);
    out[4] = (float)leave_room(centers[number], d);
}

/* The same with blocks before the walls, and holes in them. */
static void pillars(uint32_t number, const double d[3], float out[5]) {
    const double most = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
    uint32_t block = number;
    for (int k = 0; k < 3; k++) block = 8 * block + (uint32_t)(3.5 + 3 * d[k] / most);
    const double what = noise(11, block), far = leave_room(centers[number], d);
    color(d, what > 0.85, out);
    out[4] = what > 0.85 ? INFINITY : (float)(what < 0.4 ? far * (0.3 + what) : far);
}

static void sky(uint32_t number, const double d[3], float out[5]) {
    (void)number;
    color(d, true, out);
    out[4] = INFINITY;
}

/* All sky but for one texel. */
static void speck(uint32_t number, const double d[3], float out[5]) {
    const double half = 1.0 / COARSE_CUBE, at[2] = {half, -3 * half};
    const bool here = d[1] > 0 && fabs(d[0] / d[1] - at[0]) < half && fabs(d[2] / d[1] - at[1]) < half;
    sky(number, d, out);
    if (here) color(d, false, out);
    if (here) out[4] = 0.4f;
}

static void blue(const double d[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(0.4 + 0.3 * d[k]);
}

/* ---- What a run was given and made ---- */

struct traced {
    uint32_t width, height;
    float *travelled, *start_m, *depth_m, *normal;
    uint32_t *place, *end, *steps, *best, *finished;
    struct walk_grid grid;
    struct cubes cubes;
};

static bool cubes_get(struct cubes *cubes, struct trial *trial, struct glint_capture *capture) {
    static const char *const channels[1] = {"distance.Z"};
    uint32_t count = 0, longest = 0;
    uint32_t *index = trial_uints(trial, "active_index", &count, NULL),
             *chain = trial_uints(trial, "active_chain", &longest, NULL);
    cubes->count = count;
    cubes->longest = longest;
    for (uint32_t i = 0; trial->ok && i < count && i < CUBES_MOST; i++) {
        char name[32];
        snprintf(name, sizeof name, "cubemap.%03u", index[i]);
        const struct glint_part_info *part = glint_capture_find(capture, name);
        cubes->size = part->width;
        cubes->maps[i] = part->cubemap;
        for (int k = 0; k < 3; k++) cubes->center[i][k] = part->cubemap.center[k] - clutter_eye[k];
        for (uint32_t k = 0; k < longest; k++) cubes->chain[i][k] = chain[i * longest + k];
        cubes->distance_m[i] = malloc((size_t)part->width * part->height * sizeof(float));
        if (!cubes->distance_m[i]) trial->ok = glint_fail(trial->err, GLINT_ERROR_MEMORY, "out of memory");
        trial->ok =
            trial->ok && glint_capture_read(capture, part, channels, 1, GLINT_F32, cubes->distance_m[i], 0, trial->err);
    }
    cubes->has_sky = glint_capture_find(capture, "sky") != NULL;
    free(index);
    free(chain);
    return trial->ok;
}

static bool traced_get(struct traced *t, struct trial *trial) {
    t->travelled = trial_floats(trial, "travelled", &t->width, &t->height);
    t->start_m = trial_floats(trial, "screen_travelled", NULL, NULL);
    t->depth_m = trial_floats(trial, "depth_half", NULL, NULL);
    t->normal = trial_floats(trial, "normal_jittered", NULL, NULL);
    t->place = trial_uints(trial, "cubemap_index", NULL, NULL);
    t->end = trial_uints(trial, "cubemap_end", NULL, NULL);
    t->steps = trial_uints(trial, "cubemap_steps", NULL, NULL);
    t->best = trial_uints(trial, "cubemap_best", NULL, NULL);
    t->finished = trial_uints(trial, "screen_finished", NULL, NULL);
    if (!trial->ok || !cubes_get(&t->cubes, trial, trial->capture)) return false;
    walk_grid_init(&t->grid, glint_capture_frame(trial->capture), t->width, t->height, t->depth_m, t->normal);
    return true;
}

static void traced_free(struct traced *t) {
    void *const all[] = {t->travelled, t->start_m, t->depth_m, t->normal,  t->place,
                         t->end,       t->steps,   t->best,    t->finished};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (size_t i = 0; i < CUBES_MOST; i++) free(t->cubes.distance_m[i]);
}

/* ---- Judging ---- */

struct task {
    const struct march_rules *rules; /* NULL: the exact tracer */
    double bound;
    bool rough;
};

/* Way 0 is the exact one. */
static struct cube_end replayed(const struct task *task, const struct traced *traced, const struct walk_ray *ray,
                                uint32_t i, uint32_t way) {
    const struct walk_ray rounded = walk_ray_rounded(ray, way ? direction_rounding : 0, way);
    struct cubes cubes = traced->cubes;
    struct cube_ray world = {.start_m = (double)traced->start_m[i], .best = traced->best[i], .rough = task->rough};
    cubes.rounding = way ? gap_rounding : 0;
    cubes.way = way;
    for (int k = 0; k < 3; k++)
        for (int r = 0; r < 3; r++) { /* the camera's axes are the rows */
            world.origin[k] += traced->grid.rows[r][k] * rounded.origin[r];
            world.direction[k] += traced->grid.rows[r][k] * rounded.direction[r];
        }
    const double found = (double)traced->travelled[i];
    return task->rules ? cube_march(&cubes, &world, task->rules)
                       : cube_exact(&cubes, &world, found, task->bound * (1 + found));
}

static double apart(double a, double b) {
    return a == b ? 0 : fabs(a - b) / (1 + fmin(fabs(a), fabs(b)));
}

static bool same(const struct cube_end *a, const struct cube_end *b, bool steps) {
    return a->place == b->place && a->reason == b->reason && (!steps || a->steps == b->steps);
}

static double outside(const struct task *task, const struct traced *traced, const struct walk_ray *ray, uint32_t i,
                      const struct cube_end *found) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t way = 1; way <= WAYS && !(low <= found->t && found->t <= high); way++) {
        const struct cube_end other = replayed(task, traced, ray, i, way);
        if (!same(&other, found, task->rules)) continue;
        low = fmin(low, other.t);
        high = fmax(high, other.t);
    }
    return low <= high ? apart(found->t, fmin(fmax(found->t, low), high)) : INFINITY;
}

/* How much farther the chosen centre is from where the ray starts than the nearest is. */
static double farther(const struct traced *traced, const struct walk_ray *ray, uint32_t i) {
    double chosen = INFINITY, least = INFINITY;
    for (uint32_t n = 0; n < traced->cubes.count; n++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) {
            double at = -traced->cubes.center[n][k];
            for (int r = 0; r < 3; r++)
                at += traced->grid.rows[r][k] * (ray->origin[r] + (double)traced->start_m[i] * ray->direction[r]);
            sum += at * at;
        }
        least = fmin(least, sqrt(sum));
        if (n == traced->best[i]) chosen = sqrt(sum);
    }
    return chosen - least;
}

static void judge(const struct task *task, const struct traced *traced, uint32_t i, struct selftest_finding *finding) {
    const uint32_t x = i % traced->width, y = i / traced->width;
    const struct cube_end found = {(double)traced->travelled[i], traced->place[i], traced->end[i], traced->steps[i]};
    struct cube_end expected = {(double)traced->start_m[i], CUBES_NO_PLACE, END_not_traced, 0};
    struct walk_ray ray;
    const bool has_ray = walk_ray_init(&ray, &traced->grid, x, y) && !traced->finished[i];
    if (has_ray) expected = replayed(task, traced, &ray, i, 0);
    double error = same(&found, &expected, task->rules) ? apart(found.t, expected.t) : INFINITY;
    if (has_ray && !(error <= task->bound)) {
        const double beyond = outside(task, traced, &ray, i, &found);
        finding->ties += !same(&found, &expected, task->rules) && beyond <= task->bound;
        error = fmin(error, beyond);
    }
    if (has_ray && !(farther(traced, &ray, i) <= 1e-5)) error = INFINITY;
    compared(finding, error,
             "pixel %u,%u: ended for reason %u in %u at %.9g m, step %u; expected %u in %u at %.9g m, step %u", x, y,
             found.reason, found.place, found.t, found.steps, expected.reason, expected.place, expected.t,
             expected.steps);
}

/* ---- Cases ---- */

static const char *const march_words =
    "downsample=none downsample.jitter=false screen_trace=linear screen_trace.dither=false cubemap_active=nearest "
    "cubemap_select=nearest cubemap_trace=march cubemap_trace.random_scale=false";
static const char *const exact_words =
    "downsample=none downsample.jitter=false screen_trace=linear screen_trace.dither=false cubemap_active=nearest "
    "cubemap_select=nearest cubemap_trace=exact";

/* Values of `number`. */
enum {
    FROM_AROUND,  /* surfaces of all depths within the room */
    FROM_CENTER,  /* a millionth of a metre to a millimetre from a centre */
    FROM_MASS,    /* before the walls and some metres behind them */
    FROM_OUTSIDE, /* far outside */
    RAYS = 8,     /* times enum clutter_rays */
    SCENE = 128,  /* times enum scene */
    ONE = 512,    /* one cube map */
    ROUGH = 1024,
    OWN_SKY = 2048,
    VOLUME = 4096 /* times enum glint_volume */
};

static struct glint_cubemap cube_at(uint32_t number, enum glint_volume volume) {
    struct glint_cubemap cube = {.inner = volume};
    for (int k = 0; k < 3; k++) {
        const double c = cube.center[k] = centers[number][k];
        cube.box_min[k] = room_low[k] + 0.2 - c;
        cube.box_max[k] = room_high[k] - 0.2 - c;
    }
    cube.sphere_radius = 1.3;
    cube.sphere_center[0] = 0.2;
    /* A hull between two planes along the screen, 0.75 m and 1.5 m before the camera, where surfaces are, and 6 m wide. */
    static const double axes[3][3] = {{-0.36, -0.48, -0.8}, {0.48, 0.64, -0.6}, {-0.8, 0.6, 0}};
    static const double ends[3][2] = {{0.75, 1.5}, {-3, 3}, {-3, 3}};
    for (int i = 0; i < 6; i++) {
        const double *axis = axes[i / 2], sign = i % 2 ? 2 : -1; /* one of length 2 */
        for (int k = 0; k < 3; k++) {
            cube.planes[i][k] = sign * axis[k];
            cube.planes[i][3] += sign * axis[k] * (centers[number][k] - clutter_eye[k]);
        }
        cube.planes[i][3] -= sign * ends[i / 2][i % 2];
    }
    cube.plane_count = 6;
    return cube;
}

static void check(struct trial *trial, const struct trial_case *c, const char *words, const struct march_rules *rules,
                  struct selftest_finding *finding) {
    static const double depths[4][2] = {{0.2, 1.5}, {1e-6, 1e-3}, {1.5, 5}, {30, 60}};
    static void (*const scenes[4])(uint32_t, const double[3], float[5]) = {room, pillars, sky, speck};
    const enum glint_volume volume = (enum glint_volume)(c->number / VOLUME);
    const struct task task = {rules, c->bound, c->number & ROUGH};
    char all[1024];
    struct clutter clutter = {.rays = (enum clutter_rays)(c->number / RAYS % 16), .roughness = task.rough};
    memcpy(clutter.flat_m, depths[c->number % RAYS], sizeof clutter.flat_m);
    if (volume == GLINT_VOLUME_HULL) clutter.flat_m[0] = clutter.flat_m[1] = 1.5;
    snprintf(all, sizeof all, "%s %s", words, c->use);
    trial_use(trial, all);
    for (clutter.seed = 1000; clutter.seed <= (trial->test->quick || !rules ? 1000 : 3000); clutter.seed += 1000) {
        struct traced traced = {0};
        struct plain plain = clutter_capture(&clutter, WIDE, HIGH);
        plain.cube_size = c->number / SCENE % 4 == SPECK ? COARSE_CUBE : rules ? CUBE : FINE_CUBE;
        plain.cube_count = c->number & ONE ? 1 : CUBES_MOST;
        plain.cube = scenes[c->number / SCENE % 4];
        if (c->number & OWN_SKY) plain.sky = blue;
        for (uint32_t i = 0; i < plain.cube_count; i++) plain.cubes[i] = cube_at(i, volume);
        trial_run(trial, &plain);
        if (traced_get(&traced, trial))
            for (uint32_t i = 0; i < traced.width * traced.height; i++) judge(&task, &traced, i, finding);
        traced_free(&traced);
    }
}

static void check_exact(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    check(trial, c, exact_words, NULL, finding);
}

static void check_march(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding) {
    const struct march_rules rules = {.bilinear = !strstr(c->use, "bilinear=false"),
                                      .secant = !strstr(c->use, "secant=false"),
                                      .verify = !strstr(c->use, "verify=false"),
                                      .step_back = !strstr(c->use, "step_back=false"),
                                      .skip_volume = !strstr(c->use, "skip_volume=false"),
                                      .radial = strstr(c->use, "mass=radial"),
                                      .fallback =
                                          strstr(c->use, "fallback=black") ? FALL_TO_NOTHING : FALL_TO_DIRECTION};
    check(trial, c, march_words, &rules, finding);
}

/* clang-format off */
#define UNIT "m, or of the distance"
#define ALONE "screen_trace.length_m=0"
#define REASON "a position is three sums of 2^-24 of its parts, a distance its square root; where a ray closes in on a surface slowly this grows, and the replays rounded otherwise say by how much"
#define MARCH(name, what, number, use) {name ", marched", what, UNIT, 5e-6, REASON, check_march, use, number, false}
#define EXACT(name, what, number, use) {name ", exactly", what, UNIT, 5e-6, REASON, check_exact, use, (number) + ONE, false}
#define BOTH(name, what, number) MARCH(name, what, number, ALONE), EXACT(name, what, number, ALONE)

static const struct trial_case items[] = {
    BOTH("a room",                   "every way from all over it",                         FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM),
    BOTH("a room, along the view's axes", "from all over it",                              FROM_AROUND + RAYS * RAYS_AXES + SCENE * ROOM),
    BOTH("to edges and corners",     "from all over a room, along and between its axes",   FROM_AROUND + RAYS * RAYS_CORNERS + SCENE * ROOM),
    BOTH("edges and corners of a cube map", "rays from its centre through them",           FROM_CENTER + RAYS * RAYS_CORNERS + SCENE * ROOM),
    BOTH("from a cube map's centre", "1e-6 to 1e-3 m beside it",                           FROM_CENTER + RAYS * RAYS_ANY + SCENE * ROOM),
    BOTH("all sky",                  "no cube map has a surface",                          FROM_AROUND + RAYS * RAYS_ANY + SCENE * SKY),
    EXACT("a room, coarse texels skipped", "every way from all over it, over coarse texels where nothing is near", FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM, ALONE " cubemap_mips=plain cubemap_mips.join=nearest cubemap_trace.skip=true"),
    MARCH("one texel in the sky",    "all of the cube maps but a texel of each is sky",     FROM_AROUND + RAYS * RAYS_ANY + SCENE * SPECK, ALONE),
    MARCH("from inside the mass",    "surfaces that the cube maps have nearer",            FROM_MASS + RAYS * RAYS_ANY + SCENE * ROOM, ALONE),
    MARCH("from outside of all cube maps", "30 to 60 m away",                              FROM_OUTSIDE + RAYS * RAYS_ANY + SCENE * ROOM, ALONE),
    MARCH("shadows, holes",          "blocks before the walls of a room without all of its walls: chains of cube maps", FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ALONE),
    MARCH("shadows, holes, a sky",   "the same with a sky of its own",                     FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + OWN_SKY, ALONE),
    MARCH("shadows, rough",          "the same in fewer steps",                            FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + ROUGH, ALONE),
    MARCH("shadows, to nothing",     "rays that no cube map can follow are black",         FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ALONE " cubemap_trace.fallback=black"),
    MARCH("shadows, nearest texels", "without interpolation",                              FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ALONE " cubemap_trace.bilinear=false"),
    MARCH("shadows, no second look", "neither secant nor verification",                    FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ALONE " cubemap_trace.verify=false cubemap_trace.secant=false"),
    MARCH("shadows, onwards",        "no step back after a change, thickness away from the centre", FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ALONE " cubemap_trace.step_back=false cubemap_trace.mass=radial"),
    MARCH("on an inner volume's face", "every start lies on it",                           FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + VOLUME * GLINT_VOLUME_HULL, ALONE),
    MARCH("in a box that is empty",  "inner volumes of six planes",                        FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM + VOLUME * GLINT_VOLUME_BOX, ALONE),
    MARCH("in a ball that is empty", "inner volumes of a sphere",                          FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + VOLUME * GLINT_VOLUME_SPHERE, ALONE),
    MARCH("after the screen",        "from where the screen's ray stopped",                FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, ""),
};
/* clang-format on */

const struct trial_list geometry_cubes = {items, sizeof items / sizeof *items};
