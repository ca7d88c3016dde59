/* Opens an EXR file: headers and attributes, checked against limits before memory is taken. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exr_internal.h"
#include "registry.h"

#define MAX_CHANNELS 1024
/* The maximum size of headers. */
#define HEADER_BYTES ((uint64_t)16 << 20)

static int64_t stream_read(exr_const_context_t context, void *user, void *buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t error) {
    (void)context, (void)error;
    struct glint_exr_stream *stream = user;
    glint_mutex_lock(&stream->lock);
    const bool allowed = size <= stream->allowance;
    if (allowed) stream->allowance -= size;
    else stream->exceeded = true;
    glint_mutex_unlock(&stream->lock);
    if (!allowed || offset > INT64_MAX) return -1;
    size_t got = 0;
    if (glint_file_read(stream->file, buffer, size, offset, &got)) return (int64_t)got;
    const int failure = errno;
    glint_mutex_lock(&stream->lock);
    if (!stream->failure) stream->failure = failure;
    glint_mutex_unlock(&stream->lock);
    return -1;
}

static int64_t stream_size(exr_const_context_t context, void *user) {
    (void)context;
    return (int64_t)((struct glint_exr_stream *)user)->bytes;
}

/* OpenEXRCore's default prints to stderr. */
static void store_complaint(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) || !user) return;
    struct glint_exr_stream *stream = user;
    glint_mutex_lock(&stream->lock);
    snprintf(stream->complaint, sizeof stream->complaint, "%s", message ? message : "");
    glint_mutex_unlock(&stream->lock);
}

/* Other files that are given in place of captures, by their first bytes, and what glint has for them. */
static const struct {
    const char *bytes, *what;
} kinds[] = {
    {"\x89PNG", "a PNG image; glint pack makes a capture of textures"},
    {"\xFF\xD8\xFF", "a JPEG image; glint pack makes a capture of textures, which should be lossless"},
    {"RDOC", "a RenderDoc capture; docs/engines/renderdoc.md makes a capture of one"},
    {"#?", "a Radiance HDR image; glint pack makes a capture of textures"},
    {"DDS ", "a DDS texture; glint pack makes a capture of textures"},
    {"\xABKTX 20", "a KTX 2 texture; glint pack makes a capture of textures"},
    {"\x93NUMPY", "a NumPy array; glint pack makes a capture of textures"},
    {"glTF", "a glTF scene; glint sample renders a capture of one"},
    {"PK\x03\x04", "a zip archive; glint pack makes a capture of the manifest in it, once it is unpacked"},
    {"{",
     "a JSON file; glint pack makes a capture of a manifest, --preset reads presets, and a run is named by its folder"},
};

/* What the file is instead of OpenEXR, or NULL. */
static const char *other_kind(const struct glint_exr *exr) {
    char first[16] = "";
    size_t got = 0, blank = 0;
    if (!glint_file_read(exr->stream.file, first, sizeof first - 1, 0, &got)) return NULL;
    if (!got) return "an empty file";
    while (first[blank] && strchr(" \t\r\n", first[blank])) blank++; /* before a JSON text */
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strncmp(first + blank, kinds[i].bytes, strlen(kinds[i].bytes))) return kinds[i].what;
    return NULL;
}

static bool open_file(struct glint_exr *exr, struct glint_error *err) {
    struct glint_file_info info;
    exr->stream.file = exr->limits.no_link ? glint_file_open_unlinked(exr->path) : glint_file_open(exr->path);
    if (exr->stream.file == GLINT_NO_FILE && errno == ELOOP && exr->limits.no_link)
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected an EXR file, found a symbolic link, which is not followed",
                          exr->path);
    if (exr->stream.file == GLINT_NO_FILE || !glint_file_describe(exr->stream.file, &info))
        return glint_fail(err, GLINT_ERROR_IO, "%s: %s", exr->path, strerror(errno));
    if (info.kind != GLINT_FILE_REGULAR)
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected an EXR file, found %s", exr->path,
                          info.kind == GLINT_FILE_FOLDER ? "a folder (of a run? glint view, diff and report read runs)"
                                                         : "another kind of file");
    exr->stream.bytes = info.bytes;
    if (exr->stream.bytes > exr->limits.file_bytes)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: file of %llu bytes, the limit is %llu", exr->path,
                          (unsigned long long)exr->stream.bytes, (unsigned long long)exr->limits.file_bytes);
    return true;
}

static bool start_reading(struct glint_exr *exr, struct glint_error *err) {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = store_complaint;
    init.user_data = &exr->stream;
    init.alloc_fn = glint_exr_memory_take;
    init.free_fn = glint_exr_memory_free;
    init.read_fn = stream_read;
    init.size_fn = stream_size;
    init.max_image_width = init.max_image_height = 1 << 28; /* larger than any limit, which read_layout checks */
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    const uint64_t share = exr->limits.memory_bytes / GLINT_HEADER_SHARE;
    const uint64_t allowance = HEADER_BYTES < share ? HEADER_BYTES : share;
    exr->stream.allowance = allowance;
    const exr_result_t rv = exr_start_read(&exr->context, exr->path, &init);
    if (exr->stream.exceeded)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: headers of more than %llu bytes, which is the limit", exr->path,
                          (unsigned long long)allowance);
    if (rv == EXR_ERR_OUT_OF_MEMORY) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", exr->path);
    if (rv && other_kind(exr))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected an OpenEXR file, found %s", exr->path,
                          other_kind(exr));
    if (rv)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected an OpenEXR file, found: %s", exr->path,
                          exr->stream.complaint[0] ? exr->stream.complaint : exr_get_default_error_message(rv));
    exr->stream.allowance = exr->limits.memory_bytes / GLINT_TABLE_SHARE;
    return true;
}

static bool read_channels(struct glint_exr *exr, size_t p, struct glint_error *err) {
    struct glint_exr_part_file *part = &exr->parts[p];
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(exr->context, (int)p, &list) || !list || list->num_channels < 1)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected channels, found none", exr->path,
                          part->info.name);
    const size_t count = (size_t)list->num_channels;
    if (count > MAX_CHANNELS)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: part %s: %zu channels, the limit is %d", exr->path,
                          part->info.name, count, MAX_CHANNELS);
    struct glint_channel_info *channels = glint_arena_take(&exr->arena, count * sizeof *channels);
    part->channel_bytes = glint_arena_take(&exr->arena, count * sizeof *part->channel_bytes);
    if (!channels || !part->channel_bytes) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", exr->path);
    for (size_t i = 0; i < count; i++) {
        const exr_attr_chlist_entry_t *from = &list->entries[i];
        channels[i].stored = from->pixel_type == EXR_PIXEL_HALF    ? GLINT_STORED_HALF
                             : from->pixel_type == EXR_PIXEL_FLOAT ? GLINT_STORED_FLOAT
                                                                   : GLINT_STORED_UINT;
        snprintf(channels[i].name, sizeof channels[i].name, "%.*s", (int)from->name.length, from->name.str);
        snprintf(channels[i].storage, sizeof channels[i].storage, "%s", glint_stored_name(channels[i].stored));
        part->channel_bytes[i] = part->line_bytes;
        part->line_bytes += glint_stored_bytes(channels[i].stored) * part->info.width;
        if (from->x_sampling != 1 || from->y_sampling != 1) part->readable = part->tiled = false;
    }
    part->info.channels = channels;
    part->info.channel_count = count;
    return true;
}

static bool read_layout(struct glint_exr *exr, size_t p, struct glint_error *err) {
    struct glint_exr_part_file *part = &exr->parts[p];
    exr_attr_box2i_t box;
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    int32_t lines = 0, chunks = 0, stated = -1;
    if (exr_get_data_window(exr->context, (int)p, &box) || exr_get_storage(exr->context, (int)p, &storage) ||
        exr_get_compression(exr->context, (int)p, &part->compression))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: header is not complete", exr->path, part->info.name);
    const int64_t width = (int64_t)box.max.x - box.min.x + 1, height = (int64_t)box.max.y - box.min.y + 1;
    if (width < 1 || height < 1)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected a data window, found %lld x %lld", exr->path,
                          part->info.name, (long long)width, (long long)height);
    if (width > exr->limits.width || height > (int64_t)exr->limits.width * 6)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: part %s: %lld x %lld pixels, the limit is %u x %u", exr->path,
                          part->info.name, (long long)width, (long long)height, exr->limits.width,
                          exr->limits.width * 6);
    part->info.width = (uint32_t)width;
    part->info.height = (uint32_t)height;
    part->first_y = box.min.y;
    part->readable = storage == EXR_STORAGE_SCANLINE && part->compression < EXR_COMPRESSION_DWAA;
    part->tiled = storage == EXR_STORAGE_TILED && part->compression < EXR_COMPRESSION_DWAA;
    if (storage == EXR_STORAGE_SCANLINE) {
        if (exr_get_scanlines_per_chunk(exr->context, (int)p, &lines) ||
            exr_get_chunk_count(exr->context, (int)p, &chunks) || lines < 1)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: header is not complete", exr->path,
                              part->info.name);
        /* The file must state the number of chunks that OpenEXRCore computes. */
        exr_attr_get_int(exr->context, (int)p, "chunkCount", &stated);
        if (chunks != (height + lines - 1) / lines || (stated != -1 && stated != chunks))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %lld chunks, found %d", exr->path,
                              part->info.name, (long long)((height + lines - 1) / lines), stated);
        part->chunk_lines = (uint32_t)lines;
        part->chunk_count = (uint32_t)chunks;
    }
    return true;
}

/* Every chunk must lie inside the file, so that a truncated file is rejected before any pixel is read. */
static bool check_chunks(struct glint_exr *exr, size_t p, struct glint_error *err) {
    const struct glint_exr_part_file *part = &exr->parts[p];
    if (!part->readable) return true;
    for (uint32_t i = 0; i < part->chunk_count; i++) {
        exr_chunk_info_t chunk;
        const exr_result_t rv =
            exr_read_scanline_chunk_info(exr->context, (int)p, part->first_y + (int)(i * part->chunk_lines), &chunk);
        if (rv)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: chunk %u of %u is missing or damaged: %s",
                              exr->path, part->info.name, i, part->chunk_count,
                              exr->stream.complaint[0] ? exr->stream.complaint : exr_get_default_error_message(rv));
        if (chunk.data_offset > exr->stream.bytes || chunk.packed_size > exr->stream.bytes - chunk.data_offset)
            return glint_fail(err, GLINT_ERROR_FORMAT,
                              "%s: part %s: chunk %u of %u: expected it to end at byte %llu, the file has %llu",
                              exr->path, part->info.name, i, part->chunk_count,
                              (unsigned long long)(chunk.data_offset + chunk.packed_size),
                              (unsigned long long)exr->stream.bytes);
    }
    return true;
}

static bool read_parts(struct glint_exr *exr, struct glint_error *err) {
    int count = 0;
    if (exr_get_count(exr->context, &count) || count < 1)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected parts, found none", exr->path);
    if ((uint32_t)count > exr->limits.parts)
        return glint_fail(err, GLINT_ERROR_LIMIT, "%s: %d parts, the limit is %u", exr->path, count, exr->limits.parts);
    exr->parts = glint_arena_take(&exr->arena, (size_t)count * sizeof *exr->parts);
    if (!exr->parts) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", exr->path);
    exr->part_count = (size_t)count;
    for (size_t p = 0; p < exr->part_count; p++) {
        const char *name = NULL;
        exr_get_name(exr->context, (int)p, &name);
        exr->parts[p].info.name = glint_arena_string(&exr->arena, name ? name : "");
        if (!exr->parts[p].info.name) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", exr->path);
        if (!read_layout(exr, p, err) || !read_channels(exr, p, err) || !glint_exr_attributes_get(exr, p, err) ||
            !check_chunks(exr, p, err))
            return false;
    }
    return true;
}

/* Headers, without what is only there because the system refused something. */
static bool read_headers(struct glint_exr *exr, struct glint_error *err) {
    enum glint_code code;
    const char *what;
    glint_exr_memory_begin();
    const bool ok = start_reading(exr, err) && read_parts(exr, err);
    if (glint_exr_system_failed(exr, &code, &what)) return glint_fail(err, code, "%s: %s", exr->path, what);
    return ok;
}

struct glint_exr *glint_exr_open(const char *path, const struct glint_limits *limits, struct glint_error *err) {
    struct glint_exr *exr = calloc(1, sizeof *exr);
    if (!exr) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return NULL;
    }
    if (limits) exr->limits = *limits;
    if (!exr->limits.file_bytes) exr->limits.file_bytes = (uint64_t)64 << 30;
    if (!exr->limits.memory_bytes) exr->limits.memory_bytes = (uint64_t)4 << 30;
    if (!exr->limits.width || exr->limits.width > 1u << 26) exr->limits.width = 32768;
    if (!exr->limits.parts) exr->limits.parts = 1024;
    glint_mutex_init(&exr->stream.lock);
    exr->stream.file = GLINT_NO_FILE;
    exr->path = glint_arena_string(&exr->arena, path);
    if (!exr->path) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    if (!exr->path || !open_file(exr, err) || !read_headers(exr, err)) glint_exr_close(&exr);
    return exr;
}

void glint_exr_close(struct glint_exr **exr) {
    if (!exr || !*exr) return;
    if ((*exr)->context) exr_finish(&(*exr)->context);
    if ((*exr)->stream.file != GLINT_NO_FILE) glint_file_close((*exr)->stream.file);
    glint_mutex_finish(&(*exr)->stream.lock);
    glint_arena_finish(&(*exr)->arena);
    free(*exr);
    *exr = NULL;
}

size_t glint_exr_part_count(const struct glint_exr *exr) {
    return exr->part_count;
}

const struct glint_exr_part_info *glint_exr_part(const struct glint_exr *exr, size_t i) {
    return i < exr->part_count ? &exr->parts[i].info : NULL;
}

int glint_exr_channel(const struct glint_exr_part_info *part, const char *name) {
    for (size_t i = 0; i < part->channel_count; i++)
        if (!strcmp(part->channels[i].name, name)) return (int)i;
    return -1;
}
