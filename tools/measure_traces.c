/* Screen traces against the truth that a capture carries: what share of the mirror rays whose true hit the depth buffer shows they find
   (recall), what share of the hits they report is right (precision), and what an oracle finds in the same depth buffer. measure_traces
   CAPTURE REPEAT PRESET [VARIANT [SLOT.PARAMETER=VALUE | SLOT=VARIANT]… ,]… prints one JSON object a line, the first for the oracle. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/replay.h"
#include "glint/sort.h"
#include "depth_traversal.h"

struct truth {
    uint32_t width, height;
    float *depth_m, *normal;
    float *distance, *visible;
    float *footprint_m; /* of the texel where the ray truly ends */
    unsigned char *has_ray, *shown, *oracle;
    struct depth_grid grid;
};

static void die(const struct glint_error *err) {
    fprintf(stderr, "measure_traces: %s\n", err->message);
    exit(1);
}

static void *image(struct glint_replay *replay, const char *name, enum glint_type type, uint32_t *width,
                   uint32_t *height) {
    struct glint_error err = {0};
    const struct glint_image *found = glint_replay_find_image(replay, name);
    if (!found) {
        fprintf(stderr, "measure_traces: no image %s\n", name);
        exit(1);
    }
    void *out = malloc((size_t)found->width * found->height * found->components * 4);
    if (!out || !glint_replay_read_image(replay, found, type, out, &err)) die(&err);
    if (width) *width = found->width, *height = found->height;
    return out;
}

static double tolerance(const struct truth *truth, size_t i) {
    return fmax(0.05 * (double)truth->distance[i], (double)truth->footprint_m[i]);
}

/* Whether the texel where a ray truly ends shows that place, and how much of its surface a texel covers. */
static void compare_ray(struct truth *truth, size_t i, const struct depth_ray *ray) {
    double place[2], depth, slopes[2], t = (double)truth->distance[i], angle = depth_grid_texel_angle(&truth->grid);
    if (!(t < 3e38) || !depth_ray_project(&truth->grid, ray, t, place, &depth)) return;
    truth->footprint_m[i] = (float)(angle * depth);
    if (place[0] < 0 || place[1] < 0 || place[0] >= truth->width || place[1] >= truth->height) return;
    uint32_t x = (uint32_t)place[0], y = (uint32_t)place[1];
    double seen = (double)truth->depth_m[(size_t)y * truth->width + x];
    if (!(seen < 3e38) || !(truth->visible[i] > 0)) return;
    depth_grid_slopes(&truth->grid, x, y, slopes);
    double steep = fabs(slopes[0]) + fabs(slopes[1]);
    if (fabs(seen / depth - 1) > 0.01 + steep) return;
    truth->shown[i] = 1;
    truth->footprint_m[i] = (float)(depth * hypot(angle, hypot(slopes[0], slopes[1])));
}

struct best {
    const struct truth *truth;
    size_t i;
    bool found;
};

/* The oracle takes, of all surfaces of the buffer that the ray comes upon, the one that is right. */
static bool meets_cell(void *user, const struct depth_cell *cell) {
    struct best *best = user;
    if (cell->own) return true;
    double near = tolerance(best->truth, best->i), t = (double)best->truth->distance[best->i];
    double slack = 0.01 + cell->steep;
    bool touches = fmin(cell->gap_in, cell->gap_out) <= slack && fmax(cell->gap_in, cell->gap_out) >= -slack;
    best->found |= touches && cell->t_in <= t + near && cell->t_out >= t - near;
    return cell->t_in <= t + near;
}

static void judge(struct truth *truth, size_t count[2]) {
    for (size_t i = 0; i < (size_t)truth->width * truth->height; ++i) {
        struct depth_ray ray;
        if (!depth_ray_init(&ray, &truth->grid, (uint32_t)(i % truth->width), (uint32_t)(i / truth->width))) continue;
        truth->has_ray[i] = 1;
        compare_ray(truth, i, &ray);
        if (!truth->shown[i]) continue;
        struct best best = {truth, i, false};
        depth_ray_traverse(&truth->grid, &ray, 1e5, meets_cell, &best);
        truth->oracle[i] = best.found;
        count[0]++;
        count[1] += best.found;
    }
}

struct tally {
    size_t rays, shown;
    /* Hits count as much as the pipeline lets them contribute: 1, or what the image of that name says. */
    double found, hits, right, wrong_shown, wrong_hidden, wrong_sky, early, late;
    double fetches, steps, fetches_long, texels_long;
    size_t long_rays;
    size_t missed[16];
    double median_error; /* of hits whose ray truly ends on a surface, relative */
};

static struct tally tally_of(struct glint_replay *replay, const struct truth *truth) {
    struct tally tally = {0};
    const size_t texels = (size_t)truth->width * truth->height;
    double *errors = malloc(texels * sizeof *errors);
    size_t error_count = 0;
    if (!errors) exit(1);
    float *travelled = image(replay, "screen_travelled", GLINT_F32, NULL, NULL);
    uint32_t *finished = image(replay, "screen_finished", GLINT_U32, NULL, NULL);
    uint32_t *fetches = image(replay, "screen_fetches", GLINT_U32, NULL, NULL);
    uint32_t *steps = image(replay, "screen_steps", GLINT_U32, NULL, NULL);
    uint32_t *end = image(replay, "screen_end", GLINT_U32, NULL, NULL);
    float *contribution =
        glint_replay_find_image(replay, "contribution") ? image(replay, "contribution", GLINT_F32, NULL, NULL) : NULL;
    for (size_t i = 0; i < (size_t)truth->width * truth->height; ++i) {
        if (!truth->has_ray[i]) continue;
        const bool hit = finished[i] && travelled[i] < 3e38f, shown = truth->shown[i];
        const double error = (double)travelled[i] - (double)truth->distance[i];
        const bool right = hit && truth->distance[i] < 3e38f && fabs(error) <= tolerance(truth, i);
        tally.rays++;
        tally.fetches += fetches[i];
        tally.steps += steps[i];
        tally.shown += shown;
        const double weight = contribution ? (double)contribution[i] : 1;
        if (shown && right) tally.found += weight;
        if (hit) tally.hits += weight;
        if (right) tally.right += weight;
        if (hit && truth->distance[i] < 3e38f) errors[error_count++] = fabs(error) / (double)truth->distance[i];
        if (shown && !hit) tally.missed[end[i] & 15]++;
        if (hit && !right) {
            if (!(truth->distance[i] < 3e38f)) tally.wrong_sky += weight;
            else if (shown) tally.wrong_shown += weight;
            else tally.wrong_hidden += weight;
            if (truth->distance[i] < 3e38f) *(error < 0 ? &tally.early : &tally.late) += weight;
        }
        struct depth_ray ray;
        double place[2], depth;
        if (travelled[i] < 3e38f &&
            depth_ray_init(&ray, &truth->grid, (uint32_t)(i % truth->width), (uint32_t)(i / truth->width)) &&
            depth_ray_project(&truth->grid, &ray, (double)travelled[i], place, &depth) &&
            hypot(place[0] - ray.x, place[1] - ray.y) > 64)
            tally.long_rays++, tally.fetches_long += fetches[i], tally.texels_long += steps[i];
    }
    glint_sort_doubles(errors, error_count);
    tally.median_error = error_count ? errors[error_count / 2] : 0;
    free(errors);
    free(travelled);
    free(finished);
    free(fetches);
    free(steps);
    free(contribution);
    free(end);
    return tally;
}

static double share(double part, double all) {
    return all > 0 ? part / all : 0;
}

static double time_of(struct glint_replay *replay, const char *slot) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; i < count; ++i)
        if (strcmp(results[i].pass->slot, slot) == 0 && results[i].ran) return (double)results[i].time.median_ns * 1e-6;
    return 0;
}

static const char *const reasons[] = {
#define REASON(name, ...) #name,
#include "shared/end_reasons.h"
#undef REASON
};

static void print(const char *name, const struct tally *t, double pyramid_ms, double trace_ms) {
    printf("{\"name\": \"%s\", \"rays\": %zu, \"shown\": %zu, \"recall\": %.5f, \"hits\": %.1f, \"precision\": %.5f, "
           "\"wrong_shown\": %.5f, \"wrong_hidden\": %.5f, \"wrong_sky\": %.5f, \"early\": %.5f, \"late\": %.5f, "
           "\"fetches\": %.3f, \"steps\": %.3f, "
           "\"long_rays\": %zu, \"long_fetches\": %.3f, \"long_steps\": %.3f, "
           "\"median_error\": %.6f, \"pyramid_ms\": %.5f, \"trace_ms\": %.5f",
           name, t->rays, t->shown, share(t->found, (double)t->shown), t->hits, share(t->right, t->hits),
           share(t->wrong_shown, t->hits), share(t->wrong_hidden, t->hits), share(t->wrong_sky, t->hits),
           share(t->early, t->hits), share(t->late, t->hits), t->fetches / (double)t->rays, t->steps / (double)t->rays,
           t->long_rays, t->fetches_long / (double)t->long_rays, t->texels_long / (double)t->long_rays, t->median_error,
           pyramid_ms, trace_ms);
    printf(", \"missed\": {");
    const char *comma = "";
    for (size_t r = 0; r < sizeof reasons / sizeof reasons[0]; ++r)
        if (t->missed[r])
            printf("%s\"%s\": %.5f", comma, reasons[r], share((double)t->missed[r], (double)t->shown)), comma = ", ";
    printf("}}\n");
    fflush(stdout);
}

static void run_pipeline(struct glint_replay *replay, struct glint_pipeline *pipeline, uint32_t repeat,
                         bool diagnostics) {
    struct glint_error err = {0};
    /* So many rounds until a GPU that was idle has raised its clocks. */
    struct glint_replay_options options = {
        .diagnostics = diagnostics, .repeat = repeat, .warmup = 20 * repeat, .no_cache = repeat > 0};
    if (!glint_replay_run(replay, pipeline, &options, NULL, NULL, &err)) die(&err);
}

static void read_truth(struct truth *truth, struct glint_capture *capture) {
    static const char *const channels[2] = {"distance.Z", "visible"};
    struct glint_error err = {0};
    const struct glint_part_info *part = glint_capture_find(capture, "truth.mirror");
    if (!part) {
        fprintf(stderr, "measure_traces: %s has no truth.mirror\n", glint_capture_path(capture));
        exit(1);
    }
    size_t texels = (size_t)part->width * part->height;
    truth->distance = malloc(texels * sizeof(float));
    truth->visible = malloc(texels * sizeof(float));
    truth->footprint_m = calloc(texels, sizeof(float));
    truth->has_ray = calloc(texels, 1);
    truth->shown = calloc(texels, 1);
    truth->oracle = calloc(texels, 1);
    if (!truth->distance || !truth->visible || !truth->footprint_m || !truth->has_ray || !truth->shown ||
        !truth->oracle)
        exit(1);
    if (!glint_capture_read(capture, part, &channels[0], 1, GLINT_F32, truth->distance, 0, &err) ||
        !glint_capture_read(capture, part, &channels[1], 1, GLINT_F32, truth->visible, 0, &err))
        die(&err);
}

int main(int argc, char **argv) {
    struct glint_error err = {0};
    if (argc < 4) {
        fprintf(stderr, "usage: measure_traces CAPTURE REPEAT PRESET [VARIANT [SETTING]... ,]...\n");
        return 2;
    }
    const uint32_t repeat = (uint32_t)atoi(argv[2]);
    struct glint_device *device = glint_device_create(&(struct glint_device_options){0}, &err);
    struct glint_replay *replay = device ? glint_replay_create(device, &err) : NULL;
    struct glint_capture *capture = replay ? glint_capture_open(argv[1], NULL, &err) : NULL;
    if (!capture || !glint_replay_load(replay, capture, &err)) die(&err);
    struct truth truth = {0};
    read_truth(&truth, capture);
    for (int a = 4; a < argc; ++a) {
        struct glint_pipeline *pipeline = glint_pipeline_create(argv[3], &err);
        char text[128], name[512];
        snprintf(text, sizeof text, "screen_trace=%s", argv[a]);
        snprintf(name, sizeof name, "%s", argv[a]);
        if (!pipeline || !glint_pipeline_use(pipeline, text, &err)) die(&err);
        for (++a; a < argc && strcmp(argv[a], ",") != 0; ++a) {
            const size_t length = strlen(name);
            snprintf(name + length, sizeof name - length, " %s", argv[a]);
            if (!(strchr(argv[a], '.') && strchr(argv[a], '.') < strchr(argv[a], '=')
                      ? glint_pipeline_set(pipeline, argv[a], &err)
                      : glint_pipeline_use(pipeline, argv[a], &err)))
                die(&err);
        }
        run_pipeline(replay, pipeline, 0, true);
        if (!truth.depth_m) {
            truth.depth_m = image(replay, "depth_half", GLINT_F32, &truth.width, &truth.height);
            truth.normal = image(replay, "normal_half", GLINT_F32, NULL, NULL);
            depth_grid_init(&truth.grid, glint_capture_frame(capture), truth.width, truth.height, truth.depth_m,
                            truth.normal);
            size_t count[2] = {0};
            judge(&truth, count);
            printf("{\"name\": \"oracle\", \"device\": \"%s\", \"shown\": %zu, \"recall\": %.5f}\n",
                   glint_device_get_info(device)->name, count[0], share((double)count[1], (double)count[0]));
        }
        struct tally tally = tally_of(replay, &truth);
        if (repeat) run_pipeline(replay, pipeline, repeat, false);
        print(name, &tally, time_of(replay, "hiz"), time_of(replay, "screen_trace"));
        glint_pipeline_destroy(&pipeline);
    }
    glint_replay_load(replay, NULL, NULL);
    glint_capture_close(&capture);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    free(truth.depth_m);
    free(truth.normal);
    free(truth.distance);
    free(truth.visible);
    free(truth.footprint_m);
    free(truth.has_ray);
    free(truth.shown);
    free(truth.oracle);
    return 0;
}
