/* Images that a run folder gives instead of a pass. */
#include "state.h"

#include <stdlib.h>
#include <string.h>

#include "timing.h"

static struct glint_run *run_folder(const struct run *run, const struct graph_image *image) {
    return image->history ? run->history : run->inputs;
}

const struct glint_run_image *run_given(const struct run *run, const struct graph_image *image, const char *name) {
    const struct glint_run *folder = run_folder(run, image);
    const struct glint_run_image *found = glint_run_find(folder, image->history ? name + strlen(HISTORY_PREFIX) : name);
    for (size_t r = 0; !found && image->history && image->pass && r < image->pass->row_count; r++) {
        const struct glint_row *row = &image->pass->rows[r]; /* the pass may have been dropped then */
        if (row->kind == GLINT_ROW_BYPASS && strcmp(row->image, image->row->name) == 0)
            found = glint_run_find(folder, row->name);
    }
    return found;
}

/* Reads all levels of an image from its run folder, one after the other. */
bool run_read_given(const struct run *run, size_t i, size_t *bytes, struct glint_error *err) {
    const struct image *image = run->images[i];
    const struct image_desc *desc = &image->desc;
    const uint32_t components = format_components(desc->format);
    const bool integer = format_is_uint(desc->format);
    size_t values = 0;
    for (uint32_t l = 0; l < desc->levels; l++) values += image_values(desc, l);
    uint32_t *at = run->given[i] = malloc(values * sizeof *at);
    if (!at) return glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", image->name);
    const struct graph_image *source = &run->graph.images[i];
    const double start = now_seconds();
    for (uint32_t l = 0; l < desc->levels; at += image_values(desc, l++)) {
        const struct glint_image *level = &image->levels[l].info;
        const struct glint_run_image *info = run_given(run, source, level->name);
        if (!info || info->width != level->width || info->height != level->height || info->components != components ||
            info->integer != integer)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: image %s: expected %u x %u of %u %s channels, found %s",
                              source->history ? run->options->history : run->options->inputs, level->name, level->width,
                              level->height, components, integer ? "uint" : "float",
                              info ? "another size or kind" : "none");
        if (!glint_run_read(run_folder(run, source), info, integer ? GLINT_U32 : GLINT_F32, at, err)) return false;
    }
    run->replay->seconds[PHASE_READ] += now_seconds() - start;
    *bytes = values * sizeof(uint32_t);
    return true;
}
