/* Culls cube-map faces that no ray reaches, according to the survey. */
#include "frame_plan.h"

/* `crossed` of survey/reach.comp has a margin of a texel around each face, `nearby` one of a tenth of its width. */
bool plan_faces(const struct frame_plan *plan, uint32_t level, int texels, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    const uint32_t width = plan->sizes.cube_face >> level;
    const bool crossed = texels == 0 || (texels == 1 && level == 0 && width >= 4);
    for (uint32_t i = 0; i < plan->sizes.active && i < GLINT_SURVEY_CUBEMAPS; i++)
        faces[i] = crossed ? plan->reach.crossed[i] : plan->reach.nearby[i];
    return crossed || (uint32_t)texels * 10 <= width;
}

bool plan_captured_faces(const struct frame_plan *plan, size_t i, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    return plan->reach.known && plan->reach.captured[i] && plan_faces(plan, 0, 1, faces);
}

bool plan_limits(const struct frame_plan *plan, const struct graph_pass *pass) {
    return plan->reach.known && plan->reach.limited[pass - plan->graph.passes];
}

bool plan_dispatched_faces(const struct frame_plan *plan, const struct graph_pass *pass, const struct glint_row *row,
                           uint32_t level, uint8_t faces[GLINT_SURVEY_CUBEMAPS]) {
    const struct glint_row *margin = row + 1;
    return margin < pass->pass->rows + pass->pass->row_count && margin->kind == GLINT_ROW_RAY_MARGIN &&
           plan_limits(plan, pass) && plan_faces(plan, level, margin->first, faces);
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
