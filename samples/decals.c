/* A spot of oil or paint in each square of the ground, except on vehicles and plants, which the engine's stencil keeps free of decals. */
#include "decals.h"

#include <stdlib.h>

#include "dump_part.h"
#include "noise.h"

#define SQUARE 1.7f /* m */

void decals_mark(struct scene *scene) {
    if (scene->class_count < sizeof scene->classes / sizeof *scene->classes)
        scene->classes[scene->class_count++] = (struct glint_stencil_class){STENCIL_DECAL, STENCIL_DECAL, "decal"};
}

static struct decal spot(const struct pixel *pixel, vec3 at) {
    const int32_t i = (int32_t)floorf(at.x / SQUARE), k = (int32_t)floorf(at.z / SQUARE);
    const float own = cell_random(i, k, 71), radius = 0.25f + 0.45f * cell_random(i, k, 72);
    const float x = at.x - SQUARE * ((float)i + 0.3f + 0.4f * cell_random(i, k, 73)),
                z = at.z - SQUARE * ((float)k + 0.3f + 0.4f * cell_random(i, k, 74)),
                far = sqrtf(x * x + z * z) / radius;
    const float rim = far + 0.35f * (fractal2(6 * at.x, 6 * at.z, 3, 75) - 0.5f);
    const vec3 tilt = far > 0 ? scale(v3(x, 0, z), 0.25f * sinf(PI_F * fminf(far, 1)) / (far * radius)) : v3(0, 0, 0);
    return (struct decal){.albedo = own < 0.5f ? v3(0.03f, 0.028f, 0.025f) : v3(0.45f, 0.08f, 0.05f),
                          .normal = unit(add(pixel->vertex_normal, tilt)),
                          .roughness = own < 0.5f ? 0.12f : 0.4f,
                          .specular = 0.6f,
                          .alpha = 0.9f * (1 - smooth(0.75f, 1, rim))};
}

struct decal *decals_draw(const struct view *view, struct pixel *pixels, struct glint_error *err) {
    const size_t count = (size_t)view->width * view->height;
    struct decal *decals = calloc(count, sizeof *decals);
    if (!decals) glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the decals");
    for (size_t i = 0; decals && i < count; i++) {
        struct pixel *pixel = &pixels[i];
        const uint32_t free_of = STENCIL_VEHICLE | STENCIL_VEGETATION | STENCIL_FOREGROUND;
        decals[i].normal = v3(0, 1, 0);
        if (!(pixel->depth < INFINITY) || pixel->vertex_normal.y < 0.9f || pixel->stencil & free_of) continue;
        const vec3 ray = view_ray(view, (uint32_t)(i % view->width), (uint32_t)(i / view->width));
        const struct decal decal = spot(pixel, along(view_eye(view), ray, pixel->depth));
        if (!(decal.alpha > 0)) continue;
        decals[i] = decal;
        pixel->stencil |= STENCIL_DECAL;
    }
    return decals;
}

static vec3 relit(vec3 light, vec3 before, vec3 now) {
    const float b[3] = {before.x, before.y, before.z};
    return v3(b[0] > 0 ? light.x * now.x / b[0] : 0, b[1] > 0 ? light.y * now.y / b[1] : 0,
              b[2] > 0 ? light.z * now.z / b[2] : 0);
}

void decals_light(const struct decal *decals, const struct view *view, struct pixel *pixels) {
    for (size_t i = 0; i < (size_t)view->width * view->height; i++) {
        struct pixel *pixel = &pixels[i];
        if (!(decals[i].alpha > 0)) continue;
        const vec3 now = mix(pixel->albedo, decals[i].albedo, decals[i].alpha);
        pixel->lit = add(pixel->emission, relit(sub(pixel->lit, pixel->emission), pixel->albedo, now));
        pixel->indirect = relit(pixel->indirect, pixel->albedo, now);
        pixel->lamps = relit(pixel->lamps, pixel->albedo, now);
    }
}

bool decals_write(const struct dump *dump, const struct decal *decals, struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8G8B8A8"};
    static const char *const rgb[] = {"R", "G", "B"}, *const xyz[] = {"normal.X", "normal.Y", "normal.Z"};
    const uint32_t width = dump->view->width, height = dump->view->height;
    struct dump_part part;
    dump_begin(&part, dump, "decal.albedo", width, height);
    dump_channels3(&part, rgb, byte, &decals->albedo, sizeof *decals);
    dump_channel(&part, "A", byte, &decals->alpha, sizeof *decals);
    if (!dump_end(&part, dump, err)) return false;
    dump_begin(&part, dump, "decal.normal", width, height);
    part.part.encodings = (struct glint_encodings){0};
    dump_channels3(&part, xyz, dump_half, &decals->normal, sizeof *decals);
    dump_channel(&part, "A", byte, &decals->alpha, sizeof *decals);
    if (!dump_end(&part, dump, err)) return false;
    dump_begin(&part, dump, "decal.material", width, height);
    part.part.encodings = (struct glint_encodings){0};
    dump_channel(&part, "material.roughness", byte, &decals->roughness, sizeof *decals);
    dump_channel(&part, "material.specular", byte, &decals->specular, sizeof *decals);
    dump_channel(&part, "A", byte, &decals->alpha, sizeof *decals);
    return dump_end(&part, dump, err);
}
