/* Finds declarations that contradict themselves or one another. */
#include "graph.h"

#include <stdio.h>
#include <string.h>

void graph_check_kind(const struct glint_pass *pass, const struct glint_row *binding, const struct glint_row *image,
                      struct faults *faults) {
    const bool array = size_is_array(image->size), cube = size_is_cube(image->size), layered = array || cube,
               is_uint = glint_format_is_uint(image->format);
    const char *kind = binding->glsl, *is = NULL;
    if (size_is_buffer(image->size)) {
        if (strcmp(kind, glint_row_is_output(binding) ? "uimageBuffer" : "utextureBuffer") != 0)
            is = glint_row_is_output(binding) ? "a list, to be written as uimageBuffer"
                                              : "a list, to be read as utextureBuffer";
    } else if (strstr(kind, "Buffer")) is = "not a list";
    else if ((kind[0] == 'u') != is_uint) is = is_uint ? "a uint image" : "a float image";
    else if (glint_row_is_output(binding) && strcmp(kind + (kind[0] == 'u'), layered ? "image2DArray" : "image2D") != 0)
        is = layered ? "cube maps, to be written as image2DArray" : "a plain image, to be written as image2D";
    else if (row_is_sampled(binding) && (strstr(kind, "Cube") || strstr(kind, "Array") ? !layered : layered))
        is = array ? "an array of cube maps" : cube ? "a cube map" : "a plain image";
    else if (strstr(kind, "Cube") && !cube) is = "an array of plain images";
    if (is)
        faults_add(faults, GLINT_ERROR_USAGE, "%s/%s %s %s as %s, but it is %s", pass->slot, pass->variant,
                   glint_row_is_output(binding) ? "writes" : "reads", row_image(binding), kind, is);
}

/* Rows that refer to another row of the same pass. */
static void check_rows(const struct glint_pass *pass, struct faults *faults) {
    const struct glint_row *dispatch = NULL; /* the last one */
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r], *own = glint_pass_output(pass, row_image(row));
        if ((glint_row_is_output(row) || row->optional) && size_is_buffer(row->size) &&
            (row->fallback != UINT32_MAX || row->format != GLINT_FORMAT_R32UI))
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s: list %s: expected R32UI and a fallback value of 0xFFFFFFFF",
                       pass->slot, pass->variant, row->name);
        if (row->kind == GLINT_ROW_DISPATCH_LIST && glint_pass_row(pass, GLINT_ROW_WORKGROUP, NULL))
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s: list %s: expected workgroups of 8 x 8", pass->slot,
                       pass->variant, row->name);
        if (row->kind == GLINT_ROW_DISPATCH_LIST && (!glint_pass_row(pass, GLINT_ROW_READ, row->name) || !dispatch))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: DISPATCH_LIST %s: expected an image that the pass reads, and a DISPATCH before it",
                       pass->slot, pass->variant, row->name);
        if (row->kind == GLINT_ROW_DISPATCH || row->kind == GLINT_ROW_DISPATCH_LEVELS)
            dispatch = row->kind == GLINT_ROW_DISPATCH ? row : NULL;
        if (glint_row_is_output(row) && !pass->host) graph_check_kind(pass, row, row, faults);
        if (row->kind == GLINT_ROW_BYPASS && (!own || !glint_pass_row(pass, GLINT_ROW_READ, row->name)))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: BYPASS %s: expected an image that the pass writes and one that it reads", pass->slot,
                       pass->variant, row->image);
        const struct glint_row *captured = row->kind == GLINT_ROW_ALIAS ? capture_row(row->name) : NULL;
        if (row->kind == GLINT_ROW_ALIAS &&
            (!own || !captured || own->format != captured->format || own->size != captured->size))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: ALIAS %s: expected an image that the pass writes and one of the capture with the same "
                       "format and size",
                       pass->slot, pass->variant, row->image);
        if (row->kind == GLINT_ROW_READ_OWN && !own)
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s: READ_OWN %s: expected an image that the pass writes",
                       pass->slot, pass->variant, row->image);
        else if (row->kind == GLINT_ROW_READ_OWN) graph_check_kind(pass, row, own, faults);
        const bool sums =
            own && (own->size == GLINT_SIZE_FULL || own->size == GLINT_SIZE_HALF) && !glint_format_is_uint(own->format);
        if (row->kind == GLINT_ROW_ACCUMULATE && (!sums || !glint_pass_row(pass, GLINT_ROW_PER_RAY, NULL)))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: ACCUMULATE %s: expected a plain float image that the pass writes, and PER_RAY",
                       pass->slot, pass->variant, row->name);
        if (row->kind == GLINT_ROW_ASSUMED && !glint_pass_row(pass, GLINT_ROW_SPEC, row->name) &&
            !glint_pass_row(pass, GLINT_ROW_PUSH, row->name))
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s: ASSUMED %s: expected a numeric parameter of the pass",
                       pass->slot, pass->variant, row->name);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && row->assigned &&
            !glint_pass_row(pass, GLINT_ROW_SPEC, row->assigned))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: DISPATCH_LEVELS_BY %s: expected a numeric parameter of the pass", pass->slot,
                       pass->variant, row->assigned);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && (!own || !size_has_levels(own->size)))
            faults_add(faults, GLINT_ERROR_USAGE,
                       "%s/%s: DISPATCH_LEVELS %s: expected an image with levels that the pass writes", pass->slot,
                       pass->variant, row->name);
    }
}

void graph_check(const struct graph *graph, struct faults *faults) {
    for (size_t i = 0; i < graph->pass_count; i++) {
        const struct glint_pass *pass = graph->passes[i].pass;
        size_t images = 0;
        check_rows(pass, faults);
        for (size_t r = 0; r < pass->row_count; r++) images += row_is_image(&pass->rows[r]);
        if (images > PASS_IMAGES_MAX)
            faults_add(faults, GLINT_ERROR_LIMIT, "%s/%s: %zu images, expected at most %d", pass->slot, pass->variant,
                       images, PASS_IMAGES_MAX);
        for (size_t r = 0; r < pass->row_count; r++) {
            if (!glint_row_is_output(&pass->rows[r])) {
                if (pass->rows[r].kind == GLINT_ROW_READ && pass->host)
                    faults_add(faults, GLINT_ERROR_USAGE,
                               "%s/%s runs on the host, before any image exists, but reads %s", pass->slot,
                               pass->variant, pass->rows[r].name);
                continue;
            }
            const char *image = pass->rows[r].name;
            if (capture_row(image))
                faults_add(faults, GLINT_ERROR_USAGE, "image %s has two producers: %s/%s and the capture", image,
                           pass->slot, pass->variant);
            for (size_t j = i + 1; j < graph->pass_count; j++)
                if (glint_pass_output(graph->passes[j].pass, image))
                    faults_add(faults, GLINT_ERROR_USAGE, "image %s has two producers: %s/%s and %s/%s", image,
                               pass->slot, pass->variant, graph->passes[j].pass->slot, graph->passes[j].pass->variant);
        }
    }
}
