/* The group "garbage": invalid values affect only what depends on them directly. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/garbage/garbage_effects.h"
#include "cases/groups.h"

/* clang-format off */
#define ROUNDS "beyond the reach of filters only rays that cross a bad pixel read it, and may round differently"
#define ONE(name, channel, value) {name, "bad pixels on the floor: every other pixel is as without them, and all are finite", .list = {{"gbuffer", channel, value}}, .roughness = 0.3f, .reach_px = 8, .bound = 1e-6, .reason = ROUNDS}
#define MOVES(name, value) {name, "bad motion on the floor in the third frame: these pixels lose their history, every other pixel is as without them", .preset = "mafia3", .list = {{"gbuffer", "motion.X", value}}, .roughness = 0.3f, .frames = 3, .reach_px = 12, .bound = 1e-6, .reason = ROUNDS}
#define KINDS {{"gbuffer", "depth.Z", NAN}, {"gbuffer", "depth.Z", 0}, {"gbuffer", "depth.Z", -3}, {"gbuffer", "depth.Z", 1e-30f}, {"gbuffer", "depth.Z", 3.2e38f}, {"gbuffer", "depth.Z", INFINITY}, {"gbuffer", "normal.Y", NAN}, {"gbuffer", "normal.X", INFINITY}, {"gbuffer", "normal.Y", 0}, {"gbuffer", "material.roughness", NAN}, {"gbuffer", "material.roughness", -1}, {"gbuffer", "material.roughness", 1e9f}, {"gbuffer", "motion.X", NAN}, {"gbuffer", "motion.Y", INFINITY}}
#define PRESET(name, reach) {"bad pixels of every kind, " name, "14 kinds on the floor: every other pixel is as without them, and all are finite", name, .list = KINDS, .roughness = 0.3f, .reach_px = reach, .bound = 1e-6, .reason = ROUNDS}
#define SKY(name) {"stale channels under sky, " name, "normals, roughness, colours and motion under sky have no meaning: changing them has no effect", name, .where = GARBAGE_SKY, .list = {{"gbuffer", "normal.X", NAN}, {"gbuffer", "normal.Y", 1e9f}, {"gbuffer", "normal.Z", -1}, {"gbuffer", "material.roughness", INFINITY}, {"gbuffer", "material.metalness", NAN}, {"gbuffer", "material.specular", 1}, {"gbuffer", "albedo.R", INFINITY}, {"gbuffer", "albedo.G", 1}, {"gbuffer", "albedo.B", NAN}, {"gbuffer", "motion.X", NAN}, {"gbuffer", "motion.Y", 5}}, .roughness = 0.3f, .frames = 2, .reason = "nothing reads them"}
/* `only` may cut the lobe: the cone of a ray in its far tail spans much of the picture, invalid pixels included, and whether a pixel draws such a
   ray depends on its random numbers. The reach of the middle of the lobe is known. */
#define LIGHT(name, with, only, last, bad, part, value) {name, "two pixels on walls: pixels that do not reflect them are as without them, and all others are finite", with, only, .where = GARBAGE_WALL, .list = {{part, "G", value}}, .roughness = 0.05f, .frames = last, .bad_frame = bad, .reach_px = 16, .bound = 1e-6, .reason = ROUNDS}
#define ROUGH(name, part, only, place, last) {name, "a bad pixel or texel that many rays of a rough floor hit: all other pixels are finite", "mafia3", only, .where = place, .list = {{part, "G", NAN}}, .roughness = 0.5f, .frames = last, .bad_frame = 1, .cube_size = 64, .reach_px = INFINITY, .reason = "filters drop it"}
#define TEXEL(name, with, bare, channel, value) {name, "one texel of each cube map, without the screen trace: rays that end elsewhere have the same result as without it", with, bare ? NULL : "screen_trace.length_m=0", .cube_size = bare ? 32 : 64, .where = GARBAGE_TEXEL, .list = {{"cubemap", channel, value}}, .roughness = 0.05f, .bound = 1e-6, .reason = ROUNDS}

static const struct garbage_case bads[] = {
    ONE("depth NaN", "depth.Z", NAN),
    ONE("depth zero", "depth.Z", 0),
    ONE("depth next to zero", "depth.Z", 1e-30f),
    ONE("depth infinite", "depth.Z", INFINITY),
    ONE("depth negative", "depth.Z", -3),
    ONE("depth infinite behind", "depth.Z", -INFINITY),
    ONE("depth huge", "depth.Z", 3.2e38f),
    ONE("normal NaN", "normal.Y", NAN),
    ONE("normal infinite", "normal.Y", INFINITY),
    ONE("normal of length zero", "normal.Y", 0),
    ONE("normal long", "normal.Y", 1e20f),
    ONE("roughness NaN", "material.roughness", NAN),
    ONE("roughness huge", "material.roughness", 1e9f),
    ONE("roughness infinite", "material.roughness", INFINITY),
    ONE("roughness negative", "material.roughness", -1),
    PRESET("mafia3", 12), PRESET("kf2", 12), PRESET("gtav", 12), PRESET("mafia_de", 40),
    SKY("mafia3"), SKY("kf2"), SKY("gtav"), SKY("mafia_de"),
    LIGHT("light NaN", "mafia3", "downsample.split=cut", 1, 1, "lit", NAN),
    LIGHT("light infinite", "mafia3", "downsample.split=cut", 1, 1, "lit", INFINITY),
    ROUGH("light NaN, rough floor", "lit", NULL, GARBAGE_WALL, 1),
    ROUGH("light NaN in the first frame, rough floor", "lit", NULL, GARBAGE_WALL, 2),
    ROUGH("cube colour NaN, rough floor", "cubemap", "screen_trace.length_m=0", GARBAGE_TEXEL, 1),
    LIGHT("light NaN, kf2", "kf2", NULL, 1, 1, "scene", NAN),
    LIGHT("light NaN, mafia_de", "mafia_de", NULL, 1, 1, "lit", NAN),
    LIGHT("light of 10^6", "mafia3", "downsample.split=cut", 1, 1, "lit", 1e6f),
    LIGHT("light NaN in the first frame", "mafia3", NULL, 4, 1, "lit", NAN),
    LIGHT("light NaN in the first frame, mafia_de", "mafia_de", NULL, 4, 1, "lit", NAN),
    MOVES("motion NaN", NAN),
    MOVES("motion infinite", INFINITY),
    TEXEL("cube colour NaN", "mafia3", false, "G", NAN),
    TEXEL("cube colour infinite", "mafia3", false, "G", INFINITY),
    TEXEL("cube colour of 10^6", "mafia3", false, "G", 1e6f),
    TEXEL("cube alpha NaN", "mafia3", false, "A", NAN),
    TEXEL("cube distance NaN", "mafia3", false, "distance.Z", NAN),
    TEXEL("cube distance negative", "mafia3", false, "distance.Z", -2),
    TEXEL("cube distance zero", "mafia3", false, "distance.Z", 0),
    TEXEL("cube colour NaN, gtav", "gtav", true, "G", NAN),
    TEXEL("cube colour NaN, mafia_de", "mafia_de", true, "G", NAN),
};
/* clang-format on */

static size_t garbage_count(void) {
    return sizeof bads / sizeof *bads;
}
static struct glint_selftest_case garbage_get(size_t i) {
    return (struct glint_selftest_case){bads[i].name, bads[i].what, NULL, "absolute", bads[i].bound, bads[i].reason};
}

static struct open_box garbage_open_box(const struct garbage_case *c) {
    return open_box_filled(
        &(struct open_box){.width = 192, .height = 128, .cube_size = c->cube_size, .roughness = c->roughness});
}

/* The last frame of a shot. */
static bool replay_frames(struct pictures *pictures, const struct garbage_case *c, bool bad, struct picture *out,
                          struct glint_error *err) {
    const uint32_t frames = c->frames ? c->frames : 1, bad_frame = c->bad_frame ? c->bad_frame : frames;
    struct garbage_box box = {.box = garbage_open_box(c)};
    bool ok = true;
    box.box.change = garbage_store;
    box.box.user = &box;
    for (uint32_t n = 1; ok && n <= frames; n++) {
        box.box.frame = n;
        box.c = bad && n == bad_frame ? c : NULL;
        ok = pictures_box(pictures, &box.box, err);
    }
    return ok && pictures_read(pictures, "composed", out, err);
}

static void compare_pictures(const struct picture *clean, const struct picture *spoiled,
                             const enum garbage_effect *effects, struct glint_selftest_finding *finding) {
    for (size_t i = 0; i < (size_t)clean->width * clean->height; i++)
        for (size_t k = 0; k < 3 && effects[i] != GARBAGE_ANYTHING; k++, finding->values++) {
            const double e = (double)clean->values[4 * i + k], f = (double)spoiled->values[4 * i + k];
            const double error = !isfinite(f) ? (double)INFINITY : effects[i] == GARBAGE_FINITE ? 0 : fabs(f - e);
            if (error <= finding->worst) continue;
            finding->worst = error;
            snprintf(finding->at, sizeof finding->at, "pixel %zu,%zu channel %c: found %.9g, expected %.9g",
                     i % clean->width, i / clean->width, "RGB"[k], f, e);
        }
}

/* A pipeline and its result for the valid box, which similar cases share. */
struct bench {
    struct pictures pictures;
    const struct garbage_case *of; /* NULL: of none */
    struct picture clean, travelled;
};

static bool same_pipeline(const struct garbage_case *a, const struct garbage_case *b) {
    return a && a->preset == b->preset && a->set == b->set;
}

static bool same_box(const struct garbage_case *a, const struct garbage_case *b) {
    return same_pipeline(a, b) && a->where == b->where && !(a->roughness < b->roughness) &&
           !(a->roughness > b->roughness) && a->cube_size == b->cube_size && a->frames == b->frames;
}

static void forget_clean(struct bench *bench) {
    free(bench->clean.values), free(bench->travelled.values);
    bench->clean.values = bench->travelled.values = NULL;
}

static bool prepare_clean(struct bench *bench, const struct case_context *context, const struct garbage_case *c,
                          struct glint_error *err) {
    struct pictures *pictures = &bench->pictures;
    const struct garbage_case *of = bench->of;
    if (same_box(of, c)) return true;
    bench->of = NULL;
    forget_clean(bench);
    if (!same_pipeline(of, c)) {
        pictures_end(pictures);
        if (!(c->preset ? pictures_begin_preset(pictures, context, c->preset, err)
                        : pictures_begin(pictures, context, "\"blur\": \"plus\", ", err)) ||
            (c->set && !glint_pipeline_set(pictures->pipeline, c->set, err)))
            return false;
    }
    if (!replay_frames(pictures, c, false, &bench->clean, err) ||
        (c->where == GARBAGE_TEXEL && !pictures_read(pictures, "travelled", &bench->travelled, err)))
        return false;
    bench->of = c;
    return true;
}

/* Finest MIP levels copy invalid values, and the picture contains its own pixels; every filter leaves them out, and rays have no source there. */
static bool is_direct(const struct glint_bad_values *bad) {
    static const char *const images[] = {"composed", "lit_mips", "cubemap_color_mips", "cubemap_color_box",
                                         "cubemap_distance_mips"};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        if (strcmp(bad->image, images[i]) == 0) return true;
    return bad->pass == NULL;
}

static bool check_filters(const struct bench *bench, struct glint_selftest_finding *finding, struct glint_error *err) {
    const struct glint_bad_values *list;
    size_t count;
    if (!glint_replay_bad_values(bench->pictures.replay, &list, &count, err)) return false;
    for (size_t i = 0; i < count; i++) {
        if (is_direct(&list[i])) continue;
        finding->worst = INFINITY;
        snprintf(finding->at, sizeof finding->at, "image %s, pixel %u,%u channel %s: found %.9g", list[i].image,
                 list[i].x, list[i].y, list[i].channel, (double)list[i].value);
    }
    return true;
}

static bool run_case(struct bench *bench, const struct garbage_case *c, struct glint_selftest_finding *finding,
                     struct glint_error *err) {
    const struct open_box box = garbage_open_box(c);
    struct picture spoiled = {0};
    enum garbage_effect *effects = calloc((size_t)box.width * box.height, sizeof *effects);
    bool ok = effects || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && replay_frames(&bench->pictures, c, true, &spoiled, err);
    if (ok) {
        garbage_mask(c, &box, &bench->travelled, effects);
        compare_pictures(&bench->clean, &spoiled, effects, finding);
        if (isinf(c->reach_px)) ok = check_filters(bench, finding, err); /* rough surfaces, which are blurred first */
    }
    free(effects), free(spoiled.values);
    return ok;
}

static bool is_long(const struct garbage_case *c) {
    return c->frames > 1 || (c->preset && strcmp(c->preset, "mafia3") != 0);
}

static bool garbage_run(const struct case_context *context, const bool *selected,
                        struct glint_selftest_finding *findings, struct glint_error *err) {
    struct bench bench = {.of = NULL};
    bool ok = true;
    for (size_t i = 0; ok && i < garbage_count(); i++) {
        if (!selected[i]) continue;
        findings[i].left_out = context->quick && is_long(&bads[i]);
        if (!findings[i].left_out)
            ok = prepare_clean(&bench, context, &bads[i], err) && run_case(&bench, &bads[i], &findings[i], err);
    }
    forget_clean(&bench);
    pictures_end(&bench.pictures);
    return ok;
}

const struct case_group garbage_group = {"garbage", "bad values stay alone", garbage_count, garbage_get, garbage_run};
