/* crop: rays and motion stay those of the pixels, the rest keeps its bits, and a replay of the crop is a crop of the replay. */
#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../capture-format/fixture.h"

#include "edited.h"

static char made[512], room[512];

static int make_captures(void **state) {
    if (make_folder(state) != 0) return -1;
    snprintf(made, sizeof made, "%s", in_folder("made.exr"));
    snprintf(room, sizeof room, "%s", in_folder("room.exr"));
    edited_write(made);
    free(glint_ok("sample", "room", "--light=4", "-o", room, "--size", "96x64", "--cube-size", "32", "--truth", "2"));
    return 0;
}

/* The position of a pixel's centre in view space at depth 1, from the decoded camera. */
static void ray_of(const struct glint_frame *frame, const struct glint_camera *camera, const uint32_t size[2], double x,
                   double y, double ray[2]) {
    const double *m = camera->view_to_clip, front = m[14] < 0 ? -1 : 1;
    const double down = frame->clip_y == GLINT_CLIP_Y_DOWN ? 1 : -1;
    ray[0] = (2 * (x + 0.5) / size[0] - 1 - m[2] * front) / m[0];
    ray[1] = (down * (2 * (y + 0.5) / size[1] - 1) - m[6] * front) / m[5];
}

/* Both cameras see every pixel of the copy along the same ray. The remaining difference is the rounding of doubles: a few units of the
   last place of a number of the size of 1. */
static void expect_grid_rays(const char *from, const char *to, struct edited_grid grid) {
    struct glint_error err = {0};
    struct glint_capture *a = glint_capture_open(from, NULL, &err), *b = glint_capture_open(to, NULL, &err);
    if (!a || !b) fail_msg("%s", err.message);
    const struct glint_frame *f = glint_capture_frame(a), *g = glint_capture_frame(b);
    const struct glint_part_info *p = glint_capture_find(a, "gbuffer"), *q = glint_capture_find(b, "gbuffer");
    const uint32_t large[2] = {p->width, p->height}, small[2] = {q->width, q->height};
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++)
            for (int camera = 0; camera < 1 + f->has_previous; camera++) {
                double u[2], v[2];
                const uint32_t middle = (grid.step - 1) / 2;
                ray_of(f, camera ? &f->previous : &f->camera, large, grid.x0 + middle + x * grid.step,
                       grid.y0 + middle + y * grid.step, u);
                ray_of(g, camera ? &g->previous : &g->camera, small, x, y, v);
                for (int i = 0; i < 2; i++) assert_true(fabs(u[i] - v[i]) <= 4e-15);
            }
    assert_memory_equal(f->camera.world_to_view, g->camera.world_to_view, sizeof f->camera.world_to_view);
    for (int i = 0; i < 2; i++) assert_true(g->jitter_px[i] == f->jitter_px[i] / grid.step);
    glint_capture_close(&a);
    glint_capture_close(&b);
}

static void expect_rays(const char *from, const char *to, uint32_t x0, uint32_t y0) {
    expect_grid_rays(from, to, (struct edited_grid){x0, y0, 1});
}

static const char camera_and_motion[] =
    "glint.viewToClip glint.previousViewToClip motion.X motion.Y glint.storage visible";

static void rays_stay(void **state) {
    (void)state;
    static const char *const rectangles[] = {"0,0,40,24", "4,2,20,12", "6,8,2,16", "38,22,2,2", "0,20,40,4"};
    static const char *const clip_y[] = {"clipY=up", "clipY=down"};
    for (int down = 0; down < 2; down++) {
        free(glint_ok("set", made, clip_y[down], "viewToClip=1.3,0,0.03,0,0,2.1,-0.07,0,0,0,0,0.1,0,0,-1,0",
                      "jitter=0.6,0.84", "-o", in_folder("jittered.exr")));
        for (size_t i = 0; i < sizeof rectangles / sizeof *rectangles; i++) {
            unsigned x, y, w, h;
            sscanf(rectangles[i], "%u,%u,%u,%u", &x, &y, &w, &h);
            free(glint_ok("crop", in_folder("jittered.exr"), rectangles[i], "-o", in_folder("crop.exr")));
            expect_rays(in_folder("jittered.exr"), in_folder("crop.exr"), x, y);
            edited_expect_same(in_folder("jittered.exr"), in_folder("crop.exr"), x, y, camera_and_motion);
        }
    }
}

/* As many pixels as have a middle: the rest of a row that is no whole number of blocks counts if it reaches the middle of one. */
static uint32_t blocks(uint32_t size, uint32_t step) {
    return (size - (step - 1) / 2 + step - 1) / step;
}

static void every_nth_pixel_keeps_its_ray(void **state) {
    (void)state;
    static const uint32_t steps[] = {1, 2, 3, 4, 5, 7, 24};
    static const char *const clip_y[] = {"clipY=up", "clipY=down"};
    for (int down = 0; down < 2; down++) {
        free(glint_ok("set", made, clip_y[down], "viewToClip=1.3,0,0.03,0,0,2.1,-0.07,0,0,0,0,0.1,0,0,-1,0",
                      "jitter=0.6,0.84", "-o", in_folder("jittered.exr")));
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
            for (int cropped = 0; cropped < 2 && (!cropped || steps[i] <= 12); cropped++) {
                const struct edited_grid grid = {cropped ? 4 : 0, cropped ? 2 : 0, steps[i]};
                const uint32_t size[2] = {cropped ? 20 : 40, cropped ? 12 : 24};
                char every[16];
                snprintf(every, sizeof every, "%u", steps[i]);
                free(cropped
                         ? glint_ok("crop", in_folder("jittered.exr"), "4,2,20,12", "--every", every, "-o",
                                    in_folder("crop.exr"))
                         : glint_ok("crop", in_folder("jittered.exr"), "--every", every, "-o", in_folder("crop.exr")));
                free(glint_ok("validate", in_folder("crop.exr")));
                struct glint_exr *exr = edited_open(in_folder("crop.exr"));
                const struct glint_exr_part_info *lit = glint_exr_part(exr, edited_part(exr, "lit"));
                assert_int_equal(lit->width, blocks(size[0], steps[i]));
                assert_int_equal(lit->height, blocks(size[1], steps[i]));
                glint_exr_close(&exr);
                expect_grid_rays(in_folder("jittered.exr"), in_folder("crop.exr"), grid);
                edited_expect_grid(
                    in_folder("jittered.exr"), in_folder("crop.exr"), grid,
                    "glint.viewToClip glint.previousViewToClip glint.jitter motion.X motion.Y glint.storage visible");
            }
    }
}

/* A decoded offset in pixels is the same, within the step of what is stored. */
static void expect_motion(const char *from, const char *to, struct edited_grid grid) {
    static const char *const channels[] = {"motion.X", "motion.Y"};
    struct glint_error err = {0};
    struct glint_capture *a = glint_capture_open(from, NULL, &err), *b = glint_capture_open(to, NULL, &err);
    if (!a || !b) fail_msg("%s", err.message);
    const struct glint_part_info *p = glint_capture_find(a, "gbuffer"), *q = glint_capture_find(b, "gbuffer");
    float *u = calloc((size_t)p->width * p->height * 2, sizeof *u),
          *v = calloc((size_t)p->width * p->height * 2, sizeof *v);
    assert_true(u && v && glint_capture_read(a, p, channels, 2, GLINT_F32, u, 0, &err) &&
                glint_capture_read(b, q, channels, 2, GLINT_F32, v, 0, &err));
    const size_t middle = (grid.step - 1) / 2;
    double most = 0;
    for (uint32_t y = 0; y < q->height; y++)
        for (uint32_t x = 0; x < q->width; x++)
            for (uint32_t i = 0; i < 2; i++) {
                const size_t at = (grid.y0 + middle + y * grid.step) * p->width + grid.x0 + middle + x * grid.step;
                const double before = (double)u[2 * at + i] * (i ? p->height : p->width);
                const double after =
                    (double)v[2 * ((size_t)y * q->width + x) + i] * (i ? q->height : q->width) * grid.step;
                most = fmax(most, fabs(before));
                assert_true(fabs(before - after) <= 4 * 0x1p-24 * fabs(before) + 1e-6); /* floats, added up */
            }
    assert_true(most > 0.5);
    free(u);
    free(v);
    glint_capture_close(&a);
    glint_capture_close(&b);
}

static void motion_stays(void **state) {
    (void)state;
    static const char *const names[] = {"uv", "ndc", "pixels", "packed16"};
    static const char *const rectangles[] = {"16,8,48,32", "6,4,50,26"}; /* the same factor on both axes, and not */
    static const char *const every[] = {
        "2", "3", "5"}; /* 96 x 64 pixels: three are no whole number of blocks in y, five in both */
    for (int e = 0; e < 4; e++) {
        free(glint_ok("sample", "room", "--light=4", "-o", in_folder("moving.exr"), "--size", "96x64", "--cube-size",
                      "8", "--motion", names[e], "--travel", "0.1,0,0.05"));
        for (int i = 0; i < 2; i++) {
            free(glint_ok("crop", in_folder("moving.exr"), rectangles[i], "-o", in_folder("crop.exr")));
            expect_motion(in_folder("moving.exr"), in_folder("crop.exr"),
                          (struct edited_grid){i ? 6 : 16, i ? 4 : 8, 1});
        }
        for (int i = 0; i < 3; i++) {
            free(glint_ok("crop", in_folder("moving.exr"), "--every", every[i], "-o", in_folder("crop.exr")));
            free(glint_ok("validate", in_folder("crop.exr")));
            expect_motion(in_folder("moving.exr"), in_folder("crop.exr"),
                          (struct edited_grid){0, 0, (uint32_t)atoi(every[i])});
        }
    }
}

static void other_sizes_are_cropped_by_their_ratio(void **state) {
    (void)state;
    struct outcome said = glint("crop", made, "4,2,20,12", "-o", in_folder("crop.exr"), NULL);
    assert_int_equal(said.status, 0);
    assert_contains(said.err, "engine.a.list: kept whole");
    outcome_free(&said);
    struct glint_exr *exr = edited_open(in_folder("crop.exr"));
    assert_int_equal(glint_exr_part(exr, edited_part(exr, "engine.a.half"))->width, 10);
    assert_int_equal(glint_exr_part(exr, edited_part(exr, "engine.a.half"))->height, 6);
    assert_int_equal(glint_exr_part(exr, edited_part(exr, "engine.a.cube"))->height, 6 * FIX_CUBE);
    assert_int_equal(glint_exr_part(exr, edited_part(exr, "editor.overlay"))->width, 20);
    glint_exr_close(&exr);
    glint_fails(2, "crop 4,2,18,10, or leave the part out", "crop", made, "5,3,17,9", "-o", in_folder("none.exr"));
    free(glint_ok("crop", made, "4,2,18,10", "-o", in_folder("crop.exr")));
}

/* The fixture's frame is 40 x 24, with froxels of 16 x 16 pixels and an image of the engine's at half the resolution. */
static void other_sizes_are_reduced_by_their_ratio(void **state) {
    (void)state;
    static const struct {
        const char *every;
        uint32_t half[2];
        bool froxels;
    } cases[] = {
        {"2", {10, 6}, true}, {"3", {7, 4}, true}, {"4", {5, 3}, true}, {"16", {1, 1}, false}, {"24", {1, 1}, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct outcome said = glint("crop", made, "--every", cases[i].every, "-o", in_folder("crop.exr"), NULL);
        assert_int_equal(said.status, 0);
        struct glint_exr *exr = edited_open(in_folder("crop.exr"));
        const struct glint_exr_part_info *half = glint_exr_part(exr, edited_part(exr, "engine.a.half"));
        assert_non_null(half);
        assert_int_equal(half->width, cases[i].half[0]);
        assert_int_equal(half->height, cases[i].half[1]);
        assert_int_equal(edited_has(in_folder("crop.exr"), "froxels", NULL), cases[i].froxels);
        if (!cases[i].froxels) assert_contains(said.err, "froxels: left out");
        assert_contains(said.err, "engine.a.list: kept whole");
        assert_int_equal(glint_exr_part(exr, edited_part(exr, "engine.a.cube"))->height, 6 * FIX_CUBE);
        assert_int_equal(glint_exr_part(exr, edited_part(exr, "editor.overlay"))->width,
                         blocks(40, (uint32_t)atoi(cases[i].every)));
        glint_exr_close(&exr);
        outcome_free(&said);
    }
}

static void wrong_rectangles_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"0,0,0,4", "0,0,4,0", "40,0,1,1", "0,0,41,24", "39,0,2,24", "0,1048576,1,1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        glint_fails(2, "expected a rectangle within 40 x 24", "crop", made, bad[i], "-o", in_folder("none.exr"));
    glint_fails(2, "whole pixels", "crop", made, "0.5,0,4,4", "-o", in_folder("none.exr"));
    glint_fails(2, "whole pixels", "crop", made, "-1,0,4,4", "-o", in_folder("none.exr"));
    glint_fails(2, "expected 4 numbers", "crop", made, "0,0,nan,4", "-o", in_folder("none.exr"));
    glint_fails(2, "no rectangle", "crop", made, "-o", in_folder("none.exr"));
    static const char *const factors[] = {"25", "41", "32768"};
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++)
        glint_fails(2, "n from 1 to 24", "crop", made, "--every", factors[i], "-o", in_folder("none.exr"));
    static const char *const numbers[] = {"0", "-2", "2.5", "nan", "two", "", "99999999999999999999", "32769"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        glint_fails(2, "--every", "crop", made, "--every", numbers[i], "-o", in_folder("none.exr"));
    glint_fails(2, "n from 1 to 4", "crop", made, "0,0,4,4", "--every", "5", "-o", in_folder("none.exr"));
    assert_false(file_exists(in_folder("none.exr")));
}

/* The images of a run, of one pass. */
static float *run_image(const char *run, const char *file, const char *image, const char *channel, uint32_t size[2]) {
    char path[600];
    struct glint_error err = {0};
    snprintf(path, sizeof path, "%s/%s", run, file);
    struct glint_exr *exr = edited_open(path);
    const size_t part = edited_part(exr, image);
    const struct glint_exr_part_info *info = glint_exr_part(exr, part);
    assert_non_null(info);
    float *data = malloc((size_t)info->width * info->height * sizeof *data);
    uint32_t *whole = malloc((size_t)info->width * info->height * sizeof *whole);
    assert_true(data && whole);
    size[0] = info->width, size[1] = info->height;
    if (info->channels[0].stored == GLINT_STORED_UINT) {
        assert_true(glint_exr_read(exr, part, &channel, 1, GLINT_U32, whole, 0, &err));
        for (size_t i = 0; i < (size_t)size[0] * size[1]; i++) data[i] = (float)whole[i];
    } else assert_true(glint_exr_read(exr, part, &channel, 1, GLINT_F32, data, 0, &err));
    free(whole);
    glint_exr_close(&exr);
    return data;
}

static void replay_rays(const char *capture, const char *run) {
    free(glint_ok("replay", capture, "-o", run, "--preset", "kf2", "--use", "screen_trace=dda", "--set",
                  "downsample.jitter=0", "--passes", "downsample,screen_trace", "--outputs",
                  "screen_travelled,screen_finished,depth_half"));
}

static char *pass_file(const char *run, const char *slot) {
    static char names[2][64];
    static int turn;
    char *name = names[turn++ % 2];
    char path[600];
    for (int i = 0; i < 30; i++) {
        snprintf(name, 64, "%02d-%s.exr", i, slot);
        snprintf(path, sizeof path, "%s/%s", run, name);
        if (file_exists(path)) return name;
    }
    fail_msg("%s has no %s", run, slot);
    return NULL;
}

/* Where the traced ray ends at the truth's hit, the truth of the crop says that the hit is visible exactly if the ray of the crop finds it. The
   rest are hits at the border of the rectangle, and those behind surfaces that the crop does not show. */
static void expect_visible_hits(const float *far, const float *ended_whole, const float *ended, const uint32_t large[2],
                                const uint32_t small[2], uint32_t x0, uint32_t y0) {
    struct glint_exr *before = edited_open(room), *after = edited_open(in_folder("crop.exr"));
    const size_t from = edited_part(before, "truth.mirror"), to = edited_part(after, "truth.mirror");
    static const char *const names[] = {"distance.Z", "visible"};
    struct glint_error err = {0};
    float *truth = malloc((size_t)large[0] * large[1] * 2 * sizeof *truth),
          *cropped = malloc((size_t)small[0] * small[1] * 2 * sizeof *cropped);
    size_t seen = 0, hidden = 0, wrong = 0;
    assert_true(truth && cropped && glint_exr_read(before, from, names, 2, GLINT_F32, truth, 0, &err) &&
                glint_exr_read(after, to, names, 2, GLINT_F32, cropped, 0, &err));
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++) {
            const size_t i = (size_t)y * small[0] + x, k = (size_t)(y0 + y) * large[0] + x0 + x;
            assert_true(cropped[2 * i] == truth[2 * k] && cropped[2 * i + 1] <= truth[2 * k + 1]);
            if (truth[2 * k + 1] == 0 || ended_whole[k] == 0 || fabsf(far[k] - truth[2 * k]) > 0.01f * truth[2 * k])
                continue;
            *(cropped[2 * i + 1] == 1 ? &seen : &hidden) += 1;
            wrong += (cropped[2 * i + 1] == 1) != (ended[i] != 0);
        }
    print_message("# %zu hits are visible in the rectangle, %zu no longer; %zu traced otherwise\n", seen, hidden,
                  wrong);
    assert_true(seen > 100 && hidden > 100 && wrong <= (seen + hidden) / 50);
    free(truth);
    free(cropped);
    glint_exr_close(&before);
    glint_exr_close(&after);
}

/* The variants that take the first texel of each block take the same surfaces of the draft as of the whole frame, and the picture is nearer to the
   whole one's than that is to itself a pixel further. */
static void a_replay_of_every_second_pixel_is_a_draft(void **state) {
    (void)state;
    char runs[2][512];
    snprintf(runs[0], sizeof runs[0], "%s", in_folder("whole"));
    snprintf(runs[1], sizeof runs[1], "%s", in_folder("draft"));
    free(glint_ok("crop", room, "--every", "2", "-o", in_folder("crop.exr")));
    for (int i = 0; i < 2; i++)
        free(glint_ok("replay", i ? in_folder("crop.exr") : room, "-o", runs[i], "--preset", "kf2"));
    uint32_t large[2], small[2];
    float *far = run_image(runs[0], pass_file(runs[0], "downsample"), "depth_half", "Z", large),
          *near = run_image(runs[1], pass_file(runs[1], "downsample"), "depth_half", "Z", small);
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++)
            assert_true(near[(size_t)y * small[0] + x] == far[2 * ((size_t)y * large[0] + x)]);
    free(far);
    free(near);
    far = run_image(runs[0], pass_file(runs[0], "compose"), "composed", "G", large);
    near = run_image(runs[1], pass_file(runs[1], "compose"), "composed", "G", small);
    double draft = 0, neighbour = 0;
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++) {
            const float *whole = far + 2 * ((size_t)y * large[0] + x);
            draft += fabs((double)near[(size_t)y * small[0] + x] - (double)whole[0]);
            neighbour += fabs((double)whole[1] - (double)whole[0]);
        }
    print_message("# a draft differs by %.3g of what neighbours differ by\n", draft / neighbour);
    assert_true(draft > 0 && draft < neighbour / 4);
    free(far);
    free(near);
}

/* Mirror rays at every pixel, through every texel: nothing depends on a pixel's place in the picture. A ray that ends on a surface inside the
   rectangle has the same length in both; where rounding of the camera to floats decides whether it grazes a surface, it may differ. */
static void a_replay_of_the_crop_is_a_crop_of_the_replay(void **state) {
    (void)state;
    const uint32_t x0 = 18, y0 = 20;
    uint32_t large[2], small[2];
    char whole[512], part[512];
    snprintf(whole, sizeof whole, "%s", in_folder("whole"));
    snprintf(part, sizeof part, "%s", in_folder("part"));
    free(glint_ok("crop", room, "18,20,60,44", "-o", in_folder("crop.exr")));
    expect_rays(room, in_folder("crop.exr"), x0, y0);
    replay_rays(room, whole);
    replay_rays(in_folder("crop.exr"), part);
    float *far = run_image(whole, pass_file(whole, "screen_trace"), "screen_travelled", "Z", large),
          *near = run_image(part, pass_file(part, "screen_trace"), "screen_travelled", "Z", small),
          *ended = run_image(part, pass_file(part, "screen_trace"), "screen_finished", "finished", small),
          *ended_whole = run_image(whole, pass_file(whole, "screen_trace"), "screen_finished", "finished", large);
    assert_int_equal(small[0], 60);
    assert_int_equal(small[1], 44);
    size_t count = 0, differ = 0;
    for (uint32_t y = 0; y < small[1]; y++)
        for (uint32_t x = 0; x < small[0]; x++) {
            const size_t i = (size_t)y * small[0] + x, k = (size_t)(y0 + y) * large[0] + x0 + x;
            if (ended[i] == 0 || near[i] == 0) continue; /* it left the rectangle */
            count++;
            differ += ended_whole[k] == 0 || !(fabsf(far[k] - near[i]) <= 1e-4f * near[i]);
        }
    expect_visible_hits(far, ended_whole, ended, large, small, x0, y0);
    print_message("# %zu rays end in the rectangle, %zu differ\n", count, differ);
    assert_true(count > 200);
    assert_true(differ <= count / 200);
    free(far);
    free(near);
    free(ended);
    free(ended_whole);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_stay),
        cmocka_unit_test(every_nth_pixel_keeps_its_ray),
        cmocka_unit_test(motion_stays),
        cmocka_unit_test(other_sizes_are_cropped_by_their_ratio),
        cmocka_unit_test(other_sizes_are_reduced_by_their_ratio),
        cmocka_unit_test(wrong_rectangles_are_refused),
        cmocka_unit_test(a_replay_of_every_second_pixel_is_a_draft),
        cmocka_unit_test(a_replay_of_the_crop_is_a_crop_of_the_replay),
    };
    return cmocka_run_group_tests_name("crop", tests, make_captures, remove_folder);
}
