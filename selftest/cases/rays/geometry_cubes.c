/* All rays of an image through cube maps of distances, compared with a replay in double precision. */
#include <math.h>
#include <string.h>

#include "cases/rays/cube_rays.h"
#include "cases/rays/rays_lists.h"

enum { WIDE = 61, HIGH = 37, QUICK_WIDE = 31, QUICK_HIGH = 19, CUBE = 24, FINE_CUBE = 160, COARSE_CUBE = 4 };

/* ---- Scenes ---- */

enum scene { ROOM, PILLARS, SKY, SPECK };

static void color(const double d[3], bool is_sky, float out[5]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(0.5 + 0.4 * d[k]);
    out[3] = is_sky ? 0 : 1;
}

static void room_texel(uint32_t number, const double d[3], float out[5]) {
    color(d, false, out);
    out[4] = (float)room_distance(number, d);
}

/* The same with blocks in front of the walls, and holes in these. */
static void pillar_texel(uint32_t number, const double d[3], float out[5]) {
    const double most = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
    uint32_t block = number;
    for (int k = 0; k < 3; k++) block = 8 * block + (uint32_t)(3.5 + 3 * d[k] / most);
    const double what = noise(11, block), far = room_distance(number, d);
    color(d, what > 0.85, out);
    out[4] = what > 0.85 ? INFINITY : (float)(what < 0.4 ? far * (0.3 + what) : far);
}

static void sky_texel(uint32_t number, const double d[3], float out[5]) {
    (void)number;
    color(d, true, out);
    out[4] = INFINITY;
}

/* Sky except for one texel. */
static void speck_texel(uint32_t number, const double d[3], float out[5]) {
    const double half = 1.0 / COARSE_CUBE, at[2] = {half, -3 * half};
    const bool here = d[1] > 0 && fabs(d[0] / d[1] - at[0]) < half && fabs(d[2] / d[1] - at[1]) < half;
    sky_texel(number, d, out);
    if (here) color(d, false, out);
    if (here) out[4] = 0.4f;
}

static void sky_color(const double d[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(0.4 + 0.3 * d[k]);
}

/* ---- Cases ---- */

/* Values of `number`. */
enum {
    FROM_AROUND,  /* surfaces at all depths within the room */
    FROM_CENTER,  /* a millionth of a metre to a millimetre from a centre */
    FROM_MASS,    /* in front of the walls and some metres behind them */
    FROM_OUTSIDE, /* far outside */
    FROM_BEFORE,  /* in front of all blocks */
    FROM_WALL,    /* parallel to the screen, so that screen rays continue to its border */
    RAYS = 8,     /* factor of enum plane_scene_rays */
    SCENE = 128,  /* factor of enum scene */
    ROUGH = 1024,
    OWN_SKY = 2048,
    VOLUME = 4096, /* factor of enum glint_volume */
    FACES = 32768  /* factor of their width; 0: the default */
};

static void check_scene(struct case_run *run, const struct replay_case *c, const struct march_rules *rules,
                        struct glint_selftest_finding *finding) {
    static const double depths_m[6][2] = {{0.2, 1.5}, {1e-6, 1e-3}, {1.5, 5}, {30, 60}, {0.1, 0.45}, {3, 3}};
    static void (*const scenes[4])(uint32_t, const double[3], float[5]) = {room_texel, pillar_texel, sky_texel,
                                                                           speck_texel};
    const enum scene scene = (enum scene)(c->number / SCENE % 4);
    const bool few = run->context->quick && !rules; /* the replay in double takes long for these */
    struct cube_rays task = {.rules = rules,
                             .bound = c->bound,
                             .rays = (enum plane_scene_rays)(c->number / RAYS % 16),
                             .rough = c->number & ROUGH,
                             .width = few ? QUICK_WIDE : WIDE,
                             .height = few ? QUICK_HIGH : HIGH,
                             .cube_size = c->number / FACES ? (uint32_t)(c->number / FACES)
                                          : scene == SPECK  ? COARSE_CUBE
                                          : rules           ? CUBE
                                                            : FINE_CUBE,
                             .cube_count = rules ? CUBES_MOST : 1,
                             .cube = scenes[scene],
                             .sky = c->number & OWN_SKY ? sky_color : NULL,
                             .volume = (enum glint_volume)(c->number / VOLUME % 8)};
    memcpy(task.depths_m, depths_m[c->number % RAYS], sizeof task.depths_m);
    if (task.volume == GLINT_VOLUME_HULL) task.depths_m[0] = task.depths_m[1] = 1.5; /* its face */
    case_run_pipeline(run, c->use);
    cube_rays(run, &task, run->context->quick || !rules ? 1 : 3, finding);
}

static void check_exact(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    check_scene(run, c, NULL, finding);
}

static void check_march(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    const struct march_rules rules = {.bilinear = !strstr(c->use, "bilinear=false"),
                                      .secant = !strstr(c->use, "secant=false"),
                                      .verify = !strstr(c->use, "verify=false"),
                                      .step_back = !strstr(c->use, "step_back=false"),
                                      .skip_volume = !strstr(c->use, "skip_volume=false"),
                                      .radial = strstr(c->use, "mass=radial"),
                                      .strides = strstr(c->use, "count=strides"),
                                      .exact = strstr(c->use, "surfaces=exact"),
                                      .fallback =
                                          strstr(c->use, "fallback=black") ? FALL_TO_NOTHING : FALL_TO_DIRECTION};
    check_scene(run, c, &rules, finding);
}

/* clang-format off */
#define MARCH(name, what, number, use) {name ", marched", what, CUBE_UNIT, 5e-6, CUBE_REASON, check_march, CUBE_MARCH use, number, false}
#define EXACTLY(name, what, number, use, slow) {name ", exactly", what, CUBE_UNIT, 5e-6, CUBE_REASON, check_exact, CUBE_EXACT use, number, slow}
#define EXACT(name, what, number, use) EXACTLY(name, what, number, use, false)
#define BLOCKS(name, number, slow) EXACTLY("blocks and holes" name, "every jump between texels counts as a wall", FROM_BEFORE + RAYS * RAYS_ANY + SCENE * PILLARS + number, CUBE_ALONE "cubemap_trace.tolerance=1", slow)
#define BLOCKS_AT(size, slow) BLOCKS(", faces of " #size, FACES * size, slow)
#define BOTH(name, what, number) MARCH(name, what, number, CUBE_ALONE), EXACT(name, what, number, CUBE_ALONE)

static const struct replay_case items[] = {
    BOTH("a room",                   "rays of all directions from all over it",                         FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM),
    BOTH("a room, along the view's axes", "from all over it",                              FROM_AROUND + RAYS * RAYS_AXES + SCENE * ROOM),
    BOTH("to edges and corners",     "rays from all over a room, along and between its axes",   FROM_AROUND + RAYS * RAYS_CORNERS + SCENE * ROOM),
    BOTH("edges and corners of a cube map", "rays from its centre through them",           FROM_CENTER + RAYS * RAYS_CORNERS + SCENE * ROOM),
    BOTH("from a cube map's centre", "1e-6 to 1e-3 m beside it",                           FROM_CENTER + RAYS * RAYS_ANY + SCENE * ROOM),
    BOTH("all sky",                  "no cube map has a surface",                          FROM_AROUND + RAYS * RAYS_ANY + SCENE * SKY),
    EXACT("a room, coarse texels skipped", "rays of all directions from all over it, over coarse texels where nothing is near", FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM, CUBE_ALONE " cubemap_mips=plain cubemap_mips.join=nearest cubemap_trace.skip=true"),
    MARCH("one texel in the sky",    "cube maps of sky except one texel each",     FROM_AROUND + RAYS * RAYS_ANY + SCENE * SPECK, CUBE_ALONE),
    MARCH("from inside the mass",    "rays from surfaces that are nearer in the cube maps",            FROM_MASS + RAYS * RAYS_ANY + SCENE * ROOM, CUBE_ALONE),
    MARCH("from outside of all cube maps", "30 to 60 m away",                              FROM_OUTSIDE + RAYS * RAYS_ANY + SCENE * ROOM, CUBE_ALONE),
    MARCH("shadows, holes",          "blocks in front of the walls of a room with walls missing: chains of cube maps", FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE),
    MARCH("shadows, holes, a sky",   "the same with a sky of its own",                     FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + OWN_SKY, CUBE_ALONE),
    MARCH("shadows, rough",          "the same in fewer steps",                            FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + ROUGH, CUBE_ALONE),
    MARCH("shadows, to nothing",     "rays that no cube map can follow are black",         FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE " cubemap_trace.fallback=black"),
    MARCH("shadows, nearest texels", "without interpolation",                              FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE " cubemap_trace.bilinear=false"),
    MARCH("shadow regions, without verification", "neither secant nor verification",                    FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE " cubemap_trace.verify=false cubemap_trace.secant=false"),
    MARCH("shadows, onwards",        "no step back after a change, thickness away from the centre", FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE " cubemap_trace.step_back=false cubemap_trace.mass=radial"),
    MARCH("on an inner volume's face", "every start lies on it",                           FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + VOLUME * GLINT_VOLUME_HULL, CUBE_ALONE),
    MARCH("in a box that is empty",  "inner volumes of six planes",                        FROM_AROUND + RAYS * RAYS_ANY + SCENE * ROOM + VOLUME * GLINT_VOLUME_BOX, CUBE_ALONE),
    MARCH("in a ball that is empty", "inner volumes of a sphere",                          FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS + VOLUME * GLINT_VOLUME_SPHERE, CUBE_ALONE),
    MARCH("beside a box that is empty", "from outside of inner volumes of six planes",    FROM_MASS + RAYS * RAYS_ANY + SCENE * ROOM + VOLUME * GLINT_VOLUME_BOX, CUBE_ALONE),
    MARCH("past a ball that is empty", "from outside of inner volumes of a sphere",       FROM_MASS + RAYS * RAYS_ANY + SCENE * PILLARS + VOLUME * GLINT_VOLUME_SPHERE, CUBE_ALONE),
    MARCH("edges and corners, faces of 17", "odd ones: a texel's middle lies on them",     FROM_CENTER + RAYS * RAYS_CORNERS + SCENE * ROOM + FACES * 17, CUBE_ALONE),
    EXACT("along the view's axes, faces of 48", "rays that have hardly more to turn than a step", FROM_AROUND + RAYS * RAYS_AXES + SCENE * ROOM + FACES * 48, CUBE_ALONE),
    BLOCKS("", 0, false), BLOCKS_AT(3, true), BLOCKS_AT(17, false), BLOCKS_AT(33, true), BLOCKS_AT(48, true),
    BLOCKS_AT(56, true), BLOCKS_AT(64, true), BLOCKS_AT(65, true), BLOCKS_AT(72, true), BLOCKS_AT(80, true),
    MARCH("shadows, by strides",     "shrinking steps, restored after a refinement without a hit", FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE CUBE_STRIDES),
    MARCH("shadows, exact surfaces", "every surface that a ray goes behind without a jump is hit",      FROM_AROUND + RAYS * RAYS_ANY + SCENE * PILLARS, CUBE_ALONE " cubemap_trace.surfaces=exact"),
    MARCH("after the screen",        "from where the screen ray stopped, in the cube map that is nearest there", FROM_WALL + RAYS * RAYS_ANY + SCENE * PILLARS, ""),
};
/* clang-format on */

const struct replay_case_list geometry_cubes = {items, sizeof items / sizeof *items};
