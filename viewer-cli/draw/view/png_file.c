/* Writes pictures as PNG files through libpng. */
#include "draw/view/png_file.h"

#include <errno.h>
#include <libdeflate.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/output.h"
#include "io/progress.h"

struct frames {
    const struct picture *pictures;
    size_t count;
    uint32_t turn_ms;
};

/* ---- Animation: the chunks acTL, fcTL and fdAT of the PNG specification, third edition ---- */

static void put_u32(uint8_t *to, uint32_t v) {
    for (int k = 0; k < 4; k++) to[k] = (uint8_t)(v >> (24 - 8 * k));
}

static void write_control(png_structp png, const struct frames *f) {
    uint8_t data[8];
    put_u32(data, (uint32_t)f->count);
    put_u32(data + 4, 0); /* repeat forever */
    png_write_chunk(png, (png_const_bytep) "acTL", data, sizeof data);
}

static void write_frame_control(png_structp png, const struct frames *f, uint32_t sequence) {
    uint8_t data[26] = {0}; /* each frame replaces the whole picture */
    put_u32(data, sequence);
    put_u32(data + 4, f->pictures[0].width);
    put_u32(data + 8, f->pictures[0].height);
    data[20] = (uint8_t)(f->turn_ms >> 8);
    data[21] = (uint8_t)f->turn_ms;
    data[22] = 1000 >> 8;
    data[23] = 1000 & 255;
    png_write_chunk(png, (png_const_bytep) "fcTL", data, sizeof data);
}

/* The sequence number and the compressed rows of a further frame, malloc'd; NULL when out of memory. */
static uint8_t *frame_data(const struct picture *p, uint32_t sequence, size_t *size) {
    const size_t row = 1 + 3 * (size_t)p->width, bytes = row * p->height;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    uint8_t *rows = calloc(bytes, 1); /* each row begins with filter type 0, none */
    const size_t room = compressor ? libdeflate_zlib_compress_bound(compressor, bytes) : 0;
    uint8_t *data = malloc(room + 4);
    *size = 0;
    for (size_t i = 0; rows && i < (size_t)p->width * p->height; i++)
        memcpy(rows + i / p->width * row + 1 + 3 * (i % p->width), p->rgba + 4 * i, 3);
    if (rows && data && compressor) *size = libdeflate_zlib_compress(compressor, rows, bytes, data + 4, room);
    if (data) put_u32(data, sequence);
    libdeflate_free_compressor(compressor);
    free(rows);
    if (*size) return *size += 4, data;
    free(data);
    return NULL;
}

/* ---- Files ---- */

/* In place of libpng's own, which prints. */
static void fail(png_structp png, png_const_charp message) {
    (void)message;
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp message) {
    (void)png, (void)message;
}

/* Notes for the error's message that there was no memory. */
static png_voidp take(png_structp png, png_alloc_size_t bytes) {
    void *memory = malloc(bytes);
    volatile bool *lacks_memory = png_get_mem_ptr(png);
    if (!memory) *lacks_memory = true;
    return memory;
}

static void give_back(png_structp png, png_voidp memory) {
    (void)png;
    free(memory);
}

/* libpng reports errors by longjmp, so variables that are set after setjmp must not be read afterwards. */
static bool encode(FILE *file, const struct frames *frames, uint8_t *const *more, const size_t *sizes, const char *path,
                   struct glint_error *err) {
    const struct picture *picture = &frames->pictures[0];
    volatile bool lacks_memory = false;
    png_structp png =
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, NULL, fail, ignore, (void *)&lacks_memory, take, give_back);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        if (lacks_memory) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        return glint_fail(err, GLINT_ERROR_IO, "%s: cannot write the PNG: %s", path, strerror(errno));
    }
    png_init_io(png, file);
    /* Half the time of level 6 and a third less than with all filters, for files that are a few per cent larger. */
    png_set_compression_level(png, 4);
    png_set_filter(png, PNG_FILTER_TYPE_DEFAULT, PNG_FILTER_PAETH);
    png_set_IHDR(png, info, picture->width, picture->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    if (frames->count > 1) {
        write_control(png, frames);
        write_frame_control(png, frames, 0);
    }
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (uint32_t y = 0; y < picture->height; y++) png_write_row(png, picture->rgba + (size_t)y * picture->width * 4);
    for (size_t i = 1; i < frames->count; i++) {
        write_frame_control(png, frames, (uint32_t)(2 * i - 1));
        png_write_chunk(png, (png_const_bytep) "fdAT", more[i], sizes[i]);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

static bool encode_frames(FILE *file, const struct frames *frames, const char *path, struct glint_error *err) {
    uint8_t **more = calloc(frames->count, sizeof *more);
    size_t *sizes = calloc(frames->count, sizeof *sizes);
    bool ok = more && sizes;
    for (size_t i = 1; ok && i < frames->count; i++)
        ok = (more[i] = frame_data(&frames->pictures[i], (uint32_t)(2 * i), &sizes[i])) != NULL;
    if (ok) ok = encode(file, frames, more, sizes, path, err);
    else glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    for (size_t i = 1; more && i < frames->count; i++) free(more[i]);
    free(more);
    free(sizes);
    return ok;
}

static bool write_file(const char *path, const struct frames *frames, struct glint_error *err) {
    struct output output;
    if (!output_open(&output, path, err)) return false;
    bool ok = encode_frames(output.file, frames, output.path, err);
    if (ok && progress_interrupted()) ok = glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
    return output_close(&output, ok, err);
}

bool png_file_write(const char *path, const struct picture *picture, struct glint_error *err) {
    return write_file(path, &(struct frames){picture, 1, 0}, err);
}

bool png_encode(const struct picture *picture, uint8_t **bytes, size_t *size, struct glint_error *err) {
    char *memory = NULL;
    FILE *file = open_memstream(&memory, size);
    if (!file) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    bool ok = encode_frames(file, &(struct frames){picture, 1, 0}, "picture", err);
    if (fclose(file) != 0 && ok) ok = glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) *bytes = (uint8_t *)memory;
    else free(memory);
    return ok;
}

bool png_file_animate(const char *path, const struct picture *pictures, size_t count, uint32_t turn_ms,
                      struct glint_error *err) {
    for (size_t i = 1; i < count; i++)
        if (pictures[i].width != pictures[0].width || pictures[i].height != pictures[0].height)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: all frames must have the same size", path);
    return write_file(path, &(struct frames){pictures, count, turn_ms}, err);
}
