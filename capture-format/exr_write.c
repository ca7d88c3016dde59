/* Writes a multi-part EXR file: chunks are packed and compressed on all cores, or taken from another file as they are, and written in order. */
#include <errno.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "complete.h"
#include "exr_internal.h"
#include "threads.h"

/* libdeflate's level 1 compresses noisy half images to within a few percent of the slow levels. */
#define ZIP_LEVEL 1

struct worker {
    uint8_t *pixels, *scratch, *packed;
    struct libdeflate_compressor *zip;
};

struct target {
    const struct glint_exr_part *part;
    const struct glint_exr_channel **sorted; /* in the file's order */
    size_t line_bytes;
    uint32_t chunk_lines;
    size_t first_chunk;         /* in the whole file */
    struct glint_exr_kept kept; /* the part whose chunks it takes, or none */
};

/* Bytes that follow each other and have not been written yet: OpenEXRCore writes a header in hundreds of pieces of some bytes. */
struct waiting {
    uint8_t bytes[1 << 14];
    size_t size;
    uint64_t offset;
};

struct job {
    const char *path;
    struct target *targets;
    size_t target_count, chunk_count;
    exr_context_t context;
    glint_file file;
    struct waiting waiting;
    struct worker workers[GLINT_MAX_WORKERS];
    glint_mutex lock;
    glint_condition turn;
    size_t next; /* the chunk to be written next */
    bool failed;
    struct glint_error first;
};

static bool job_fail(struct job *job, enum glint_code code, const char *part, const char *what) {
    glint_mutex_lock(&job->lock);
    if (!job->failed) glint_fail(&job->first, code, "%s: part %s: %s", job->path, part, what);
    job->failed = true;
    glint_condition_wake_all(&job->turn);
    glint_mutex_unlock(&job->lock);
    return false;
}

static bool write_waiting(struct job *job) {
    struct waiting *waiting = &job->waiting;
    const size_t size = waiting->size;
    waiting->size = 0;
    return !size || glint_file_write(job->file, waiting->bytes, size, waiting->offset);
}

static exr_result_t complain_of_writing(exr_const_context_t context) {
    glint_exr_complain(context, EXR_ERR_WRITE_IO, strerror(errno));
    return EXR_ERR_WRITE_IO;
}

/* Chunks are written in turn, and headers before them: one call at a time. */
static int64_t stream_write(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                            exr_stream_error_func_ptr_t error) {
    (void)error;
    struct job *job = user;
    struct waiting *waiting = &job->waiting;
    const bool follows = offset == waiting->offset + waiting->size && size <= sizeof waiting->bytes - waiting->size,
               fits = size <= sizeof waiting->bytes;
    bool ok = follows || write_waiting(job);
    if (ok && fits) {
        if (!follows) waiting->offset = offset;
        memcpy(waiting->bytes + waiting->size, buffer, size);
        waiting->size += size;
    } else ok = ok && glint_file_write(job->file, buffer, size, offset);
    if (ok) return (int64_t)size;
    complain_of_writing(context);
    return -1;
}

static exr_compression_t compression_of(enum glint_compression compression) {
    switch (compression) {
    case GLINT_NONE:
        return EXR_COMPRESSION_NONE;
    case GLINT_ZIPS:
        return EXR_COMPRESSION_ZIPS;
    case GLINT_PIZ:
        return EXR_COMPRESSION_PIZ;
    case GLINT_PXR24:
        return EXR_COMPRESSION_PXR24;
    case GLINT_RLE:
        return EXR_COMPRESSION_RLE;
    case GLINT_ZIP:
        break;
    }
    return EXR_COMPRESSION_ZIP;
}

static void pack_lines(const struct target *target, uint32_t y, uint32_t lines, uint8_t *out) {
    for (uint32_t l = 0; l < lines; l++)
        for (size_t c = 0; c < target->part->channel_count; c++) {
            const struct glint_exr_channel *channel = target->sorted[c];
            const size_t bytes = glint_stored_bytes(channel->stored), width = target->part->width;
            const size_t step = channel->x_stride_bytes ? channel->x_stride_bytes : bytes;
            const size_t line = channel->y_stride_bytes ? channel->y_stride_bytes : step * width;
            const uint8_t *from = (const uint8_t *)channel->data + (size_t)(y + l) * line;
            if (step == bytes) memcpy(out, from, width * bytes);
            else if (bytes == 2)
                for (size_t x = 0; x < width; x++) memcpy(out + x * 2, from + x * step, 2);
            else
                for (size_t x = 0; x < width; x++) memcpy(out + x * 4, from + x * step, 4);
            out += width * bytes;
        }
}

/* ---- compressions that glint leaves to OpenEXRCore ---- */

struct foreign {
    const uint8_t *pixels;
    size_t bytes;
    uint8_t *packed; /* holds `bytes` */
    size_t packed_bytes;
};

static exr_result_t foreign_pack(exr_encode_pipeline_t *pipe) {
    const struct foreign *foreign = pipe->encoding_user_data;
    if (pipe->packed_alloc_size < foreign->bytes) return EXR_ERR_ARGUMENT_OUT_OF_RANGE;
    memcpy(pipe->packed_buffer, foreign->pixels, foreign->bytes);
    pipe->packed_bytes = foreign->bytes;
    return EXR_ERR_SUCCESS;
}

static exr_result_t foreign_write(exr_encode_pipeline_t *pipe) {
    struct foreign *foreign = pipe->encoding_user_data;
    foreign->packed_bytes = pipe->compressed_bytes;
    if (pipe->compressed_bytes > foreign->bytes) return EXR_ERR_ARGUMENT_OUT_OF_RANGE;
    memcpy(foreign->packed, pipe->compressed_buffer, pipe->compressed_bytes);
    return EXR_ERR_SUCCESS;
}

static exr_result_t foreign_yield(exr_encode_pipeline_t *pipe) {
    (void)pipe;
    return EXR_ERR_SUCCESS;
}

static bool compress_foreign(struct job *job, int part, uint32_t y, struct foreign *foreign) {
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    if (exr_write_scanline_chunk_info(job->context, part, (int)y, &chunk)) return false;
    if (exr_encoding_initialize(job->context, part, &chunk, &pipe)) return false;
    /* The default routines require channel pointers, although the packing that would use them is replaced. */
    for (int i = 0; i < pipe.channel_count; i++) {
        pipe.channels[i].encode_from_ptr = foreign->pixels;
        pipe.channels[i].user_pixel_stride = pipe.channels[i].bytes_per_element;
        pipe.channels[i].user_line_stride = pipe.channels[i].bytes_per_element * pipe.channels[i].width;
    }
    bool ok = exr_encoding_choose_default_routines(job->context, part, &pipe) == EXR_ERR_SUCCESS;
    pipe.encoding_user_data = foreign;
    pipe.convert_and_pack_fn = foreign_pack;
    pipe.yield_until_ready_fn = foreign_yield;
    pipe.write_fn = foreign_write;
    ok = ok && exr_encoding_run(job->context, part, &pipe) == EXR_ERR_SUCCESS;
    exr_encoding_destroy(job->context, &pipe);
    return ok;
}

static bool write_in_turn(struct job *job, size_t index, int part, uint32_t y, const uint8_t *data, size_t bytes) {
    glint_mutex_lock(&job->lock);
    while (job->next != index && !job->failed) glint_condition_wait(&job->turn, &job->lock);
    const bool go = !job->failed;
    glint_mutex_unlock(&job->lock);
    if (!go) return false;
    const exr_result_t rv = exr_write_scanline_chunk(job->context, part, (int)y, data, bytes);
    if (rv) return job_fail(job, GLINT_ERROR_IO, job->targets[part].part->name, glint_exr_complaint(rv));
    glint_mutex_lock(&job->lock);
    job->next++;
    glint_condition_wake_all(&job->turn);
    glint_mutex_unlock(&job->lock);
    return true;
}

bool glint_exr_can_keep(const struct glint_exr *exr, size_t part) {
    return exr->parts[part].readable && exr->parts[part].compression == EXR_COMPRESSION_ZIP;
}

static bool keep_chunk(struct job *job, struct worker *worker, size_t index, size_t part, uint32_t y, size_t bytes) {
    const struct target *target = &job->targets[part];
    struct glint_exr *from = target->kept.exr;
    exr_chunk_info_t chunk;
    size_t got = 0;
    enum glint_code code = GLINT_ERROR_FORMAT;
    const char *what = "a chunk of the input is missing or damaged";
    glint_exr_memory_begin();
    if (exr_read_scanline_chunk_info(from->context, (int)target->kept.part,
                                     from->parts[target->kept.part].first_y + (int)y, &chunk) ||
        chunk.unpacked_size != bytes || chunk.packed_size > bytes || !chunk.packed_size) {
        glint_exr_system_failed(from, &code, &what);
        return job_fail(job, code, target->part->name, what);
    }
    if (!glint_file_read(from->stream.file, worker->packed, chunk.packed_size, chunk.data_offset, &got))
        return job_fail(job, GLINT_ERROR_IO, target->part->name, strerror(errno));
    if (got != chunk.packed_size)
        return job_fail(job, GLINT_ERROR_FORMAT, target->part->name, "the input ends inside a chunk");
    return write_in_turn(job, index, (int)part, y, worker->packed, got);
}

static bool write_chunk(void *user, uint32_t w, size_t index) {
    struct job *job = user;
    struct worker *worker = &job->workers[w];
    size_t part = job->target_count - 1;
    while (job->targets[part].first_chunk > index) part--;
    const struct target *target = &job->targets[part];
    const uint32_t y = (uint32_t)(index - target->first_chunk) * target->chunk_lines;
    const uint32_t left = target->part->height - y, lines = left < target->chunk_lines ? left : target->chunk_lines;
    const size_t bytes = lines * target->line_bytes;
    if (target->kept.exr) return keep_chunk(job, worker, index, part, y, bytes);
    const exr_compression_t compression = compression_of(target->part->compression);
    const uint8_t *data = worker->pixels;
    size_t data_bytes = bytes;
    pack_lines(target, y, lines, worker->pixels);
    if (compression == EXR_COMPRESSION_ZIP || compression == EXR_COMPRESSION_ZIPS) {
        const size_t packed = glint_zip_pack(worker->zip, worker->pixels, bytes, worker->scratch, worker->packed);
        if (packed) data = worker->packed, data_bytes = packed;
    } else if (compression != EXR_COMPRESSION_NONE) {
        struct foreign foreign = {.pixels = worker->pixels, .bytes = bytes, .packed = worker->packed};
        if (!compress_foreign(job, (int)part, y, &foreign))
            return job_fail(job, GLINT_ERROR_UNSUPPORTED, target->part->name, "OpenEXRCore cannot compress it");
        if (foreign.packed_bytes < bytes) data = worker->packed, data_bytes = foreign.packed_bytes;
    }
    return write_in_turn(job, index, (int)part, y, data, data_bytes);
}

/* ---- headers ---- */

static int by_name(const void *a, const void *b) {
    const struct glint_exr_channel *const *left = a, *const *right = b;
    return strcmp((*left)->name, (*right)->name);
}

static exr_result_t declare_part(struct job *job, size_t i, const struct glint_exr_part *first, const char **what) {
    static const exr_pixel_type_t types[] = {EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT};
    const struct target *target = &job->targets[i];
    const struct glint_exr_part *part = target->part;
    /* A multi-part file has a single display window, that of the first part. */
    const exr_attr_box2i_t display = {.max = {.x = (int)first->width - 1, .y = (int)first->height - 1}};
    const exr_attr_box2i_t data = {.max = {.x = (int)part->width - 1, .y = (int)part->height - 1}};
    const exr_attr_v2f_t center = {.x = 0};
    int at = 0;
    *what = "header";
    exr_result_t rv = exr_add_part(job->context, part->name, EXR_STORAGE_SCANLINE, &at);
    if (!rv)
        rv = exr_initialize_required_attr(job->context, at, &display, &data, 1, &center, 1, EXR_LINEORDER_INCREASING_Y,
                                          compression_of(part->compression));
    for (size_t c = 0; !rv && c < part->channel_count; c++) {
        *what = target->sorted[c]->name;
        rv = exr_add_channel(job->context, at, *what, types[target->sorted[c]->stored], EXR_PERCEPTUALLY_LOGARITHMIC, 1,
                             1);
    }
    for (size_t a = 0; !rv && a < part->attribute_count; a++) {
        *what = part->attributes[a].name;
        if (!glint_exr_attribute_set(job->context, at, &part->attributes[a])) rv = EXR_ERR_INVALID_ATTR;
    }
    return rv;
}

static bool write_headers(struct job *job) {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = glint_exr_complain;
    init.user_data = job;
    init.write_fn = stream_write;
    init.alloc_fn = glint_exr_memory_take;
    init.free_fn = glint_exr_memory_free;
    glint_exr_memory_begin();
    const char *what = "header", *name = job->targets[0].part->name;
    exr_result_t rv = exr_start_write(&job->context, job->path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (!rv) rv = exr_set_longname_support(job->context, 1);
    for (size_t i = 0; !rv && i < job->target_count; i++) {
        name = job->targets[i].part->name;
        rv = declare_part(job, i, job->targets[0].part, &what);
    }
    if (!rv) what = "header", rv = exr_write_header(job->context);
    if (!rv && !write_waiting(job)) rv = complain_of_writing(job->context);
    if (glint_exr_memory_ran_out()) return job_fail(job, GLINT_ERROR_MEMORY, name, "out of memory");
    if (!rv) return true;
    char text[512];
    snprintf(text, sizeof text, "%s: %s", what, glint_exr_complaint(rv));
    return job_fail(job, rv == EXR_ERR_WRITE_IO ? GLINT_ERROR_IO : GLINT_ERROR_USAGE, name, text);
}

static bool plan_chunks(struct job *job, const struct glint_exr_part *parts, size_t count,
                        const struct glint_exr_kept *kept, struct glint_arena *arena, size_t *chunk_bytes,
                        struct glint_error *err) {
    job->targets = glint_arena_take(arena, count * sizeof *job->targets);
    if (!job->targets) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", job->path);
    for (size_t i = 0; i < count; i++) {
        const struct glint_exr_part *part = &parts[i];
        struct target *target = &job->targets[i];
        if (!part->name || !part->name[0] || !part->width || !part->height || part->width > 1u << 24 ||
            part->height > 1u << 26 || !part->channel_count)
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "%s: part %s: expected a name, a size and channels, found %u x %u, %zu", job->path,
                              part->name ? part->name : "(none)", part->width, part->height, part->channel_count);
        target->part = part;
        if (kept) target->kept = kept[i];
        target->sorted = glint_arena_take(arena, part->channel_count * sizeof *target->sorted);
        if (!target->sorted) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", job->path);
        for (size_t c = 0; c < part->channel_count; c++) {
            target->sorted[c] = &part->channels[c];
            target->line_bytes += part->width * glint_stored_bytes(part->channels[c].stored);
        }
        qsort(target->sorted, part->channel_count, sizeof *target->sorted, by_name);
        target->chunk_lines = part->compression == GLINT_PIZ                                       ? 32
                              : part->compression == GLINT_ZIP || part->compression == GLINT_PXR24 ? 16
                                                                                                   : 1;
        target->first_chunk = job->chunk_count;
        job->chunk_count += (part->height + target->chunk_lines - 1) / target->chunk_lines;
        const size_t bytes = target->line_bytes * target->chunk_lines;
        if (bytes > *chunk_bytes) *chunk_bytes = bytes;
        job->target_count++;
    }
    return true;
}

static bool write_file(struct job *job, size_t chunk_bytes, uint32_t threads) {
    const uint32_t workers = glint_loop_workers(job->chunk_count, threads);
    bool ok = write_headers(job);
    for (uint32_t i = 0; i < workers && ok; i++) {
        struct worker *worker = &job->workers[i];
        worker->pixels = malloc(chunk_bytes);
        worker->scratch = malloc(chunk_bytes);
        worker->packed = malloc(chunk_bytes);
        worker->zip = libdeflate_alloc_compressor(ZIP_LEVEL);
        if (!worker->pixels || !worker->scratch || !worker->packed || !worker->zip)
            ok = job_fail(job, GLINT_ERROR_MEMORY, job->targets[0].part->name, "out of memory");
    }
    ok = ok && glint_loop(job->chunk_count, workers, write_chunk, job);
    if (job->context) {
        exr_result_t rv = exr_finish(&job->context);
        if (!rv && !write_waiting(job)) rv = complain_of_writing(NULL);
        if (ok && rv)
            ok = job_fail(job, GLINT_ERROR_IO, job->targets[job->target_count - 1].part->name, glint_exr_complaint(rv));
    }
    for (uint32_t i = 0; i < workers; i++) {
        free(job->workers[i].pixels);
        free(job->workers[i].scratch);
        free(job->workers[i].packed);
        if (job->workers[i].zip) libdeflate_free_compressor(job->workers[i].zip);
    }
    return ok;
}

bool glint_exr_write_file(const char *path, const struct glint_exr_part *parts, size_t count,
                          const struct glint_exr_write_options *options, struct glint_error *err) {
    struct glint_arena arena = {0};
    struct job job = {.path = path, .file = GLINT_NO_FILE};
    struct complete_file out;
    size_t chunk_bytes = 0;
    if (!count) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected at least one part, found none", path);
    glint_mutex_init(&job.lock);
    glint_condition_init(&job.turn);
    bool ok =
        plan_chunks(&job, parts, count, options->kept, &arena, &chunk_bytes, err) && complete_open(&out, path, err);
    if (ok) {
        job.file = out.file;
        ok = write_file(&job, chunk_bytes, options->threads);
        if (!ok && err) *err = job.first;
        ok = complete_close(&out, ok, options->durable, err);
    }
    glint_condition_finish(&job.turn);
    glint_mutex_finish(&job.lock);
    glint_arena_finish(&arena);
    return ok;
}

bool glint_exr_write(const char *path, const struct glint_exr_part *parts, size_t count, uint32_t threads,
                     struct glint_error *err) {
    const struct glint_exr_write_options options = {.threads = threads};
    return glint_exr_write_file(path, parts, count, &options, err);
}
