/* Captures without some of what they need not have: every preset replays them without a NaN, the plan changes no bit, and says what is missing
   and what the passes do without it. With an argument, this many combinations for each scene and preset. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "glint/edit.h"
#include "glint/samples.h"
#include "pair.h"

enum { WIDTH = 36, HEIGHT = 20, FACE = 8 };
static int combinations = 1;

/* ---- What may be absent ---- */

/* A part or all parts that begin so, and the beginning of the channels; NULL: the part itself. */
static const struct {
    const char *part, *channels;
} optional[] = {
    {"cubemap", NULL},
    {"cubemap", "distance"},
    {"sky", NULL},
    {"scene", NULL},
    {"previous.lit", NULL},
    {"previous.scene", NULL},
    {"previous.gbuffer", NULL},
    {"planar", NULL},
    {"water", NULL},
    {"transparent", NULL},
    {"gbuffer", "motion"},
    {"gbuffer", "motion.Z"},
    {"gbuffer", "material.metalness"},
    {"gbuffer", "material.specular"},
    {"gbuffer", "albedo"},
    {"gbuffer", "vertexNormal"},
    {"gbuffer", "stencil"},
    {"cubemap.002", "distance"}, /* of one among several */
    {"cubemap.002", NULL},
};
enum { OPTIONAL = sizeof optional / sizeof *optional };
static const uint32_t BLIND = 1u << (OPTIONAL - 2), GONE = 1u << (OPTIONAL - 1);

static bool is_of(const char *part, const char *name) {
    const size_t length = strlen(name);
    return !strncmp(part, name, length) && (!part[length] || part[length] == '.');
}

static void leave_out(struct glint_edit *edit, size_t k) {
    struct glint_error err = {0};
    for (size_t p = 0; glint_edit_part(edit, p);) {
        const bool named = is_of(glint_edit_part(edit, p)->name, optional[k].part);
        if (named && !optional[k].channels) {
            glint_edit_drop_part(edit, p);
            continue;
        }
        for (size_t c = 0; named && c < glint_edit_part(edit, p)->channel_count;) {
            const char *channel = glint_edit_part(edit, p)->channels[c].name;
            if (strncmp(channel, optional[k].channels, strlen(optional[k].channels)) != 0) c++;
            else pair_check(glint_edit_drop_channel(edit, p, channel, &err), &err);
        }
        p++;
    }
}

/* `which`: a bit for each of `optional`. */
static struct glint_capture *without(const struct pair *pair, const char *from, uint32_t which) {
    struct glint_error err = {0};
    char path[256];
    snprintf(path, sizeof path, "%s/without.exr", pair->fixture->folder);
    struct glint_edit *edit = glint_edit_open(from, NULL, NULL, NULL, &err);
    pair_check(edit != NULL, &err);
    for (size_t k = 0; k < OPTIONAL; k++)
        if (which >> k & 1) leave_out(edit, k);
    pair_check(glint_edit_write(edit, path, &err), &err);
    glint_edit_close(&edit);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    pair_check(capture != NULL, &err);
    return capture;
}

static const char *sampled(const struct fixture *fixture, const char *scene, char path[256]) {
    const struct glint_sample_options options = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .cube_size = FACE,
                                                 .planar_width = 32,
                                                 .planar_height = 16,
                                                 .light_samples = 2,
                                                 .finished_samples = !strcmp(scene, "room")};
    struct glint_error err = {0};
    snprintf(path, 256, "%s/%s.exr", fixture->folder, scene);
    if (access(path, R_OK) != 0) pair_check(glint_sample_write(scene, path, &options, NULL, NULL, &err), &err);
    return path;
}

/* ---- What is expected of each ---- */

static void check_values(const struct pair *pair, const char *preset, uint32_t which) {
    const struct glint_bad_values *bad;
    struct glint_error err = {0};
    size_t count;
    pair_check(glint_replay_bad_values(pair->planned, &bad, &count, &err), &err);
    for (size_t i = 0; i < count; i++)
        if (bad[i].not_finite)
            fail_msg("%s without %x: %s holds %g at %u, %u", preset, which, bad[i].image, (double)bad[i].value,
                     bad[i].x, bad[i].y);
}

static bool lists(const struct glint_replay *replay, const char *role, const char *channels) {
    const struct glint_absence *missing;
    for (size_t i = 0; (missing = glint_replay_missing(replay, i)) != NULL; i++)
        if (!strcmp(missing->role, role) && !strcmp(missing->channels, channels)) return true;
    return false;
}

/* Everything that is listed is missing and has its cost, and a warning in run.json. */
static void check_missing(const struct pair *pair, const struct glint_capture *capture) {
    const struct glint_absence *missing;
    struct glint_error err = {0};
    char *json = glint_replay_json(pair->planned, &err);
    pair_check(json != NULL, &err);
    for (size_t i = 0; (missing = glint_replay_missing(pair->planned, i)) != NULL; i++) {
        assert_true(glint_capture_lacks(capture, missing) && strlen(missing->cost) > 20);
        assert_non_null(strstr(json, missing->cost));
    }
    free(json);
}

static size_t replay_without(struct pair *pair, const char *path, const char *preset, uint32_t which) {
    struct glint_capture *capture = without(pair, path, which);
    size_t left_out = 0;
    const size_t differ = pair_differences(pair, capture, &left_out);
    if (differ) fail_msg("%s without %x: the plan changes %zu values of the picture", preset, which, differ);
    check_values(pair, preset, which);
    check_missing(pair, capture);
    pair_check(glint_replay_load(pair->planned, NULL, NULL) && glint_replay_load(pair->whole, NULL, NULL), NULL);
    glint_capture_close(&capture);
    return left_out;
}

/* Whether the capture has what is to be left out. */
static bool has(const char *path, size_t k) {
    struct glint_error err = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    bool found = false;
    pair_check(capture != NULL, &err);
    for (size_t p = 0; p < glint_capture_part_count(capture); p++) {
        const struct glint_part_info *part = glint_capture_part(capture, p);
        for (size_t c = 0; is_of(part->name, optional[k].part) && c < part->channel_count; c++)
            found |= !optional[k].channels ||
                     !strncmp(part->channels[c].name, optional[k].channels, strlen(optional[k].channels));
    }
    glint_capture_close(&capture);
    return found;
}

/* Each alone, or every third one, so that three presets have each between them; all together, and at random. */
static void check_preset(struct pair *pair, const char *preset, const char *scene, size_t turn, uint32_t *random) {
    char path[256];
    pair_use(pair, preset);
    sampled(pair->fixture, scene, path);
    for (size_t k = 0; k < OPTIONAL; k++)
        if (has(path, k) && (combinations > 10 || k % 3 == turn % 3)) replay_without(pair, path, preset, 1u << k);
    replay_without(pair, path, preset, (1u << OPTIONAL) - 1);
    for (int i = 0; i < combinations; i++) {
        *random = *random * 1664525 + 1013904223;
        replay_without(pair, path, preset, *random >> (32 - OPTIONAL));
    }
}

static void every_preset_replays_what_there_is(void **state) {
    struct pair *pair = pair_of(state);
    /* a picture with its reflections; water and a mirrored map; panes. The first scene is the one of the short test. */
    static const struct {
        const char *preset, *scenes[3];
    } presets[] = {{"mafia3", {"room", "lake", "glasshouse"}},         {"mafia3_talk", {"lake", "room", "glasshouse"}},
                   {"mafia3_shipped", {"room", "glasshouse", "lake"}}, {"kf2", {"room", "lake", "glasshouse"}},
                   {"gtav", {"lake", "room", "glasshouse"}},           {"mafia_de", {"glasshouse", "room", "lake"}},
                   {"reference", {"glasshouse", "lake", "room"}}};
    uint32_t random = 12345;
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++)
        for (size_t s = 0; s < (combinations > 10 ? 3 : 1); s++)
            check_preset(pair, presets[p].preset, presets[p].scenes[s], p, &random);
    fixture_check_messages(pair->fixture);
}

/* ---- What passes do without ---- */

static const char *reason_of(const struct glint_replay *replay, const char *slot, bool *ran) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(results[i].pass->slot, slot)) {
            *ran = results[i].ran;
            return results[i].reason;
        }
    fail_msg("no slot %s", slot);
    return NULL;
}

/* The capture of the last run, whose results are valid as long as it is loaded. */
static struct glint_capture *loaded;
static void unload(struct pair *pair) {
    pair_check(glint_replay_load(pair->planned, NULL, NULL), NULL);
    glint_capture_close(&loaded);
}

static void run_without(struct pair *pair, const char *scene, const char *preset, uint32_t which) {
    char path[256];
    struct glint_error err = {0};
    pair_use(pair, preset);
    unload(pair);
    loaded = without(pair, sampled(pair->fixture, scene, path), which);
    pair_check(glint_replay_load(pair->planned, loaded, &err) &&
                   glint_replay_run(pair->planned, pair->pipeline, NULL, NULL, NULL, &err),
               &err);
}

static void expect_reason(const struct pair *pair, const char *slot, bool runs, const char *text) {
    bool ran;
    const char *reason = reason_of(pair->planned, slot, &ran);
    if (ran != runs || !strstr(reason, text))
        fail_msg("%s: %s, because: %s", slot, ran ? "ran" : "did not run", reason);
}

static void the_plan_says_why(void **state) {
    struct pair *pair = pair_of(state);
    run_without(pair, "lake", "mafia3", 1u << 1);
    expect_reason(pair, "cocoon", false, "0 of 8 cube maps have distances");
    expect_reason(pair, "cubemap_trace", true, "without cubemap_distance: rays that leave the screen are looked up by");
    assert_true(lists(pair->planned, "cubemap", "distance") && !lists(pair->planned, "cubemap", ""));
    run_without(pair, "lake", "mafia3", 1u << 0);
    expect_reason(pair, "cubemap_select", false, "0 cube maps");
    expect_reason(pair, "resolve", true, "without cubemap_color");
    assert_true(lists(pair->planned, "cubemap", "") && !lists(pair->planned, "cubemap", "distance"));
    run_without(pair, "lake", "mafia_de", 1u << 4 | 1u << 5 | 1u << 10);
    expect_reason(pair, "resolve", true, "without previous_lit: screen hits show this frame's picture");
    expect_reason(pair, "temporal", true, "without motion_full: reprojected with the cameras alone");
    run_without(pair, "lake", "gtav", 1u << 1); /* which looks its map up by direction anyway */
    assert_false(lists(pair->planned, "cubemap", "distance"));
    run_without(pair, "lake", "kf2", 0);
    assert_null(glint_replay_missing(pair->planned, 0));
    unload(pair);
    fixture_check_messages(pair->fixture);
}

/* An image of the planned replay as floats. */
static float *image_of(const struct pair *pair, const char *name, size_t *count) {
    struct glint_error err = {0};
    const struct glint_image *image = glint_replay_find_image(pair->planned, name);
    assert_non_null(image);
    *count = (size_t)image->width * image->height * image->components;
    float *values = malloc(*count * sizeof *values);
    assert_non_null(values);
    pair_check(glint_replay_read_image(pair->planned, image, GLINT_F32, values, &err), &err);
    return values;
}

/* Rays that no surface on screen ends: all of them, by a length of 0 on screen. setting: words, or NULL. */
static void run_off_screen(struct pair *pair, const char *scene, const char *preset, const char *variant,
                           const char *setting, uint32_t which) {
    char path[256];
    struct glint_error err = {0};
    pair_use(pair, preset);
    if (variant) pair_check(glint_pipeline_use(pair->pipeline, variant, &err), &err);
    pair_check(glint_pipeline_use(pair->pipeline, "cubemap_select=nearest", &err), &err); /* not by distances */
    pair_check(glint_pipeline_set(pair->pipeline, "screen_trace.length_m=0", &err), &err);
    for (char word[64]; setting && sscanf(setting, " %63s", word) == 1; setting = strchr(setting + 1, ' '))
        pair_check(glint_pipeline_set(pair->pipeline, word, &err), &err);
    unload(pair);
    loaded = without(pair, sampled(pair->fixture, scene, path), which);
    pair_check(glint_replay_load(pair->planned, loaded, &err) &&
                   glint_replay_run(pair->planned, pair->pipeline, NULL, NULL, NULL, &err),
               &err);
}

/* Catches: a march through distances that are not there, whose rays would all end in the sky. */
static void rays_without_distances_are_looked_up(void **state) {
    struct pair *pair = pair_of(state);
    static const char *const with_distances[] = {"mafia3", "mafia3_shipped", "mafia3_talk"};
    for (size_t p = 0; p < 3; p++) {
        size_t counts[2];
        run_off_screen(pair, "room", with_distances[p], NULL, NULL, 1u << 1);
        float *found = image_of(pair, "reflection_half", &counts[0]);
        run_off_screen(pair, "room", with_distances[p], "cubemap_trace=lookup", NULL, 0);
        float *expected = image_of(pair, "reflection_half", &counts[1]);
        assert_int_equal(counts[0], counts[1]);
        size_t differ = 0, lit = 0;
        for (size_t i = 0; i < counts[0]; i++) differ += found[i] != expected[i], lit += found[i] > 0;
        assert_true(lit > 60);
        assert_int_equal(differ, 0);
        free(found);
        free(expected);
    }
    unload(pair);
}

/* The ends of all rays of the last run, with cube maps by the numbers of their names; 255: none. `gone`: there is no cubemap.002. */
struct ends {
    size_t count;
    float *travelled;
    uint32_t *start, *end; /* cube maps */
};
static uint32_t *indices_of(const struct pair *pair, const char *name, const uint32_t *numbers) {
    struct glint_error err = {0};
    const struct glint_image *image = glint_replay_find_image(pair->planned, name);
    assert_non_null(image);
    const size_t count = (size_t)image->width * image->height;
    uint32_t *values = malloc(count * sizeof *values);
    assert_non_null(values);
    pair_check(glint_replay_read_image(pair->planned, image, GLINT_U32, values, &err), &err);
    for (size_t i = 0; numbers && i < count; i++)
        if (values[i] < 255) values[i] = numbers[values[i]];
    return values;
}
static struct ends ends_of(const struct pair *pair, bool gone) {
    struct ends ends;
    uint32_t *numbers = indices_of(pair, "active_index", NULL);
    const uint32_t active = glint_replay_find_image(pair->planned, "active_index")->width;
    for (uint32_t i = 0; gone && i < active; i++) numbers[i] += numbers[i] >= 2;
    ends.travelled = image_of(pair, "travelled", &ends.count);
    ends.start = indices_of(pair, "cubemap_best", numbers);
    ends.end = indices_of(pair, "cubemap_index", numbers);
    free(numbers);
    return ends;
}
static void ends_free(struct ends *ends) {
    free(ends->travelled), free(ends->start), free(ends->end);
}

/* Where one of the cube maps has no distances, rays that start in it are looked up in it by direction, and the others end as if it were not there.
   Catches: distances of all cube maps given up for those of one; rays that take it for one that shows nothing but sky. */
static void rays_are_traced_where_there_are_distances(void **state) {
    struct pair *pair = pair_of(state);
    static const char *const variants[] = {"cubemap_trace=march", "cubemap_trace=exact"};
    for (size_t v = 0; v < 2; v++) {
        /* Switches cost no steps, and every cube map is in every chain. */
        const char *const setting =
            v ? NULL : "cubemap_trace.count=strides cubemap_trace.chain=8 cubemap_active.chain=8";
        run_off_screen(pair, "room", "mafia3", variants[v], setting, BLIND);
        expect_reason(pair, "cubemap_trace", true, "");
        struct ends blind = ends_of(pair, false);
        run_off_screen(pair, "room", "mafia3", variants[v], setting, GONE);
        struct ends gone = ends_of(pair, true);
        size_t looked_up = 0, traced = 0, switched = 0, differ = 0;
        assert_int_equal(blind.count, gone.count);
        for (size_t i = 0; i < blind.count; i++) {
            if (blind.start[i] == 255) continue;
            if (blind.start[i] == 2) {
                looked_up++;
                assert_true(blind.travelled[i] == INFINITY && blind.end[i] == 2);
                continue;
            }
            const bool same = blind.travelled[i] == gone.travelled[i] ||
                              fabsf(blind.travelled[i] - gone.travelled[i]) <= 1e-4F * gone.travelled[i];
            assert_true(blind.start[i] == gone.start[i] && blind.end[i] != 2);
            traced++;
            switched += gone.end[i] != gone.start[i] && gone.end[i] < 255;
            differ += !same || blind.end[i] != gone.end[i];
        }
        print_message("# %s: %zu looked up, %zu traced, %zu of them by several; %zu end elsewhere\n", variants[v],
                      looked_up, traced, switched, differ);
        assert_true(looked_up > 10 && traced > 10 && switched > 0);
        assert_int_equal(differ, 0);
        ends_free(&blind), ends_free(&gone);
    }
    unload(pair);
}

/* The number of rays of the last run that end in the sky; they have its colour, and no other ray has a colour. */
static size_t rays_to_the_sky(struct pair *pair) {
    size_t count, endless = 0;
    float *travelled = image_of(pair, "travelled", &count), *color = image_of(pair, "reflection_half", &count);
    for (size_t i = 0; i < count / 4; i++) {
        const bool lit = color[4 * i + 3] == 1 && color[4 * i + 2] > 0;
        assert_int_equal(lit, travelled[i] == INFINITY);
        assert_true(lit ||
                    (color[4 * i] == 0 && color[4 * i + 1] == 0 && color[4 * i + 2] == 0 && color[4 * i + 3] == 0));
        endless += lit;
    }
    free(travelled);
    free(color);
    return endless;
}

/* Catches: rays that leave the screen and find nothing, although the picture shows the sky; a sky indoors; an off switch that leaves some. */
static void rays_without_cubemaps_end_in_the_sky(void **state) {
    struct pair *pair = pair_of(state);
    static const char *const SKY = "cubemap_trace.no_cubemap=sky", *const BLACK = "cubemap_trace.no_cubemap=black",
                             *const SHARE = "cubemap_trace.open_share=0.95";
    static const struct {
        const char *scene, *setting;
        uint32_t which;
        bool expected; /* as many as with SKY, the first case of its scene; or none */
    } cases[] = {
        {"room", SKY, 1u << 0, true},    {"room", NULL, 1u << 0, false},
        {"room", BLACK, 1u << 0, false}, {"room", SKY, 1u << 0 | 1u << 2, false},
        {"lake", SKY, 1u << 0, true},    {"lake", NULL, 1u << 0, true},
        {"lake", SHARE, 1u << 0, false}, {"lake", BLACK, 1u << 0, false},
    };
    size_t all = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        run_off_screen(pair, cases[i].scene, "mafia3", NULL, cases[i].setting, cases[i].which);
        const size_t rays = rays_to_the_sky(pair);
        print_message("# %s, %s: %zu rays end in the sky\n", cases[i].scene, cases[i].setting ? cases[i].setting : "-",
                      rays);
        if (!i || strcmp(cases[i].scene, cases[i - 1].scene)) all = rays;
        assert_true(all > 5);
        assert_int_equal(rays, cases[i].expected ? all : 0);
    }
    unload(pair);
}

/* Catches: a G-buffer without motion that is read as one in which nothing moves on screen, while the camera moves. */
static void motion_that_is_absent_is_the_cameras(void **state) {
    struct pair *pair = pair_of(state);
    struct glint_error err = {0};
    const struct glint_sample_options options = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .cube_size = FACE,
                                                 .light_samples = 2,
                                                 .frames = 2,
                                                 .travel = {0.3, 0, 0.1},
                                                 .travel_given = true};
    char path[256];
    float *found[3] = {NULL};
    size_t count = 0;
    snprintf(path, sizeof path, "%s/moving.exr", pair->fixture->folder);
    pair_check(glint_sample_write("room", path, &options, NULL, NULL, &err), &err);
    for (int i = 0; i < 3; i++) { /* without motion; not used; used */
        pair_use(pair, "mafia3");
        pair_check(i == 2 ||
                       glint_pipeline_set(pair->pipeline, i == 1 ? "pipeline.motion=0" : "pipeline.motion=1", &err),
                   &err);
        for (int frame = 1; frame <= 2; frame++) {
            snprintf(path, sizeof path, "%s/moving.%04d.exr", pair->fixture->folder, frame);
            struct glint_capture *capture = without(pair, path, i == 0 ? 1u << 10 : 0);
            pair_check(glint_replay_load(pair->planned, capture, &err) &&
                           glint_replay_run(pair->planned, pair->pipeline, NULL, NULL, NULL, &err),
                       &err);
            if (frame == 2) found[i] = image_of(pair, "reflection_temporal", &count);
            pair_check(glint_replay_load(pair->planned, NULL, &err), &err);
            glint_capture_close(&capture);
        }
    }
    assert_memory_equal(found[0], found[1], count * sizeof *found[0]);
    assert_memory_not_equal(found[1], found[2], count * sizeof *found[1]); /* it matters */
    for (int i = 0; i < 3; i++) free(found[i]);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_plan_says_why),
        cmocka_unit_test(rays_without_distances_are_looked_up),
        cmocka_unit_test(rays_are_traced_where_there_are_distances),
        cmocka_unit_test(rays_without_cubemaps_end_in_the_sky),
        cmocka_unit_test(motion_that_is_absent_is_the_cameras),
        cmocka_unit_test(every_preset_replays_what_there_is),
    };
    if (argc > 1) combinations = atoi(argv[1]);
    return cmocka_run_group_tests(tests, pair_set_up, pair_tear_down);
}
