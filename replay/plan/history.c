/* Finds images of the previous frame, on the device or in a run folder. */
#include "planner.h"

/* Whether the image of the previous frame is available. */
static bool is_available(const struct frame_plan *plan, const struct pool *pool, const struct graph_image *image,
                         const struct image_desc *desc) {
    if (!plan->history) return pool_holds_history(pool, image->name, plan->options->lineage, desc);
    const struct glint_run_image *stored = plan_stored_image(plan, image, image->name);
    return stored && stored->width == desc->width && stored->height == desc->height * image_layers(desc);
}

/* There is no history without a previous frame or after a camera cut. An image whose pass was dropped in the previous frame has its fallback
   value there. */
bool plan_history(struct frame_plan *plan, const struct pool *pool, struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(plan->source->capture);
    const struct glint_replay_options *options = plan->options;
    if (options->history && !(plan->history = glint_run_open(options->history, err))) return false;
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        struct graph_image *image = &plan->graph.images[i];
        struct image_desc desc;
        if (!image->history) continue;
        if (!plan_describe(plan, image, &desc, err)) return false;
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
