/* What is left of the frame before: images that change their name when the next frame of a shot is loaded, or those of
   a run folder. */
#include "state.h"

#include <stdio.h>
#include <string.h>

void replay_age_images(struct glint_replay *replay, const struct glint_frame *next) {
    const bool follows = replay->loaded && replay->ran && next->number == replay->number + 1;
    for (struct image *image = replay->images; image; image = image->next) image->transient |= image_is_history(image);
    replay_drop_images(replay, false);
    for (struct image *image = replay->images; image; image = image->next) {
        char name[sizeof image->name];
        const bool remembered = follows && image->kept && image->key;
        image->kept = false;
        if (!remembered) continue;
        snprintf(name, sizeof name, HISTORY_PREFIX "%.64s", image->kept_as ? image->kept_as : image->name);
        image_rename(image, name);
    }
    replay->number = next->number;
    replay->loaded = true;
    replay->ran = false;
}

bool replay_has_history(const struct glint_replay *replay) {
    for (const struct image *image = replay->images; image; image = image->next)
        if (image_is_history(image)) return true;
    return false;
}

static bool on_device(const struct run *run, const char *name, const struct image_desc *desc) {
    for (const struct image *image = run->replay->images; image; image = image->next)
        if (strcmp(image->name, name) == 0 && image->lineage == run->options->lineage)
            return image->key && image_desc_equal(&image->desc, desc);
    return false;
}

/* Whether the frame before left the image. */
static bool is_there(struct run *run, const struct graph_image *image, const struct image_desc *desc) {
    if (!run->history) return on_device(run, image->name, desc);
    const struct glint_run_image *given = run_given(run, image, image->name);
    return given && given->width == desc->width && given->height == desc->height * image_layers(desc);
}

/* Without a frame before, or after a cut, there is none. Of one whose plan left a pass out, what it would have made is
   nothing. */
bool run_history(struct run *run, struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(run->replay->capture);
    if (run->options->history && !(run->history = glint_run_open(run->options->history, err))) return false;
    run->sizes.history = false;
    for (size_t i = 0; i < run->graph.image_count; i++) {
        struct graph_image *image = &run->graph.images[i];
        struct image_desc desc;
        if (!image->history) continue;
        image->source = SOURCE_HISTORY;
        if (!run_describe_image(run, image, &desc, err)) return false;
        if (frame->cut || !is_there(run, image, &desc)) image->source = SOURCE_NOTHING;
        else if (run->history) image->source = SOURCE_RUN;
        run->sizes.history |= image->source != SOURCE_NOTHING;
    }
    for (size_t i = 0; i < run->graph.image_count; i++) {
        struct graph_image *image = &run->graph.images[i];
        image->blank = image->history && image->source == SOURCE_NOTHING && run->sizes.history;
    }
    return true;
}
