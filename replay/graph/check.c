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

static void expect(bool holds, const struct glint_pass *pass, const char *what, const char *name, const char *expected,
                   struct faults *faults) {
    if (!holds)
        faults_add(faults, GLINT_ERROR_USAGE, "%s/%s: %s %s: expected %s", pass->slot, pass->variant, what, name,
                   expected);
}

static bool is_switch(const struct glint_pass *pass, const char *parameter) {
    const struct glint_row *row = glint_pass_row(pass, GLINT_ROW_SPEC, parameter);
    return row && row->type == GLINT_VALUE_BOOL;
}

/* Rows that refer to another row of the same pass. `own`: the row with which the pass writes the image, or NULL. */
static void check_row(const struct glint_pass *pass, const struct glint_row *row, const struct glint_row *own,
                      bool after_dispatch, struct faults *faults) {
    const struct glint_row *captured = row->kind == GLINT_ROW_ALIAS ? capture_row(row->name) : NULL;
    const bool reads = glint_pass_row(pass, GLINT_ROW_READ, row->name),
               spec = glint_pass_row(pass, GLINT_ROW_SPEC, row->name);
    if ((glint_row_is_output(row) || row->optional) && size_is_buffer(row->size))
        expect(row->fallback == UINT32_MAX && row->format == GLINT_FORMAT_R32UI, pass, "list", row->name,
               "R32UI and a fallback value of 0xFFFFFFFF", faults);
    if (glint_row_is_output(row) && !pass->host) graph_check_kind(pass, row, row, faults);
    if (row->kind == GLINT_ROW_DISPATCH_LIST)
        expect(after_dispatch, pass, "DISPATCH_LIST", row->name, "a DISPATCH before it", faults);
    else if (row->kind == GLINT_ROW_BYPASS)
        expect(own && reads, pass, "BYPASS", row->image, "an image that the pass writes and one that it reads", faults);
    else if (row->kind == GLINT_ROW_ALIAS)
        expect(own && captured && own->format == captured->format && own->size == captured->size, pass, "ALIAS",
               row->image, "an image that the pass writes and one of the capture with the same format and size",
               faults);
    else if (row->kind == GLINT_ROW_CALLED_BY) {
        const struct glint_row *read = glint_pass_row(pass, GLINT_ROW_READ, row->image);
        expect(read && read->optional, pass, "CALLED_BY", row->image, "an optional image that the pass reads", faults);
    } else if (row->kind == GLINT_ROW_IN_PLACE_OF) {
        const struct glint_row *read = glint_pass_row(pass, GLINT_ROW_READ, row->image);
        expect(read && read->optional && is_switch(pass, row->assigned) && is_switch(pass, row->source), pass,
               "IN_PLACE_OF", row->image,
               "an optional image that the pass reads, and two of its parameters that are true or false", faults);
    } else if (row->kind == GLINT_ROW_READ_OWN) {
        expect(own, pass, "READ_OWN", row->image, "an image that the pass writes", faults);
        if (own) graph_check_kind(pass, row, own, faults);
    } else if (row->kind == GLINT_ROW_WRITE_LEVELS) {
        expect(own && size_has_levels(own->size) && !strcmp(own->glsl, row->glsl), pass, "WRITE_LEVELS", row->image,
               "an image with levels that the pass writes, and its kind", faults);
    } else if (row->kind == GLINT_ROW_ACCUMULATE)
        expect(own && glint_size_is_picture(own->size) && !glint_format_is_uint(own->format) &&
                   glint_pass_row(pass, GLINT_ROW_PER_RAY, NULL),
               pass, "ACCUMULATE", row->name, "a float image of the picture that the pass writes, and PER_RAY", faults);
    else if (row->kind == GLINT_ROW_TRACER)
        expect(own && own->kind == GLINT_ROW_DIAGNOSTIC && own->format == GLINT_FORMAT_R8UI, pass, "TRACER", row->image,
               "a diagnostic image of the pass in R8UI", faults);
    else if (row->kind == GLINT_ROW_WITHOUT)
        expect(reads && capture_row(row->name), pass, "WITHOUT", row->name,
               "an image of the capture that the pass reads", faults);
    else if (row->kind == GLINT_ROW_ASSUMED)
        expect(spec || glint_pass_row(pass, GLINT_ROW_PUSH, row->name), pass, "ASSUMED", row->name,
               "a numeric parameter of the pass", faults);
    else if (row->kind == GLINT_ROW_DISPATCH_LEVELS) {
        if (row->assigned)
            expect(glint_pass_row(pass, GLINT_ROW_SPEC, row->assigned), pass, "DISPATCH_LEVELS_BY", row->assigned,
                   "a numeric parameter of the pass", faults);
        expect(own && size_has_levels(own->size), pass, "DISPATCH_LEVELS", row->name,
               "an image with levels that the pass writes", faults);
        if (row->chain)
            expect(after_dispatch && glint_pass_row(pass, GLINT_ROW_WRITE_LEVELS, row->name), pass, "DISPATCH_CHAIN",
                   row->name, "a DISPATCH before it and a row WRITE_LEVELS of the image", faults);
    }
}

/* A slot whose pass does not read what another pass leaves to it. */
static void check_reader(const struct graph *graph, const struct glint_pass *pass, const struct glint_row *row,
                         struct faults *faults) {
    const struct glint_pass *found = NULL;
    char readers[200] = "";
    size_t count, length = 0;
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < graph->pass_count; i++)
        if (!strcmp(graph->passes[i].pass->slot, row->image)) found = graph->passes[i].pass;
    if (found && glint_pass_row(found, GLINT_ROW_READ, row->name)) return;
    for (size_t i = 0; i < count && length < sizeof readers; i++)
        if (!strcmp(all[i].slot, row->image) && glint_pass_row(&all[i], GLINT_ROW_READ, row->name))
            length +=
                (size_t)snprintf(readers + length, sizeof readers - length, "%s%s", length ? ", " : "", all[i].variant);
    faults_add(faults, GLINT_ERROR_USAGE, "%s/%s makes %s, which slot %s has to read (variants: %s), but it %s%s; %s",
               pass->slot, pass->variant, row->name, row->image, readers, found ? "holds " : "is empty",
               found ? found->variant : "", row->help);
}

static void check_rows(const struct glint_pass *pass, struct faults *faults) {
    bool after_dispatch = false; /* the last row of these kinds was a DISPATCH */
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        check_row(pass, row, glint_pass_output(pass, row_image(row)), after_dispatch, faults);
        if (row_is_dispatch(row)) after_dispatch = row->kind == GLINT_ROW_DISPATCH;
    }
}

void graph_check(const struct graph *graph, struct faults *faults) {
    for (size_t i = 0; i < graph->pass_count; i++) {
        const struct glint_pass *pass = graph->passes[i].pass;
        size_t images = 0;
        check_rows(pass, faults);
        for (size_t r = 0; r < pass->row_count; r++) {
            images += row_is_image(&pass->rows[r]);
            if (pass->rows[r].kind == GLINT_ROW_NEEDS_READER) check_reader(graph, pass, &pass->rows[r], faults);
        }
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
            if (capture_row(image) && !glint_pass_row(pass, GLINT_ROW_ALIAS, image))
                faults_add(faults, GLINT_ERROR_USAGE, "image %s has two producers: %s/%s and the capture", image,
                           pass->slot, pass->variant);
            for (size_t j = i + 1; j < graph->pass_count; j++)
                if (glint_pass_output(graph->passes[j].pass, image))
                    faults_add(faults, GLINT_ERROR_USAGE, "image %s has two producers: %s/%s and %s/%s", image,
                               pass->slot, pass->variant, graph->passes[j].pass->slot, graph->passes[j].pass->variant);
        }
    }
}
