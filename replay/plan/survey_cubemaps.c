/* Surveys the active cube maps: which of their faces show sky, and which mirror rays reach. The result is kept as long as they do not change. */
#include "planner.h"

#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

/* Whether a running pass depends on the contents of cube maps. */
static bool asks_about_faces(const struct graph *graph) {
    for (size_t i = 0; i < graph->pass_count; i++)
        for (size_t r = 0; graph->passes[i].runs && r < graph->passes[i].pass->row_count; r++) {
            const struct glint_row *row = &graph->passes[i].pass->rows[r];
            if (row->kind != GLINT_ROW_FACT && row->kind != GLINT_ROW_NEEDS && row->kind != GLINT_ROW_CALLED_BY)
                continue;
            const enum fact_about about = survey_fact_about(row->name);
            if (about == FACT_FACES || about == FACT_FACES_AND_PIXELS) return true;
        }
    return false;
}

/* Hash of the contents of the active cube maps: the hash of their file, or the number of this load if they are in the capture. */
static uint64_t cubemaps_key(const struct frame_source *source, const struct glint_table *active) {
    uint64_t key = 1 + glint_capture_perturbed(source->capture);
    for (uint32_t i = 0; i < active->width; i++) {
        const uint32_t number = active->texels.u[i];
        const char *hash = number < source->cubemap_count ? source->cubemaps[number]->sibling_hash : "";
        key = XXH3_64bits_withSeed(&number, sizeof number, key);
        key = hash[0] ? XXH3_64bits_withSeed(hash, strlen(hash), key)
                      : XXH3_64bits_withSeed(&source->serial, sizeof source->serial, key);
    }
    return key;
}

enum {
    SQUARES = 6 * SMALL_FACE * SMALL_FACE /* texels for each cube map */,
    NEARBY_WORDS = 4 /* index of the first mask `nearby` */
};

static uint8_t mask_faces(const uint32_t *squares) {
    uint8_t faces = 0;
    for (uint32_t i = 0; i < SQUARES; i++)
        if (squares[i]) faces |= (uint8_t)(1u << 6 * i / SQUARES);
    return faces;
}

/* Whether all visible rays are mirror rays, whose paths are known before they are traced. */
static bool has_only_mirror_rays(const struct survey_state *state, const struct graph *graph) {
    const struct glint_survey *figures = &state->figures;
    const char *image;
    const struct glint_pass *pass = glint_pass_with_role(GLINT_ROLE_SURVEY_OPEN_FACES, &image);
    const struct glint_row *colors = glint_pass_row(pass, GLINT_ROW_ALONG_RAYS, NULL);
    return graph_is_along_rays(graph, colors->name) && state->done && figures->on_device && !figures->has_transparent &&
           !pipeline_shows_all(graph->pipeline) && figures->reflecting.count > 0 &&
           !(figures->reflecting.roughness[1] > 0);
}

static uint8_t six_bits(const uint32_t *words, uint32_t place) {
    uint8_t faces = 0;
    for (uint32_t bit = 6 * place, i = 0; i < 6; bit++, i++) faces |= (uint8_t)((words[bit / 32] >> bit % 32 & 1) << i);
    return faces;
}

/* Hash of what the reached faces depend on. */
static uint64_t rays_key(const struct frame_source *source, const struct glint_table *active) {
    const uint64_t key = XXH3_64bits_withSeed(&source->serial, sizeof source->serial, 1);
    return XXH3_64bits_withSeed(active->texels.u, active->width * sizeof *active->texels.u, key);
}

/* Arguments of the survey of cube maps. */
struct cubemaps_task {
    struct planner *planner;
    struct frame_plan *plan;
    const struct pipeline_pass *maker; /* makes the table of active cube maps */
    const struct glint_table *active;
};

static bool survey_faces(const struct cubemaps_task *l, struct glint_error *err) {
    static const enum glint_pass_role figures[] = {GLINT_ROLE_SURVEY_OPEN_FACES, GLINT_ROLE_SURVEY_SKY_FACES};
    struct cube_survey *cubes = &l->planner->survey.cubes;
    const uint32_t count = l->active->width;
    uint32_t *texels =
        survey_run(l->planner, l->maker, l->plan->tables, figures, 2, 0, l->plan->options, &cubes->time, err);
    for (uint32_t i = 0; texels && i < count; i++) {
        cubes->active[i].open = mask_faces(texels + (size_t)i * SQUARES);
        cubes->active[i].sky = mask_faces(texels + (size_t)(count + i) * SQUARES);
    }
    free(texels);
    return texels != NULL;
}

static bool trace_mirror_rays(const struct cubemaps_task *l, struct glint_error *err) {
    static const enum glint_pass_role figures[] = {GLINT_ROLE_SURVEY_REACHED_FACES};
    struct survey_state *state = &l->planner->survey;
    uint32_t *words =
        survey_run(l->planner, l->maker, l->plan->tables, figures, 1, 0, l->plan->options, &state->trace_time, err);
    if (!words) return false;
    for (uint32_t i = 0; i < l->active->width; i++) {
        state->figures.active[i].crossed = six_bits(words, i);
        state->figures.active[i].nearby = six_bits(words + NEARBY_WORDS, i);
    }
    free(words);
    state->figures.active_traced = l->active->width;
    return true;
}

static bool survey_active(const struct cubemaps_task *l, bool mirrors, uint32_t before, struct glint_error *err) {
    struct survey_state *state = &l->planner->survey;
    struct glint_survey *figures = &state->figures;
    const uint32_t count = l->active->width;
    uint64_t key = cubemaps_key(l->planner->source, l->active),
             rays = mirrors ? rays_key(l->planner->source, l->active) : 0;
    if (mirrors && before == count && state->traced_key == rays) figures->active_traced = count;
    else if (mirrors && !trace_mirror_rays(l, err)) return false;
    state->traced_key = rays;
    for (uint32_t i = 0; i < count; i++) key = key * 31 + (figures->active_traced ? figures->active[i].crossed : 63);
    for (uint32_t i = 0; i < count; i++) key = key * 31 + (figures->active_traced ? figures->active[i].nearby : 63);
    if (state->cubes.key != key) {
        state->cubes.key = 0;
        if (!survey_faces(l, err)) return false;
        state->cubes.key = key;
        before = 0;
    }
    for (uint32_t i = 0; i < count && before != count; i++) {
        figures->active[i].number = l->active->texels.u[i];
        figures->active[i].open = state->cubes.active[i].open;
        figures->active[i].sky = state->cubes.active[i].sky;
    }
    figures->active_surveyed = count;
    return true;
}

/* Where pixels show the sky, cube maps usually do, too, and then the survey of cube maps would drop no pass. */
static bool is_outdoors(const struct glint_survey *figures) {
    return figures->partial && figures->sky > 0;
}

bool survey_cubemaps(struct planner *planner, struct frame_plan *plan, uint32_t before, struct glint_error *err) {
    const struct graph *graph = &plan->graph;
    const char *order = cubemap_order_image();
    const size_t maker = graph_maker(graph, order);
    const bool mirrors = has_only_mirror_rays(&planner->survey, graph);
    if (!planner->engine || !asks_about_faces(graph) || (is_outdoors(&planner->survey.figures) && !mirrors) ||
        maker == graph->pass_count || !graph->passes[maker].runs)
        return true;
    if (!tables_fill(plan->tables, graph, planner->source, err)) return false;
    const struct glint_table *active = tables_find(plan->tables, order);
    if (!active || !active->texels.u || active->width > GLINT_SURVEY_CUBEMAPS) return true;
    return survey_active(&(struct cubemaps_task){planner, plan, graph->passes[maker].entry, active}, mirrors, before,
                         err);
}
