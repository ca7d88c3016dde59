/* A picture of 8-bit RGBA. */
#include "draw/view/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "capture/cube_face.h"

bool picture_init(struct picture *picture, uint32_t width, uint32_t height, struct rgb color, struct glint_error *err) {
    *picture = (struct picture){.width = width, .height = height};
    if (width == 0 || height == 0 || (uint64_t)width * height > UINT64_C(1) << 30)
        return glint_fail(err, GLINT_ERROR_LIMIT, "a picture of %u × %u pixels is too large", width, height);
    picture->rgba = malloc((size_t)width * height * 4);
    if (!picture->rgba) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory for %u × %u pixels", width, height);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const uint8_t pixel[4] = {color.r, color.g, color.b, 255};
        memcpy(picture->rgba + 4 * i, pixel, 4);
    }
    return true;
}

void picture_finish(struct picture *picture) {
    free(picture->rgba);
    *picture = (struct picture){0};
}

static uint8_t *pixel_at(const struct picture *picture, uint32_t x, uint32_t y) {
    return picture->rgba + 4 * ((size_t)y * picture->width + x);
}

void picture_set(struct picture *picture, uint32_t x, uint32_t y, struct rgb color) {
    uint8_t *p = pixel_at(picture, x, y);
    p[0] = color.r;
    p[1] = color.g;
    p[2] = color.b;
}

static uint8_t mix(uint8_t a, uint8_t b, uint8_t coverage) {
    return (uint8_t)((a * (255 - coverage) + b * coverage + 127) / 255);
}

void picture_blend(struct picture *picture, int x, int y, struct rgb color, uint8_t coverage) {
    if (x < 0 || y < 0 || (uint32_t)x >= picture->width || (uint32_t)y >= picture->height) return;
    uint8_t *p = pixel_at(picture, (uint32_t)x, (uint32_t)y);
    p[0] = mix(p[0], color.r, coverage);
    p[1] = mix(p[1], color.g, coverage);
    p[2] = mix(p[2], color.b, coverage);
}

void picture_fill(struct picture *picture, int x, int y, int width, int height, struct rgb color) {
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) picture_blend(picture, x + i, y + j, color, 255);
}

void picture_paste(struct picture *to, const struct picture *from, uint32_t x, uint32_t y) {
    for (uint32_t j = 0; j < from->height && y + j < to->height; j++) {
        uint32_t width = x + from->width <= to->width ? from->width : to->width - x;
        memcpy(pixel_at(to, x, y + j), pixel_at(from, 0, j), (size_t)width * 4);
    }
}

static void replace(struct picture *picture, struct picture *by) {
    picture_finish(picture);
    *picture = *by;
}

bool picture_holds(uint32_t width, uint32_t height, const uint32_t crop[4], struct glint_error *err) {
    return (crop[0] < width && crop[1] < height && crop[2] <= width - crop[0] && crop[3] <= height - crop[1]) ||
           glint_fail(err, GLINT_ERROR_USAGE, "--crop=%u,%u,%u,%u reaches outside the picture of %u × %u pixels",
                      crop[0], crop[1], crop[2], crop[3], width, height);
}

bool picture_crop(struct picture *picture, const uint32_t crop[4], struct glint_error *err) {
    const uint32_t x = crop[0], y = crop[1], width = crop[2], height = crop[3];
    struct picture cut;
    if (!picture_holds(picture->width, picture->height, crop, err)) return false;
    if (!picture_init(&cut, width, height, COLOR_BACKGROUND, err)) return false;
    for (uint32_t j = 0; j < height; j++) memcpy(pixel_at(&cut, 0, j), pixel_at(picture, x, y + j), (size_t)width * 4);
    replace(picture, &cut);
    return true;
}

bool picture_zoom(struct picture *picture, uint32_t factor, struct glint_error *err) {
    struct picture large;
    if (factor <= 1) return true;
    if (!picture_init(&large, picture->width * factor, picture->height * factor, COLOR_BACKGROUND, err)) return false;
    for (uint32_t y = 0; y < large.height; y++)
        for (uint32_t x = 0; x < large.width; x++)
            memcpy(pixel_at(&large, x, y), pixel_at(picture, x / factor, y / factor), 4);
    replace(picture, &large);
    return true;
}

bool picture_shrink(struct picture *picture, uint32_t factor, bool mean, struct glint_error *err) {
    struct picture small;
    if (factor <= 1) return true;
    uint32_t width = picture->width / factor, height = picture->height / factor, taps = mean ? factor : 1;
    if (!picture_init(&small, width ? width : 1, height ? height : 1, COLOR_BACKGROUND, err)) return false;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t sum[3] = {0};
            for (uint32_t j = 0; j < taps; j++)
                for (uint32_t i = 0; i < taps; i++)
                    for (int k = 0; k < 3; k++) sum[k] += pixel_at(picture, x * factor + i, y * factor + j)[k];
            for (int k = 0; k < 3; k++)
                pixel_at(&small, x, y)[k] = (uint8_t)((sum[k] + taps * taps / 2) / (taps * taps));
        }
    replace(picture, &small);
    return true;
}

bool picture_cross(struct picture *picture, struct glint_error *err) {
    static const uint32_t places[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
    uint32_t n = picture->width, cubes = picture->height / (6 * n);
    struct picture cross;
    if (!picture_init(&cross, 4 * n, 3 * n * cubes, COLOR_BACKGROUND, err)) return false;
    for (uint32_t face = 0; face < 6 * cubes; face++) {
        uint32_t x = places[face % 6][0] * n, y = (places[face % 6][1] + 3 * (face / 6)) * n;
        for (uint32_t j = 0; j < n; j++)
            memcpy(pixel_at(&cross, x, y + j), pixel_at(picture, 0, face * n + j), (size_t)n * 4);
    }
    replace(picture, &cross);
    return true;
}

/* The position of a direction in a column of six faces. */
static void face_position(const double d[3], uint32_t size, uint32_t *x, uint32_t *y) {
    double u, v;
    const int face = cube_face_of(d, &u, &v);
    u *= size, v *= size;
    *x = u < 0 ? 0 : u >= size ? size - 1 : (uint32_t)u;
    *y = (uint32_t)face * size + (v < 0 ? 0 : v >= size ? size - 1 : (uint32_t)v);
}

bool picture_latlong(struct picture *picture, struct glint_error *err) {
    const double pi = 3.14159265358979323846;
    const uint32_t n = picture->width, cubes = picture->height / (6 * n), width = 4 * n, height = 2 * n;
    struct picture map;
    if (!picture_init(&map, width, height * cubes, COLOR_BACKGROUND, err)) return false;
    for (uint32_t row = 0; row < height * cubes; row++)
        for (uint32_t column = 0; column < width; column++) {
            const double latitude = pi * (0.5 - (row % height + 0.5) / height),
                         longitude = 2 * pi * ((column + 0.5) / width - 0.5);
            const double d[3] = {cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude)};
            uint32_t x, y;
            face_position(d, n, &x, &y);
            memcpy(pixel_at(&map, column, row), pixel_at(picture, x, y + row / height * 6 * n), 4);
        }
    replace(picture, &map);
    return true;
}

bool picture_chain(struct picture *chain, const struct picture *pictures, size_t count, struct glint_error *err) {
    uint32_t side = 0, high = 0;
    for (size_t i = 1; i < count; i++) {
        side = pictures[i].width > side ? pictures[i].width : side;
        high += pictures[i].height;
    }
    if (!picture_init(chain, pictures[0].width + side, pictures[0].height > high ? pictures[0].height : high,
                      COLOR_BACKGROUND, err))
        return false;
    uint32_t y = 0;
    for (size_t i = 0; i < count; i++) {
        picture_paste(chain, &pictures[i], i ? pictures[0].width : 0, y);
        y += i ? pictures[i].height : 0;
    }
    return true;
}
