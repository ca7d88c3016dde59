/* Decodes images with libpng's simplified reader, and with libjpeg whose error handler returns. */
#include "image.h"

#include <stdio.h> /* jpeglib.h needs FILE */

#include <jpeglib.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

static bool fits(const char *name, uint32_t width, uint32_t height, struct glint_error *err) {
    if (width && height && width <= IMAGE_MAX_SIDE && height <= IMAGE_MAX_SIDE) return true;
    return glint_fail(err, GLINT_ERROR_LIMIT, "%s: %u x %u pixels, expected 1 to %d a side", name, width, height,
                      IMAGE_MAX_SIDE);
}

static uint8_t *decode_png(const char *name, const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height,
                           struct glint_error *err) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    uint8_t *pixels = NULL;
    if (!png_image_begin_read_from_memory(&image, bytes, size)) goto failed;
    if (!fits(name, image.width, image.height, err)) goto done;
    image.format = PNG_FORMAT_RGBA;
    image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    pixels = malloc(PNG_IMAGE_SIZE(image));
    if (!pixels) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory for its pixels", name);
        goto done;
    }
    *width = image.width;
    *height = image.height;
    if (png_image_finish_read(&image, NULL, pixels, 0, NULL)) goto done;
    free(pixels);
    pixels = NULL;
failed:
    glint_fail(err, GLINT_ERROR_FORMAT, "%s: damaged PNG: %s", name, image.message);
done:
    png_image_free(&image);
    return pixels;
}

struct jpeg {
    struct jpeg_decompress_struct info;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf back;
    uint8_t *pixels;
    char reason[JMSG_LENGTH_MAX];
};

_Noreturn static void leave(j_common_ptr info) {
    struct jpeg *jpeg = info->client_data;
    info->err->format_message(info, jpeg->reason);
    longjmp(jpeg->back, 1);
}

/* libjpeg fills missing data and only issues a warning. */
static void on_warning(j_common_ptr info, int level) {
    if (level < 0) leave(info);
}

static void print_nothing(j_common_ptr info) {
    (void)info;
}

/* A small progressive file may request any number of passes over the whole picture. */
static void count_scans(j_common_ptr info) {
    enum { MOST_SCANS = 200 };
    struct jpeg *jpeg = info->client_data;
    if (jpeg->info.input_scan_number <= MOST_SCANS) return;
    snprintf(jpeg->reason, sizeof jpeg->reason, "more than %d scans", MOST_SCANS);
    longjmp(jpeg->back, 1);
}

static bool read_jpeg(struct jpeg *jpeg, const char *name, const uint8_t *bytes, size_t size, struct glint_error *err) {
    struct jpeg_decompress_struct *info = &jpeg->info;
    if (setjmp(jpeg->back)) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: damaged JPEG: %s", name, jpeg->reason);
    jpeg_create_decompress(info);
    info->progress = &jpeg->progress;
    jpeg_mem_src(info, bytes, (unsigned long)size);
    jpeg_read_header(info, TRUE);
    if (!fits(name, info->image_width, info->image_height, err)) return false;
    info->out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(info);
    size_t row = (size_t)info->output_width * 4;
    jpeg->pixels = malloc(row * info->output_height);
    if (!jpeg->pixels) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory for its pixels", name);
    while (info->output_scanline < info->output_height) {
        JSAMPROW line = jpeg->pixels + row * info->output_scanline;
        jpeg_read_scanlines(info, &line, 1);
    }
    jpeg_finish_decompress(info);
    return true;
}

static uint8_t *decode_jpeg(const char *name, const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height,
                            struct glint_error *err) {
    struct jpeg *jpeg = calloc(1, sizeof *jpeg);
    if (!jpeg) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: no memory", name);
        return NULL;
    }
    jpeg->info.err = jpeg_std_error(&jpeg->errors);
    jpeg->info.client_data = jpeg;
    jpeg->errors.error_exit = leave;
    jpeg->errors.emit_message = on_warning;
    jpeg->errors.output_message = print_nothing;
    jpeg->progress.progress_monitor = count_scans;
    bool ok = read_jpeg(jpeg, name, bytes, size, err);
    uint8_t *pixels = jpeg->pixels;
    *width = jpeg->info.output_width;
    *height = jpeg->info.output_height;
    jpeg_destroy_decompress(&jpeg->info);
    free(jpeg);
    if (ok) return pixels;
    free(pixels);
    return NULL;
}

uint8_t *image_decode(const char *name, const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height,
                      struct glint_error *err) {
    static const uint8_t png[4] = {0x89, 'P', 'N', 'G'}, jpeg[3] = {0xff, 0xd8, 0xff};
    if (size >= sizeof png && !memcmp(bytes, png, sizeof png)) return decode_png(name, bytes, size, width, height, err);
    if (size >= sizeof jpeg && !memcmp(bytes, jpeg, sizeof jpeg))
        return decode_jpeg(name, bytes, size, width, height, err);
    glint_fail(err, GLINT_ERROR_FORMAT, "%s: neither a PNG nor a JPEG image", name);
    return NULL;
}
