/* Plans change nothing: the images equal those of a replay that skips nothing, bit for bit. With an argument, of every scene with every preset;
   without, of every scene with two presets and every preset with some scenes, and of one that sends light on but reflects nothing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/samples.h"
#include "painted.h"
#include "plain_capture.h"
#include "ray_paths.h"
#include "unit.h"

enum { WIDTH = 56, HEIGHT = 32, FACE = 16, FRAMES = 2 };

static size_t differences_of_file(struct pair *pair, const char *path, size_t *left_out) {
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    pair_check(capture != NULL, &err);
    const size_t differ = pair_differences(pair, capture, left_out);
    pair_check(glint_replay_load(pair->planned, NULL, &err) && glint_replay_load(pair->whole, NULL, &err), &err);
    glint_capture_close(&capture);
    return differ;
}

/* ---- Sample scenes with presets ---- */

static bool all_pairs;

static const char *sampled(const struct fixture *fixture, const char *scene, int frame, char path[256]) {
    const struct glint_sample_options options = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .cube_size = FACE,
                                                 .planar_width = 32,
                                                 .planar_height = 16,
                                                 .frames = FRAMES,
                                                 .light_samples = 2};
    struct glint_error err = {0};
    char shot[256];
    snprintf(shot, sizeof shot, "%s/%s.exr", fixture->folder, scene);
    snprintf(path, 256, "%s/%s.%04d.exr", fixture->folder, scene, frame);
    if (access(path, R_OK) != 0) pair_check(glint_sample_write(scene, shot, &options, NULL, NULL, &err), &err);
    return path;
}

/* A single mirror, and cube maps large enough for faces to be culled. */
static const char *mirror(const struct fixture *fixture, char path[256]) {
    const struct glint_sample_options options = {
        .width = PATHS_WIDTH, .height = PATHS_HEIGHT, .cube_size = 128, .light_samples = 2};
    struct glint_error err = {0};
    snprintf(path, 256, "%s/mirror.exr", fixture->folder);
    if (access(path, R_OK) != 0) pair_check(glint_sample_write("desert_night", path, &options, NULL, NULL, &err), &err);
    return path;
}

/* Rays end on the cocoon. */
static void use_cocoon(struct pair *pair) {
    struct glint_error err = {0};
    pair_check(glint_pipeline_set(pair->pipeline, "cubemap_trace.length_m=0.1", &err) &&
                   glint_pipeline_set(pair->pipeline, "cubemap_trace.exhausted=fallback", &err),
               &err);
}

/* Catches: faces that are counted as culled although they are processed, or the reverse. */
static void check_counted_faces(const struct pair *pair) {
    const struct glint_cube_faces *all = glint_replay_cube_faces(pair->whole),
                                  *some = glint_replay_cube_faces(pair->planned);
    const uint32_t maps = pair->last.active_surveyed, crossed = glint_survey_faces(&pair->last, GLINT_SURVEY_CROSSED);
    assert_int_equal(all->uploaded,
                     2 * 6 * maps); /* colour and distance; three chains, the cocoon's levels and the cocoon */
    assert_int_equal(all->filtered, 5 * 6 * maps);
    assert_true(all->uploaded == all->uploaded_of && all->filtered == all->filtered_of);
    assert_true(some->uploaded_of == all->uploaded_of && some->filtered_of == all->filtered_of);
    assert_int_equal(some->uploaded, crossed + 6 * maps); /* the cocoon needs all distances */
    assert_int_equal(some->filtered, 6 * maps + crossed);
    assert_true(2 * (some->uploaded + some->filtered) <= all->uploaded + all->filtered);
}

/* Catches: a culled face that a ray, a filter or the cocoon reads. */
static void faces_that_no_ray_comes_to_are_left_out(void **state) {
    struct pair *pair = pair_of(state);
    static const char *const presets[] = {"mafia3", "mafia3", "mafia3_shipped", "mafia_de"};
    char path[256];
    bool *is_cpu = &pair->fixture->device->gpu.info.is_cpu;
    const bool own = *is_cpu;
    mirror(pair->fixture, path);
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++) {
        size_t left_out = 0;
        *is_cpu = p == 1 ? !own : own; /* rays are surveyed by blocks of pixels, or one by one */
        pair_use(pair, presets[p]);
        if (p < 2) use_cocoon(pair);
        assert_int_equal(differences_of_file(pair, path, &left_out), 0);
        const struct glint_survey *survey = &pair->last;
        if (p < 2) check_counted_faces(pair), check_ray_paths(&pair->last, path);
        if (p > 1 && survey->active_traced == 0) continue; /* its rays are between pixels */
        assert_true(survey->active_traced == survey->active_surveyed && survey->active_traced > 0);
        const uint32_t crossed = glint_survey_faces(survey, GLINT_SURVEY_CROSSED);
        assert_true(crossed > 0 && crossed <= 4 * survey->active_traced);
        assert_true(glint_survey_faces(survey, GLINT_SURVEY_NEARBY) >= crossed);
        assert_int_equal(glint_survey_faces(survey, GLINT_SURVEY_OPEN), 0);
    }
    fixture_check_messages(pair->fixture);
}

/* Rough rays are marched through levels of the distances themselves. */
static void read_levels(struct pair *pair) {
    struct glint_error err = {0};
    pair_check(glint_pipeline_set(pair->pipeline, "cubemap_trace.depth=captured", &err) &&
                   glint_pipeline_set(pair->pipeline, "cubemap_trace.rough_level=4", &err),
               &err);
}

/* Catches: a chain that is written without a reader, and one that is skipped although a parameter makes a pass read it. */
static void a_chain_that_no_pass_reads_is_not_made(void **state) {
    struct pair *pair = pair_of(state);
    char path[256];
    size_t left_out = 0;
    const struct glint_cube_faces *faces = glint_replay_cube_faces(pair->planned);
    sampled(pair->fixture, "room", 1, path);
    pair_use(pair, "mafia3");
    assert_int_equal(differences_of_file(pair, path, &left_out), 0);
    const uint64_t whole = faces->filtered_of;
    assert_true(faces->filtered > 0 && faces->filtered < whole);
    assert_null(glint_replay_find_image(pair->planned, "cubemap_distance_mips"));
    read_levels(pair);
    assert_int_equal(differences_of_file(pair, path, &left_out), 0);
    assert_int_equal(faces->filtered, whole);
    pair_use(pair, "mafia3"); /* a wrong declaration on purpose: nothing reads them */
    read_levels(pair);
    struct glint_pipeline *right = pair->pipeline;
    pair->pipeline = NULL;
    pair_use(pair, "mafia3");
    read_levels(pair);
    pair_spoil(pair, "cubemap_mips", "prefilter", "joined_distance(at, size, level)", "INFINITE");
    pair->other = right;
    assert_int_not_equal(differences_of_file(pair, path, &left_out), 0);
    fixture_check_messages(pair->fixture);
}

/* Catches: a rule that drops what the image depends on, history that a dropped pass would have left, and arithmetic that depends on
   what else runs. */
static void the_picture_of_a_plan_is_the_whole_picture(void **state) {
    struct pair *pair = pair_of(state);
    struct fixture *fixture = pair->fixture;
    size_t scenes, presets = 0, left_out = 0, faults = 0;
    const struct glint_sample *samples = glint_samples(&scenes);
    char path[256];
    while (glint_preset(presets)) presets++;
    for (size_t s = 0; s < scenes; s++) sampled(fixture, samples[s].name, 1, path);
    for (size_t p = 0; p < presets; p++)
        for (size_t s = 0; s < scenes; s++) {
            const bool bounced = !strcmp(samples[s].name, "matte") && !strcmp(glint_preset(p), "mafia_de_frame");
            if (!all_pairs && !bounced && s % presets != p && (s + scenes / 2) % presets != p) continue;
            pair_use(pair, glint_preset(p));
            for (int frame = 1; frame <= FRAMES; frame++) {
                snprintf(path, sizeof path, "%s/%s.%04d.exr", fixture->folder, samples[s].name, frame);
                const size_t differ = differences_of_file(pair, path, &left_out);
                if (differ)
                    print_error("%s, %s, frame %d: %zu values differ\n", glint_preset(p), samples[s].name, frame,
                                differ);
                faults += differ > 0;
            }
        }
    assert_int_equal(faults, 0);
    assert_true(left_out > 0);
    fixture_check_messages(pair->fixture);
}

/* ---- The survey ---- */

static void check_pixels(const struct glint_survey_pixels *device, const struct glint_survey_pixels *host) {
    assert_int_equal(device->count, host->count);
    assert_memory_equal(device->roughness, host->roughness, sizeof host->roughness);
    assert_memory_equal(device->by_roughness, host->by_roughness, sizeof host->by_roughness);
}

static uint64_t sum(const uint64_t *values, size_t count) {
    uint64_t all = 0;
    for (size_t i = 0; i < count; i++) all += values[i];
    return all;
}

/* Luminance by Rec. 709. */
static void light_of(struct glint_capture *capture, double range[2]) {
    static const char *const names[] = {"R", "G", "B"};
    struct glint_error err = {0};
    const size_t pixels = (size_t)WIDTH * HEIGHT;
    float *rgb = malloc(pixels * 3 * sizeof *rgb);
    assert_non_null(rgb);
    pair_check(glint_capture_read(capture, glint_capture_find(capture, "lit"), names, 3, GLINT_F32, rgb, 0, &err),
               &err);
    range[0] = INFINITY, range[1] = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float *c = rgb + 3 * i;
        const double light = 0.2126 * (double)c[0] + 0.7152 * (double)c[1] + 0.0722 * (double)c[2];
        range[0] = fmin(range[0], light), range[1] = fmax(range[1], light);
    }
    free(rgb);
}

/* Catches: pixels at the borders of blocks counted twice or not at all, and bins that miss values. The host counts independently, in
   another order. */
static void the_device_counts_as_the_host_does(void **state) {
    struct pair *pair = pair_of(state);
    struct glint_error err = {0};
    size_t scenes;
    const struct glint_sample *samples = glint_samples(&scenes);
    uint64_t water = 0, transparent = 0, moved = 0, moving = 0;
    for (size_t s = 0; s < scenes; s++) {
        char path[256];
        const struct glint_survey *device;
        struct glint_survey host;
        struct glint_capture *capture =
            glint_capture_open(sampled(pair->fixture, samples[s].name, 1, path), NULL, &err);
        pair_check(capture && glint_replay_load(pair->planned, capture, &err), &err);
        pair_check(glint_replay_survey(pair->planned, &device, NULL, &err), &err);
        pair_check(glint_survey_capture(capture, &host, &err), &err);
        assert_true(device->on_device && !host.on_device);
        assert_int_equal(device->pixels, WIDTH * HEIGHT);
        assert_int_equal(device->sky, host.sky);
        check_pixels(&device->surfaces, &host.surfaces);
        check_pixels(&device->reflecting, &host.reflecting);
        assert_memory_equal(device->depth_m, host.depth_m, sizeof host.depth_m);
        assert_int_equal(sum(device->weight, GLINT_SURVEY_WEIGHTS), device->reflecting.count);
        assert_int_equal(sum(device->metalness, GLINT_SURVEY_BINS), device->surfaces.count);
        assert_true((device->water > 0) == device->has_water && (device->transparent > 0) == device->has_transparent);
        double light[2]; /* three products and two sums of non-negative values, each rounded by 2^-24 */
        light_of(capture, light);
        for (int k = 0; k < 2; k++) assert_true(fabs(device->light[k] - light[k]) <= 4 * 0x1p-24 * light[k]);
        assert_true(light[1] > light[0]);
        if (strcmp(samples[s].name, "still_life") == 0) assert_null(glint_survey_motion(device));
        if (strcmp(samples[s].name, "matte") == 0) assert_string_equal(glint_survey_motion(device), "camera");
        water += device->water, transparent += device->transparent, moved += device->moved, moving += device->moving;
        pair_check(glint_replay_load(pair->planned, NULL, &err), &err);
        glint_capture_close(&capture);
    }
    assert_true(water && transparent && moved && moving);
    fixture_check_messages(pair->fixture);
}

/* ---- A shot whose materials change from frame to frame ---- */

/* Catches: history that a frame without some class of surfaces would have passed to one with them. Every look follows every other one. */
static void a_plan_may_change_from_frame_to_frame(void **state) {
    struct pair *pair = pair_of(state);
    static const enum look shot[] = {MATTE, MIRROR, MATTE, GLOSSY, MATTE, ROUGH,  MATTE, MIXED, MIRROR, GLOSSY, MIRROR,
                                     ROUGH, MIRROR, MIXED, GLOSSY, ROUGH, GLOSSY, MIXED, ROUGH, MIXED,  MATTE};
    static const char *const presets[] = {"mafia3", "mafia_de"};
    size_t faults = 0;
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++) {
        pair_use(pair, presets[p]);
        size_t before = 0, changes = 0;
        for (uint32_t i = 0; i < sizeof shot / sizeof *shot; i++) {
            struct glint_capture *capture =
                painted_capture(pair->fixture, &(struct painted){.look = shot[i], .number = i + 1});
            size_t left_out = 0;
            const size_t differ = pair_differences(pair, capture, &left_out);
            if (differ) print_error("%s, frame %u: %zu values differ\n", presets[p], i + 1, differ);
            faults += differ > 0;
            changes += left_out != before;
            before = left_out;
            pair_check(glint_replay_load(pair->planned, NULL, NULL) && glint_replay_load(pair->whole, NULL, NULL),
                       NULL);
            glint_capture_close(&capture);
        }
        assert_true(changes > 0);
    }
    assert_int_equal(faults, 0);
    fixture_check_messages(pair->fixture);
}

/* Catches: a composed image other than lit where nothing reflects, for any light; water and panes that are not composed over it. */
static void where_nothing_reflects_the_picture_is_lit(void **state) {
    struct pair *pair = pair_of(state);
    static const enum look shot[] = {MATTE, MATTE, MIXED, MATTE};
    static const char *const presets[] = {"mafia3", "kf2", "gtav", "mafia_de"};
    const struct glint_pass_result *results;
    size_t faults = 0, instead = 0, count;
    for (size_t p = 0; p < 2 * sizeof presets / sizeof *presets; p++) {
        pair_use(pair, presets[p / 2]);
        for (uint32_t i = 0; i < sizeof shot / sizeof *shot; i++) {
            const struct painted frame = {.look = shot[i], .number = i + 1, .bad_light = p % 2, .layers = !(p % 2)};
            struct glint_capture *capture = painted_capture(pair->fixture, &frame);
            size_t left_out = 0;
            const size_t differ = pair_differences(pair, capture, &left_out);
            if (differ) print_error("%s, %zu, frame %u: %zu values differ\n", presets[p / 2], p % 2, i + 1, differ);
            faults += differ > 0;
            results = glint_replay_results(pair->planned, &count);
            for (size_t r = 0; r < count; r++) instead += results[r].shown && !results[r].ran;
            pair_check(glint_replay_load(pair->planned, NULL, NULL) && glint_replay_load(pair->whole, NULL, NULL),
                       NULL);
            glint_capture_close(&capture);
        }
    }
    assert_int_equal(faults, 0);
    assert_int_equal(instead, 3 * 2 * sizeof presets / sizeof *presets);
    fixture_check_messages(pair->fixture);
}

/* ---- Alpha ---- */

static void half_a_window(uint32_t number, const double direction[3], float out[5]) {
    pair_cube(number, direction, out);
    out[3] = direction[2] > 0 ? 0.5f : 1;
}
static void bright(UNUSED const double direction[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = 1;
}

/* One texel of each face: in every row and column of a square of three, as the survey reads them. */
enum { SQUARES = 32, WIDE = 3 * SQUARES };
static void one_texel_a_face(uint32_t number, const double direction[3], float out[5]) {
    pair_cube(number, direction, out);
    for (uint32_t face = 0; face < 6; face++) {
        double d[3];
        plain_direction(face, 15 + face % 3, 18 + 2 * face % 3, WIDE, d);
        if (fabs(d[0] - direction[0]) + fabs(d[1] - direction[1]) + fabs(d[2] - direction[2]) < 1e-6) out[3] = 0.5f;
    }
}

/* Catches: a sky that only a cube map's alpha shows, not a distance or a pixel. */
static void alpha_alone_shows_the_sky(void **state) {
    struct pair *pair = pair_of(state);
    char path[256];
    struct glint_error err = {0};
    size_t left_out = 0;
    struct plain plain = {.width = WIDTH, .height = HEIGHT, .fov_y_degrees = 60, .cube_count = 1, .sky = bright};
    for (uint32_t faces = 5; faces <= 6; faces++) {
        plain.cube_size = faces == 6 ? WIDE : FACE;
        plain.cube = faces == 6 ? one_texel_a_face : half_a_window;
        snprintf(path, sizeof path, "%s/window%u.exr", pair->fixture->folder, faces);
        pair_check(plain_write(path, &plain, &err), &err);
        pair_use(pair, "mafia3");
        assert_int_equal(differences_of_file(pair, path, &left_out), 0);
        assert_int_equal(pair->last.sky, 0);
        assert_int_equal(glint_survey_faces(&pair->last, GLINT_SURVEY_OPEN), 0);
        assert_int_equal(glint_survey_faces(&pair->last, GLINT_SURVEY_SKY), faces);
    }
    fixture_check_messages(pair->fixture);
}

/* ---- Rules that are wrong on purpose ---- */

static void nothing_reflects(struct glint_survey *s) {
    s->reflecting = s->surfaces = (struct glint_survey_pixels){.roughness = {INFINITY, -INFINITY}};
}
static void nothing_is_smooth(struct glint_survey *s) {
    s->reflecting.roughness[0] = s->surfaces.roughness[0] = 1;
}
static void nothing_is_rough(struct glint_survey *s) {
    s->reflecting.roughness[1] = s->surfaces.roughness[1] = 0.01f;
}
static void all_are_mirrors(struct glint_survey *s) {
    s->reflecting.roughness[1] = s->surfaces.roughness[1] = 0;
}
static void cubemaps_show_no_sky(struct glint_survey *s) {
    for (uint32_t i = 0; i < s->active_surveyed; i++) s->active[i].open = 0;
}
static void no_sky_is_seen(struct glint_survey *s) {
    cubemaps_show_no_sky(s);
    for (uint32_t i = 0; i < s->active_surveyed; i++) s->active[i].sky = 0;
    s->sky = 0;
    s->has_fog = false;
}
static void rays_come_to_no_face(struct glint_survey *s) {
    for (uint32_t i = 0; i < s->active_traced; i++) s->active[i].crossed = s->active[i].nearby = 0;
}
static void rays_come_near_no_other_face(struct glint_survey *s) {
    for (uint32_t i = 0; i < s->active_traced; i++) s->active[i].nearby = 0;
}
static void there_are_no_cubemaps(struct glint_survey *s) {
    s->cubemaps = 0;
}
static void there_are_no_distances(struct glint_survey *s) {
    s->distances = 0;
}
static void there_are_no_volumes(struct glint_survey *s) {
    s->volumes = 0;
}
static void there_is_no_water(struct glint_survey *s) {
    s->has_water = false;
}
static void there_is_no_planar_map(struct glint_survey *s) {
    s->has_planar = false;
}
static void nothing_is_transparent(struct glint_survey *s) {
    s->has_transparent = false;
}
static void materials_say_nothing(struct glint_survey *s) {
    s->has_fresnel = false;
}
static void there_was_no_frame_before(struct glint_survey *s) {
    s->has_history = false;
}

/* Catches: a comparison that accepts every plan. */
static void a_wrong_rule_is_found(void **state) {
    struct pair *pair = pair_of(state);
    static const struct {
        const char *name, *scene, *preset;
        void (*falsify)(struct glint_survey *survey);
    } rules[] = {{"reflecting", "room", "mafia3", nothing_reflects},
                 {"reflecting", "street", "kf2", nothing_reflects},
                 {"reflecting", "lake", "gtav", nothing_reflects},
                 {"smooth", "room", "mafia3", nothing_is_smooth},
                 {"rough", "room", "mafia3", nothing_is_rough},
                 {"cones", "room", "mafia3", all_are_mirrors},
                 {"cube_sky", "still_life", "mafia3", cubemaps_show_no_sky},
                 {"sky_seen", "still_life", "mafia3", no_sky_is_seen},
                 {"faces that rays come to", NULL, "mafia3", rays_come_to_no_face},
                 {"faces beside those", NULL, "mafia3", rays_come_near_no_other_face},
                 {"cubemaps", "room", "mafia3", there_are_no_cubemaps},
                 {"distances", NULL, "mafia3", there_are_no_distances},
                 {"volumes", "room", "mafia3_shipped", there_are_no_volumes},
                 {"water", "lake", "gtav", there_is_no_water},
                 {"planar", "lake", "gtav", there_is_no_planar_map},
                 {"transparent", "glasshouse", "mafia_de", nothing_is_transparent}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        pair_use(pair, rules[i].preset);
        size_t left_out = 0;
        char path[256];
        pair->falsify = rules[i].falsify;
        if (rules[i].scene) sampled(pair->fixture, rules[i].scene, 1, path);
        else mirror(pair->fixture, path), use_cocoon(pair);
        if (differences_of_file(pair, path, &left_out) == 0)
            fail_msg("a wrong rule for '%s' changes nothing", rules[i].name);
    }
    fixture_check_messages(pair->fixture);
}

/* Replays painted frames with both, and returns the number of different values in the last one. */
static size_t last_difference(struct pair *pair, uint32_t frames, const float *fresnel,
                              void (*falsify)(struct glint_survey *survey)) {
    size_t differ = 0, left_out = 0;
    pair_use(pair, "mafia3");
    for (uint32_t i = 1; i <= frames; i++) {
        struct glint_capture *capture =
            painted_capture(pair->fixture, &(struct painted){.look = MIXED, .number = i, .fresnel = fresnel});
        pair->falsify = i == frames ? falsify : NULL;
        differ = pair_differences(pair, capture, &left_out);
        pair_check(glint_replay_load(pair->planned, NULL, NULL) && glint_replay_load(pair->whole, NULL, NULL), NULL);
        glint_capture_close(&capture);
    }
    return differ;
}

/* Catches the same for rules about properties of no sample: materials with a Fresnel scale, and histories that end. */
static void a_wrong_rule_about_made_frames_is_found(void **state) {
    struct pair *pair = pair_of(state);
    static const float flat = 0.1f;
    assert_int_equal(last_difference(pair, 1, &flat, NULL), 0);
    assert_int_not_equal(last_difference(pair, 1, &flat, materials_say_nothing), 0);
    assert_int_equal(last_difference(pair, 3, NULL, NULL), 0);
    assert_int_not_equal(last_difference(pair, 3, NULL, there_was_no_frame_before), 0);
    fixture_check_messages(pair->fixture);
}

/* Catches: a comparison that accepts every list of transparent surfaces or water. */
static void a_wrong_list_of_layers_is_found(void **state) {
    struct pair *pair = pair_of(state);
    static const struct {
        const char *slot, *scene, *preset, *right, *wrong;
    } lists[] = {{"classify_transparent", "glasshouse", "mafia_de", "a > 0.0", "a > 2.0"},
                 {"classify_water", "lake", "gtav", "depth_m > 0.0", "depth_m > 1e9"},
                 {"classify_water", "lake", "gtav", "if (found != 0u)", "if (found != 0u && texel.y % 4u < 2u)"}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        char path[256];
        size_t left_out = 0;
        pair_use(pair, lists[i].preset);
        pair_spoil(pair, lists[i].slot, "shown", lists[i].right, lists[i].wrong);
        if (differences_of_file(pair, sampled(pair->fixture, lists[i].scene, 1, path), &left_out) == 0)
            fail_msg("a wrong list of %s changes nothing: %s", lists[i].slot, lists[i].wrong);
    }
    fixture_check_messages(pair->fixture);
}

int main(int argc, UNUSED char **argv) {
    all_pairs = argc > 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_device_counts_as_the_host_does),
        cmocka_unit_test(a_plan_may_change_from_frame_to_frame),
        cmocka_unit_test(where_nothing_reflects_the_picture_is_lit),
        cmocka_unit_test(alpha_alone_shows_the_sky),
        cmocka_unit_test(a_wrong_rule_is_found),
        cmocka_unit_test(faces_that_no_ray_comes_to_are_left_out),
        cmocka_unit_test(a_wrong_rule_about_made_frames_is_found),
        cmocka_unit_test(a_chain_that_no_pass_reads_is_not_made),
        cmocka_unit_test(a_wrong_list_of_layers_is_found),
        cmocka_unit_test(the_picture_of_a_plan_is_the_whole_picture),
    };
    return cmocka_run_group_tests(tests, pair_set_up, pair_tear_down);
}
