/* The survey of the active cube maps: what they show. Made once for as long as they stay the same. */
#include "state.h"

#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

/* Whether a pass that runs asks for what cube maps show. */
static bool asks(const struct graph *graph) {
    for (size_t i = 0; i < graph->pass_count; i++)
        for (size_t r = 0; graph->passes[i].runs && r < graph->passes[i].pass->row_count; r++) {
            const struct glint_row *row = &graph->passes[i].pass->rows[r];
            if ((row->kind == GLINT_ROW_FACT || row->kind == GLINT_ROW_NEEDS) && fact_is_of_cubemaps(row->name))
                return true;
        }
    return false;
}

/* Of what the active cube maps hold: their files', or this load's. */
static bool find_key(const struct glint_replay *replay, const struct glint_table *active, uint64_t *key,
                     struct glint_error *err) {
    const struct glint_part_info **parts;
    size_t count;
    if (!cubemap_parts(replay->capture, &parts, &count, err)) return false;
    *key = 1 + glint_capture_perturbed(replay->capture);
    for (uint32_t i = 0; i < active->width; i++) {
        const char *hash = active->texels.u[i] < count ? parts[active->texels.u[i]]->sibling_hash : "";
        *key = XXH3_64bits_withSeed(&active->texels.u[i], sizeof active->texels.u[i], *key);
        *key = hash[0] ? XXH3_64bits_withSeed(hash, strlen(hash), *key)
                       : XXH3_64bits_withSeed(&replay->serial, sizeof replay->serial, *key);
    }
    free(parts);
    return true;
}

/* All texels of COCOON_SIZE squares of each face. */
static void read_faces(struct glint_survey_cubemap *map, const uint32_t *texels) {
    enum { FACE = COCOON_SIZE * COCOON_SIZE };
    for (uint32_t i = 0; i < 6 * FACE; i++) {
        if (texels[i] & 1) map->open |= (uint8_t)(1u << i / FACE);
        if (texels[i] & 2) map->sky |= (uint8_t)(1u << i / FACE);
    }
}

static bool look_at(struct glint_replay *replay, const struct pipeline_pass *maker, const struct glint_table *active,
                    const struct glint_replay_options *options, struct glint_error *err) {
    struct pipeline_pass passes[] = {*maker, {.pass = glint_pass_find("survey", "cubemaps")}};
    struct cube_survey found = {0};
    uint32_t *texels = survey_run(replay, passes, 2, "cubemap_sky", options, &found.time, err);
    if (!texels) return false;
    for (uint32_t i = 0; i < active->width; i++) {
        found.active[i].number = active->texels.u[i];
        read_faces(&found.active[i], texels + i * 6 * COCOON_SIZE * COCOON_SIZE);
    }
    free(texels);
    replay->cubes = found;
    return true;
}

bool survey_cubemaps(struct glint_replay *replay, const struct graph *graph, const struct glint_replay_options *options,
                     uint32_t before, struct glint_error *err) {
    const size_t maker = graph_maker(graph, "active_index");
    struct glint_survey *survey = &replay->survey;
    double seconds[256];
    struct tables tables = {0};
    uint64_t key = 0;
    if (!replay->device || !asks(graph) || maker == graph->pass_count || !graph->passes[maker].runs ||
        graph->pass_count > sizeof seconds / sizeof *seconds)
        return true;
    bool ok = tables_init(&tables, graph, replay->capture, seconds, err);
    const struct glint_table *active = ok ? tables_find(&tables, "active_index") : NULL;
    if (active && active->texels.u && active->width <= GLINT_SURVEY_CUBEMAPS) {
        ok = find_key(replay, active, &key, err);
        if (ok && replay->cubes.key != key) {
            ok = look_at(replay, graph->passes[maker].entry, active, options, err);
            replay->cubes.key = ok ? key : 0;
            before = 0;
        }
        if (ok && before != active->width) memcpy(survey->active, replay->cubes.active, sizeof survey->active);
        survey->looked_at = ok ? active->width : 0;
    }
    tables_finish(&tables);
    return ok;
}
