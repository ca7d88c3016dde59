/* Images that are read from a run folder instead of being computed. */
#include <string.h>

#include "frame_plan.h"

struct glint_run *plan_stored_run(const struct frame_plan *plan, const struct graph_image *image) {
    return image->history ? plan->history : plan->inputs;
}

const struct glint_run_image *plan_stored_image(const struct frame_plan *plan, const struct graph_image *image,
                                                const char *name) {
    const struct glint_run *folder = plan_stored_run(plan, image);
    const struct glint_run_image *found = glint_run_find(folder, image->history ? name + strlen(HISTORY_PREFIX) : name);
    for (size_t r = 0; !found && image->history && image->pass && r < image->pass->row_count; r++) {
        const struct glint_row *row = &image->pass->rows[r]; /* the pass may have been dropped in that run */
        if (row->kind == GLINT_ROW_BYPASS && strcmp(row->image, image->row->name) == 0)
            found = glint_run_find(folder, row->name);
    }
    return found;
}
