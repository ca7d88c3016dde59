/* Reads images from a run folder instead of computing them. */
#include "run.h"

#include <stdlib.h>

#include "timing.h"

bool run_read_stored(struct run *run, size_t i, size_t *bytes, struct glint_error *err) {
    const struct pooled *image = run->images[i];
    const struct image_desc *desc = &image->image.desc;
    const uint32_t components = format_components(desc->format);
    const bool integer = glint_format_is_uint(desc->format);
    size_t values = 0;
    for (uint32_t l = 0; l < desc->levels; l++) values += image_values(desc, l);
    uint32_t *at = run->stored[i] = malloc(values * sizeof *at);
    if (!at) return glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", image->image.name);
    const struct graph_image *source = &run->graph->images[i];
    const double start = glint_now_seconds();
    for (uint32_t l = 0; l < desc->levels; at += image_values(desc, l++)) {
        const struct glint_image *level = &image->levels[l].info;
        const struct glint_run_image *info = plan_stored_image(run->plan, source, level->name);
        if (!info || info->width != level->width || info->height != level->height || info->components != components ||
            info->integer != integer)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: image %s: expected %u x %u of %u %s channels, found %s",
                              source->history ? run->options->history : run->options->inputs, level->name, level->width,
                              level->height, components, integer ? "uint" : "float",
                              info ? "another size or kind" : "nothing");
        if (!glint_run_read(plan_stored_run(run->plan, source), info, integer ? GLINT_U32 : GLINT_F32, at, err))
            return false;
    }
    run->source->seconds[PHASE_READ] += glint_now_seconds() - start;
    *bytes = values * sizeof(uint32_t);
    return true;
}
