/* Reads and decompresses the chunks of one part on all cores. */
#include <Imath/half.h>
#include <errno.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

#include "exr_internal.h"
#include "threads.h"

struct worker {
    uint8_t *packed, *unpacked, *scratch;
    size_t packed_bytes;
    struct libdeflate_decompressor *zip;
};

struct job {
    struct glint_exr *exr;
    size_t part;
    size_t offsets[GLINT_EXR_MAX_WANTED]; /* in an unpacked line; SIZE_MAX for none */
    size_t count;
    glint_exr_rows_fn rows;
    void *user;
    struct worker workers[GLINT_MAX_WORKERS];
    glint_mutex lock;
    struct glint_error first;
};

static bool chunk_fail(struct job *job, size_t index, enum glint_code code, const char *what) {
    const struct glint_exr_part_file *part = &job->exr->parts[job->part];
    if (code == GLINT_ERROR_FORMAT) glint_exr_system_failed(job->exr, &code, &what);
    glint_mutex_lock(&job->lock);
    if (job->first.code == GLINT_OK)
        glint_fail(&job->first, code, "%s: part %s: chunk %zu of %u: %s", job->exr->path, part->info.name, index,
                   part->chunk_count, what);
    glint_mutex_unlock(&job->lock);
    return false;
}

/* ---- compressions that glint leaves to OpenEXRCore ---- */

static exr_result_t take_unpacked(exr_decode_pipeline_t *pipe) {
    struct worker *worker = pipe->decoding_user_data;
    if (!pipe->unpacked_buffer) return EXR_ERR_CORRUPT_CHUNK;
    memcpy(worker->unpacked, pipe->unpacked_buffer, pipe->chunk.unpacked_size);
    return EXR_ERR_SUCCESS;
}

static bool unpack_foreign(struct job *job, struct worker *worker, const exr_chunk_info_t *chunk) {
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_const_context_t context = job->exr->context;
    if (exr_decoding_initialize(context, (int)job->part, chunk, &pipe)) return false;
    /* The default routines require channel pointers, although the unpacking that would use them is replaced. */
    for (int i = 0; i < pipe.channel_count; i++) {
        pipe.channels[i].decode_to_ptr = worker->unpacked;
        pipe.channels[i].user_pixel_stride = pipe.channels[i].bytes_per_element;
        pipe.channels[i].user_line_stride = pipe.channels[i].bytes_per_element * pipe.channels[i].width;
    }
    bool ok = exr_decoding_choose_default_routines(context, (int)job->part, &pipe) == EXR_ERR_SUCCESS;
    pipe.decoding_user_data = worker;
    pipe.unpack_and_convert_fn = take_unpacked;
    ok = ok && exr_decoding_run(context, (int)job->part, &pipe) == EXR_ERR_SUCCESS;
    exr_decoding_destroy(context, &pipe);
    return ok;
}

static bool read_packed(struct job *job, struct worker *worker, const exr_chunk_info_t *chunk, size_t index) {
    if (chunk->packed_size > worker->packed_bytes) {
        free(worker->packed);
        worker->packed_bytes = 0;
        worker->packed = malloc(chunk->packed_size);
        if (!worker->packed) return chunk_fail(job, index, GLINT_ERROR_MEMORY, "out of memory");
        worker->packed_bytes = chunk->packed_size;
    }
    size_t got = 0;
    if (!glint_file_read(job->exr->stream.file, worker->packed, chunk->packed_size, chunk->data_offset, &got))
        return chunk_fail(job, index, GLINT_ERROR_IO, strerror(errno));
    return got == chunk->packed_size || chunk_fail(job, index, GLINT_ERROR_FORMAT, "the file ends inside it");
}

static bool read_chunk(void *user, uint32_t w, size_t index) {
    struct job *job = user;
    struct worker *worker = &job->workers[w];
    const struct glint_exr_part_file *part = &job->exr->parts[job->part];
    const uint32_t y = (uint32_t)index * part->chunk_lines;
    const uint32_t lines = part->info.height - y < part->chunk_lines ? part->info.height - y : part->chunk_lines;
    const size_t bytes = lines * part->line_bytes;
    exr_chunk_info_t chunk;
    glint_exr_memory_begin();
    if (exr_read_scanline_chunk_info(job->exr->context, (int)job->part, part->first_y + (int)y, &chunk))
        return chunk_fail(job, index, GLINT_ERROR_FORMAT, "its offset in the file is missing or damaged");
    if (chunk.unpacked_size != bytes || chunk.packed_size > bytes || chunk.packed_size == 0)
        return chunk_fail(job, index, GLINT_ERROR_FORMAT, "its size does not fit the part");
    const uint8_t *pixels = worker->unpacked;
    if (chunk.packed_size == bytes) { /* stored as it is */
        if (!read_packed(job, worker, &chunk, index)) return false;
        pixels = worker->packed;
    } else if (part->compression == EXR_COMPRESSION_ZIP || part->compression == EXR_COMPRESSION_ZIPS) {
        if (!read_packed(job, worker, &chunk, index)) return false;
        if (!glint_zip_unpack(worker->zip, worker->packed, chunk.packed_size, worker->scratch, worker->unpacked, bytes))
            return chunk_fail(job, index, GLINT_ERROR_FORMAT, "damaged ZIP data");
    } else if (part->compression == EXR_COMPRESSION_NONE || !unpack_foreign(job, worker, &chunk)) {
        return chunk_fail(job, index, GLINT_ERROR_FORMAT, "damaged compressed data");
    }
    const uint8_t *planes[GLINT_EXR_MAX_WANTED];
    for (size_t i = 0; i < job->count; i++) planes[i] = job->offsets[i] == SIZE_MAX ? NULL : pixels + job->offsets[i];
    struct glint_error err = {0};
    if (!job->rows(job->user, y, lines, planes, part->line_bytes, &err))
        return chunk_fail(job, index, err.code, err.message);
    return true;
}

static bool find_channels(struct job *job, const char *const *channels, struct glint_error *err) {
    const struct glint_exr_part_file *part = &job->exr->parts[job->part];
    for (size_t i = 0; i < job->count; i++) {
        const int at = channels[i] ? glint_exr_channel(&part->info, channels[i]) : 0;
        if (at < 0)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: %s missing", job->exr->path, part->info.name,
                              channels[i]);
        job->offsets[i] = channels[i] ? part->channel_bytes[at] : SIZE_MAX;
    }
    return true;
}

bool glint_exr_rows(struct glint_exr *exr, size_t p, const char *const *channels, size_t count, uint32_t threads,
                    glint_exr_rows_fn rows, void *user, struct glint_error *err) {
    if (p >= exr->part_count || count > GLINT_EXR_MAX_WANTED)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: expected a part below %zu and at most %d channels, found %zu, %zu", exr->path,
                          exr->part_count, GLINT_EXR_MAX_WANTED, p, count);
    const struct glint_exr_part_file *part = &exr->parts[p];
    if (!part->readable)
        return glint_fail(
            err, GLINT_ERROR_UNSUPPORTED,
            "%s: part %s: expected flat scanlines without subsampling, compressed by NONE, RLE, ZIPS, ZIP, "
            "PIZ, PXR24 or B44; found tiles, deep data, subsampling or another compression",
            exr->path, part->info.name);
    struct job job = {.exr = exr, .part = p, .count = count, .rows = rows, .user = user};
    if (!find_channels(&job, channels, err)) return false;
    /* The packed and the unpacked chunk, and up to three more buffers in OpenEXRCore's PIZ. */
    const uint64_t chunk_bytes = (uint64_t)part->line_bytes * part->chunk_lines, worker_bytes = 6 * chunk_bytes;
    const uint64_t fit = exr->limits.memory_bytes / GLINT_CHUNK_SHARE / worker_bytes;
    if (fit == 0)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: part %s: a chunk of %llu bytes, the limit is %llu", exr->path,
                          part->info.name, (unsigned long long)chunk_bytes,
                          (unsigned long long)(exr->limits.memory_bytes / GLINT_CHUNK_SHARE / 6));
    uint32_t workers = glint_loop_workers(part->chunk_count, threads);
    if (fit < workers) workers = (uint32_t)fit;
    glint_mutex_init(&job.lock);
    bool ok = true;
    for (uint32_t i = 0; i < workers && ok; i++) {
        job.workers[i].unpacked = malloc(chunk_bytes);
        job.workers[i].scratch = malloc(chunk_bytes);
        job.workers[i].zip = libdeflate_alloc_decompressor();
        ok = job.workers[i].unpacked && job.workers[i].scratch && job.workers[i].zip;
    }
    if (!ok) glint_fail(&job.first, GLINT_ERROR_MEMORY, "%s: part %s: out of memory", exr->path, part->info.name);
    else ok = glint_loop(part->chunk_count, workers, read_chunk, &job);
    if (!ok && err) *err = job.first;
    for (uint32_t i = 0; i < workers; i++) {
        free(job.workers[i].packed);
        free(job.workers[i].unpacked);
        free(job.workers[i].scratch);
        if (job.workers[i].zip) libdeflate_free_decompressor(job.workers[i].zip);
    }
    glint_mutex_finish(&job.lock);
    return ok;
}

/* ---- values as stored, interleaved ---- */

struct interleave {
    const struct glint_exr_part_info *part;
    enum glint_stored stored[GLINT_EXR_MAX_WANTED];
    const char *const *names;
    size_t count;
    enum glint_type type;
    uint8_t *out;
};

static size_t type_bytes(enum glint_type type) {
    return type == GLINT_F32 || type == GLINT_U32 ? 4 : type == GLINT_U8 ? 1 : 2;
}

size_t glint_exr_put_line(const uint8_t *from, enum glint_stored stored, enum glint_type type, uint32_t width,
                          size_t count, uint8_t *out) {
    size_t misfits = 0;
    const size_t bytes = type_bytes(type), step = bytes * count;
    if (!from) {
        for (uint32_t x = 0; x < width; x++) memset(out + x * step, 0, bytes);
    } else if (stored == GLINT_STORED_HALF && type == GLINT_F16) {
        for (uint32_t x = 0; x < width; x++) memcpy(out + x * step, from + x * 2, 2);
    } else if (stored == GLINT_STORED_HALF) {
        for (uint32_t x = 0; x < width; x++) {
            uint16_t half;
            memcpy(&half, from + x * 2, 2);
            const float value = imath_half_to_float(half);
            memcpy(out + x * step, &value, 4);
        }
    } else if (type == GLINT_F16) {
        for (uint32_t x = 0; x < width; x++) {
            float value;
            memcpy(&value, from + x * 4, 4);
            const uint16_t half = imath_float_to_half(value);
            memcpy(out + x * step, &half, 2);
        }
    } else if (type == GLINT_F32 || type == GLINT_U32) {
        for (uint32_t x = 0; x < width; x++) memcpy(out + x * step, from + x * 4, 4);
    } else {
        for (uint32_t x = 0; x < width; x++) {
            uint32_t value;
            memcpy(&value, from + x * 4, 4);
            misfits += value >> (8 * bytes) != 0;
            memcpy(out + x * step, &value, bytes);
        }
    }
    return misfits;
}

static bool put_rows(void *user, uint32_t y, uint32_t lines, const uint8_t *const *planes, size_t line_bytes,
                     struct glint_error *err) {
    const struct interleave *to = user;
    const uint32_t width = to->part->width;
    const size_t bytes = type_bytes(to->type);
    for (uint32_t l = 0; l < lines; l++)
        for (size_t i = 0; i < to->count; i++) {
            uint8_t *out = to->out + ((size_t)(y + l) * width * to->count + i) * bytes;
            const uint8_t *from = planes[i] ? planes[i] + l * line_bytes : NULL;
            if (glint_exr_put_line(from, to->stored[i], to->type, width, to->count, out))
                return glint_fail(err, GLINT_ERROR_FORMAT,
                                  "line %u: %s: expected values below 2^%zu, found a larger one", y + l, to->names[i],
                                  8 * bytes);
        }
    return true;
}

bool glint_exr_read(struct glint_exr *exr, size_t p, const char *const *channels, size_t count, enum glint_type type,
                    void *out, uint32_t threads, struct glint_error *err) {
    const struct glint_exr_part_info *part = glint_exr_part(exr, p);
    if (!part || count > GLINT_EXR_MAX_WANTED || type > GLINT_U32)
        return glint_fail(
            err, GLINT_ERROR_USAGE,
            "%s: expected a part, at most %d channels and a plain type, found part %zu, %zu channels, type %d",
            exr->path, GLINT_EXR_MAX_WANTED, p, count, (int)type);
    struct interleave to = {.part = part, .names = channels, .count = count, .type = type, .out = out};
    const bool integer = type != GLINT_F16 && type != GLINT_F32;
    for (size_t i = 0; i < count; i++) {
        const int at = channels[i] ? glint_exr_channel(part, channels[i]) : -1;
        if (at < 0) continue; /* glint_exr_rows reports the missing channel */
        to.stored[i] = part->channels[at].stored;
        if ((to.stored[i] == GLINT_STORED_UINT) != integer)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: part %s: %s: expected %s, found %s", exr->path, part->name,
                              channels[i], integer ? "uint" : "half or float", part->channels[at].storage);
    }
    const struct glint_exr_wanted wanted = {channels, count, type, out};
    if (exr->parts[p].tiled && type_bytes(type) >= 2 && type != GLINT_U16)
        return glint_exr_read_tiles(exr, p, &wanted, err);
    return glint_exr_rows(exr, p, channels, count, threads, put_rows, &to, err);
}
