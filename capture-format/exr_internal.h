/* Shared by the EXR reader, the EXR writer and the capture reader. */
#ifndef GLINT_EXR_INTERNAL_H
#define GLINT_EXR_INTERNAL_H

#include <openexr.h>

#include "arena.h"
#include "glint/exr.h"
#include "system.h"

/* A file that glint opened for OpenEXRCore, and the last error of OpenEXRCore. */
struct glint_exr_stream {
    glint_file file;
    uint64_t bytes;     /* size of the file */
    uint64_t allowance; /* bytes that may still be read through the stream, which chunks bypass */
    bool exceeded;      /* more than the allowance was requested */
    int failure;        /* errno of the first read that failed, or 0 */
    const char *path;
    glint_mutex lock;
    char complaint[256];
};

struct glint_exr_part_file {
    struct glint_exr_part_info info;
    bool readable;        /* flat scanlines without subsampling */
    bool tiled;           /* flat tiles without subsampling, which glint_exr_read_tiles reads */
    int32_t first_y;      /* of the data window */
    uint32_t chunk_lines; /* scanlines in each chunk but the last */
    uint32_t chunk_count;
    size_t line_bytes;     /* of all channels */
    size_t *channel_bytes; /* offset of each channel in an unpacked line */
    exr_compression_t compression;
};

/* How memory_bytes is shared out: headers (which take up to 40 times their bytes), chunk tables, chunks in flight; the
   rest is for the siblings of a capture. */
#define GLINT_HEADER_SHARE 128
#define GLINT_TABLE_SHARE 16
#define GLINT_CHUNK_SHARE 4
#define GLINT_SIBLING_SHARE 32

struct glint_exr {
    char *path;
    exr_context_t context;
    struct glint_exr_stream stream;
    struct glint_limits limits; /* with the defaults filled in */
    struct glint_arena arena;
    struct glint_exr_part_file *parts;
    size_t part_count;
};

/* A part of another file, whose compressed chunks are written as they are; exr NULL: none. */
struct glint_exr_kept {
    struct glint_exr *exr;
    size_t part;
};
/* Whether glint_exr_write_file can keep a part's chunks: it is of flat scanlines compressed with ZIP. */
bool glint_exr_can_keep(const struct glint_exr *exr, size_t part);
struct glint_exr_write_options {
    const struct glint_exr_kept *
        kept; /* one for each part, or NULL; the pixels of parts that are kept are not read, and the rest is as in that part */
    uint32_t threads; /* 0: all cores */
    bool
        durable; /* the file is on the disk before it gets its name, so that a machine that stops leaves no empty one */
};
bool glint_exr_write_file(const char *path, const struct glint_exr_part *parts, size_t count,
                          const struct glint_exr_write_options *options, struct glint_error *err);

/* Receives lines y .. y + lines - 1 of the requested channels, as stored: planes[i] is the first line of channel i (NULL
   for a NULL name), the next line is line_bytes further. Called from several threads, each line once. */
typedef bool (*glint_exr_rows_fn)(void *user, uint32_t y, uint32_t lines, const uint8_t *const *planes,
                                  size_t line_bytes, struct glint_error *err);
#define GLINT_EXR_MAX_WANTED 64
bool glint_exr_rows(struct glint_exr *exr, size_t part, const char *const *channels, size_t count, uint32_t threads,
                    glint_exr_rows_fn rows, void *user, struct glint_error *err);
/* Writes a line of a channel to every `count`-th element of `out`; returns the number of values that do not fit the type. */
size_t glint_exr_put_line(const uint8_t *from, enum glint_stored stored, enum glint_type type, uint32_t width,
                          size_t count, uint8_t *out);
/* Channels as glint_exr_read takes them; types half, float and uint. */
struct glint_exr_wanted {
    const char *const *names;
    size_t count;
    enum glint_type type;
    uint8_t *out;
};
bool glint_exr_read_tiles(struct glint_exr *exr, size_t part, const struct glint_exr_wanted *wanted,
                          struct glint_error *err);
/* -1 if the part has no such channel. */
int glint_exr_channel(const struct glint_exr_part_info *part, const char *name);
static inline size_t glint_stored_bytes(enum glint_stored stored) {
    return stored == GLINT_STORED_HALF ? 2 : 4;
}

/* Memory for OpenEXRCore, which may go on without where it gets none: it then drops attributes or calls a file damaged. Whether that happened
   is kept for each thread since glint_exr_memory_begin, as OpenEXRCore says neither for whom it allocates nor that it failed. */
void *glint_exr_memory_take(size_t bytes);
void glint_exr_memory_free(void *memory);
void glint_exr_memory_begin(void);
bool glint_exr_memory_ran_out(void);
/* An error handler that keeps the first message of this thread since glint_exr_memory_begin. A context that is written to is locked while it calls
   its handler, which therefore must not ask it for anything, not even for its user data. */
void glint_exr_complain(exr_const_context_t context, exr_result_t code, const char *message);
/* That message, or what the code means. */
const char *glint_exr_complaint(exr_result_t code);
/* What OpenEXRCore says of a file is not the file's fault if the system refused memory or a read: then this is the error, and the result true. */
bool glint_exr_system_failed(struct glint_exr *exr, enum glint_code *code, const char **what);

/* Convert attributes between OpenEXRCore and glint. */
bool glint_exr_attributes_get(struct glint_exr *exr, size_t part, struct glint_error *err);
bool glint_exr_attribute_set(exr_context_t context, int part, const struct glint_exr_attribute *attribute);

/* ZIP chunks of OpenEXR: bytes split by parity, each the difference to the one before, then zlib. `scratch` holds as
   many bytes as the unpacked chunk. */
struct libdeflate_compressor;
struct libdeflate_decompressor;
/* The compressed size, or 0 if it would not be smaller than `bytes`, which is the size of `out`. */
size_t glint_zip_pack(struct libdeflate_compressor *zip, const uint8_t *in, size_t bytes, uint8_t *scratch,
                      uint8_t *out);
bool glint_zip_unpack(struct libdeflate_decompressor *zip, const uint8_t *in, size_t in_bytes, uint8_t *scratch,
                      uint8_t *out, size_t bytes);

#endif
