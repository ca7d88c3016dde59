/* What the camera's rays hit: stippled meshes, as an engine marks them in its G-buffer, and surfaces that bend. */
#include "extra.h"

#include <stdlib.h>

#include "caustics.h"
#include "dump_part.h"
#include "froxels.h"

struct extra_work {
    const struct world *world;
    const struct view *view;
    float *values;
};

static void mask_row(void *user, uint32_t y) {
    const struct extra_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const struct hit hit = primary_hit(work->world, work->view, x, y);
        work->values[(size_t)y * work->view->width + x] = hit.t < INFINITY && hit.mesh->flags & MESH_STIPPLED;
    }
}

/* The mean of what the normals at the ends of the triangle's edges differ by along the edge, over its length, as a baked one: of a sphere, 1 / radius. */
static float curvature_of(const struct hit *hit) {
    const struct mesh *mesh = hit->mesh;
    const uint32_t *corners = mesh->triangles + 3 * (size_t)hit->triangle;
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        const uint32_t a = corners[i], b = corners[(i + 1) % 3];
        const vec3 along_edge = sub(mesh->positions[b], mesh->positions[a]),
                   turned = sub(mesh->normals[b], mesh->normals[a]);
        const float square = dot(along_edge, along_edge);
        if (square > 0) sum += dot(turned, along_edge) / square / 3;
    }
    return fabsf(sum);
}

static void curvature_row(void *user, uint32_t y) {
    const struct extra_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const struct hit hit = primary_hit(work->world, work->view, x, y);
        work->values[(size_t)y * work->view->width + x] = hit.t < INFINITY ? curvature_of(&hit) : 0;
    }
}

/* One channel of the picture's size. */
static bool write_channel(const struct dump *dump, const struct world *world, const char *part_name, const char *name,
                          struct storage storage, void (*row)(void *user, uint32_t y), struct job *job,
                          struct glint_error *err) {
    float *values = calloc((size_t)dump->view->width * dump->view->height, sizeof *values);
    struct extra_work work = {world, dump->view, values};
    struct dump_part part;
    bool ok = values || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for part %s", part_name);
    ok = ok &&
         parallel_for(job, "rendering what the engine has beside the picture", 0, dump->view->height, row, &work, err);
    if (ok) {
        dump_begin(&part, dump, part_name, dump->view->width, dump->view->height);
        dump_channel(&part, name, storage, values, sizeof *values);
        ok = dump_end(&part, dump, err);
    }
    free(values);
    return ok;
}

bool extra_write(const struct dump *dump, const struct world *world, const struct glint_sample_options *options,
                 struct job *job, struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8"};
    const uint32_t also = options->also;
    return (!(also & GLINT_ALSO_STIPPLE) || write_channel(dump, world, "stipple", "drawn", byte, mask_row, job, err)) &&
           (!(also & GLINT_ALSO_CURVATURE) ||
            write_channel(dump, world, "curvature", "curvature", dump_half, curvature_row, job, err)) &&
           (!(also & GLINT_ALSO_FROXELS) || froxels_write(dump, world, job, err)) &&
           (!(also & GLINT_ALSO_CAUSTICS) || caustics_write(dump, world, job, err));
}
