/* Pictures as PNG files through libpng. */
#include "view/png_file.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "progress.h"

/* libpng reports errors by longjmp; nothing that is set after setjmp is read after it. */
static bool encode(FILE *file, const struct picture *picture, const char *path, struct glint_error *err) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return glint_fail(err, GLINT_ERROR_IO, "%s: cannot write the PNG", path);
    }
    png_init_io(png, file);
    png_set_compression_level(png, 4); /* half the time of 6, a few per cent larger */
    png_set_IHDR(png, info, picture->width, picture->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (uint32_t y = 0; y < picture->height; y++) png_write_row(png, picture->rgba + (size_t)y * picture->width * 4);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

bool png_file_write(const char *path, const struct picture *picture, struct glint_error *err) {
    if (!strcmp(path, "-")) return encode(stdout, picture, "stdout", err);
    char *temporary = NULL;
    if (asprintf(&temporary, "%s.tmp-%ld", path, (long)getpid()) < 0)
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    FILE *file = fopen(temporary, "wb");
    bool ok =
        file ? encode(file, picture, path, err) : glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (file && fclose(file) != 0 && ok) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (ok && progress_interrupted()) ok = glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
    if (ok && rename(temporary, path) != 0) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (!ok && file) unlink(temporary);
    free(temporary);
    return ok;
}
