/* Hashes everything that the contents of an image depend on, and decides which passes have to execute. An image whose stored hash
   equals the required one stays as it is, and whatever only it depends on is neither read nor computed. */
#include "run.h"

#include <string.h>

#include <xxhash.h>

#include "timing.h"

static uint64_t mix_bytes(uint64_t key, const void *data, size_t size) {
    return XXH3_64bits_withSeed(data, size, key);
}
static uint64_t mix_text(uint64_t key, const char *text) {
    return mix_bytes(key, text, strlen(text) + 1);
}
static uint64_t mix_number(uint64_t key, uint64_t number) {
    return mix_bytes(key, &number, sizeof number);
}

static uint64_t table_key(const struct glint_table *table) {
    uint64_t key = mix_number(mix_text(1, table->name), ((uint64_t)table->width << 32) | table->height);
    return mix_bytes(key, table->texels.u, (size_t)table->width * table->height * table->components * 4);
}

/* Cube maps in a file beside the capture are identified by its contents. False if some are in the capture itself. */
static bool sibling_key(const struct run *run, uint64_t *key) {
    const struct glint_frame *frame = glint_capture_frame(run->source->capture);
    const double scale[] = {frame->pre_exposure, frame->metres_per_unit};
    uint64_t own = mix_bytes(*key, scale, sizeof scale);
    bool siblings = true;
    for (uint32_t i = 0; siblings && i < run->sizes->active; i++) {
        const struct glint_part_info *part = run->source->cubemaps[run->plan->active[i]];
        siblings = part->sibling_hash[0] != 0;
        own = mix_text(mix_text(own, part->name), part->sibling_hash);
    }
    if (siblings) *key = own;
    return siblings;
}

/* The sky is identified by its pixels, which are kept for the upload. */
static bool sky_key(const struct run *run, const struct graph_image *image, uint64_t *key, struct glint_error *err) {
    struct glint_capture *capture = run->source->capture;
    struct channels *sky = &run->source->sky;
    const double start = glint_now_seconds();
    if (run->source->sky_hash) {
        *key = mix_number(*key, run->source->sky_hash);
        return true;
    }
    channels_finish(sky);
    sky->part = glint_capture_find(capture, image->row->role);
    if (!channels_add_row(sky, image->row, err) || !channels_read(sky, capture, err)) return false;
    run->source->seconds[PHASE_READ] += glint_now_seconds() - start;
    run->source->sky_hash =
        mix_bytes(1, sky->data, (size_t)sky->part->width * sky->part->height * sky->count * sizeof *sky->data);
    *key = mix_number(*key, run->source->sky_hash);
    return true;
}

/* Images that the frames of a shot may share keep their key, so that they are processed once. All others get a new key with every load,
   or with another capture if results may be restored from the cache folder. */
static bool capture_key(const struct run *run, size_t i, uint64_t *key, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    if (image->source == SOURCE_CAPTURE && image->row->size == GLINT_SIZE_SKY) return sky_key(run, image, key, err);
    if (image->source != SOURCE_CAPTURE || !size_is_array(image->row->size) || !sibling_key(run, key))
        *key = run->plan->content[0] ? mix_text(*key, run->plan->content) : mix_number(*key, run->source->serial);
    *key = mix_number(*key, glint_capture_perturbed(run->source->capture));
    return true;
}

/* The key of an image that no shader of this run writes. Images of a run folder are read and identified by their pixels. */
static bool input_key(struct run *run, size_t i, uint64_t *key, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    *key = mix_text(mix_number(2 + (uint64_t)image->source, (uint64_t)run->images[i]->image.desc.format), image->name);
    if (image->source == SOURCE_FALLBACK) *key = mix_bytes(*key, &image->row->fallback, sizeof image->row->fallback);
    else if (image->source != SOURCE_RUN && !capture_key(run, i, key, err)) return false;
    if (size_is_array(image->row->size) && run->plan->active)
        *key = mix_bytes(*key, run->plan->active, run->sizes->active * sizeof *run->plan->active);
    uint8_t faces[GLINT_SURVEY_CUBEMAPS];
    if (plan_captured_faces(run->plan, i, faces)) *key = mix_bytes(*key, faces, run->sizes->active);
    if (image->source != SOURCE_RUN) return true;
    size_t bytes = 0;
    if (!run_read_stored(run, i, &bytes, err)) return false;
    *key = mix_bytes(*key, run->stored[i], bytes);
    return true;
}

static uint64_t mix_faces(uint64_t key, const struct run *run) {
    for (uint32_t i = 0; i < run->sizes->active; i++)
        key = mix_number(mix_number(key, run->plan->reach.crossed[i]), run->plan->reach.nearby[i]);
    return key;
}

static bool step_key(struct run *run, struct step *step, struct glint_error *err) {
    const struct glint_pass *pass = step->pass->pass;
    if (!spirv_find(&step->spirv, &run->engine->device->shaders, step->pass->entry, err) ||
        !constants_init(&step->constants, run->graph, step->pass, &step->spirv, run->options, run->gpu->info.is_cpu,
                        run->gpu->info.filters_together, err))
        return false;
    uint64_t key = mix_number(step->spirv.hash, run->options->float_precision);
    /* The first constants switch diagnostics and probes on, which changes no other image; a user's shader may use them for anything. */
    const uint32_t skipped = step->pass->entry->shader ? 0 : 2;
    key = mix_bytes(key, step->constants.data + skipped, (step->constants.count - skipped) * sizeof(uint32_t));
    key = mix_bytes(key, step->constants.push, step->constants.push_count * sizeof(uint32_t));
    uint32_t words[FRAME_WORDS];
    memcpy(words, &run->plan->block, sizeof words);
    for (uint64_t w = 0; w < FRAME_WORDS; w++)
        if (step->spirv.frame_words[w]) key = mix_number(key, w << 32 | words[w]);
    if (plan_limits(run->plan, step->pass)) key = mix_faces(key, run);
    for (size_t r = 0; r < pass->row_count; r++)
        if (row_is_sampled(&pass->rows[r]) && pass->rows[r].kind != GLINT_ROW_READ_OWN) {
            const struct graph_image *image = graph_bound(run->graph, &pass->rows[r]);
            key = mix_number(mix_text(key, image->name), run->keys[image - run->graph->images]);
        }
    step->key = step->pass->rank == RANK_RAY ? mix_number(key, glint_pipeline_rays(run->plan->pipeline)) : key;
    return true;
}

static bool is_outdated(const struct run *run, size_t i) {
    const uint32_t round = run->options->round;
    return !pooled_has(run->images[i], run->keys[i], run->options->quick) || (round && run->images[i]->round != round);
}

bool run_writes(const struct run *run, size_t i) {
    const struct graph_image *image = &run->graph->images[i];
    if (image->source == SOURCE_MADE && !image->pass->host) return run->steps[image->maker].execute;
    return run->needed[i] && run->images[i]->key != run->keys[i];
}

static void decide_step(struct run *run, struct step *step, size_t place) {
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source == SOURCE_MADE && image->maker == place && run->needed[i] &&
            (is_outdated(run, i) || run->options->no_cache))
            step->execute = true;
    }
    if (run_restore(run, step)) step->execute = false;
    step->execute |= step->constants.probed;
    /* An image that one pass of the loop reads from another exists for one ray at a time. */
    for (size_t later = place + 1; later < run->graph->loop_end && place >= run->graph->loop_first; later++)
        step->execute |=
            run->steps[later].execute && glint_pass_depends(run->steps[later].pass->pass, step->pass->pass);
    for (size_t i = 0; step->execute && i < step->pass->pass->row_count; i++)
        if (row_is_image(&step->pass->pass->rows[i]))
            run->needed[graph_bound(run->graph, &step->pass->pass->rows[i]) - run->graph->images] = true;
}

bool run_keys(struct run *run, struct glint_error *err) {
    const struct graph *graph = run->graph;
    for (size_t i = 0; i < graph->image_count; i++) {
        const struct graph_image *image = &graph->images[i];
        run->needed[i] = image->requested || image->kept;
        if (image->source == SOURCE_MADE && image->pass->host)
            run->keys[i] = table_key(tables_find(run->plan->tables, image->name));
        else if (image->source == SOURCE_HISTORY) run->keys[i] = run->images[i]->key;
        else if (image->source != SOURCE_MADE && !input_key(run, i, &run->keys[i], err)) return false;
        if (image->source == SOURCE_RUN && !image->history) run->needed[i] = true;
    }
    for (size_t p = 0; p < graph->pass_count; p++) {
        struct step *step = &run->steps[p];
        step->pass = &graph->passes[p];
        if (!step->pass->runs || step->pass->pass->host) continue;
        if (!step_key(run, step, err)) return false;
        for (size_t i = 0; i < graph->image_count; i++)
            if (graph->images[i].source == SOURCE_MADE && graph->images[i].maker == p)
                run->keys[i] = mix_text(step->key, graph->images[i].name);
    }
    return true;
}

void run_decide(struct run *run) {
    for (size_t p = run->graph->pass_count; p-- > 0;)
        if (run->graph->passes[p].runs && !run->graph->passes[p].pass->host) decide_step(run, &run->steps[p], p);
}
