/* Which faces of cube maps a run can leave out: those that no ray comes to. Known where all rays that the picture shows are
   mirrors'; the survey then says which faces their ways cross, as each centre sees them. */
#include "state.h"

#include <string.h>

static const struct glint_row *along_rays(const struct glint_pass *pass, const char *image) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_ALONG_RAYS && strcmp(pass->rows[r].name, image) == 0) return &pass->rows[r];
    return NULL;
}

/* Whether the pass looks it up along rays of the picture's own normals. What a user's shader does is not known. */
static bool looks_along_rays(const struct graph *graph, const struct graph_pass *reader, const char *image) {
    const struct glint_row *row = reader->entry->shader ? NULL : along_rays(reader->pass, image);
    if (!row || capture_row(row->image)) return row != NULL;
    const size_t maker = graph_maker(graph, row->image);
    if (maker == graph->pass_count || !graph->passes[maker].runs || graph->passes[maker].entry->shader) return false;
    row = along_rays(graph->passes[maker].pass, row->image);
    return row && capture_row(row->image);
}

bool graph_follows_rays(const struct graph *graph, const char *image) {
    for (size_t i = 0; i < graph->pass_count; i++)
        if (graph->passes[i].runs && pass_row(graph->passes[i].pass, GLINT_ROW_READ, image) &&
            !looks_along_rays(graph, &graph->passes[i], image))
            return false;
    return true;
}

static bool knows_ways(const struct run *run) {
    return !run->options->all && run->sizes.active && run->replay->survey.followed == run->sizes.active;
}

bool run_captures_faces(const struct run *run, size_t i, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    const struct graph_image *image = &run->graph.images[i];
    return knows_ways(run) && image->source == SOURCE_CAPTURE && size_is_array(image->row->size) &&
           graph_follows_rays(&run->graph, image->name) && run_faces(run, 0, 1, faces);
}

bool run_limits(const struct run *run, const struct glint_pass *pass) {
    bool within = false;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (row_is_output(row) && !graph_follows_rays(&run->graph, row->name)) return false;
        within |= row->kind == GLINT_ROW_RAY_MARGIN;
    }
    return within && knows_ways(run);
}

/* survey/reach.comp takes a face as larger by a texel, or by a tenth of its width. */
bool run_faces(const struct run *run, uint32_t level, int texels, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    const uint32_t width = run->sizes.cube_face >> level;
    const struct glint_survey_cubemap *active = run->replay->survey.active;
    const bool crossed = texels == 0 || (texels == 1 && level == 0 && width >= 4);
    for (uint32_t i = 0; i < run->sizes.active && i < GLINT_SURVEY_CUBEMAPS; i++)
        faces[i] = crossed ? active[i].crossed : active[i].nearby;
    return crossed || (uint32_t)texels * 10 <= width;
}

bool run_dispatches_faces(const struct run *run, const struct glint_pass *pass, const struct glint_row *row,
                          uint32_t level, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    const struct glint_row *within = row + 1;
    return within < pass->rows + pass->row_count && within->kind == GLINT_ROW_RAY_MARGIN && run_limits(run, pass) &&
           run_faces(run, level, within->first, faces);
}

uint32_t count_faces(const uint8_t *faces, uint32_t active) {
    uint32_t count = 0;
    for (uint32_t layer = 0; layer < 6 * active; layer++) count += faces[layer / 6] >> layer % 6 & 1;
    return count;
}

uint32_t face_runs(const uint8_t *faces, uint32_t active, struct face_run *runs) {
    uint32_t count = 0;
    for (uint32_t layer = 0; layer < 6 * active; layer++) {
        if (!(faces[layer / 6] >> layer % 6 & 1)) continue;
        if (count && runs[count - 1].first + runs[count - 1].count == layer) runs[count - 1].count++;
        else runs[count++] = (struct face_run){layer, 1};
    }
    return count;
}
