/* Gathers light over the hemisphere of each vertex, bounce by bounce. */
#include "bake.h"

#include <stdlib.h>
#include <string.h>

#include "noise.h"

struct bake {
    struct scene *scene;
    const struct world *world;
    uint32_t samples, vertex_count;
    uint32_t *first;         /* index of each mesh's first vertex */
    vec3 *direct, *gathered; /* irradiance by vertex index */
    vec3 *next;
};

enum { PIECE = 64 };

static const struct mesh *mesh_of(const struct bake *bake, uint32_t vertex, uint32_t *within) {
    uint32_t low = 0, high = bake->scene->mesh_count;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (bake->first[middle] <= vertex) low = middle;
        else high = middle;
    }
    *within = vertex - bake->first[low];
    return &bake->scene->meshes[low];
}

/* The radiance along a gathering ray: emission, and the light that is known at the triangle's vertices. */
static vec3 incoming(const struct bake *bake, vec3 origin, vec3 direction) {
    struct hit hit = world_trace(bake->world, origin, direction, 0);
    if (!(hit.t < INFINITY)) return world_sky(bake->world, direction);
    const struct material *material = &hit.mesh->material;
    uint32_t first = bake->first[hit.mesh - bake->scene->meshes];
    const uint32_t *index = hit.mesh->triangles + 3 * (size_t)hit.triangle;
    vec3 irradiance = gray(0);
    for (int i = 0; i < 3; i++) {
        uint32_t v = first + index[i];
        irradiance = add(irradiance, scale(add(bake->direct[v], bake->gathered[v]), 1 / 3.0f));
    }
    /* Metals are treated as diffuse here; otherwise a metal wall would absorb the room's light. */
    return add(scale(material->emission, bake->scene->gain), times(material->albedo, scale(irradiance, 1 / PI_F)));
}

static void gather_piece(void *user, uint32_t piece) {
    struct bake *bake = user;
    uint32_t end = (piece + 1) * PIECE < bake->vertex_count ? (piece + 1) * PIECE : bake->vertex_count;
    for (uint32_t v = piece * PIECE; v < end; v++) {
        uint32_t within;
        const struct mesh *mesh = mesh_of(bake, v, &within);
        vec3 normal = mesh->normals[within], t, b, sum = gray(0);
        frame_of(normal, &t, &b);
        vec3 origin = along(mesh->positions[within], normal, 2e-3f);
        for (uint32_t i = 0; i < bake->samples; i++) {
            float u1, u2;
            r2_point(i, v, &u1, &u2);
            float r = sqrtf(u1), phi = 2 * PI_F * u2;
            vec3 d = along(along(scale(normal, sqrtf(1 - u1)), t, r * cosf(phi)), b, r * sinf(phi));
            sum = add(sum, incoming(bake, origin, d));
        }
        bake->next[v] = scale(sum, PI_F / (float)bake->samples);
    }
}

/* Neighbouring vertices share a face, so averaging with them removes the noise of gathering without leaking light around corners. */
static void smooth_mesh(const struct mesh *mesh, vec3 *light, vec3 *sums, uint32_t *counts) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        sums[v] = gray(0);
        counts[v] = 0;
    }
    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1, from = mesh->triangles[i], to = mesh->triangles[next];
        sums[from] = add(sums[from], light[to]);
        sums[to] = add(sums[to], light[from]);
        counts[from]++;
        counts[to]++;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (counts[v]) light[v] = mix(light[v], scale(sums[v], 1 / (float)counts[v]), 0.6f);
}

static void direct_piece(void *user, uint32_t piece) {
    struct bake *bake = user;
    uint32_t end = (piece + 1) * PIECE < bake->vertex_count ? (piece + 1) * PIECE : bake->vertex_count;
    for (uint32_t v = piece * PIECE; v < end; v++) {
        uint32_t within;
        const struct mesh *mesh = mesh_of(bake, v, &within);
        bake->direct[v] = world_direct(bake->world, mesh->positions[within], mesh->normals[within]);
    }
}

static bool hand_over(struct bake *bake, struct glint_error *err) {
    for (uint32_t m = 0; m < bake->scene->mesh_count; m++) {
        struct mesh *mesh = &bake->scene->meshes[m];
        size_t bytes = mesh->vertex_count * sizeof(vec3);
        mesh->light = malloc(bytes ? bytes : 1);
        if (!mesh->light) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for baked light");
        memcpy(mesh->light, bake->gathered + bake->first[m], bytes);
    }
    return true;
}

bool bake_light(struct scene *scene, uint32_t samples, struct job *job, double weight, struct glint_error *err) {
    bool ok = false;
    struct bake bake = {.scene = scene};
    struct world *world = NULL;
    vec3 *sums = NULL;
    uint32_t *counts = NULL;
    bake.first = calloc(scene->mesh_count + 1, sizeof *bake.first);
    if (!bake.first) goto no_memory;
    for (uint32_t m = 0; m < scene->mesh_count; m++) {
        bake.first[m] = bake.vertex_count;
        bake.vertex_count += scene->meshes[m].vertex_count;
    }
    bake.direct = calloc(bake.vertex_count + 1, sizeof(vec3));
    bake.gathered = calloc(bake.vertex_count + 1, sizeof(vec3));
    bake.next = calloc(bake.vertex_count + 1, sizeof(vec3));
    sums = calloc(bake.vertex_count + 1, sizeof *sums);
    counts = calloc(bake.vertex_count + 1, sizeof *counts);
    if (!bake.direct || !bake.gathered || !bake.next || !sums || !counts) goto no_memory;
    world = world_create(scene, WORLD_STATIC, 0, err);
    if (!world) goto done;
    bake.world = world;
    uint32_t pieces = (bake.vertex_count + PIECE - 1) / PIECE, passes = scene->bounces + 1;
    if (!parallel_for(job, "lighting", 0, pieces, direct_piece, &bake, err)) goto done;
    for (uint32_t i = 0; i < passes; i++) {
        bool last = i + 1 == passes; /* earlier results are averaged once more, so they may be noisy */
        bake.samples = last ? samples : (samples + 3) / 4;
        double share = (double)bake.samples / (samples + (passes - 1.0) * ((samples + 3) / 4));
        if (!parallel_for(job, "lighting", weight * share, pieces, gather_piece, &bake, err)) goto done;
        for (uint32_t k = 0; k < 2 * scene->mesh_count; k++) /* two iterations */
            smooth_mesh(&scene->meshes[k / 2], bake.next + bake.first[k / 2], sums, counts);
        vec3 *swapped = bake.gathered;
        bake.gathered = bake.next;
        bake.next = swapped;
    }
    ok = hand_over(&bake, err);
    goto done;
no_memory:
    glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the light of %u vertices", bake.vertex_count);
done:
    world_destroy(&world);
    free(bake.first);
    free(bake.direct);
    free(bake.gathered);
    free(bake.next);
    free(sums);
    free(counts);
    return ok;
}
