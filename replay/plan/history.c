/* Finds images of the previous frame, on the device or in a run folder. */
#include "planner.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

/* Whether the image of the previous frame is available. */
static bool is_available(const struct frame_plan *plan, const struct pool *pool, const struct graph_image *image,
                         const struct image_desc *desc) {
    if (!plan->history) return pool_holds_history(pool, image->name, plan->options->lineage, desc);
    const struct glint_run_image *stored = plan_stored_image(plan, image, image->name);
    return stored && stored->width == desc->width && stored->height == desc->height * image_layers(desc);
}

/* ---- A run folder as history ---- */

/* A pass that ran made its images. One that is missing was not asked for, and taking the fallback value for it would change the picture in silence. */
static bool check_written(const struct frame_plan *plan, const struct graph_image *image, struct glint_error *err) {
    const char *name = image->name + strlen(HISTORY_PREFIX);
    if (plan_stored_image(plan, image, image->name)) return true;
    json_t *run = json_loads(glint_run_json(plan->history), 0, NULL);
    const json_t *pass;
    size_t i;
    bool made = false;
    json_array_foreach(json_object_get(run, "passes"), i, pass) {
        const char *slot = json_string_value(json_object_get(pass, "slot"));
        made |= image->pass && slot && !strcmp(slot, image->pass->slot) && json_is_true(json_object_get(pass, "ran"));
    }
    json_decref(run);
    return !made ||
           glint_fail(err, GLINT_ERROR_USAGE,
                      "%s: cannot be the history of %s: it lacks the image %s, as it was written with --outputs",
                      plan->options->history, glint_capture_path(plan->source->capture), name);
}

/* The view matrix of the previous frame is that of the run, up to the rounding of engines that keep matrices in single precision: a few of
   its steps of 6e-8, and of the largest element, as translations are sums of products. The unit of metres makes it at least 1. */
enum { MATRIX = 16 };
static bool same_view(const json_t *theirs, const double ours[MATRIX]) {
    double largest = 1;
    for (size_t i = 0; i < MATRIX; i++) largest = fmax(largest, fabs(ours[i]));
    for (size_t i = 0; i < MATRIX; i++)
        if (!(fabs(json_number_value(json_array_get(theirs, i)) - ours[i]) <= 1e-5 * largest)) return false;
    return true;
}

/* The field of view. The other elements hold jitter, which an engine may leave out of the previous frame's matrix. */
static bool same_lens(const json_t *theirs, const double ours[MATRIX]) {
    for (size_t i = 0; i <= 5; i += 5)
        if (!(fabs(json_number_value(json_array_get(theirs, i)) - ours[i]) <= 1e-4 * fabs(ours[i]))) return false;
    return true;
}

/* Engines that do not count frames dump 0 each time. */
static bool is_next(json_int_t theirs, uint32_t ours) {
    return theirs + 1 == (json_int_t)ours || (theirs == 0 && ours == 0);
}

/* History of another frame is worse than none, since passes believe it. */
static bool check_history(const struct frame_plan *plan, struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(plan->source->capture);
    const char *folder = plan->options->history, *path = glint_capture_path(plan->source->capture);
    json_t *run = json_loads(glint_run_json(plan->history), 0, NULL), *camera = json_object_get(run, "camera");
    const json_t *size = json_object_get(json_object_get(run, "resolution"), "full");
    const json_int_t number = json_integer_value(json_object_get(run, "frame")),
                     width = json_integer_value(json_array_get(size, 0)),
                     height = json_integer_value(json_array_get(size, 1));
    bool ok = true;
    if (!run) ok = glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    else if (width != plan->sizes.full[0] || height != plan->sizes.full[1])
        ok = glint_fail(err, GLINT_ERROR_USAGE,
                        "%s: cannot be the history of %s: expected %u x %u pixels, found %lld x %lld", folder, path,
                        plan->sizes.full[0], plan->sizes.full[1], (long long)width, (long long)height);
    else if (!is_next(number, frame->number))
        ok = glint_fail(err, GLINT_ERROR_USAGE,
                        "%s: cannot be the history of %s: expected frame %lld, the one before, found frame %lld",
                        folder, path, (long long)frame->number - 1, (long long)number);
    else if (camera && frame->has_previous &&
             !(same_view(json_object_get(camera, "world_to_view"), frame->previous.world_to_view) &&
               same_lens(json_object_get(camera, "view_to_clip"), frame->previous.view_to_clip)))
        ok = glint_fail(err, GLINT_ERROR_USAGE,
                        "%s: cannot be the history of %s: its camera is not that capture's previous camera", folder,
                        path);
    json_decref(run);
    return ok;
}

/* There is no history without a previous frame or after a camera cut. An image whose pass was dropped in the previous frame has its fallback
   value there. */
bool plan_history(struct frame_plan *plan, const struct pool *pool, struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(plan->source->capture);
    const struct glint_replay_options *options = plan->options;
    if (options->history &&
        (!(plan->history = glint_run_open(options->history, err)) || (!frame->cut && !check_history(plan, err))))
        return false;
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        struct graph_image *image = &plan->graph.images[i];
        struct image_desc desc;
        if (!image->history) continue;
        if (!plan_describe(plan, image, &desc, err)) return false;
        if (plan->history && !frame->cut && !check_written(plan, image, err)) return false;
        if (frame->cut || !is_available(plan, pool, image, &desc)) image->source = SOURCE_FALLBACK;
        else if (plan->history) image->source = SOURCE_RUN;
        plan->sizes.history |= image->source != SOURCE_FALLBACK;
    }
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        struct graph_image *image = &plan->graph.images[i];
        image->blank = image->history && image->source == SOURCE_FALLBACK && plan->sizes.history;
    }
    return true;
}
