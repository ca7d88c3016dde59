/* Encodes pictures in pages as data URIs: PNG if the size allows it, else JPEG. */
#include <stdio.h> /* jpeglib.h needs FILE */

#include <jpeglib.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "draw/page/base64.h"
#include "draw/page/page.h"
#include "io/memory.h"

struct bytes {
    unsigned char *data; /* malloc'd */
    unsigned long size;
};

static bool encode_png(const struct picture *p, struct bytes *out) {
    png_image image = {.version = PNG_IMAGE_VERSION, .width = p->width, .height = p->height, .format = PNG_FORMAT_RGBA};
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    *out = (struct bytes){malloc(size), 0};
    if (!out->data) return false;
    if (!png_image_write_to_memory(&image, out->data, &size, 0, p->rgba, 0, NULL)) {
        memory_note(); /* there is room for any picture: only memory of libpng's own can lack */
        return false;
    }
    out->size = size;
    return true;
}

struct jpeg {
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr errors;
    jmp_buf back;
};

_Noreturn static void leave(j_common_ptr info) {
    struct jpeg *jpeg = info->client_data;
    longjmp(jpeg->back, 1);
}

/* No chroma subsampling, which would blur the edges of false colours. */
static bool encode_jpeg(const struct picture *p, int quality, struct bytes *out) {
    struct jpeg jpeg = {0};
    *out = (struct bytes){NULL, 0};
    jpeg.info.err = jpeg_std_error(&jpeg.errors);
    jpeg.errors.error_exit = leave;
    jpeg.info.client_data = &jpeg;
    if (setjmp(jpeg.back)) {
        jpeg_destroy_compress(&jpeg.info);
        return false;
    }
    jpeg_create_compress(&jpeg.info);
    jpeg_mem_dest(&jpeg.info, &out->data, &out->size);
    jpeg.info.image_width = p->width;
    jpeg.info.image_height = p->height;
    jpeg.info.input_components = 4;
    jpeg.info.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&jpeg.info);
    jpeg_set_quality(&jpeg.info, quality, TRUE);
    jpeg.info.comp_info[0].h_samp_factor = jpeg.info.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg.info, TRUE);
    while (jpeg.info.next_scanline < p->height) {
        JSAMPROW row = p->rgba + (size_t)jpeg.info.next_scanline * p->width * 4;
        jpeg_write_scanlines(&jpeg.info, &row, 1);
    }
    jpeg_finish_compress(&jpeg.info);
    jpeg_destroy_compress(&jpeg.info);
    return true;
}

static json_t *data_uri(const char *type, const struct bytes *bytes) {
    char before[32];
    snprintf(before, sizeof before, "data:image/%s;base64,", type);
    return base64_json(before, bytes->data, bytes->size);
}

/* Lowers the quality, then halves the size, until the result fits. Very small pictures are accepted as they are. */
static bool encode_small(const struct picture *picture, size_t bytes, struct bytes *out, struct glint_error *err) {
    enum { SMALLEST_PX = 64, FINE = 90, COARSE = 75 };
    struct picture small = {0};
    bool ok = picture_init(&small, picture->width, picture->height, COLOR_BACKGROUND, err);
    if (ok) picture_paste(&small, picture, 0, 0);
    ok = ok && encode_jpeg(&small, FINE, out);
    while (ok && out->size > bytes) {
        free(out->data);
        ok = encode_jpeg(&small, COARSE, out);
        if (!ok || out->size <= bytes || small.width < SMALLEST_PX || small.height < SMALLEST_PX) break;
        free(out->data);
        out->data = NULL;
        ok = picture_shrink(&small, 2, true, err) && encode_jpeg(&small, FINE, out);
    }
    picture_finish(&small);
    return ok;
}

static json_t *picture_json(const struct picture *picture, struct bytes png, size_t bytes, struct glint_error *err) {
    struct bytes jpeg = {0};
    json_t *json = NULL;
    if (png.data && png.size <= bytes) json = data_uri("png", &png);
    else if (encode_small(picture, bytes, &jpeg, err)) json = data_uri("jpeg", &jpeg);
    free(jpeg.data);
    if (!json && !(err && err->code)) glint_fail(err, GLINT_ERROR_MEMORY, "cannot encode a picture");
    return json;
}

json_t *page_picture(const struct picture *picture, size_t bytes, struct glint_error *err) {
    struct bytes png = {0};
    if (!encode_png(picture, &png)) png.size = SIZE_MAX;
    json_t *json = picture_json(picture, png, bytes, err);
    free(png.data);
    return json;
}

json_t *page_picture_file(const char *name, uint8_t *file, size_t size, size_t bytes, struct glint_error *err) {
    static const uint8_t signature[] = {0x89, 'P', 'N', 'G'};
    struct picture picture = {0};
    picture.rgba = image_decode(name, file, size, &picture.width, &picture.height, err);
    bool png = picture.rgba && size > sizeof signature && !memcmp(file, signature, sizeof signature);
    json_t *json = picture.rgba ? picture_json(&picture, (struct bytes){png ? file : NULL, size}, bytes, err) : NULL;
    picture_finish(&picture);
    return json;
}
