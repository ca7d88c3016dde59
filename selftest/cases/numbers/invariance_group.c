/* The group "invariance": one open box in every convention that FORMAT.md allows gives the same image. */
#include <math.h>

#include "cases/groups.h"
#include "cases/numbers/numbers_depth.h"
#include "harness/convention_case.h"

/* ---- The world's axes ---- */

/* One of the 24 rotations of the world onto its axes; 24 more are mirrored. */
static void turn_axes(uint32_t i, struct open_box *box) {
    static const int orders[6][3] = {{1, 2, 3}, {2, 3, 1}, {3, 1, 2}, {2, 1, 3}, {1, 3, 2}, {3, 2, 1}};
    const int *order = orders[i % 6];
    const uint32_t signs = i / 6; /* 0 to 7 */
    for (int k = 0; k < 3; k++) box->axes[k] = signs >> k & 1 ? -order[k] : order[k];
}
static bool is_mirrored(uint32_t i) {
    const uint32_t signs = i / 6;
    return (((i % 6 >= 3) + (signs & 1) + (signs >> 1 & 1) + (signs >> 2 & 1)) & 1) != 0;
}
static void turn_chosen(uint32_t i, bool mirrored, struct open_box *box) {
    for (uint32_t n = 0, j = 0; j < 48; j++)
        if (is_mirrored(j) == mirrored && n++ == i) turn_axes(j, box);
}
static void turned(uint32_t i, struct open_box *box) {
    turn_chosen(i, false, box);
}
static void mirrored(uint32_t i, struct open_box *box) {
    turn_chosen(i, true, box);
}

/* ---- The projection's ---- */

static void set_handedness(uint32_t i, struct open_box *box) {
    box->x_left = i & 1, box->y_down = i >> 1 & 1, box->depth_grows = i >> 2 & 1;
    box->clip_y = i >> 3 & 1 ? GLINT_CLIP_Y_DOWN : GLINT_CLIP_Y_UP;
}
static void set_clip_depth(uint32_t i, struct open_box *box) {
    static const enum glint_depth_encoding depths[] = {GLINT_DEPTH_REVERSED, GLINT_DEPTH_DEVICE,
                                                       GLINT_DEPTH_REVERSED_INFINITE, GLINT_DEPTH_VIEW_LINEAR};
    set_handedness(i, box);
    box->clip_z = i & 1 ? GLINT_CLIP_Z_ZERO_TO_ONE : GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
    box->encodings.depth = depths[i / 2 % 4];
    box->near_m = 0.3, box->far_m = 100;
}

/* ---- All of it ---- */

static uint32_t next_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 16;
}

static void any_encoding(uint32_t *state, struct open_box *box) {
    box->encodings = (struct glint_encodings){.depth = next_random(state) % 6,
                                              .normal = next_random(state) % 3,
                                              .normal_space = next_random(state) % 2,
                                              .roughness = next_random(state) % 4,
                                              .motion = next_random(state) % 3,
                                              .color = next_random(state) % 3,
                                              .motion_depth = GLINT_MOTION_DEPTH_VIEW_LINEAR};
    box->near_m = 0.3, box->far_m = 100;
    box->pre_exposure = exp2(next_random(state) % 9 - 4.0);
    box->metres_per_unit = exp2(next_random(state) % 21 - 10.0);
    box->clip_z = next_random(state) % 2 ? GLINT_CLIP_Z_ZERO_TO_ONE : GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
    set_handedness(next_random(state), box);
    for (int k = 0; k < 3; k++) box->offset_m[k] = 1e4 * (next_random(state) / 32768.0 - 1);
}
static void anything(uint32_t i, struct open_box *box) {
    uint32_t state = i;
    any_encoding(&state, box);
    turn_axes(next_random(&state) % 48, box);
    box->cubes_reversed = next_random(&state) % 2;
}
static void anything_unturned(uint32_t i, struct open_box *box) {
    uint32_t state = i + 1000;
    any_encoding(&state, box);
}

/* clang-format off */
#define STEEP "; light follows 56 times the relative error of depth: see numbers"
#define ROUNDED "six roundings of 6e-8" STEEP
#define STORED "a stored float rounds depth by up to 3e-8 z/near, 8e-7, and six roundings of 6e-8" STEEP

static const struct convention_case mirrors[] = {
    {"axes turned", "each of the 24 permutations and signs of the axes, which permute the faces of the cube maps", {0}, 2e-5, .reason = ROUNDED, .variants = 24, .vary = turned},
    {"axes mirrored", "each of the 24 in a left-handed world", {0}, 2e-5, .reason = ROUNDED, .variants = 24, .vary = mirrored},
    {"view space", "x to the left, y down, z away from the viewer, clip y down", {0}, 2e-5, .reason = ROUNDED, .variants = 16, .vary = set_handedness},
    {"clip depth", "clip z from -1 to 1 and from 0 to 1, near or far at 1", {0}, 6.5e-5, .reason = STORED, .variants = 16, .vary = set_clip_depth},
    {"cube maps in another order", "the last one is the first", {.cubes_reversed = true}, 0, .reason = "the same arithmetic"},
    {"inches", "0.0254 metres a unit", {.metres_per_unit = 0.0254}, 2e-5, .reason = ROUNDED},
    {"anything", "random conventions, all at once", {0}, 6.5e-5, .reason = STORED, .variants = 24, .vary = anything},
};
static const struct convention_case lobes[] = {
    {"normals in unorm", "0 to 1 for -1 to 1", {.encodings.normal = GLINT_NORMAL_UNORM}, 0, .reason = "the floor's normal is exact"},
    {"octahedral normals", "two numbers for three", {.encodings.normal = GLINT_NORMAL_OCTAHEDRAL}, 0, .reason = "the floor's normal is exact"},
    {"normals in view space", "rotated with the camera", {.encodings.normal_space = GLINT_SPACE_VIEW}, 2e-5, .reason = ROUNDED},
    {"normals of view x and y", "view z follows", {.encodings.normal = GLINT_NORMAL_VIEW_XY}, 2e-5, .reason = ROUNDED},
    {"alpha", "the square of roughness", {.encodings.roughness = GLINT_ROUGHNESS_ALPHA}, 2e-5, .reason = ROUNDED},
    {"gloss of a rough floor", "one less roughness", {.encodings.roughness = GLINT_ROUGHNESS_GLOSS}, 2e-5, .reason = ROUNDED},
    {"spheremap normals", "view z follows", {.encodings.normal = GLINT_NORMAL_SPHEREMAP}, 2e-5, .reason = ROUNDED},
    {"log2 of a power", "of a rough floor", {.encodings.roughness = GLINT_ROUGHNESS_LOG2_POWER}, 2e-5, .reason = ROUNDED},
    {"power of a rough floor", "Blinn-Phong's", {.encodings.roughness = GLINT_ROUGHNESS_POWER}, 2e-5, .reason = ROUNDED},
    {"view-space normals of a rough floor", "x to the left, y down, z away from the viewer, clip y down", {0}, 2e-5, .reason = ROUNDED, .variants = 16, .vary = set_handedness},
    {"anything on a rough floor", "random conventions, all at once", {0}, 6.5e-5, .reason = STORED, .variants = 24, .vary = anything_unturned},
};
static const struct convention_case moves[] = {
    {"motion in NDC", "2 for the width of the picture, y up", {.encodings.motion = GLINT_MOTION_NDC}, 2e-5, .reason = ROUNDED},
    {"motion in NDC, y down", "the same where clip y is down", {.clip_y = GLINT_CLIP_Y_DOWN, .encodings.motion = GLINT_MOTION_NDC}, 2e-5, .reason = ROUNDED},
    {"motion in pixels", "96 and 64 for the size of the picture", {.encodings.motion = GLINT_MOTION_PIXELS}, 2e-5, .reason = ROUNDED},
    {"packed motion", "16 bits", {.encodings.motion = GLINT_MOTION_PACKED16}, 4.5e-4, .reason = "half a step of 1/32767 is 1.5e-3 pixels in each of two frames, over a history that changes by 0.15 a pixel"},
    {"packed motion of depth", "16 bits for metres", {.encodings.motion_depth = GLINT_MOTION_DEPTH_PACKED16}, 2e-5, .reason = ROUNDED},
};

/* Whole presets with a mirror: directions of rough surfaces and the taps of mafia3's cocoon depend on the world's axes. */
static const struct convention_case wholes[] = {
    {"anything, mafia3", "random conventions, all at once, except the axes of the world", {0}, 6.5e-5, .reason = STORED, .variants = 6, .vary = anything_unturned},
};
static const struct convention_case wholes_kf2[] = {
    {"anything, kf2", "random conventions, all at once", {0}, 6.5e-5, .reason = STORED, .variants = 6, .vary = anything},
};
static const struct convention_case wholes_gtav[] = {
    {"anything, gtav", "random conventions, all at once", {0}, 6.5e-5, .reason = STORED, .variants = 6, .vary = anything},
};
static const struct convention_case wholes_mafia_de[] = {
    {"anything, mafia_de", "random conventions, all at once", {0}, 6.5e-5, .reason = STORED, .variants = 6, .vary = anything},
};
/* clang-format on */

#define CASES(list) .cases = list, .count = sizeof list / sizeof *list
static const struct convention_set kinds[] = {
    {.image = "composed", CASES(mirrors)},
    {.preset = "mafia3", .image = "composed", .usual = {.roughness = 0.3f}, CASES(lobes)},
    {.preset = "mafia3",
     .image = "composed",
     .frames = 3,
     .usual = {.roughness = 0.3f, .travel_m = {0.05, 0.01, -0.03}},
     CASES(moves)},
    {.preset = "mafia3", .image = "composed", CASES(wholes)},
    {.preset = "kf2", .image = "composed", CASES(wholes_kf2)},
    {.preset = "gtav", .image = "composed", CASES(wholes_gtav)},
    {.preset = "mafia_de", .image = "composed", CASES(wholes_mafia_de)},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* ---- Resolution ---- */

static const struct resolution {
    const char *name, *what, *downsample;
    uint32_t width, height;
} resolutions[] = {
    /* clang-format off */
    {"half of 192 x 128", "half the resolution, of a picture twice as wide: the double replay's answer", "downsample=pick", 192, 128},
    {"all of 96 x 64", "the same number of rays, of a picture half as wide: the double replay's answer", "downsample=none", 96, 64},
    /* clang-format on */
};
enum { RESOLUTIONS = sizeof resolutions / sizeof *resolutions };

static size_t convention_count(void) {
    size_t all = 0;
    for (size_t k = 0; k < KINDS; k++) all += kinds[k].count;
    return all;
}
static size_t invariance_count(void) {
    return convention_count() + RESOLUTIONS;
}
static struct glint_selftest_case invariance_get(size_t i) {
    size_t k = 0;
    for (; k < KINDS && i >= kinds[k].count; k++) i -= kinds[k].count;
    if (k < KINDS) return convention_case_get(&kinds[k].cases[i]);
    struct glint_selftest_case c = numbers_depth_get(0); /* the same claim, unit and bound */
    c.name = resolutions[i].name, c.what = resolutions[i].what;
    return c;
}

static bool invariance_run(const struct case_context *context, const bool *selected,
                           struct glint_selftest_finding *findings, struct glint_error *err) {
    bool ok = true;
    size_t first = 0;
    for (size_t k = 0; ok && k < KINDS; first += kinds[k++].count)
        ok = convention_set_run(context, &kinds[k], selected + first, findings + first, err);
    for (size_t i = 0; ok && i < RESOLUTIONS; i++) {
        const struct open_box box = {.width = resolutions[i].width, .height = resolutions[i].height};
        if (!selected[convention_count() + i]) continue;
        ok = numbers_depth_check(context, &box, resolutions[i].downsample, &findings[convention_count() + i], err);
    }
    return ok;
}

const struct case_group invariance_group = {"invariance", "the same result under every convention", invariance_count,
                                            invariance_get, invariance_run};
