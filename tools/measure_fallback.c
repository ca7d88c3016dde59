/* Mirror rays of a shot that no cube map could follow: their error against the truth, and how much those that fell back in either of two
   frames change from the one to the next, where the best cube map changes and where it stays, with the truth's own change beside it.
   measure_fallback PRESET [SLOT.PARAMETER=VALUE | SLOT=VARIANT]… , CAPTURE… prints one JSON object. A texel shows the same pixel in each
   frame (set downsample.alternate=false), and a mirror ray (downsample.jitter=false). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/replay.h"
#include "glint/study.h"

enum {
#define REASON(name, ...) END_##name,
#include "shared/end_reasons.h"
#undef REASON
    NO_CUBEMAP = 255
};

struct frame {
    uint32_t width, height;
    float *found, *truth; /* of each texel, R G B */
    uint8_t *fell;
    uint32_t *best; /* of the capture's cube maps */
};

static void die(const struct glint_error *err) {
    fprintf(stderr, "measure_fallback: %s\n", err->message);
    exit(1);
}

static void *image(struct glint_replay *replay, const char *name, enum glint_type type, struct frame *frame) {
    struct glint_error err = {0};
    const struct glint_image *found = glint_replay_find_image(replay, name);
    if (!found) {
        fprintf(stderr, "measure_fallback: no image %s\n", name);
        exit(1);
    }
    void *out = malloc((size_t)found->width * found->height * found->components * 4);
    if (!out || !glint_replay_read_image(replay, found, type, out, &err)) die(&err);
    if (frame) frame->width = found->width, frame->height = found->height;
    return out;
}

static float *true_reflection(struct glint_capture *capture, uint32_t *width) {
    static const char *const rgb[] = {"R", "G", "B"};
    struct glint_error err = {0};
    const struct glint_part_info *part = glint_capture_find(capture, "truth.reflection.ggx");
    if (!part) {
        fprintf(stderr, "measure_fallback: %s has no truth\n", glint_capture_path(capture));
        exit(1);
    }
    float *truth = malloc((size_t)part->width * part->height * 3 * sizeof *truth);
    if (!truth || !glint_capture_read(capture, part, rgb, 3, GLINT_F32, truth, 0, &err)) die(&err);
    *width = part->width;
    return truth;
}

static struct frame frame_of(struct glint_replay *replay, struct glint_capture *capture) {
    struct frame frame = {0};
    uint32_t full_width, *end = image(replay, "cubemap_end", GLINT_U32, &frame),
                         *pick = image(replay, "pick", GLINT_U32, NULL),
                         *active = image(replay, "active_index", GLINT_U32, NULL);
    float *normal = image(replay, "normal_half", GLINT_F32, NULL),
          *found = image(replay, "reflection_half", GLINT_F32, NULL), *truth = true_reflection(capture, &full_width);
    const size_t texels = (size_t)frame.width * frame.height;
    frame.best = image(replay, "cubemap_best", GLINT_U32, NULL);
    frame.found = malloc(texels * 3 * sizeof *frame.found);
    frame.truth = malloc(texels * 3 * sizeof *frame.truth);
    frame.fell = calloc(texels, 1);
    if (!frame.found || !frame.truth || !frame.fell) exit(1);
    for (size_t i = 0; i < texels; ++i) {
        const size_t pixel =
            (2 * (i / frame.width) + (pick[i] >> 1 & 1)) * full_width + 2 * (i % frame.width) + (pick[i] & 1);
        memcpy(frame.found + 3 * i, found + 4 * i, 3 * sizeof *found);
        memcpy(frame.truth + 3 * i, truth + 3 * pixel, 3 * sizeof *truth);
        const bool smooth = normal[4 * i + 3] <= (float)glint_effect_find("reflection")->classes[0].most && pick[i] < 4;
        frame.fell[i] = smooth && (end[i] == END_shadow_region || end[i] == END_fallback);
        frame.best[i] = frame.best[i] == NO_CUBEMAP ? NO_CUBEMAP : active[frame.best[i]];
    }
    free(end);
    free(pick);
    free(active);
    free(normal);
    free(found);
    free(truth);
    return frame;
}

static void free_frame(struct frame *frame) {
    free(frame->found);
    free(frame->truth);
    free(frame->fell);
    free(frame->best);
}

struct tally {
    size_t rays;
    double found, truth; /* sums */
};

static double symmetric(const float *found, const float *truth) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum +=
            fabs((double)found[k] - (double)truth[k]) / ((double)found[k] + (double)truth[k] + GLINT_SYMMETRIC_EPSILON);
    return sum / 3;
}

static void add_change(const struct frame *before, const struct frame *now, struct tally *error,
                       struct tally change[2]) {
    for (size_t i = 0; i < (size_t)now->width * now->height; ++i) {
        if (now->fell[i]) {
            error->rays++;
            error->found += symmetric(now->found + 3 * i, now->truth + 3 * i);
        }
        if (!before->fell || !(before->fell[i] || now->fell[i])) continue;
        if (before->best[i] == NO_CUBEMAP || now->best[i] == NO_CUBEMAP) continue;
        struct tally *t = &change[before->best[i] != now->best[i]];
        t->rays++;
        t->found += symmetric(now->found + 3 * i, before->found + 3 * i);
        t->truth += symmetric(now->truth + 3 * i, before->truth + 3 * i);
    }
}

static void print(const char *name, const struct tally *t) {
    const double per_ray = t->rays ? 1 / (double)t->rays : 0;
    printf("\"%s\": {\"rays\": %zu, \"change\": %.5f, \"truth\": %.5f}", name, t->rays, t->found * per_ray,
           t->truth * per_ray);
}

static struct glint_pipeline *pipeline_of(int argc, char **argv, int *a) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(argv[1], &err);
    if (!pipeline) die(&err);
    for (*a = 2; *a < argc && strcmp(argv[*a], ",") != 0; ++*a) {
        const char *dot = strchr(argv[*a], '.');
        if (!(dot && dot < strchr(argv[*a], '=') ? glint_pipeline_set(pipeline, argv[*a], &err)
                                                 : glint_pipeline_use(pipeline, argv[*a], &err)))
            die(&err);
    }
    return pipeline;
}

int main(int argc, char **argv) {
    struct glint_error err = {0};
    int a = 0;
    if (argc < 4) {
        fprintf(stderr, "usage: measure_fallback PRESET [SETTING]... , CAPTURE...\n");
        return 2;
    }
    static const char *const outputs[] = {"cubemap_end", "cubemap_best",    "pick", "active_index",
                                          "normal_half", "reflection_half", NULL};
    const struct glint_replay_options options = {.diagnostics = true, .outputs = outputs};
    struct glint_pipeline *pipeline = pipeline_of(argc, argv, &a);
    struct glint_device *device = glint_device_create(&(struct glint_device_options){0}, &err);
    struct glint_replay *replay = device ? glint_replay_create(device, &err) : NULL;
    if (!replay) die(&err);
    struct frame before = {0};
    struct tally error = {0}, change[2] = {{0}};
    for (++a; a < argc; ++a) {
        struct glint_capture *capture = glint_capture_open(argv[a], NULL, &err);
        if (!capture || !glint_replay_load(replay, capture, &err) ||
            !glint_replay_run(replay, pipeline, &options, NULL, NULL, &err))
            die(&err);
        struct frame now = frame_of(replay, capture);
        add_change(&before, &now, &error, change);
        free_frame(&before);
        before = now;
        glint_replay_load(replay, NULL, NULL);
        glint_capture_close(&capture);
    }
    printf("{\"rays\": %zu, \"error\": %.5f, ", error.rays, error.rays ? error.found / (double)error.rays : 0);
    print("same", &change[0]);
    printf(", ");
    print("changed", &change[1]);
    printf("}\n");
    free_frame(&before);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    glint_pipeline_destroy(&pipeline);
    return 0;
}
