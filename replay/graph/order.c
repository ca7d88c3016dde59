/* Sorts passes, and finds the loop over rays and the passes whose work can be cached between frames. */
#include "graph.h"
#include "nearest.h"

#include <string.h>

bool pass_reads_history(const struct glint_pass *later, const struct glint_pass *earlier) {
    for (size_t r = 0; r < later->row_count; r++)
        if (later->rows[r].kind == GLINT_ROW_HISTORY && glint_pass_output(earlier, row_image(&later->rows[r])))
            return true;
    return false;
}

static void find_ranks(struct graph *graph) {
    for (size_t i = 0; i < graph->pass_count; i++)
        if (glint_pass_row(graph->passes[i].pass, GLINT_ROW_PER_RAY, NULL)) graph->passes[i].rank = RANK_RAY;
    for (bool more = true; more;) {
        more = false;
        for (size_t i = 0; i < graph->pass_count; i++)
            for (size_t j = 0; j < graph->pass_count && graph->passes[i].rank == RANK_BEFORE; j++)
                if (graph->passes[j].rank != RANK_BEFORE &&
                    glint_pass_depends(graph->passes[i].pass, graph->passes[j].pass))
                    graph->passes[i].rank = RANK_AFTER, more = true;
    }
}

static void check_ranks(const struct graph *graph, struct faults *faults) {
    for (size_t i = 0; i < graph->pass_count; i++)
        for (size_t j = 0; j < graph->pass_count; j++)
            if (graph->passes[i].rank == RANK_RAY && graph->passes[j].rank == RANK_AFTER &&
                glint_pass_depends(graph->passes[i].pass, graph->passes[j].pass))
                faults_add(faults, GLINT_ERROR_USAGE,
                           "%s/%s runs for each ray and reads what %s makes after all of them: it must run for each "
                           "ray too",
                           graph->passes[i].pass->slot, graph->passes[i].pass->variant, graph->passes[j].pass->slot);
}

/* Sorts topologically, ties by rank and then by slot name, in which order the passes come. Passes that remain are in a cycle or depend on
   one. */
static void sort_passes(struct graph *graph, struct faults *faults) {
    for (size_t done = 0; done < graph->pass_count; done++) {
        size_t next = graph->pass_count;
        for (size_t i = done; i < graph->pass_count; i++) {
            bool ready = true;
            for (size_t j = done; j < graph->pass_count && ready; j++)
                ready = !glint_pass_depends(graph->passes[i].pass, graph->passes[j].pass);
            if (ready && (next == graph->pass_count || graph->passes[i].rank < graph->passes[next].rank)) next = i;
        }
        if (next == graph->pass_count) {
            char members[400] = "";
            for (size_t i = done; i < graph->pass_count; i++) {
                bool feeds = false; /* a pass that no remaining pass reads is not in the cycle itself */
                for (size_t j = done; j < graph->pass_count; j++)
                    feeds |= glint_pass_depends(graph->passes[j].pass, graph->passes[i].pass);
                if (feeds) text_list(members, sizeof members, graph->passes[i].pass->slot);
            }
            faults_add(faults, GLINT_ERROR_USAGE, "passes read one another in a cycle: %s", members);
            return;
        }
        struct graph_pass chosen = graph->passes[next]; /* shifting keeps the other passes in order of their names */
        memmove(&graph->passes[done + 1], &graph->passes[done], (next - done) * sizeof chosen);
        graph->passes[done] = chosen;
    }
}

void graph_sort(struct graph *graph) {
    find_ranks(graph);
    sort_passes(graph, &graph->declared);
    check_ranks(graph, &graph->declared);
}

/* Images that the loop reads from before it, or accumulates, stay in use until the loop ends. */
void graph_find_loop(struct graph *graph, uint32_t rays) {
    for (size_t i = 0; i < graph->pass_count && rays > 1; i++)
        if (graph->passes[i].rank == RANK_RAY) {
            if (!graph->loop_end) graph->loop_first = i;
            graph->loop_end = i + 1;
        }
    for (size_t i = 0; i < graph->image_count && graph->loop_end; i++) {
        struct graph_image *image = &graph->images[i];
        const bool inside = image->first_use >= graph->loop_first && image->source == SOURCE_MADE;
        const bool used = image->last_use >= graph->loop_first && image->first_use < graph->loop_end;
        const bool summed = image->pass && glint_pass_row(image->pass, GLINT_ROW_ACCUMULATE, image->name);
        if (used && (!inside || summed) && image->last_use < graph->loop_end - 1) image->last_use = graph->loop_end - 1;
    }
}

/* Whether an image is the same in every frame: cube maps, their tables, and images made from these alone. */
static bool is_persistent(const struct graph *graph, const struct graph_image *image) {
    if (image->source == SOURCE_MADE && !image->pass->host) return graph->passes[image->maker].cached_work;
    return image->source == SOURCE_FALLBACK || size_is_cube(image->row->size) ||
           image->row->size == GLINT_SIZE_ACTIVE || image->row->size == GLINT_SIZE_CHAIN;
}

void graph_find_cached_work(struct graph *graph) {
    for (size_t i = 0; i < graph->pass_count; i++) {
        struct graph_pass *pass = &graph->passes[i];
        bool persistent = pass->runs && !pass->pass->host, cubes = false;
        for (size_t r = 0; persistent && r < pass->pass->row_count; r++) {
            const struct glint_row *row = &pass->pass->rows[r];
            const struct graph_image *image = row->kind == GLINT_ROW_READ ? graph_find(graph, row->name) : NULL;
            if (row->kind == GLINT_ROW_HISTORY || (image && !is_persistent(graph, image))) persistent = false;
            cubes |= image && size_is_cube(image->row->size);
        }
        pass->cached_work = persistent && cubes;
    }
}
