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

enum { SQUARES = 6 * COCOON_SIZE * COCOON_SIZE /* of a cube map */, NEARBY_WORDS = 4 /* where they begin */ };

static uint8_t faces_of(const uint32_t *squares) {
    uint8_t faces = 0;
    for (uint32_t i = 0; i < SQUARES; i++)
        if (squares[i]) faces |= (uint8_t)(1u << 6 * i / SQUARES);
    return faces;
}

static bool look_at(struct glint_replay *replay, const struct pipeline_pass *maker, uint32_t count,
                    const struct glint_replay_options *options, struct glint_error *err) {
    static const char *const outputs[] = {"cubemap_open", "cubemap_sky", NULL};
    struct pipeline_pass passes[] = {*maker, {.pass = glint_pass_find("survey", "cubemaps")}};
    struct cube_survey *cubes = &replay->cubes;
    uint32_t *texels = survey_run(replay, passes, 2, outputs, options, &cubes->time, err);
    for (uint32_t i = 0; texels && i < count; i++) {
        cubes->active[i].open = faces_of(texels + (size_t)i * SQUARES);
        cubes->active[i].sky = faces_of(texels + (size_t)(count + i) * SQUARES);
    }
    free(texels);
    return texels != NULL;
}

/* Whether all rays that the picture shows are mirrors', whose ways are known before they are traced. */
static bool all_mirrors(const struct glint_replay *replay, const struct glint_pipeline *pipeline,
                        const struct graph *graph) {
    const struct glint_survey *survey = &replay->survey;
    return graph_follows_rays(graph, "cubemap_color") && replay->surveyed && survey->whole &&
           !survey->has_transparent && !pipeline_shows_all(pipeline) && survey->reflecting.count > 0 &&
           !(survey->reflecting.roughness[1] > 0);
}

static uint8_t six_bits(const uint32_t *words, uint32_t place) {
    uint8_t faces = 0;
    for (uint32_t bit = 6 * place, i = 0; i < 6; bit++, i++) faces |= (uint8_t)((words[bit / 32] >> bit % 32 & 1) << i);
    return faces;
}

static bool follow_rays(struct glint_replay *replay, const struct pipeline_pass *maker, uint32_t count,
                        const struct glint_replay_options *options, struct glint_error *err) {
    static const char *const outputs[] = {"reached_faces", NULL};
    struct pipeline_pass passes[] = {*maker, {.pass = glint_pass_find("survey", "reach")}};
    struct glint_survey *survey = &replay->survey;
    uint32_t *words = survey_run(replay, passes, 2, outputs, options, &replay->followed_time, err);
    if (!words) return false;
    for (uint32_t i = 0; i < count; i++) {
        survey->active[i].crossed = six_bits(words, i);
        survey->active[i].nearby = six_bits(words + NEARBY_WORDS, i);
    }
    free(words);
    survey->followed = count;
    return true;
}

/* What the ways of rays are known from. */
static uint64_t ways_key(const struct glint_replay *replay, const struct glint_table *active) {
    const uint64_t key = XXH3_64bits_withSeed(&replay->serial, sizeof replay->serial, 1);
    return XXH3_64bits_withSeed(active->texels.u, active->width * sizeof *active->texels.u, key);
}

static bool look(struct glint_replay *replay, const struct pipeline_pass *maker, const struct glint_table *active,
                 const struct glint_replay_options *options, bool mirrors, uint32_t before, struct glint_error *err) {
    struct glint_survey *survey = &replay->survey;
    const uint32_t count = active->width;
    uint64_t key = 0, ways = ways_key(replay, active);
    if (!mirrors) ways = 0;
    else if (before == count && replay->followed_key == ways) survey->followed = count;
    else if (!follow_rays(replay, maker, count, options, err)) return false;
    replay->followed_key = ways;
    if (!find_key(replay, active, &key, err)) return false;
    for (uint32_t i = 0; i < count; i++) key = key * 31 + (survey->followed ? survey->active[i].crossed : 63);
    for (uint32_t i = 0; i < count; i++) key = key * 31 + (survey->followed ? survey->active[i].nearby : 63);
    if (replay->cubes.key != key) {
        replay->cubes.key = 0;
        if (!look_at(replay, maker, count, options, err)) return false;
        replay->cubes.key = key;
        before = 0;
    }
    for (uint32_t i = 0; i < count && before != count; i++) {
        survey->active[i].number = active->texels.u[i];
        survey->active[i].open = replay->cubes.active[i].open;
        survey->active[i].sky = replay->cubes.active[i].sky;
    }
    survey->looked_at = count;
    return true;
}

/* Where pixels show the sky, cube maps do as a rule, and then no pass is spared by knowing it: only a whole survey asks. */
static bool is_outdoors(const struct glint_survey *survey) {
    return survey->brief && survey->sky > 0;
}

bool survey_cubemaps(struct glint_replay *replay, const struct glint_pipeline *pipeline, const struct graph *graph,
                     const struct glint_replay_options *options, uint32_t before, struct glint_error *err) {
    const size_t maker = graph_maker(graph, "active_index");
    double seconds[256];
    struct tables tables = {0};
    const bool mirrors = all_mirrors(replay, pipeline, graph);
    if (!replay->device || !asks(graph) || (is_outdoors(&replay->survey) && !mirrors) || maker == graph->pass_count ||
        !graph->passes[maker].runs || graph->pass_count > sizeof seconds / sizeof *seconds)
        return true;
    bool ok = tables_init(&tables, graph, replay->capture, seconds, err);
    const struct glint_table *active = ok ? tables_find(&tables, "active_index") : NULL;
    if (active && active->texels.u && active->width <= GLINT_SURVEY_CUBEMAPS)
        ok = look(replay, graph->passes[maker].entry, active, options, mirrors, before, err);
    tables_finish(&tables);
    return ok;
}
