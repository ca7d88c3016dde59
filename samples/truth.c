/* The exact values of what a resolve pass estimates: the mean radiance over the whole lobe around the full-resolution normal, and the
   end of the exact mirror ray. */
#include <stdlib.h>

#include "finished.h"
#include "lobes.h"
#include "noise.h"

struct truth_work {
    const struct world *world;
    const struct view *view;
    const struct pixel *pixels;
    uint32_t samples, first; /* index of the first one in the sequence */
    bool finished;
    struct truth *truth;
};

typedef vec3 lobe(vec3 to_eye, vec3 normal, float roughness, float u, float v);

struct mean {
    double color[3], square;
    uint32_t count;
};

static void gather(struct mean *mean, vec3 color) {
    mean->color[0] += (double)color.x;
    mean->color[1] += (double)color.y;
    mean->color[2] += (double)color.z;
    double l = (double)luminance(color);
    mean->square += l * l;
    mean->count++;
}

static vec3 result(const struct mean *mean, uint32_t samples, float *weight, float *error) {
    *weight = samples ? (float)mean->count / (float)samples : 0;
    *error = 0;
    if (!mean->count) return gray(0);
    double n = mean->count;
    vec3 color = v3((float)(mean->color[0] / n), (float)(mean->color[1] / n), (float)(mean->color[2] / n));
    double l = (double)luminance(color), variance = mean->square / n - l * l;
    if (n > 1 && l > 0 && variance > 0) *error = (float)(sqrt(variance / (n - 1)) / l);
    return color;
}

/* The surface of a pixel, and the frame of its lobes. */
struct start {
    vec3 to_eye, normal; /* unit vectors; the normal of the G-buffer */
    vec3 geometric, leave;
    float roughness;
};

/* The radiance along one sample direction. */
static vec3 sample_radiance(const struct truth_work *work, const struct start *start, vec3 direction, uint32_t seed,
                            uint32_t i) {
    float u, v;
    if (!work->finished) return world_look(work->world, start->leave, direction, NULL);
    r2_point(i, hash_two(seed, 3), &u, &v);
    return finished_look(work->world, start->leave, direction, u, v);
}

/* Samples below the horizon, of the normal or of the surface itself, are repeated. */
static vec3 average_lobe(const struct truth_work *work, const struct start *start, lobe *draw, uint32_t seed,
                         float *weight, float *error) {
    enum { MOST_REPEATS = 64 };
    struct mean mean = {0};
    for (uint32_t i = 0; i < work->samples; i++) {
        float u, v;
        r2_point(work->first + i, seed, &u, &v);
        for (uint32_t k = 0; k < MOST_REPEATS; k++) {
            vec3 direction = draw(start->to_eye, start->normal, start->roughness, u, v);
            if (dot(direction, start->normal) > 0 && dot(direction, start->geometric) > 0) {
                gather(&mean, sample_radiance(work, start, direction, seed, work->first + i));
                break;
            }
            uint32_t again = hash_two(hash_two(seed, work->first + i), k);
            u = unit_float(hash_u32(again));
            v = unit_float(hash_u32(again + 1));
        }
    }
    return result(&mean, work->samples, weight, error);
}

static bool on_screen(const struct truth_work *work, const struct hit *hit) {
    double uv[2];
    vec3 to_eye = sub(view_eye(work->view), hit->position);
    if (!view_project(work->view, hit->position, 1, uv)) return false;
    if (uv[0] < 0 || uv[0] >= 1 || uv[1] < 0 || uv[1] >= 1) return false;
    if (dot(to_eye, hit->geometric) <= 0) return false;
    vec3 from = world_leave(hit, hit->geometric);
    return !world_hidden(work->world, from, sub(view_eye(work->view), from), 1);
}

static struct truth truth_of(const struct truth_work *work, uint32_t x, uint32_t y) {
    uint32_t index = y * work->view->width + x;
    struct truth truth = {.distance = INFINITY};
    struct hit seen = primary_hit(work->world, work->view, x, y);
    if (!(seen.t < INFINITY)) return truth;
    struct start start = {.to_eye = unit(sub(view_eye(work->view), seen.position)),
                          .normal = unit(work->pixels[index].normal),
                          .geometric = seen.geometric,
                          .leave = world_leave(&seen, seen.geometric),
                          .roughness = work->pixels[index].roughness};
    truth.ggx = average_lobe(work, &start, lobe_ggx, 2 * index, &truth.ggx_weight, &truth.ggx_error);
    truth.blinn_phong =
        average_lobe(work, &start, lobe_blinn_phong, 2 * index + 1, &truth.phong_weight, &truth.phong_error);
    vec3 mirror = unit(reflected(start.to_eye, start.normal));
    struct hit hit = world_trace(work->world, start.leave, mirror, 0);
    if (!(hit.t < INFINITY)) return truth;
    truth.distance = length(sub(hit.position, seen.position));
    truth.visible = on_screen(work, &hit) ? 1 : 0;
    return truth;
}

static void add_lobe(struct truth_sum *sum, int lobe, vec3 color, float weight, float error) {
    if (!(weight > 0)) return;
    double absolute = (double)error * (double)luminance(color);
    sum->color[lobe][0] += (double)color.x;
    sum->color[lobe][1] += (double)color.y;
    sum->color[lobe][2] += (double)color.z;
    sum->square[lobe] += absolute * absolute;
    sum->count[lobe]++;
}

void truth_add(struct truth_sum *sum, const struct truth *truth) {
    add_lobe(sum, 0, truth->ggx, truth->ggx_weight, truth->ggx_error);
    add_lobe(sum, 1, truth->blinn_phong, truth->phong_weight, truth->phong_error);
}

static void mean_lobe(const struct truth_sum *sum, int lobe, vec3 *color, float *error) {
    double n = sum->count[lobe];
    if (n == 0) return;
    *color = v3((float)(sum->color[lobe][0] / n), (float)(sum->color[lobe][1] / n), (float)(sum->color[lobe][2] / n));
    *error = luminance(*color) > 0 ? (float)(sqrt(sum->square[lobe]) / n) / luminance(*color) : 0;
}

void truth_mean(const struct truth_sum *sum, struct truth *truth) {
    mean_lobe(sum, 0, &truth->ggx, &truth->ggx_error);
    mean_lobe(sum, 1, &truth->blinn_phong, &truth->phong_error);
}

static void truth_row(void *user, uint32_t y) {
    const struct truth_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++)
        work->truth[(size_t)y * work->view->width + x] = truth_of(work, x, y);
}

bool render_truth(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                  uint32_t first, bool finished, struct truth *truth, struct job *job, double weight,
                  struct glint_error *err) {
    struct truth_work work = {world, view, pixels, samples, first, finished, truth};
    return parallel_for(job, "tracing the truth", weight, view->height, truth_row, &work, err);
}

bool truth_average(const struct world *world, const struct glint_sample_options *options, uint32_t number,
                   struct truth *truth, struct job *job, struct glint_error *err) {
    const struct glint_sample_options *o = options;
    size_t pixels = (size_t)o->width * o->height;
    struct truth_sum *sums = calloc(pixels, sizeof *sums);
    struct pixel *seen = calloc(pixels, sizeof *seen);
    struct truth *found = calloc(pixels, sizeof *found);
    bool ok = (sums && seen && found) || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the truth of pixels");
    for (uint32_t k = 0; ok && k < VIEW_PLACES; k++) {
        struct view view = view_through(world_scene(world), o, o->width, o->height, number, k);
        ok = render_frame(world, &view, &view, seen, job, 0, err) &&
             render_truth(world, &view, seen, o->truth_samples, k * o->truth_samples, o->finished_samples > 0, found,
                          job, 0, err);
        for (size_t i = 0; ok && i < pixels; i++) truth_add(&sums[i], &found[i]);
    }
    for (size_t i = 0; ok && i < pixels; i++) truth_mean(&sums[i], &truth[i]);
    free(sums);
    free(seen);
    free(found);
    return ok;
}
