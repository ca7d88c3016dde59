/* Finds the images of a run. */
#include "run.h"

struct pooled *run_image(const struct run *run, const char *name) {
    const struct graph_image *image = graph_find(run->graph, name);
    return image ? run->images[image - run->graph->images] : NULL;
}

struct pooled *run_bound(const struct run *run, const struct glint_row *binding) {
    return run->images[graph_bound(run->graph, binding) - run->graph->images];
}
