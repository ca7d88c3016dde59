/* Restores images that depend on cube maps alone from the cache folder, which holds the pass's EXR file from an earlier run. */
#include "run.h"

#include <stdio.h>
#include <string.h>

#include <xxhash.h>

#include "glint/cache.h"
#include "glint/exr.h"
#include "timing.h"

static void add_text(XXH3_state_t *state, const char *text) {
    if (text) XXH3_128bits_update(state, text, strlen(text) + 1);
}

/* The key covers everything that the file depends on: the step's key (inputs, shader, values), the device, and the metadata of the images. */
static bool find_cache_key(const struct run *run, const struct step *step, char key[GLINT_CACHE_KEY_SIZE]) {
    const struct glint_pass *pass = step->pass->pass;
    const struct glint_device_info *device = &run->gpu->info;
    XXH3_state_t *state = XXH3_createState();
    if (!state || XXH3_128bits_reset(state) != XXH_OK) {
        XXH3_freeState(state);
        return false;
    }
    XXH3_128bits_update(state, &step->key, sizeof step->key);
    const uint64_t processor = device->is_cpu ? glint_cache_processor() : 0;
    XXH3_128bits_update(state, &processor, sizeof processor);
    const char *const texts[] = {GLINT_VERSION,          device->name, device->driver,
                                 device->driver_version, pass->slot,   pass->variant};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) add_text(state, texts[i]);
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!glint_row_is_output(row)) continue;
        const uint32_t numbers[] = {row->kind, row->format, row->size};
        XXH3_128bits_update(state, numbers, sizeof numbers);
        const char *const words[] = {row->name, row->unit, row->channels, row->help};
        for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) add_text(state, words[i]);
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state);
    snprintf(key, GLINT_CACHE_KEY_SIZE, "%016llx%016llx", (unsigned long long)hash.high64,
             (unsigned long long)hash.low64);
    XXH3_freeState(state);
    return true;
}

static enum glint_type stored_type(enum glint_format format) {
    const size_t bytes = format_bytes(format) / format_components(format);
    if (glint_format_is_uint(format)) return bytes == 1 ? GLINT_U8 : GLINT_U32;
    return bytes == 2 ? GLINT_F16 : GLINT_F32;
}

static bool read_level(struct run *run, struct pooled *image, uint32_t l, struct glint_exr *exr,
                       struct glint_error *err) {
    struct pool *pool = run->pool;
    const struct glint_image *level = &image->levels[l].info;
    struct channel_names names;
    size_t p = 0;
    channel_names(&names, level->row->channels);
    while (p < glint_exr_part_count(exr) && strcmp(glint_exr_part(exr, p)->name, level->name) != 0) p++;
    if (p == glint_exr_part_count(exr) || names.count != level->components ||
        glint_exr_part(exr, p)->width != level->width || glint_exr_part(exr, p)->height != level->height)
        return false;
    if (!pool_stage(pool, image_bytes(&image->image.desc, l), err) ||
        !glint_exr_read(exr, p, names.list, names.count, stored_type(image->image.desc.format), pool->staging.map, 0,
                        err) ||
        !device_begin(run->gpu, err))
        return false;
    image_record_upload(&image->image, run->gpu, &pool->staging, 0, l, 0, image_layers(&image->image.desc), l == 0);
    return device_submit(run->gpu, "uploading an image of the cache folder", 1, err);
}

bool run_restore(struct run *run, struct step *step) {
    const struct glint_replay_options *options = run->options;
    const size_t place = (size_t)(step - run->steps);
    struct glint_error ignored = {0};
    char path[4096];
    const bool keeps = step->pass->cached_work && step->pass->rank != RANK_RAY && run->plan->content[0];
    if (!keeps || !find_cache_key(run, step, step->cache_key) || !step->execute) return false;
    if (options->no_cache || options->repeat) return false; /* execution is to be measured */
    if (!glint_cache_find(options->cache, step->cache_key, path, sizeof path)) return false;
    const double start = glint_now_seconds();
    struct glint_exr *exr = glint_exr_open(path, &(struct glint_limits){.no_link = true}, &ignored);
    bool ok = exr != NULL;
    for (size_t i = 0; ok && i < run->graph->image_count; i++) {
        if (run->graph->images[i].source != SOURCE_MADE || run->graph->images[i].maker != place) continue;
        run->images[i]->key = 0, run->images[i]->quick = false;
        for (uint32_t l = 0; ok && l < run->images[i]->image.desc.levels; l++)
            ok = read_level(run, run->images[i], l, exr, &ignored);
    }
    for (size_t i = 0; ok && i < run->graph->image_count; i++)
        if (run->graph->images[i].source == SOURCE_MADE && run->graph->images[i].maker == place)
            run->images[i]->key = run->keys[i];
    if (exr) glint_exr_close(&exr);
    run->source->seconds[PHASE_READ] += glint_now_seconds() - start;
    return ok;
}
