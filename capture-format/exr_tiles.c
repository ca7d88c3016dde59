/* Reads the full-size level of a tiled part, tile by tile, through OpenEXRCore. Captures hold scanlines; other files need not. */
#include <stdlib.h>
#include <string.h>

#include "exr_internal.h"

static bool tile_fail(struct glint_exr *exr, size_t p, const int at[2], enum glint_code code, const char *what,
                      struct glint_error *err) {
    if (code == GLINT_ERROR_FORMAT) glint_exr_system_failed(exr, &code, &what);
    return glint_fail(err, code, "%s: part %s: tile %d, %d: %s", exr->path, exr->parts[p].info.name, at[0], at[1],
                      what);
}

/* A tile, and where its texels go. */
struct tile {
    const struct glint_exr_part_info *part;
    const struct glint_exr_wanted *wanted;
    uint32_t x, y, width, height;
};

/* Lines of channels, one after the other. */
static void put_tile(const struct tile *tile, const uint8_t *line) {
    const struct glint_exr_wanted *wanted = tile->wanted;
    const size_t bytes = wanted->type == GLINT_F16 ? 2 : 4, step = bytes * wanted->count;
    for (uint32_t y = 0; y < tile->height; y++)
        for (size_t c = 0; c < tile->part->channel_count; c++) {
            const struct glint_channel_info *channel = &tile->part->channels[c];
            uint8_t *out = wanted->out + ((size_t)(tile->y + y) * tile->part->width + tile->x) * step;
            for (size_t i = 0; i < wanted->count; i++)
                if (wanted->names[i] && !strcmp(wanted->names[i], channel->name))
                    glint_exr_put_line(line, channel->stored, wanted->type, tile->width, wanted->count,
                                       out + i * bytes);
            line += tile->width * glint_stored_bytes(channel->stored);
        }
}

/* In place of OpenEXRCore's routine, which writes all channels. */
static exr_result_t take_tile(exr_decode_pipeline_t *pipe) {
    if (!pipe->unpacked_buffer) return EXR_ERR_CORRUPT_CHUNK;
    put_tile(pipe->decoding_user_data, pipe->unpacked_buffer);
    return EXR_ERR_SUCCESS;
}

/* A tile that is stored as it is. */
static bool read_plain(struct glint_exr *exr, const struct tile *tile, const exr_chunk_info_t *chunk) {
    uint8_t *lines = malloc(chunk->packed_size);
    size_t got = 0;
    const bool ok = lines && glint_file_read(exr->stream.file, lines, chunk->packed_size, chunk->data_offset, &got) &&
                    got == chunk->packed_size;
    if (ok) put_tile(tile, lines);
    free(lines);
    return ok;
}

static bool read_tile(struct glint_exr *exr, size_t p, const struct glint_exr_wanted *wanted, const int at[2],
                      const uint32_t size[2], struct glint_error *err) {
    const struct glint_exr_part_info *part = &exr->parts[p].info;
    const uint32_t x = (uint32_t)at[0] * size[0], y = (uint32_t)at[1] * size[1];
    const uint32_t width = part->width - x < size[0] ? part->width - x : size[0],
                   height = part->height - y < size[1] ? part->height - y : size[1];
    exr_chunk_info_t chunk;
    glint_exr_memory_begin();
    if (exr_read_tile_chunk_info(exr->context, (int)p, at[0], at[1], 0, 0, &chunk))
        return tile_fail(exr, p, at, GLINT_ERROR_FORMAT, "its offset in the file is missing or damaged", err);
    const uint64_t bytes = (uint64_t)width * height * (exr->parts[p].line_bytes / part->width);
    if (chunk.width != (int32_t)width || chunk.height != (int32_t)height || chunk.unpacked_size != bytes ||
        chunk.packed_size > bytes || chunk.packed_size == 0)
        return tile_fail(exr, p, at, GLINT_ERROR_FORMAT, "its size does not fit the part", err);
    if (bytes > exr->limits.memory_bytes / GLINT_CHUNK_SHARE / 6)
        return tile_fail(exr, p, at, GLINT_ERROR_LIMIT, "it is larger than the limit of memory allows", err);
    struct tile tile = {part, wanted, x, y, width, height};
    if (chunk.packed_size == bytes)
        return read_plain(exr, &tile, &chunk) || tile_fail(exr, p, at, GLINT_ERROR_IO, "cannot be read", err);
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    if (exr_decoding_initialize(exr->context, (int)p, &chunk, &pipe))
        return tile_fail(exr, p, at, GLINT_ERROR_MEMORY, "out of memory", err);
    /* The default routines require channel pointers, although the unpacking that would use them is replaced. */
    for (int i = 0; i < pipe.channel_count; i++) {
        pipe.channels[i].decode_to_ptr = wanted->out;
        pipe.channels[i].user_pixel_stride = pipe.channels[i].bytes_per_element;
        pipe.channels[i].user_line_stride = pipe.channels[i].bytes_per_element * pipe.channels[i].width;
    }
    bool ok = exr_decoding_choose_default_routines(exr->context, (int)p, &pipe) == EXR_ERR_SUCCESS;
    pipe.decoding_user_data = &tile;
    pipe.unpack_and_convert_fn = take_tile;
    ok = ok && exr_decoding_run(exr->context, (int)p, &pipe) == EXR_ERR_SUCCESS;
    exr_decoding_destroy(exr->context, &pipe);
    return ok || tile_fail(exr, p, at, GLINT_ERROR_FORMAT, "damaged pixels", err);
}

bool glint_exr_read_tiles(struct glint_exr *exr, size_t p, const struct glint_exr_wanted *wanted,
                          struct glint_error *err) {
    const struct glint_exr_part_file *part = &exr->parts[p];
    uint32_t size[2];
    exr_tile_level_mode_t levels;
    exr_tile_round_mode_t rounding;
    if (exr_get_tile_descriptor(exr->context, (int)p, &size[0], &size[1], &levels, &rounding) || !size[0] || !size[1])
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: header is not complete", exr->path, part->info.name);
    for (size_t i = 0; i < wanted->count; i++)
        if (wanted->names[i] && glint_exr_channel(&part->info, wanted->names[i]) < 0)
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: %s missing", exr->path, part->info.name,
                              wanted->names[i]);
    memset(wanted->out, 0,
           (size_t)part->info.width * part->info.height * wanted->count * (wanted->type == GLINT_F16 ? 2 : 4));
    for (int y = 0; (uint64_t)y * size[1] < part->info.height; y++)
        for (int x = 0; (uint64_t)x * size[0] < part->info.width; x++)
            if (!read_tile(exr, p, wanted, (const int[2]){x, y}, size, err)) return false;
    return true;
}
