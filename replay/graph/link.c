/* Builds a graph: links passes by image name, and finds each image's source. */
#include "graph.h"

#include <stdio.h>
#include <string.h>

#include "faults.h"

/* Whether the part has any of the channels of an image. */
static bool part_has(const struct glint_part_info *part, const struct glint_row *row) {
    char channel[64];
    for (const char *at = row->source; part && *at;) {
        const size_t length = strcspn(at, " ");
        snprintf(channel, sizeof channel, "%.*s", (int)length, at);
        if (glint_part_can_read(part, channel)) return true;
        at += length + (at[length] == ' ');
    }
    return false;
}

bool graph_capture_has(const struct glint_capture *capture, const struct glint_row *row) {
    size_t found = 0;
    char part[64];
    if (!capture) return false;
    if (!size_is_array(row->size) && row->size != GLINT_SIZE_SHADOW)
        return part_has(glint_capture_find(capture, row->role), row);
    snprintf(part, sizeof part, "%s.", row->role);
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *info = glint_capture_part(capture, i);
        if (strncmp(info->name, part, strlen(part)) != 0) continue;
        found += part_has(info, row);
    }
    return found > 0;
}

/* "a, b": the variants of a slot that write an image. */
static void name_makers(const char *slot, const char *image, char *text, size_t size) {
    size_t count, length = 0;
    const struct glint_pass *all = glint_passes(&count);
    text[0] = 0;
    for (size_t i = 0; i < count && length < size; i++)
        if (!strcmp(all[i].slot, slot) && glint_pass_output(&all[i], image))
            length += (size_t)snprintf(text + length, size - length, "%s%s", length ? ", " : "", all[i].variant);
}

/* `left_out`: the pipeline does not have the slot; otherwise it was not requested. */
static void complain_missing(const struct graph_pass *reader, const char *image, const struct glint_pass *maker,
                             bool left_out, const struct glint_replay_options *options, struct faults *faults) {
    const char *inputs = options->inputs ? options->inputs : "no run was given for its inputs";
    char makers[200], without[280] = "it does not run";
    if (maker && left_out) {
        name_makers(maker->slot, image, makers, sizeof makers);
        snprintf(without, sizeof without, "that slot is empty in the pipeline (variants: %s)", makers);
    }
    if (maker)
        faults_add(faults, GLINT_ERROR_USAGE, "%s/%s reads %s, which %s makes; %s, and %s%s", reader->pass->slot,
                   reader->pass->variant, image, maker->slot, without, inputs,
                   options->inputs ? " does not hold it" : "");
    else
        faults_add(faults, GLINT_ERROR_USAGE, "%s/%s reads %s, which no known pass writes", reader->pass->slot,
                   reader->pass->variant, image);
}

static bool is_made(const struct graph *graph, const char *image) {
    return graph_maker(graph, image) < graph->pass_count;
}

bool graph_calls(const struct graph *graph, const struct glint_pass *pass, const char *image) {
    const struct glint_row *first = glint_pass_row(pass, GLINT_ROW_CALLED_BY, NULL);
    bool any = false;
    if (!glint_pass_row(pass, GLINT_ROW_CALLED_BY, image)) return false;
    for (size_t r = 0; r < pass->row_count; r++)
        any |= pass->rows[r].kind == GLINT_ROW_CALLED_BY && is_made(graph, pass->rows[r].image);
    return any ? is_made(graph, image) : strcmp(first->image, image) == 0;
}

const struct glint_row *graph_replaced(const struct graph *graph, const struct graph_pass *pass, const char *image) {
    const struct glint_row *row = pass->entry->shader ? NULL : glint_pass_row(pass->pass, GLINT_ROW_IN_PLACE_OF, image);
    if (!row || !is_made(graph, row->name)) return NULL;
    const double *on = parameter_value(pass->pass, pass->entry->values, row->assigned),
                 *off = parameter_value(pass->pass, pass->entry->values, row->source);
    return on && *on != 0 && off && *off == 0 ? row : NULL;
}

/* Whether the pipeline makes one of the images of a row READ_BESIDE. */
static bool is_beside(const struct graph *graph, const char *others) {
    char name[64];
    for (const char *at = others; *at; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (is_made(graph, name)) return true;
        at += length;
    }
    return false;
}

/* The row itself if its image need not exist in this pipeline; NULL: it has to. */
static const struct glint_row *optional_row(const struct graph *graph, const struct graph_pass *pass,
                                            const struct glint_row *row) {
    const bool required = !row->optional || (row->beside ? is_beside(graph, row->beside)
                                                         : graph_calls(graph, pass->pass, row->name) &&
                                                               !graph_replaced(graph, pass, row->name));
    return required ? NULL : row;
}

/* Finds the source of an image that pass `reader` reads, and adds it to the graph's images. `optional`: the row with the fallback value
   if no pass writes it, or NULL. */
static void link_read(struct graph *graph, size_t reader, const char *name, const struct glint_row *optional,
                      const struct graph_inputs *inputs, struct faults *faults) {
    struct graph_image *image = graph_find(graph, name);
    if (image) {
        image->last_use = reader;
        if (!optional && image->row->optional)
            complain_missing(&graph->passes[reader], name, image->pass, false, inputs->options, faults);
        return;
    }
    struct graph_image fresh = {.name = name, .first_use = reader, .last_use = reader};
    const size_t maker = graph_maker(graph, name);
    /* An image of a pass that the plan dropped has no source; one that was merely not requested needs one. */
    const bool dropped =
        maker < graph->pass_count &&
        (!inputs->options->passes || list_has(inputs->options->passes, graph->passes[maker].pass->slot));
    if (!optional || maker < graph->pass_count) fresh.row = graph_row(graph, name, &fresh.pass);
    char part[128];
    snprintf(part, sizeof part, "engine.%.48s.%.48s", fresh.pass ? fresh.pass->slot : "", name);
    if (!fresh.row && optional) fresh.row = optional, fresh.source = SOURCE_FALLBACK;
    else if (!fresh.row) complain_missing(&graph->passes[reader], name, NULL, false, inputs->options, faults);
    else if (!fresh.pass) {
        fresh.source = graph_capture_has(inputs->capture, fresh.row) ? SOURCE_CAPTURE : SOURCE_FALLBACK;
        if (fresh.source == SOURCE_FALLBACK && fresh.row->required)
            faults_add(faults, GLINT_ERROR_FORMAT, "%s: part %s: missing, but %s/%s reads its channels %s",
                       inputs->capture ? glint_capture_path(inputs->capture) : "no capture", fresh.row->role,
                       graph->passes[reader].pass->slot, graph->passes[reader].pass->variant, fresh.row->source);
    } else if (dropped) fresh.source = SOURCE_FALLBACK;
    else if (optional && size_is_buffer(fresh.row->size)) fresh.row = optional, fresh.source = SOURCE_FALLBACK;
    else if (inputs->run && glint_run_find(inputs->run, name)) fresh.source = SOURCE_RUN;
    else if (inputs->capture && glint_capture_find(inputs->capture, part)) fresh.source = SOURCE_ENGINE;
    else if (optional) fresh.row = optional, fresh.source = SOURCE_FALLBACK;
    else
        complain_missing(&graph->passes[reader], name, fresh.pass, maker >= graph->pass_count, inputs->options, faults);
    const bool given = fresh.source == SOURCE_RUN || fresh.source == SOURCE_ENGINE;
    if (given && glint_pipeline_rays(graph->pipeline) > 1 && graph->passes[reader].rank == RANK_RAY &&
        glint_pass_row(fresh.pass, GLINT_ROW_PER_RAY, NULL))
        faults_add(faults, GLINT_ERROR_USAGE,
                   "%s/%s reads %s, which %s writes again for each of %u rays: that pass must run, too",
                   graph->passes[reader].pass->slot, graph->passes[reader].pass->variant, name, fresh.pass->slot,
                   glint_pipeline_rays(graph->pipeline));
    if (fresh.row) graph->images[graph->image_count++] = fresh;
}

/* The contents of an image at the end of the previous frame. The image itself is kept for the next frame. */
static void link_history(struct graph *graph, size_t reader, const struct glint_row *row,
                         const struct graph_inputs *inputs, struct faults *faults) {
    struct graph_image *image = graph_find(graph, row->image), *known = graph_bound(graph, row);
    const bool given = inputs->run && glint_run_find(inputs->run, row->image);
    if (capture_row(row->image)) {
        faults_add(
            faults, GLINT_ERROR_USAGE,
            "%s/%s declares a history of %s, an image of the capture; use the previous parts of the capture instead",
            graph->passes[reader].pass->slot, graph->passes[reader].pass->variant, row->image);
        return;
    }
    if (!image && given) {
        link_read(graph, reader, row->image, NULL, inputs, faults);
        image = graph_find(graph, row->image);
    }
    if (image) image->kept = true;
    if (known) {
        known->last_use = reader > known->last_use ? reader : known->last_use;
        return;
    }
    struct graph_image fresh = {.source = SOURCE_HISTORY, .history = true, .first_use = reader, .last_use = reader};
    struct graph_image *place = &graph->images[graph->image_count];
    fresh.row = graph_row(graph, row->image, &fresh.pass);
    if (!fresh.row) {
        complain_missing(&graph->passes[reader], row->image, NULL, false, inputs->options, faults);
        return;
    }
    snprintf(fresh.history_name, sizeof fresh.history_name, HISTORY_PREFIX "%s", row->image);
    *place = fresh;
    place->name = place->history_name;
    graph->image_count++;
    graph_check_kind(graph->passes[reader].pass, row, fresh.row, faults);
}

/* The input that a dropped pass would have passed on unchanged becomes its history for the next frame. */
static void link_passed_on(struct graph *graph, const struct glint_pass *dropped) {
    for (size_t r = 0; r < dropped->row_count; r++) {
        const struct glint_row *row = &dropped->rows[r];
        struct graph_image *image = row->kind == GLINT_ROW_BYPASS ? graph_find(graph, row->name) : NULL;
        if (!image || image->source != SOURCE_MADE || image->kept) continue;
        image->kept = true;
        image->kept_as = row->image;
        return;
    }
}

/* The outputs of a dropped pass that would not have changed the capture's images are those images. One in place of the capture's own is shown
   only where it is asked for. */
static void link_aliases(struct graph *graph, size_t dropped, const struct graph_inputs *inputs,
                         struct faults *faults) {
    const struct graph_pass *pass = &graph->passes[dropped];
    const char *const *outputs = inputs->options->outputs;
    for (size_t r = 0; pass->aliased && r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        if (row->kind != GLINT_ROW_ALIAS) continue;
        link_read(graph, dropped, row->name, NULL, inputs, faults);
        struct graph_image *image = graph_find(graph, row->name);
        if (!image) return;
        image->alias = glint_pass_output(pass->pass, row->image);
        image->alias_pass = pass->pass;
        image->requested = outputs ? list_has(outputs, row->image) : !capture_row(row->image);
    }
}

/* Whether a row FACT names the image, and the fact does not hold. */
static bool is_left_out(const struct graph_pass *pass, const char *image) {
    uint32_t fact = 0;
    for (size_t r = 0; r < pass->pass->row_count; r++) {
        if (pass->pass->rows[r].kind != GLINT_ROW_FACT) continue;
        if (strcmp(pass->pass->rows[r].name, image) == 0) return pass->false_facts >> fact & 1;
        fact++;
    }
    return false;
}

static void link_images(struct graph *graph, const struct graph_inputs *inputs, struct faults *faults) {
    const struct glint_replay_options *options = inputs->options;
    for (size_t i = 0; i < graph->pass_count; i++) {
        const struct graph_pass *pass = &graph->passes[i];
        link_aliases(graph, i, inputs, faults);
        for (size_t r = 0; pass->runs && r < pass->pass->row_count; r++) {
            const struct glint_row *row = &pass->pass->rows[r];
            const char *names[2];
            for (size_t n = glint_row_reads(row, names); n-- > 0;)
                link_read(graph, i, names[n], n == 0 ? optional_row(graph, pass, row) : NULL, inputs, faults);
            const struct graph_image *read = row->kind == GLINT_ROW_READ ? graph_find(graph, row->name) : NULL;
            if (read && read->source == SOURCE_RUN && size_is_array(read->row->size))
                link_read(graph, i, cubemap_order_image(), NULL, inputs, faults); /* contains the number of cube maps */
            if (read) graph_check_kind(pass->pass, row, read->row, faults);
            if (!glint_row_is_output(row)) continue;
            const bool diagnostic = row->kind == GLINT_ROW_DIAGNOSTIC;
            const bool made = diagnostic ? options->diagnostics : !is_left_out(pass, row->name);
            graph->images[graph->image_count++] = (struct graph_image){
                .name = row->name,
                .row = row,
                .pass = pass->pass,
                .source = made ? SOURCE_MADE : SOURCE_FALLBACK,
                .requested = made && (diagnostic || !options->outputs || list_has(options->outputs, row->name)),
                .maker = i,
                .first_use = i,
                .last_use = i};
        }
    }
    for (size_t i = 0; i < graph->pass_count; i++) /* after it is known which images are written */
        for (size_t r = 0; graph->passes[i].runs && r < graph->passes[i].pass->row_count; r++)
            if (graph->passes[i].pass->rows[r].kind == GLINT_ROW_HISTORY)
                link_history(graph, i, &graph->passes[i].pass->rows[r], inputs, faults);
    for (size_t i = 0; i < graph->pass_count; i++)
        if (!graph->passes[i].runs) link_passed_on(graph, graph->passes[i].pass);
}

bool graph_init(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err) {
    if (!graph_allocate(graph, pipeline, err)) return false;
    for (size_t i = 0; i < pipeline->count; i++)
        graph->passes[i] = (struct graph_pass){.entry = &pipeline->passes[i], .pass = pipeline->passes[i].pass};
    graph_check(graph, &graph->declared);
    graph_sort(graph);
    graph->faults = graph->declared;
    return true;
}

bool graph_link(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err) {
    link_images(graph, inputs, &graph->faults);
    if (graph->faults.count == 0) graph_find_cached_work(graph);
    graph_find_loop(graph, glint_pipeline_rays(graph->pipeline));
    return faults_none(&graph->faults, graph->pipeline->name, err);
}
