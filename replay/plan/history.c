/* What is left of the frame before: on the device, or in a run folder. */
#include "planner.h"

/* Whether the frame before left the image. */
static bool is_there(const struct frame_plan *plan, const struct pool *pool, const struct graph_image *image,
                     const struct image_desc *desc) {
    if (!plan->history) return pool_remembers(pool, image->name, plan->options->lineage, desc);
    const struct glint_run_image *given = plan_given(plan, image, image->name);
    return given && given->width == desc->width && given->height == desc->height * image_layers(desc);
}

/* Without a frame before, or after a cut, there is none. Of one whose plan left a pass out, what it would have made is
   nothing. */
bool plan_history(struct frame_plan *plan, const struct pool *pool, struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(plan->source->capture);
    const struct glint_replay_options *options = plan->options;
    if (options->history && !(plan->history = glint_run_open(options->history, err))) return false;
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        struct graph_image *image = &plan->graph.images[i];
        struct image_desc desc;
        if (!image->history) continue;
        if (!plan_describe(plan, image, &desc, err)) return false;
        if (frame->cut || !is_there(plan, pool, image, &desc)) image->source = SOURCE_NOTHING;
        else if (plan->history) image->source = SOURCE_RUN;
        plan->sizes.history |= image->source != SOURCE_NOTHING;
    }
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        struct graph_image *image = &plan->graph.images[i];
        image->blank = image->history && image->source == SOURCE_NOTHING && plan->sizes.history;
    }
    return true;
}
