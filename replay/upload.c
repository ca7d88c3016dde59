/* Fills the images that no shader makes: decoded capture parts, tables, images of a run folder, "nothing". Pixels go
   straight into mapped staging memory in the image's format. */
#include "bad_values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <Imath/half.h>
#include <pthread.h>

#include "parallel.h"
#include "timing.h"

/* Conversion of interleaved 32-bit values to an image's texels. */
struct packing {
    const uint32_t *from; /* float or uint bits */
    size_t stride;        /* values a pixel */
    size_t at[4];         /* value of each component; SIZE_MAX: `missing` */
    float missing;
    enum glint_format format;
    void *to;
    size_t width;
    const struct glint_row *row; /* bad values are counted; NULL: not */
    struct bad_values bad;
    pthread_mutex_t lock;
};

/* Those of a component that the capture gives. */
static void count_bad(struct packing *p, size_t c, const uint32_t *from, size_t stride, size_t begin, size_t end) {
    const size_t components = format_components(p->format);
    struct bad_values bad = {0};
    for (size_t i = begin; i < end; i++, from += stride) {
        float value;
        memcpy(&value, from, sizeof value);
        bad_value(&bad, p->row, format_bytes(p->format) / components == 2, i * components + c, value);
    }
    pthread_mutex_lock(&p->lock);
    bad_values_add(&p->bad, &bad);
    pthread_mutex_unlock(&p->lock);
}

static void pack_rows(void *user, size_t first, size_t last) {
    struct packing *p = user;
    const size_t components = format_components(p->format), begin = first * p->width, end = last * p->width;
    uint32_t missing;
    memcpy(&missing, &p->missing, sizeof missing);
    for (size_t c = 0; c < components; c++) {
        const uint32_t *from = p->at[c] == SIZE_MAX ? &missing : p->from + p->at[c] + begin * p->stride;
        const size_t stride = p->at[c] == SIZE_MAX ? 0 : p->stride;
        const size_t bytes = format_bytes(p->format) / components;
        if (p->row && stride) count_bad(p, c, from, stride, begin, end);
        if (bytes == 1)
            for (size_t i = begin; i < end; i++, from += stride)
                ((uint8_t *)p->to)[i * components + c] = (uint8_t)*from;
        else if (bytes == 2)
            for (size_t i = begin; i < end; i++, from += stride) {
                float value;
                memcpy(&value, from, sizeof value);
                ((uint16_t *)p->to)[i * components + c] = imath_float_to_half(half_clamped(value));
            }
        else
            for (size_t i = begin; i < end; i++, from += stride) ((uint32_t *)p->to)[i * components + c] = *from;
    }
}

static void pack(struct packing *packing, uint32_t width, uint32_t height) {
    packing->width = width;
    pthread_mutex_init(&packing->lock, NULL);
    parallel_rows(height, pack_rows, packing);
    pthread_mutex_destroy(&packing->lock);
}

static bool submit(struct run *run, struct glint_error *err) {
    return device_submit(run->replay->device, "uploading images", err);
}

static void place_components(struct packing *packing, const struct channels *channels, const struct glint_row *row) {
    size_t c = 0;
    for (size_t i = 0; i < 4; i++) packing->at[i] = SIZE_MAX;
    for (const char *at = row->source; *at && c < 4; c++) {
        size_t length = strcspn(at, " "), found = channels_find(channels, at, length);
        if (found < channels->count) packing->at[c] = found;
        at += length + (at[length] == ' ');
    }
}

/* Whether the image comes from parts of this role: ids, which are read as integers, apart from the others. */
static bool comes_with(const struct graph_image *image, const char *role, bool ids) {
    return strcmp(image->row->role, role) == 0 && format_is_uint(image->row->format) == ids;
}

/* The layers of an image that are needed; the others hold nothing. */
static void record_layers(const struct run *run, size_t i, VkDeviceSize offset, uint32_t first, uint32_t layers) {
    struct glint_replay *replay = run->replay;
    struct image *image = run->images[i];
    const VkDeviceSize face_bytes =
        (VkDeviceSize)image->desc.width * image->desc.height * format_bytes(image->desc.format);
    uint8_t faces[GLINT_SURVEY_CUBEMAPS];
    if (!run_captures_faces(run, i, faces)) {
        image_record_upload(image, replay->device, &replay->staging, offset, 0, first, layers, first == 0);
        return;
    }
    if (first == 0) image_record_clear(image, replay->device, run->graph.images[i].row->nothing);
    for (uint32_t face = 0; face < 6; face++)
        if (faces[first / 6] >> face & 1)
            image_record_upload(image, replay->device, &replay->staging, offset + face * face_bytes, 0, first + face, 1,
                                false);
}

/* All images of the graph that one part of the capture fills: `role`'s, each into `layers` layers from `first`. */
static bool upload_part(struct run *run, const struct glint_part_info *part, const char *role,
                        struct channels *channels, uint32_t first, uint32_t layers, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    struct glint_capture *capture = replay->capture;
    double start = now_seconds();
    VkDeviceSize offset = 0;
    uint32_t width = part->width, rows = part->height;
    channels->part = part;
    for (size_t i = 0; i < run->graph.image_count; i++) {
        const struct graph_image *image = &run->graph.images[i];
        if (image->source != SOURCE_CAPTURE || !run_writes(run, i) || !comes_with(image, role, false)) continue;
        const struct image_desc *desc = &run->images[i]->desc;
        width = desc->width, rows = desc->height * layers;
        if (layers == 1 && (part->width != width || part->height != rows))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %u x %u, found %u x %u",
                              glint_capture_path(capture), part->name, width, rows, part->width, part->height);
        if (!channels->data && !channels_add_row(channels, image->row, err)) return false;
        offset += ((VkDeviceSize)width * rows * format_bytes(desc->format) + 15) & ~(VkDeviceSize)15;
    }
    for (size_t c = 0; !channels->data && c < channels->count; c++) /* optional ones that this part lacks */
        if (!glint_part_has_channel(part, channels->names[c])) {
            free((char *)channels->names[c]);
            channels->names[c--] = channels->names[--channels->count];
        }
    if (!channels->data && channels->count && !channels_read(channels, capture, err)) return false;
    if (channels->data && part->width != width && !channels_enlarge(channels, width, err)) return false;
    replay->seconds[PHASE_READ] += now_seconds() - start;
    start = now_seconds();
    if (!replay_staging(replay, offset, err) || !device_begin(replay->device, err)) return false;
    offset = 0;
    for (size_t i = 0; i < run->graph.image_count; i++) {
        const struct graph_image *image = &run->graph.images[i];
        if (image->source != SOURCE_CAPTURE || !run_writes(run, i) || !comes_with(image, role, false)) continue;
        struct packing packing = {.from = (const uint32_t *)channels->data,
                                  .stride = channels->count,
                                  .missing = (float)image->row->nothing,
                                  .format = run->images[i]->desc.format,
                                  .to = (char *)replay->staging.map + offset,
                                  .row = image->row};
        place_components(&packing, channels, image->row);
        run->images[i]->key = 0; /* until all of it is there */
        pack(&packing, width, rows);
        struct bad_values *bad = &run->images[i]->levels[0].bad;
        if (first == 0) *bad = (struct bad_values){0};
        packing.bad.first += image_values(&run->images[i]->desc, 0) / image_layers(&run->images[i]->desc) * first;
        bad_values_add(bad, &packing.bad);
        record_layers(run, i, offset, first, layers);
        offset += ((VkDeviceSize)width * rows * format_bytes(packing.format) + 15) & ~(VkDeviceSize)15;
    }
    bool ok = submit(run, err);
    replay->seconds[PHASE_UPLOAD] += now_seconds() - start;
    return ok;
}

static bool upload_cubemaps(struct run *run, const char *role, struct glint_error *err) {
    const struct glint_part_info **parts;
    size_t count;
    if (!cubemap_parts(run->replay->capture, &parts, &count, err)) return false;
    bool ok = true;
    for (uint32_t i = 0; ok && i < run->sizes.active; i++) {
        struct channels channels = {0};
        ok = report_progress(run->progress, run->user, parts[run->active[i]]->name, (double)i / run->sizes.active * 0.2,
                             err) &&
             upload_part(run, parts[run->active[i]], role, &channels, 6 * i, 6, err);
        channels_finish(&channels);
    }
    free(parts);
    return ok;
}

/* A list from a file must not start more work than it has items for, nor leave tiles out. */
static bool check_list(const struct run *run, size_t i, const uint32_t *header, struct glint_error *err) {
    const uint32_t *half = run->sizes.half;
    const uint64_t capacity = list_capacity(&run->sizes), tiles = (uint64_t)((half[0] + 7) / 8) * ((half[1] + 7) / 8);
    const uint64_t most = capacity / LIST_ITEMS + 64; /* rounded up to full rows of workgroups */
    const bool apart = header[0] <= most && header[1] <= most && header[2] <= most;
    const uint64_t groups = apart ? (uint64_t)header[0] * header[1] * header[2] : UINT64_MAX;
    if (header[3] <= capacity && groups <= most && groups >= tiles) return true;
    return glint_fail(err, GLINT_ERROR_FORMAT,
                      "image %s: expected at most %llu items in %llu to %llu workgroups, found %u in %u x %u x %u",
                      run->images[i]->name, (unsigned long long)capacity, (unsigned long long)tiles,
                      (unsigned long long)most, header[3], header[0], header[1], header[2]);
}

/* Values that are in memory already: tables and images of runs or of the engine. */
static bool upload_values(struct run *run, size_t i, const void *values, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    struct image *image = run->images[i];
    const struct image_desc *desc = &image->desc;
    if (run->graph.images[i].row->size == GLINT_SIZE_LIST && !check_list(run, i, values, err)) return false;
    image->key = 0;
    bool ok = true;
    const uint32_t *from = values;
    for (uint32_t l = 0; ok && l < desc->levels; from += image_values(desc, l++)) {
        if (!replay_staging(replay, image_bytes(desc, l), err) || !device_begin(replay->device, err)) return false;
        struct packing packing = {.from = from,
                                  .stride = format_components(desc->format),
                                  .at = {0, 1, 2, 3},
                                  .format = desc->format,
                                  .to = replay->staging.map};
        pack(&packing, image->levels[l].info.width, image->levels[l].info.height);
        image_record_upload(image, replay->device, &replay->staging, 0, l, 0, image_layers(desc), l == 0);
        ok = submit(run, err);
    }
    return ok;
}

/* A level is a part of its own, named as run folders name it. */
static bool read_engine_level(struct run *run, size_t i, uint32_t l, void *data, struct glint_error *err) {
    const struct graph_image *image = &run->graph.images[i];
    const struct glint_image *level = &run->images[i]->levels[l].info;
    char name[160];
    struct glint_row row = *image->row;
    row.source = image->row->channels; /* the engine names them as the declaration does */
    struct channels channels = {0};
    snprintf(name, sizeof name, "engine.%.48s.%.80s", image->pass->slot, level->name);
    channels.part = glint_capture_find(run->replay->capture, name);
    if (!channels.part || channels.part->width != level->width || channels.part->height != level->height)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %u x %u, found %u x %u",
                          glint_capture_path(run->replay->capture), name, level->width, level->height,
                          channels.part ? channels.part->width : 0, channels.part ? channels.part->height : 0);
    bool ok = channels_add_row(&channels, &row, err);
    if (ok && channels.count != level->components)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "part %s: image %s declares %zu channels for %u components", name,
                        image->name, channels.count, level->components);
    ok = ok && glint_capture_read_raw(run->replay->capture, channels.part, channels.names, channels.count,
                                      format_is_uint(level->format) ? GLINT_U32 : GLINT_F32, data, 0, err);
    channels_finish(&channels);
    return ok;
}

static bool upload_from_engine(struct run *run, size_t i, struct glint_error *err) {
    const struct image_desc *desc = &run->images[i]->desc;
    size_t values = 0;
    for (uint32_t l = 0; l < desc->levels; l++) values += image_values(desc, l);
    uint32_t *data = malloc(values * sizeof *data), *at = data;
    bool ok = data || glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", run->images[i]->name);
    for (uint32_t l = 0; ok && l < desc->levels; at += image_values(desc, l++))
        ok = read_engine_level(run, i, l, at, err);
    ok = ok && upload_values(run, i, data, err);
    free(data);
    return ok;
}

static bool upload_given(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph.images[i];
    const struct glint_table *table = tables_find(&run->tables, image->name);
    if (image->source == SOURCE_RUN) return upload_values(run, i, run->given[i], err);
    if (image->source == SOURCE_ENGINE) return upload_from_engine(run, i, err);
    if (image->source == SOURCE_MADE && table && table->width && table->height)
        return upload_values(run, i, table->texels.u, err);
    if (!device_begin(run->replay->device, err)) return false;
    image_record_clear(run->images[i], run->replay->device, image->row->nothing);
    return submit(run, err);
}

static bool upload_ids(struct run *run, size_t i, struct glint_error *err) {
    const struct glint_row *row = run->graph.images[i].row;
    const struct glint_part_info *part = glint_capture_find(run->replay->capture, row->role);
    uint32_t *ids = calloc(image_values(&run->images[i]->desc, 0), sizeof *ids);
    bool ok = ids || glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", row->name);
    if (ok && glint_part_has_channel(part, row->source))
        ok = glint_capture_read(run->replay->capture, part, &row->source, 1, GLINT_U32, ids, 0, err);
    ok = ok && upload_values(run, i, ids, err);
    free(ids);
    return ok;
}

/* Captures fill several images from one part; the first image met brings the others along. */
static bool upload_captured(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph.images[i];
    struct glint_replay *replay = run->replay;
    const char *role = image->row->role;
    if (format_is_uint(image->row->format)) return upload_ids(run, i, err);
    if (size_is_array(image->row->size)) return upload_cubemaps(run, role, err);
    struct channels own = {0}, *channels = &own;
    if (strcmp(role, "gbuffer") == 0 && replay->gbuffer.data) channels = &replay->gbuffer;
    if (strcmp(role, "sky") == 0 && replay->sky.data) channels = &replay->sky;
    bool ok = upload_part(run, glint_capture_find(replay->capture, role), role, channels, 0,
                          image->row->size == GLINT_SIZE_SKY ? 6 : 1, err);
    channels_finish(&own);
    return ok;
}

/* What a pass leaves out holds nothing. */
static bool clear_left_out(struct run *run, size_t i, struct glint_error *err) {
    const struct graph_image *image = &run->graph.images[i];
    if (!run_limits(run, image->pass)) return true;
    if (!device_begin(run->replay->device, err)) return false;
    image_record_clear(run->images[i], run->replay->device, image->row->nothing);
    return submit(run, err);
}

bool run_upload(struct run *run, struct glint_error *err) {
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph.image_count; i++) {
        const struct graph_image *image = &run->graph.images[i];
        bool table = image->source == SOURCE_MADE && image->pass->host;
        if (!run_writes(run, i)) continue;
        if (image->source == SOURCE_MADE && !table) {
            ok = clear_left_out(run, i, err);
            continue;
        }
        bool stand_in = size_is_array(image->row->size) && run->sizes.active == 0;
        if (image->source == SOURCE_CAPTURE && !stand_in) {
            ok = report_progress(run->progress, run->user, image->row->role, 0, err) && upload_captured(run, i, err);
            for (size_t j = 0; ok && j < run->graph.image_count; j++)
                if (run->graph.images[j].source == SOURCE_CAPTURE && run->needed[j] &&
                    comes_with(&run->graph.images[j], image->row->role, format_is_uint(image->row->format)))
                    run->images[j]->key = run->keys[j];
        } else {
            double start = now_seconds();
            ok = upload_given(run, i, err);
            run->replay->seconds[image->source == SOURCE_MADE ? PHASE_UPLOAD : PHASE_READ] += now_seconds() - start;
            if (ok) run->images[i]->key = run->keys[i];
        }
    }
    if (run->survey) return ok; /* the run that follows may need more of what was read */
    channels_finish(&run->replay->gbuffer);
    channels_finish(&run->replay->sky);
    return ok;
}
