/* Fills the images that no shader writes: decoded parts of the capture, tables, images of a run folder, fallback values. Pixels are
   written directly to mapped staging memory in the image's format. */
#include "run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool submit_upload(struct run *run, const char *name, struct glint_error *err) {
    char what[288];
    snprintf(what, sizeof what, "uploading %s", name);
    return device_submit(run->gpu, what, 1, err);
}

/* Whether the image comes from parts of this role. Ids are read as integers and therefore separately. */
static bool comes_with(const struct graph_image *image, const char *role, bool ids) {
    return strcmp(image->row->role, role) == 0 && glint_format_is_uint(image->row->format) == ids;
}

/* The required layers of an image; the others stay undefined. */
static void record_layers(const struct run *run, size_t i, VkDeviceSize offset, uint32_t first, uint32_t layers) {
    struct pool *pool = run->pool;
    struct pooled *image = run->images[i];
    const VkDeviceSize face_bytes =
        (VkDeviceSize)image->image.desc.width * image->image.desc.height * format_bytes(image->image.desc.format);
    uint8_t faces[GLINT_SURVEY_CUBEMAPS];
    if (!plan_captured_faces(run->plan, i, faces)) {
        image_record_upload(&image->image, run->gpu, &pool->staging, offset, 0, first, layers, first == 0);
        return;
    }
    if (first == 0) image_record_clear(&image->image, run->gpu, run->graph->images[i].row->fallback);
    for (uint32_t face = 0; face < 6; face++)
        if (faces[first / 6] >> face & 1)
            image_record_upload(&image->image, run->gpu, &pool->staging, offset + face * face_bytes, 0, first + face, 1,
                                false);
}

/* All images of the graph that one part of the capture fills: those of `role`, each into `layers` layers from `first`. */
static bool upload_part(struct run *run, const struct glint_part_info *part, const char *role,
                        struct channels *channels, uint32_t first, uint32_t layers, struct glint_error *err) {
    struct pool *pool = run->pool;
    struct glint_capture *capture = run->source->capture;
    double start = glint_now_seconds();
    VkDeviceSize offset = 0;
    uint32_t width = part->width, rows = part->height;
    channels->part = part;
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source != SOURCE_CAPTURE || !run_writes(run, i) || !comes_with(image, role, false)) continue;
        const struct image_desc *desc = &run->images[i]->image.desc;
        width = desc->width, rows = desc->height * layers;
        if (layers == 1 && (part->width != width || part->height != rows))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %u x %u, found %u x %u",
                              glint_capture_path(capture), part->name, width, rows, part->width, part->height);
        if (!channels->data && !channels_add_row(channels, image->row, err)) return false;
        offset += ((VkDeviceSize)width * rows * format_bytes(desc->format) + 15) & ~(VkDeviceSize)15;
    }
    for (size_t c = 0; !channels->data && c < channels->count; c++) /* optional channels that this part does not have */
        if (!glint_part_can_read(part, channels->names[c])) {
            free((char *)channels->names[c]);
            channels->names[c--] = channels->names[--channels->count];
        }
    if (!channels->data && channels->count && !channels_read(channels, capture, err)) return false;
    if (channels->data && part->width != width && !channels_enlarge(channels, width, err)) return false;
    run->source->seconds[PHASE_READ] += glint_now_seconds() - start;
    start = glint_now_seconds();
    if (!pool_stage(pool, offset, err) || !device_begin(run->gpu, err)) return false;
    offset = 0;
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source != SOURCE_CAPTURE || !run_writes(run, i) || !comes_with(image, role, false)) continue;
        struct packing packing = {.from = (const uint32_t *)channels->data,
                                  .stride = channels->count,
                                  .missing = (float)image->row->fallback,
                                  .format = run->images[i]->image.desc.format,
                                  .to = (char *)pool->staging.map + offset,
                                  .row = image->row};
        pack_place(&packing, channels, image->row);
        run->images[i]->quick = false;
        run->images[i]->key = 0; /* until it is complete */
        pack_texels(&packing, width, rows);
        struct bad_values *bad = &run->images[i]->levels[0].bad;
        if (first == 0) *bad = (struct bad_values){0};
        packing.bad.first +=
            image_values(&run->images[i]->image.desc, 0) / image_layers(&run->images[i]->image.desc) * first;
        bad_values_add(bad, &packing.bad);
        record_layers(run, i, offset, first, layers);
        offset += ((VkDeviceSize)width * rows * format_bytes(packing.format) + 15) & ~(VkDeviceSize)15;
    }
    bool ok = submit_upload(run, part->name, err);
    run->source->seconds[PHASE_UPLOAD] += glint_now_seconds() - start;
    return ok;
}

static bool upload_cubemaps(struct run *run, const char *role, struct glint_error *err) {
    bool ok = true;
    for (uint32_t i = 0; ok && i < run->sizes->active; i++) {
        const struct glint_part_info *part = run->source->cubemaps[run->plan->active[i]];
        struct channels channels = {0};
        ok = glint_report_progress(run->progress, run->user, part->name, (double)i / run->sizes->active * 0.2, err) &&
             upload_part(run, part, role, &channels, 6 * i, 6, err);
        channels_finish(&channels);
    }
    return ok;
}

/* Values that are in memory already: tables, and images of runs or of the engine. */
static bool upload_values(struct run *run, size_t i, const void *values, struct glint_error *err) {
    struct pool *pool = run->pool;
    struct pooled *image = run->images[i];
    const struct image_desc *desc = &image->image.desc;
    image->key = 0, image->quick = false;
    bool ok = true;
    const uint32_t *from = values;
    for (uint32_t l = 0; ok && l < desc->levels; from += image_values(desc, l++)) {
        if (!pool_stage(pool, image_bytes(desc, l), err) || !device_begin(run->gpu, err)) return false;
        struct packing packing = {.from = from,
                                  .stride = format_components(desc->format),
                                  .at = {0, 1, 2, 3},
                                  .format = desc->format,
                                  .to = pool->staging.map};
        pack_texels(&packing, image->levels[l].info.width, image->levels[l].info.height);
        image_record_upload(&image->image, run->gpu, &pool->staging, 0, l, 0, image_layers(desc), l == 0);
        ok = submit_upload(run, image->levels[l].info.name, err);
    }
    return ok;
}

/* A level is a separate part, named as in run folders. */
static bool read_engine_level(struct run *run, size_t i, uint32_t l, void *data, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    const struct glint_image *level = &run->images[i]->levels[l].info;
    char name[160];
    struct glint_row row = *image->row;
    row.source = image->row->channels; /* the engine uses the names of the declaration */
    struct channels channels = {0};
    snprintf(name, sizeof name, "engine.%.48s.%.80s", image->pass->slot, level->name);
    channels.part = glint_capture_find(run->source->capture, name);
    if (!channels.part || channels.part->width != level->width || channels.part->height != level->height)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %u x %u, found %u x %u",
                          glint_capture_path(run->source->capture), name, level->width, level->height,
                          channels.part ? channels.part->width : 0, channels.part ? channels.part->height : 0);
    bool ok = channels_add_row(&channels, &row, err);
    if (ok && channels.count != level->components)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "part %s: image %s declares %zu channels for %u components", name,
                        image->name, channels.count, level->components);
    ok = ok && glint_capture_read_raw(run->source->capture, channels.part, channels.names, channels.count,
                                      glint_format_is_uint(level->format) ? GLINT_U32 : GLINT_F32, data, 0, err);
    channels_finish(&channels);
    return ok;
}

/* A level of the capture's probe is a part of its own. */
static bool read_probe_level(struct run *run, uint32_t l, void *data, struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B", NULL};
    const struct glint_part_info *levels[GLINT_MAX_LEVELS];
    double roughness[GLINT_MAX_LEVELS];
    glint_capture_probe(run->source->capture, 0, levels, roughness);
    return glint_capture_read(run->source->capture, levels[l], names, 4, GLINT_F32, data, 0, err);
}

static bool upload_levels(struct run *run, size_t i, struct glint_error *err) {
    const bool engine = run->graph->images[i].source == SOURCE_ENGINE;
    const struct image_desc *desc = &run->images[i]->image.desc;
    size_t values = 0;
    for (uint32_t l = 0; l < desc->levels; l++) values += image_values(desc, l);
    uint32_t *data = malloc(values * sizeof *data), *at = data;
    bool ok = data || glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", run->images[i]->image.name);
    for (uint32_t l = 0; ok && l < desc->levels; at += image_values(desc, l++))
        ok = engine ? read_engine_level(run, i, l, at, err) : read_probe_level(run, l, at, err);
    ok = ok && upload_values(run, i, data, err);
    free(data);
    return ok;
}

static bool upload_input(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    const struct glint_table *table = tables_find(run->plan->tables, image->name);
    if (image->source == SOURCE_RUN) return upload_values(run, i, run->stored[i], err);
    if (image->source == SOURCE_ENGINE) return upload_levels(run, i, err);
    if (image->source == SOURCE_MADE && table && table->width && table->height)
        return upload_values(run, i, table->texels.u, err);
    if (!device_begin(run->gpu, err)) return false;
    run->images[i]->quick = false;
    image_record_clear(&run->images[i]->image, run->gpu, image->row->fallback);
    return submit_upload(run, run->images[i]->image.name, err);
}

static bool upload_ids(struct run *run, size_t i, struct glint_error *err) {
    const struct glint_row *row = run->graph->images[i].row;
    const struct glint_part_info *part = glint_capture_find(run->source->capture, row->role);
    uint32_t *ids = calloc(image_values(&run->images[i]->image.desc, 0), sizeof *ids);
    bool ok = ids || glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", row->name);
    if (ok && glint_part_has_channel(part, row->source))
        ok = glint_capture_read(run->source->capture, part, &row->source, 1, GLINT_U32, ids, 0, err);
    ok = ok && upload_values(run, i, ids, err);
    free(ids);
    return ok;
}

/* The shadow maps, one below the other; texels beside a map that is narrower than others hold the fallback value. */
static bool upload_shadows(struct run *run, size_t i, struct glint_error *err) {
    static const char *const depth = "depth.Z";
    const struct glint_part_info *maps[SHADOW_MAPS];
    const struct glint_row *row = run->graph->images[i].row;
    const struct image_desc *desc = &run->images[i]->image.desc;
    const size_t count = frame_shadow_maps(run->source->capture, maps), texels = (size_t)desc->width * desc->height;
    float *values = malloc(texels * sizeof *values), *at = values;
    bool ok = values || glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", row->name);
    for (size_t t = 0; ok && t < texels; t++) values[t] = (float)row->fallback;
    for (size_t k = 0; ok && k < count; at += (size_t)maps[k++]->height * desc->width) {
        const size_t width = maps[k]->width;
        ok = glint_capture_read(run->source->capture, maps[k], &depth, 1, GLINT_F32, at, 0, err);
        for (size_t y = maps[k]->height; ok && width < desc->width && y-- > 0;) { /* from the last row on */
            memmove(at + y * desc->width, at + y * width, width * sizeof *at);
            for (size_t x = width; x < desc->width; x++) at[y * desc->width + x] = (float)row->fallback;
        }
    }
    ok = ok && upload_values(run, i, values, err);
    if (ok) run->images[i]->levels[0].bad = bad_floats(row, values, texels);
    free(values);
    return ok;
}

/* Captures fill several images from one part; the first of these images fills the others, too. */
static bool upload_captured(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    struct frame_source *source = run->source;
    const char *role = image->row->role;
    if (glint_format_is_uint(image->row->format)) return upload_ids(run, i, err);
    if (size_is_array(image->row->size)) return upload_cubemaps(run, role, err);
    if (image->row->size == GLINT_SIZE_SHADOW) return upload_shadows(run, i, err);
    if (size_has_levels(image->row->size)) return upload_levels(run, i, err);
    struct channels own = {0}, *channels = &own;
    const struct glint_part_info *part = glint_capture_find(source->capture, role);
    if (source->gbuffer.data && source->gbuffer.part == part) channels = &source->gbuffer;
    if (source->sky.data && source->sky.part == part) channels = &source->sky;
    bool ok = upload_part(run, part, role, channels, 0, image->row->size == GLINT_SIZE_SKY ? 6 : 1, err);
    channels_finish(&own);
    return ok;
}

/* The fallback value of the faces that a limited pass skips. */
static bool clear_left_out(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph->images[i];
    if (!plan_limits(run->plan, &run->graph->passes[image->maker])) return true;
    if (!device_begin(run->gpu, err)) return false;
    run->images[i]->quick = false;
    image_record_clear(&run->images[i]->image, run->gpu, image->row->fallback);
    return submit_upload(run, run->images[i]->image.name, err);
}

bool run_upload(struct run *run, struct glint_error *err) {
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        bool table = image->source == SOURCE_MADE && image->pass->host;
        if (!run_writes(run, i)) continue;
        if (image->source == SOURCE_MADE && !table) {
            ok = clear_left_out(run, i, err);
            continue;
        }
        bool stand_in = size_is_array(image->row->size) && run->sizes->active == 0;
        if (image->source == SOURCE_CAPTURE && !stand_in) {
            ok = glint_report_progress(run->progress, run->user, image->row->role, 0, err) &&
                 upload_captured(run, i, err);
            for (size_t j = 0; ok && j < run->graph->image_count; j++)
                if (run->graph->images[j].source == SOURCE_CAPTURE && run->needed[j] &&
                    comes_with(&run->graph->images[j], image->row->role, glint_format_is_uint(image->row->format)))
                    run->images[j]->key = run->keys[j];
        } else {
            double start = glint_now_seconds();
            ok = upload_input(run, i, err);
            run->source->seconds[image->source == SOURCE_MADE ? PHASE_UPLOAD : PHASE_READ] +=
                glint_now_seconds() - start;
            if (ok) run->images[i]->key = run->keys[i];
        }
    }
    if (!run->plan->interim) frame_source_release(run->source);
    return ok;
}
