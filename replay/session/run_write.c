/* Writes run folders: an EXR file for each pass, and run.json last, which marks the folder as complete. */
#include "session.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "glint/exr.h"
#include "record.h"
#include "run_json.h"
#include "run_writer.h"

enum { PATH_SIZE = 4096, CHANNELS = 4 };

/* An EXR file, written by a worker thread while the next pass is read back. */
struct job {
    const struct glint_pass *pass;
    const json_t *parameters; /* of the pass, as run.json has them */
    struct host_buffer buffer;
    struct image_part parts[PASS_PARTS_MAX];
    VkDeviceSize offsets[PASS_PARTS_MAX];
    size_t count;
    char path[PATH_SIZE];
    pthread_t thread;
    bool busy, threaded, ok;
    struct glint_error err;
    double seconds;
};

/* Memory that a part needs until the file is written. */
struct part_memory {
    struct glint_exr_channel channels[CHANNELS];
    struct glint_exr_attribute attributes[9];
    double level;
    struct channel_names names;
    uint32_t *widened;
};

/* How the colours of an image are encoded, or NULL: linear. */
static const char *encoding_of(const struct glint_pass *pass, const json_t *parameters, const char *image) {
    const struct glint_row *row = glint_pass_row(pass, GLINT_ROW_ENCODED_BY, image);
    return row ? json_string_value(json_object_get(parameters, row->assigned)) : NULL;
}

static bool fill_part(const struct job *job, size_t i, struct part_memory *memory, struct glint_exr_part *part,
                      struct glint_error *err) {
    const struct glint_image *image = job->parts[i].info;
    const struct glint_row *row = image->row;
    const uint32_t components = image->components;
    const size_t bytes = format_bytes(image->format) / components;
    const char *data = (const char *)job->buffer.map + job->offsets[i];
    channel_names(&memory->names, row->channels);
    if (bytes == 1) { /* EXR has no integers below 32 bits */
        const size_t texels = (size_t)image->width * image->height * components;
        if (!(memory->widened = malloc(texels * sizeof(uint32_t))))
            return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", job->path);
        for (size_t t = 0; t < texels; t++) memory->widened[t] = ((const uint8_t *)data)[t];
        data = (const char *)memory->widened;
    }
    const size_t stored_bytes = bytes == 1 ? 4 : bytes;
    for (uint32_t c = 0; c < components; c++)
        memory->channels[c] =
            (struct glint_exr_channel){.name = memory->names.list[c],
                                       .stored = glint_format_is_uint(image->format) ? GLINT_STORED_UINT
                                                 : bytes == 2                        ? GLINT_STORED_HALF
                                                                                     : GLINT_STORED_FLOAT,
                                       .data = data + c * stored_bytes,
                                       .x_stride_bytes = components * stored_bytes};
    const char *const texts[][2] = {{"glint.image", row->name},
                                    {"glint.slot", job->pass->slot},
                                    {"glint.variant", job->pass->variant},
                                    {"glint.unit", row->unit},
                                    {"glint.meaning", row->help},
                                    {"glint.channels", row->channels},
                                    {"glint.format", format_name(image->format)}};
    const size_t text_count = sizeof texts / sizeof texts[0];
    for (size_t t = 0; t < text_count; t++)
        memory->attributes[t] = (struct glint_exr_attribute){
            .name = texts[t][0], .type = GLINT_EXR_STRING, .string = texts[t][1], .count = 1};
    size_t count = text_count;
    const char *encoding = encoding_of(job->pass, job->parameters, row->name);
    if (encoding)
        memory->attributes[count++] = (struct glint_exr_attribute){
            .name = "glint.color", .type = GLINT_EXR_STRING, .string = encoding, .count = 1};
    memory->level = image->level;
    if (image->levels > 1)
        memory->attributes[count++] = (struct glint_exr_attribute){
            .name = "glint.level", .type = GLINT_EXR_INT, .numbers = &memory->level, .count = 1};
    *part = (struct glint_exr_part){.name = image->name,
                                    .width = image->width,
                                    .height = image->height,
                                    .channels = memory->channels,
                                    .channel_count = components,
                                    .attributes = memory->attributes,
                                    .attribute_count = count,
                                    .compression = GLINT_ZIP};
    return true;
}

static void *write_file(void *argument) {
    struct job *job = argument;
    double start = glint_now_seconds();
    struct glint_exr_part *parts = calloc(job->count, sizeof *parts);
    struct part_memory *memory = calloc(job->count, sizeof *memory);
    job->ok = (parts && memory) || glint_fail(&job->err, GLINT_ERROR_MEMORY, "%s: out of memory", job->path);
    for (size_t i = 0; job->ok && i < job->count; i++) {
        bad_values_of_texels(&job->parts[i], (const char *)job->buffer.map + job->offsets[i]);
        job->ok = fill_part(job, i, &memory[i], &parts[i], &job->err);
    }
    job->ok = job->ok && glint_exr_write(job->path, parts, job->count, 0, &job->err);
    for (size_t i = 0; memory && i < job->count; i++) free(memory[i].widened);
    free(memory);
    free(parts);
    job->seconds = glint_now_seconds() - start;
    return NULL;
}

static bool job_finish(struct job *job, struct glint_replay *replay, struct glint_error *err) {
    if (!job->busy) return true;
    if (job->threaded) pthread_join(job->thread, NULL);
    job->busy = false;
    replay->source.seconds[PHASE_WRITE] += job->seconds;
    return job->ok || glint_fail(err, job->err.code, "%s", job->err.message);
}

static void job_start(struct job *job) {
    job->busy = true;
    job->threaded = pthread_create(&job->thread, NULL, write_file, job) == 0;
    if (!job->threaded) write_file(job);
}

static json_t *image_record(const struct image_part *part, const char *file, const char *encoding) {
    const struct glint_image *image = part->info;
    const struct glint_row *row = image->row;
    json_t *record = json_pack("{ssssssssssss si si ss}", "name", image->name, "file", file, "part", image->name,
                               "channels", row->channels, "unit", row->unit, "meaning", row->help, "width",
                               (int)image->width, "height", (int)image->height, "format", format_name(image->format));
    if (image->levels > 1) record_set(&record, "level", json_integer((json_int_t)image->level));
    if (encoding) record_set(&record, "encoding", json_string(encoding));
    return record;
}

/* Overwriting the run that this run's inputs came from would lose images that this run did not make. */
static bool check_not_inputs(const struct glint_replay *replay, const char *folder, struct glint_error *err) {
    static const char *const keys[] = {"inputs", "history"};
    struct stat from, to;
    bool same = false;
    for (size_t i = 0; i < 2; i++) {
        const char *inputs = json_string_value(json_object_get(replay->results.record, keys[i]));
        same |= inputs && stat(inputs, &from) == 0 && stat(folder, &to) == 0 && from.st_dev == to.st_dev &&
                from.st_ino == to.st_ino;
    }
    return !same || glint_fail(err, GLINT_ERROR_USAGE,
                               "%s: this folder holds the inputs of the run; expected another folder", folder);
}

bool run_finish_record(struct glint_replay *replay, json_t *root, struct glint_error *err) {
    char hash[33];
    if (!frame_source_hash(&replay->source, hash, err)) return false;
    const char *path = glint_capture_path(replay->source.capture);
    const int failed =
        json_object_set_new(root, "capture",
                            json_pack("{ss?ss}", "path", record_can_hold(path) ? path : NULL, "xxh3_128", hash)) |
        json_object_set_new(
            root, "seconds",
            json_pack("{sfsfsfsfsf}", "read", replay->source.seconds[PHASE_READ], "upload",
                      replay->source.seconds[PHASE_UPLOAD], "passes", replay->source.seconds[PHASE_PASSES], "readback",
                      replay->source.seconds[PHASE_READBACK], "write", replay->source.seconds[PHASE_WRITE])) |
        json_object_set_new(root, "peak_memory_bytes", json_integer((json_int_t)peak_memory_bytes()));
    return !failed || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static bool file_of_pass(const struct glint_replay *replay, size_t p, const char *folder, char path[PATH_SIZE]) {
    return snprintf(path, PATH_SIZE, "%s/%02zu-%s.exr", folder, p + 1, replay->results.passes[p].pass->slot) <
           PATH_SIZE;
}

/* Reads a pass back while the file of the pass before is still being written, and starts the worker. A file in the cache folder is copied
   instead. */
static bool write_pass(struct glint_replay *replay, size_t p, const char *folder, struct job *job, struct job *before,
                       json_t *root, struct glint_error *err) {
    const struct glint_pass_result *result = &replay->results.passes[p];
    job->pass = result->pass;
    job->count = pool_parts(&replay->pool, result->pass, job->parts, PASS_PARTS_MAX);
    if (!file_of_pass(replay, p, folder, job->path))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    const json_t *recorded = json_array_get(json_object_get(root, "passes"), p);
    json_t *images = json_object_get(recorded, "images");
    job->parameters = json_object_get(recorded, "parameters");
    for (size_t i = 0; i < job->count; i++)
        if (json_array_append_new(images,
                                  image_record(&job->parts[i], job->path + strlen(folder) + 1,
                                               encoding_of(job->pass, job->parameters, job->parts[i].info->row->name))))
            return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", job->path);
    if (result->cached && replay->results.cache_keys[p][0] &&
        glint_cache_copy(replay->results.cache, replay->results.cache_keys[p], job->path))
        return true;
    bool read = pool_readback(&replay->pool, job->parts, job->count, &job->buffer, job->offsets, err);
    if (!job_finish(before, replay, read ? err : NULL) || !read) return false;
    job_start(job);
    return true;
}

/* Stores the file of a pass in the cache folder, if that can be written. */
static void cache_pass(const struct glint_replay *replay, size_t p, const char *folder) {
    char path[PATH_SIZE];
    const struct glint_pass_result *result = &replay->results.passes[p];
    if (result->cached || result->from_quick || !replay->results.cache_keys[p][0]) return;
    if (file_of_pass(replay, p, folder, path))
        glint_cache_store(replay->results.cache, replay->results.cache_keys[p], path, 0);
}

static bool record_bad_values(struct glint_replay *replay, json_t *root, struct glint_error *err) {
    const struct glint_bad_values *bad;
    size_t count;
    if (!glint_replay_bad_values(replay, &bad, &count, err)) return false;
    return json_object_set_new(root, "bad_values", bad_values_record(bad, count)) == 0 ||
           glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

char *glint_replay_json(struct glint_replay *replay, struct glint_error *err) {
    if (!replay->results.record) {
        glint_fail(err, GLINT_ERROR_USAGE, "there is no run yet");
        return NULL;
    }
    json_t *root = json_deep_copy(replay->results.record);
    char *text = NULL;
    if (!root) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else if (run_finish_record(replay, root, err) && !(text = record_text(root, JSON_REAL_PRECISION(17))))
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    json_decref(root);
    return text;
}

static bool write_passes(struct glint_replay *replay, const char *folder, json_t *root, glint_progress progress,
                         void *user, struct glint_error *err) {
    struct job *jobs = calloc(2, sizeof *jobs);
    bool ok = jobs || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    size_t turn = 0;
    struct image_part first;
    for (size_t p = 0; ok && p < replay->results.count; p++) {
        const struct glint_pass_result *result = &replay->results.passes[p];
        if (!result->shown || pool_parts(&replay->pool, result->pass, &first, 1) == 0) continue;
        ok =
            glint_report_progress(progress, user, result->pass->slot, (double)p / (double)replay->results.count, err) &&
            write_pass(replay, p, folder, &jobs[turn], &jobs[1 - turn], root, err);
        if (jobs[turn].busy) turn = 1 - turn;
    }
    for (size_t j = 0; jobs && j < 2; j++) {
        ok = job_finish(&jobs[j], replay, ok ? err : NULL) && ok;
        host_buffer_finish(&jobs[j].buffer, replay->pool.gpu);
    }
    free(jobs);
    return ok;
}

bool glint_replay_write_to(struct glint_replay *replay, struct glint_run_writer *writer, glint_progress progress,
                           void *user, struct glint_error *err) {
    struct glint_error own = {0};
    const char *target = run_writer_folder(writer);
    if (!replay->results.record) return glint_fail(err, GLINT_ERROR_USAGE, "%s: there is no run to write", target);
    const char *folder = check_not_inputs(replay, target, err) ? glint_run_writer_begin(writer, err) : NULL;
    if (!folder) return false;
    json_t *root = json_deep_copy(replay->results.record);
    bool ok = root || glint_fail(&own, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    ok = ok && write_passes(replay, folder, root, progress, user, &own);
    for (size_t p = 0; ok && p < replay->results.count; p++) cache_pass(replay, p, folder);
    ok = ok && record_bad_values(replay, root, &own) && replay_count_work(replay, root, &own) &&
         run_finish_record(replay, root, &own) && run_write_json(folder, root, &own) &&
         glint_run_writer_commit(writer, &own);
    json_decref(root);
    return ok || session_fail(replay, &own, err);
}

bool glint_replay_write(struct glint_replay *replay, const char *folder, glint_progress progress, void *user,
                        struct glint_error *err) {
    struct glint_run_writer *writer = glint_run_writer_open(folder, err);
    const bool ok = writer && glint_replay_write_to(replay, writer, progress, user, err);
    glint_run_writer_close(&writer);
    return ok;
}
