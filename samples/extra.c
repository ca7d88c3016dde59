/* The mask of stippled pixels is where the camera's rays hit stippled meshes, as an engine's own mark in its G-buffer. */
#include "extra.h"

#include <stdlib.h>

#include "dump_part.h"
#include "froxels.h"

struct mask_work {
    const struct world *world;
    const struct view *view;
    float *drawn;
};

static void mask_row(void *user, uint32_t y) {
    const struct mask_work *work = user;
    for (uint32_t x = 0; x < work->view->width; x++) {
        const struct hit hit = primary_hit(work->world, work->view, x, y);
        work->drawn[(size_t)y * work->view->width + x] = hit.t < INFINITY && hit.mesh->flags & MESH_STIPPLED;
    }
}

static bool write_stipple(const struct dump *dump, const struct world *world, struct job *job,
                          struct glint_error *err) {
    static const struct storage byte = {GLINT_UNORM8, "R8"};
    float *drawn = calloc((size_t)dump->view->width * dump->view->height, sizeof *drawn);
    struct mask_work work = {world, dump->view, drawn};
    struct dump_part part;
    bool ok = drawn || glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the mask of stippled pixels");
    ok = ok && parallel_for(job, "rendering the mask of stippled pixels", 0, dump->view->height, mask_row, &work, err);
    if (ok) {
        dump_begin(&part, dump, "stipple", dump->view->width, dump->view->height);
        dump_channel(&part, "drawn", byte, drawn, sizeof *drawn);
        ok = dump_end(&part, dump, err);
    }
    free(drawn);
    return ok;
}

bool extra_write(const struct dump *dump, const struct world *world, const struct glint_sample_options *options,
                 struct job *job, struct glint_error *err) {
    return (!(options->also & GLINT_ALSO_STIPPLE) || write_stipple(dump, world, job, err)) &&
           (!(options->also & GLINT_ALSO_FROXELS) || froxels_write(dump, world, job, err));
}
