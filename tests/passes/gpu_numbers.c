/* Extreme and invalid values in every kind of channel, in every preset: pixels whose own values are finite have a finite picture. Without
   arguments a short sample; as a program it takes the number of replays and the first seed, and prints a table of presets and kinds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "spoiled.h"
#include "unit.h"

enum { WIDTH = 64, HEIGHT = 36, PRESETS = 16, FRAMES = 2 };

static const struct {
    const char *name;
    uint32_t also;
} scenes[] = {
    {"street", 0x1FFF & ~GLINT_ALSO_SKY},
    {"lake", GLINT_ALSO_CAUSTICS | GLINT_ALSO_SHADOW | GLINT_ALSO_VOLUME | GLINT_ALSO_AO | GLINT_ALSO_SUN},
    {"alley", GLINT_ALSO_LAMPS | GLINT_ALSO_FROXELS},
    {"glasshouse", GLINT_ALSO_SHADOW | GLINT_ALSO_SUN},
    {"portrait", GLINT_ALSO_CURVATURE | GLINT_ALSO_SHADOW},
    {"meadow", GLINT_ALSO_SKY | GLINT_ALSO_SHADOW | GLINT_ALSO_SUN},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* Without arguments: infinite and NaN skies whose rays reached other pixels, depths of every kind, a denormal one. */
static const uint32_t sample[] = {20, 116, 157, 212, 385};
static uint32_t replays = sizeof sample / sizeof *sample, first_seed = UINT32_MAX, only_kind = SPOILED_KINDS;

struct tally {
    uint32_t replays, refused, failed; /* refused: the capture cannot be opened, with a message */
    uint64_t pixels, beyond; /* not finite: all of the pictures, and those whose captured values were all finite */
};
static struct tally tallies[PRESETS][SPOILED_KINDS];

static void frame_path(const struct gpu *gpu, const char *scene, int frame, char path[256]) {
    snprintf(path, 256, "%s/%s.%04d.exr", gpu->folder, scene, frame);
}

/* A shot of two frames of the scene, and its cube maps beside them. */
static void make_shot(const struct gpu *gpu, size_t s) {
    struct glint_error err = {0};
    char path[256];
    static bool made[SCENES];
    if (made[s]) return;
    made[s] = true;
    snprintf(path, sizeof path, "%s/%s.exr", gpu->folder, scenes[s].name);
    const struct glint_sample_options options = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .cube_size = 8,
                                                 .planar_width = 32,
                                                 .planar_height = 16,
                                                 .frames = FRAMES,
                                                 .light_samples = 4,
                                                 .also = scenes[s].also,
                                                 .threads = 1};
    if (!glint_sample_write(scenes[s].name, path, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
}

/* ---- One replay ---- */

struct trial {
    struct gpu *gpu;
    const char *preset;
    enum spoiled_kind kind;
    uint32_t seed;
    struct spoiled spoiled;
    struct tally *tally;
};

static bool is_picture(const char *name) {
    static const char *const others[] = {"antialiased", "unstippled", "bloomed",      "exposed",
                                         "toned",       "graded",     "lit_scattered"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (!strcmp(name, others[i])) return true;
    return !strncmp(name, "composed", 8);
}

static void count_picture(struct trial *trial, const struct glint_image *image) {
    struct glint_error err = {0};
    const struct spoiled *s = &trial->spoiled;
    float *texels = malloc((size_t)image->width * image->height * image->components * sizeof *texels);
    assert_non_null(texels);
    if (!glint_replay_read_image(trial->gpu->replay, image, GLINT_F32, texels, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        bool finite = true;
        for (uint32_t c = 0; c < image->components; c++) finite = finite && isfinite(texels[i * image->components + c]);
        trial->tally->pixels += !finite;
        trial->tally->beyond += !finite && !s->not_finite[i];
    }
    free(texels);
}

/* Where a value that is not finite reached a pixel whose own values are, the first pass that made one is printed, with the seed. */
static void judge(struct trial *trial, int frame) {
    struct glint_error err = {0};
    const struct glint_bad_values *bad;
    size_t count, i = 0;
    const uint64_t before = trial->tally->beyond;
    for (size_t k = 0; k < glint_replay_image_count(trial->gpu->replay); k++) {
        const struct glint_image *image = glint_replay_image(trial->gpu->replay, k);
        if (is_picture(image->name)) count_picture(trial, image);
    }
    if (trial->tally->beyond == before) return;
    trial->tally->failed++;
    if (!glint_replay_bad_values(trial->gpu->replay, &bad, &count, &err)) fail_msg("%s", err.message);
    while (i < count && (!bad[i].pass || !bad[i].not_finite)) i++;
    if (i < count)
        print_message("# seed %u %s, %s, frame %d: %s/%s %s %s at %u,%u is %g, %llu values; %s\n", trial->seed,
                      trial->preset, spoiled_names[trial->kind], frame, bad[i].pass->slot, bad[i].pass->variant,
                      bad[i].image, bad[i].channel, bad[i].x, bad[i].y, (double)bad[i].value,
                      (unsigned long long)bad[i].not_finite, trial->spoiled.what);
}

/* Replays a frame; false if it is refused. */
static bool replay(struct trial *trial, const char *path, int frame, bool may_refuse) {
    struct gpu *gpu = trial->gpu;
    struct glint_error err = {0};
    const struct glint_replay_options options = {.diagnostics = true};
    if (!glint_replay_load(gpu->replay, NULL, &err)) fail_msg("%s", err.message);
    glint_capture_close(&gpu->capture);
    gpu->capture = glint_capture_open(path, NULL, &err);
    const bool ok = gpu->capture && glint_replay_load(gpu->replay, gpu->capture, &err) &&
                    glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err);
    if (!ok && !may_refuse) fail_msg("seed %u: %s", trial->seed, err.message);
    if (!ok && !*err.message) fail_msg("seed %u: refused without a reason", trial->seed);
    if (ok) judge(trial, frame);
    memset(trial->spoiled.not_finite, 0,
           WIDTH * HEIGHT * sizeof *trial->spoiled.not_finite); /* later frames are valid */
    return ok;
}

/* The first or the second frame of the shot is spoiled; the second one has history of the first. */
static void run_trial(struct trial *trial, size_t scene) {
    struct rewrite r;
    char paths[FRAMES][256], spoiled_path[256];
    const int which = (int)(trial->seed >> 1 & 1);
    make_shot(trial->gpu, scene);
    for (int f = 0; f < FRAMES; f++) frame_path(trial->gpu, scenes[scene].name, f + 1, paths[f]);
    rewrite_load(&r, paths[which]);
    const bool any = spoil(&r, trial->kind, trial->seed, &trial->spoiled);
    if (any) {
        snprintf(spoiled_path, sizeof spoiled_path, "%s/spoiled.exr", trial->gpu->folder);
        rewrite_save(&r, spoiled_path);
        bool ok = true;
        for (int f = which; ok && f < FRAMES; f++)
            ok = replay(trial, f == which ? spoiled_path : paths[f], f, f == which);
        trial->tally->replays++;
        trial->tally->refused += !ok;
    }
    free(trial->spoiled.not_finite);
    rewrite_finish(&r);
}

/* ---- The table ---- */

static uint64_t print_table(void) {
    uint64_t wrong = 0;
    print_message(
        "# preset: by kind, replays (refused) failed, pixels not finite / of these beyond the values' own pixels\n");
    for (size_t p = 0; glint_preset(p); p++) {
        print_message("# %-18s", glint_preset(p));
        for (int k = 0; k < SPOILED_KINDS; k++) {
            const struct tally *t = &tallies[p][k];
            if (t->replays)
                print_message(" | %s: %u (%u) %u, %llu / %llu", spoiled_names[k], t->replays, t->refused, t->failed,
                              (unsigned long long)t->pixels, (unsigned long long)t->beyond);
            wrong += t->failed;
        }
        print_message("\n");
    }
    return wrong;
}

static void what_is_not_finite_stays_in_its_pixels(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    size_t presets = 0;
    while (glint_preset(presets)) presets++;
    for (uint32_t i = 0; i < replays; i++) {
        const uint32_t seed = first_seed == UINT32_MAX ? sample[i] : first_seed + i;
        const uint32_t kind = only_kind < SPOILED_KINDS ? only_kind : seed % SPOILED_KINDS;
        const size_t p = seed / SPOILED_KINDS % presets, scene = seed / SPOILED_KINDS / presets % SCENES;
        struct trial trial = {gpu, glint_preset(p), (enum spoiled_kind)kind, seed, {0}, &tallies[p][kind]};
        glint_pipeline_destroy(&gpu->pipeline);
        gpu->pipeline = glint_pipeline_create(trial.preset, &err);
        if (!gpu->pipeline) fail_msg("%s", err.message);
        run_trial(&trial, scene);
    }
    assert_true(print_table() == 0);
}

/* ---- What is stored ---- */

static uint64_t bad_of(const struct gpu *gpu, const char *image, uint64_t *clamped) {
    struct glint_error err = {0};
    const struct glint_bad_values *bad;
    size_t count;
    if (!glint_replay_bad_values(gpu->replay, &bad, &count, &err)) fail_msg("%s", err.message);
    *clamped = 0;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(bad[i].image, image) != 0) continue;
        *clamped = bad[i].clamped;
        return bad[i].not_finite;
    }
    return 0;
}

/* A half is at most 65504. Denormal halves, infinities and NaN stay. */
static void finite_values_stay_finite_in_halves(void **state) {
    static const float expected[8] = {65504, -65504, 65504, 1024, 0x1p-24F, INFINITY, -INFINITY, NAN};
    struct gpu *gpu = *state;
    char path[256];
    uint64_t clamped;
    plain_capture(gpu_path(gpu, "plain", path), &(struct plain){.width = 8, .height = 8, .fov_y_degrees = 60});
    gpu_load(gpu, "plain");
    gpu_reset(gpu);
    gpu_shader(gpu, "upscale", "beyond.comp");
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "reflection", NULL, NULL);
    for (int i = 0; i < 64; i++) {
        const float value = found[4 * i], right = expected[i % 8];
        if (!(isnan(right) ? isnan(value) : value == right)) fail_msg("column %d holds %g", i % 8, (double)value);
        assert_true(found[4 * i + 1] == 1 && found[4 * i + 2] == -0.25F && found[4 * i + 3] == 65504);
    }
    assert_int_equal(bad_of(gpu, "reflection", &clamped), 3 * 8);
    assert_int_equal(clamped, 3 * 8 + 64);
    free(found);
}

/* Three pixels of the wall, which the floor reflects. */
static const float captured[3] = {NAN, INFINITY, -INFINITY};
enum { ROOM = 48, BAD_ROW = 20, BAD_COLUMN = 10, APART = 12 };
static void spoil_wall(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < 3; i++)
        values[(PLAIN_LIT_G * plain->height + BAD_ROW) * plain->width + BAD_COLUMN + i * APART] = captured[i];
}

/* Rays of the floor end beside and on the bad pixels, which are seen as what they are in their own places alone. */
static void a_mirror_shows_finite_light(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint64_t clamped, reached = 0;
    plain_capture(
        gpu_path(gpu, "spoiled", path),
        &(struct plain){.width = ROOM, .height = ROOM, .fov_y_degrees = 60, .floor = true, .spoil = spoil_wall});
    gpu_load(gpu, "spoiled");
    gpu_reset(gpu);
    gpu->all = true;
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_run(gpu);
    float *composed = gpu_floats(gpu, "composed", NULL, NULL),
          *reflected = gpu_floats(gpu, "reflection_half", NULL, NULL);
    uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    for (uint32_t i = 0; i < ROOM * ROOM; i++) {
        const uint32_t x = i % ROOM - BAD_COLUMN;
        const bool bad = i / ROOM == BAD_ROW && x % APART == 0 && x < 3 * APART;
        assert_true(bad || isfinite(composed[4 * i + 1]));
        reached += finished[i] && reflected[4 * i + 3] == 0;
    }
    print_message("# %llu rays meet a bad pixel\n", (unsigned long long)reached);
    assert_true(reached >= 3 && isnan(composed[4 * (BAD_ROW * ROOM + BAD_COLUMN) + 1]));
    assert_int_equal(bad_of(gpu, "reflection_half", &clamped), 0);
    assert_int_equal(bad_of(gpu, "lit", &clamped), 3);
    free(composed), free(reflected), free(finished);
}

int main(int argc, char **argv) {
    if (argc > 1) replays = (uint32_t)strtoul(argv[1], NULL, 10), first_seed = 0;
    if (argc > 2) first_seed = (uint32_t)strtoul(argv[2], NULL, 10);
    if (argc > 3) only_kind = (uint32_t)strtoul(argv[3], NULL, 10);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finite_values_stay_finite_in_halves),
        cmocka_unit_test(a_mirror_shows_finite_light),
        cmocka_unit_test(what_is_not_finite_stays_in_its_pixels),
    };
    return cmocka_run_group_tests_name("gpu_numbers", tests, gpu_set_up, gpu_tear_down);
}
