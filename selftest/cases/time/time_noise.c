/* Noise of rays over the frames of a static camera, and camera cuts in a whole pipeline. */
#include "cases/time/time_noise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/open_box.h"

/* Statistics of 2,048 pixels whose rays are independent: of a variance the relative standard deviation is
   sqrt((kurtosis - 1)/2048), 3.1 % for normal noise and 3.5 % for a kurtosis of 3.5, of a mean sigma/45. */
#define ALARM "a false alarm in 10^6"

enum { CURVE, FLOOR, DRIFT, NUMBERS, CUT };

/* clang-format off */
const struct glint_selftest_case time_noise[NOISE_CASES] = {
    {"noise of n frames", "the variance with a still camera is 1/n of one frame's, n up to 15; rays drawn by the pipeline", NULL, "relative", 0.18, "five standard deviations of 3.5 % of one variance of 2,048 rays: " ALARM " for each"},
    {"noise's floor", "it converges to 1/31 of one frame's, which is 0.18 sigma at 15:1", NULL, "relative", 0.1, "five standard deviations: 3.5 % by the root of as many independent pictures as the frames hold, one in 15.5; at least three"},
    {"no drift", "the mean of all pixels after 256 frames is that of the rays; in half floats", NULL, "absolute", 0.012, "five standard deviations of 0.18 sigma/45, sigma 0.56, however a device rounds what it stores"},
    {"noise of frame numbers", "0, 1 and the last two: pairwise independent", NULL, "correlation", 0.11, "five standard deviations, 1/45 each: " ALARM},
    {"cut through mafia3", "a frame after a cut has the same bits as if it were the first frame, in every image", NULL, "images that differ", 0, "nothing else goes in"},
};
/* clang-format on */

/* A figure and the number of values that it comes from. */
static void figure(struct glint_selftest_finding *finding, double error, size_t values, const char *what, int n,
                   double value, double expected) {
    finding_compare(finding, error, "%s %d: found %.6g, expected %.6g", what, n, value, expected);
    finding->values += values - 1;
}

/* ---- Rays into a sky from a wall that mirrors where it is steepest, seen under a tenth of a degree ---- */

static const char *const passes[] = {"cubemap_active", "downsample", "resolve", "temporal", NULL};
static const char *const settings[] = {"downsample.pattern=white", "temporal.extra=false", NULL};

static void tilted_wall(struct frame *frame, uint32_t number) {
    frame_ordinary(frame, number);
    for (size_t i = 0; i < FRAME_PIXELS; i++) {
        frame->travelled[i] = INFINITY;
        frame->normal[0][i] = (float)sin(0.39269908169872414);
        frame->normal[2][i] = (float)cos(0.39269908169872414);
    }
    struct glint_camera *const cameras[2] = {&frame->info.camera, &frame->info.previous};
    for (int k = 0; k < 2; k++) cameras[k]->view_to_clip[0] = 1146, cameras[k]->view_to_clip[5] = 2292;
}

struct statistic {
    double mean, variance;
};
static struct statistic statistic_of(const float *color) {
    struct statistic s = {0, 0};
    for (size_t i = 0; i < FRAME_PIXELS; i++) s.mean += (double)color[4 * i] / FRAME_PIXELS;
    for (size_t i = 0; i < FRAME_PIXELS; i++) s.variance += pow((double)color[4 * i] - s.mean, 2) / FRAME_PIXELS;
    return s;
}

struct bench {
    struct frame frame;
    float color[4 * FRAME_PIXELS], others[4][4 * FRAME_PIXELS];
    struct statistic one[256], mean[256];
};

static bool still_camera(struct frames *shot, struct bench *bench, struct glint_selftest_finding *findings,
                         struct glint_error *err) {
    const int frames = shot->context->quick ? 32 : 256;
    struct statistic all = {0, 0}, last = {0, 0};
    double floor = 0;
    bool ok = true;
    for (int n = 1; ok && n <= frames; n++) {
        tilted_wall(&bench->frame, (uint32_t)n);
        ok = frames_run(shot, &bench->frame, err) && frames_read(shot, "reflection_half", bench->color, err);
        if (ok) bench->one[n - 1] = statistic_of(bench->color);
        ok = ok && frames_read(shot, "reflection_temporal", bench->color, err);
        if (ok) bench->mean[n - 1] = statistic_of(bench->color);
    }
    for (int n = 0; n < frames; n++) {
        all.mean += bench->one[n].mean / frames;
        all.variance += bench->one[n].variance / frames;
    }
    for (int n = 2; n <= 15; n++) {
        const double part = bench->mean[n - 1].variance / all.variance;
        figure(&findings[CURVE], fabs(part * n - 1), FRAME_PIXELS, "variance after frames:", n, part, 1.0 / n);
    }
    if (shot->context->quick) return ok;
    for (int n = 48; n < frames; n++) floor += bench->mean[n].variance / all.variance / (frames - 48);
    figure(&findings[FLOOR], fabs(31 * floor - 1), FRAME_PIXELS, "variance up to frame", frames, floor, 1 / 31.0);
    for (int n = frames - 32; n < frames; n++) last.mean += bench->mean[n].mean / 32;
    figure(&findings[DRIFT], fabs(last.mean - all.mean), FRAME_PIXELS, "mean at frame", frames, last.mean, all.mean);
    return ok;
}

static bool frame_numbers(struct frames *frames, struct bench *bench, struct glint_selftest_finding *finding,
                          struct glint_error *err) {
    static const uint32_t numbers[4] = {0, 1, UINT32_MAX - 1, UINT32_MAX};
    struct statistic each[4];
    bool ok = true;
    for (int n = 0; ok && n < 4; n++) {
        tilted_wall(&bench->frame, numbers[n]);
        ok = frames_run(frames, &bench->frame, err) && frames_read(frames, "reflection_half", bench->others[n], err);
        if (ok) each[n] = statistic_of(bench->others[n]);
    }
    for (int a = 0; ok && a < 4; a++)
        for (int b = 0; b < a; b++) {
            double both = 0;
            for (size_t i = 0; i < FRAME_PIXELS; i++)
                both += ((double)bench->others[a][4 * i] - each[a].mean) *
                        ((double)bench->others[b][4 * i] - each[b].mean) / FRAME_PIXELS;
            both /= sqrt(each[a].variance * each[b].variance);
            figure(finding, fabs(both), FRAME_PIXELS, "correlation of pair", 4 * a + b, both, 0);
        }
    return ok;
}

/* ---- A cut, through the whole of a preset ---- */

static const char *const images[] = {"reflection_temporal", "temporal_age",      "reflection",
                                     "reflection_sharp",    "reflection_stable", "composed"};
enum { IMAGES = sizeof images / sizeof *images, CUT_AT = 3 };

struct pictures {
    float *values[IMAGES];
    size_t bytes[IMAGES];
};

static void free_pictures(struct pictures *pictures) {
    for (int i = 0; i < IMAGES; i++) free(pictures->values[i]);
    *pictures = (struct pictures){{NULL}, {0}};
}

static bool read_pictures(struct glint_replay *replay, struct pictures *pictures, struct glint_error *err) {
    for (int i = 0; i < IMAGES; i++) {
        const struct glint_image *image = glint_replay_find_image(replay, images[i]);
        if (!image) return glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s", images[i]);
        pictures->bytes[i] = (size_t)image->width * image->height * image->components * sizeof(float);
        if (!(pictures->values[i] = malloc(pictures->bytes[i])))
            return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        if (!glint_replay_read_image(replay, image, GLINT_F32, pictures->values[i], err)) return false;
    }
    return true;
}

static bool replay_frame(const struct case_context *context, struct glint_replay *replay,
                         const struct glint_pipeline *pipeline, const struct open_box *box,
                         struct glint_capture **capture, struct glint_error *err) {
    const struct glint_replay_options options = {.all = true};
    char path[4096];
    snprintf(path, sizeof path, "%s/cut.exr", context->folder);
    glint_replay_load(replay, NULL, NULL);
    glint_capture_close(capture);
    return open_box_write(box, path, err) && (*capture = glint_capture_open(path, NULL, err)) &&
           glint_replay_load(replay, *capture, err) &&
           glint_replay_run(replay, pipeline, &options, context->progress, context->user, err);
}

/* Half of the floor is a mirror, so that both histories of the pipeline are used. */
static void half_mirror(void *user, const char *part, const char *channel, float *plane, uint32_t width,
                        uint32_t height) {
    (void)user;
    if (strcmp(part, "gbuffer") != 0 || strcmp(channel, "material.roughness") != 0) return;
    for (size_t i = 0; i < (size_t)width * height; i++) plane[i] = i % width < width / 2 ? 0 : 0.3f;
}

/* A frame that follows others of a moving camera, or that has no predecessor. */
static bool follow(const struct case_context *context, const struct glint_pipeline *pipeline, bool cut, bool alone,
                   struct pictures *pictures, struct glint_error *err) {
    struct open_box box = {
        .width = 48, .height = 27, .cube_size = 8, .travel_m = {0.05, 0.01, -0.03}, .change = half_mirror};
    struct glint_capture *capture = NULL;
    struct glint_replay *replay = glint_replay_create(context->device, err);
    bool ok = replay != NULL;
    for (box.frame = alone ? CUT_AT : 1; ok && box.frame <= CUT_AT; box.frame++) {
        box.cut = cut && box.frame == CUT_AT;
        ok = replay_frame(context, replay, pipeline, &box, &capture, err);
    }
    ok = ok && read_pictures(replay, pictures, err);
    if (replay) glint_replay_load(replay, NULL, NULL);
    glint_replay_destroy(&replay);
    glint_capture_close(&capture);
    return ok;
}

/* Without the cut the earlier frames affect every image. */
static bool cut_leaves_no_trace(const struct case_context *context, struct glint_selftest_finding *finding,
                                struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_create("mafia3", err);
    bool ok = pipeline != NULL;
    for (int cut = 0; ok && cut < 2; cut++) {
        struct pictures in_shot = {{NULL}, {0}}, alone = {{NULL}, {0}};
        ok = follow(context, pipeline, cut, false, &in_shot, err) && follow(context, pipeline, cut, true, &alone, err);
        int differing = 0;
        for (int i = 0; ok && i < IMAGES; i++)
            differing +=
                in_shot.bytes[i] != alone.bytes[i] || memcmp(in_shot.values[i], alone.values[i], alone.bytes[i]) != 0;
        const int expected = cut ? 0 : IMAGES;
        if (ok)
            figure(finding, abs(differing - expected), alone.bytes[IMAGES - 1] / sizeof(float),
                   "images that differ, cuts:", cut, differing, expected);
        free_pictures(&in_shot), free_pictures(&alone);
    }
    glint_pipeline_destroy(&pipeline);
    return ok;
}

bool time_noise_run(struct frames *frames, const bool *selected, struct glint_selftest_finding *findings,
                    struct glint_error *err) {
    const bool quick = frames->context->quick,
               still = selected[CURVE] || (!quick && (selected[FLOOR] || selected[DRIFT]));
    struct bench *bench = calloc(1, sizeof *bench);
    bool ok = bench || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    findings[FLOOR].left_out = findings[DRIFT].left_out = findings[CUT].left_out = quick; /* these need many frames */
    frames->half = frames->planned = true;
    if (still || selected[NUMBERS]) ok = ok && frames_pipeline(frames, passes, settings, err);
    if (still) ok = ok && still_camera(frames, bench, findings, err);
    if (selected[NUMBERS]) ok = ok && frame_numbers(frames, bench, &findings[NUMBERS], err);
    free(bench);
    return ok && (!selected[CUT] || quick || cut_leaves_no_trace(frames->context, &findings[CUT], err));
}
