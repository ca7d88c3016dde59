/* Decides which passes of a graph run, with the reason for each. */
#include "graph.h"
#include "nearest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_slots(const struct graph *graph, const char *option, const char *const *slots,
                        struct faults *faults) {
    char known[400] = "";
    for (size_t i = 0; i < graph->pass_count; i++) text_list(known, sizeof known, graph->passes[i].pass->slot);
    for (; slots && *slots; slots++) {
        size_t i = 0;
        while (i < graph->pass_count && strcmp(graph->passes[i].pass->slot, *slots) != 0) i++;
        if (i == graph->pass_count)
            faults_add(faults, GLINT_ERROR_USAGE, "%s: no slot '%s' in the pipeline; it has: %s", option, *slots,
                       known);
    }
}

static const double *value_of(const struct graph_pass *pass, const char *parameter) {
    return parameter_value(pass->pass, pass->entry->values, parameter);
}

/* The text of a fact, with the value of the parameter that it depends on. */
static const char *fact_text(const struct graph_pass *pass, const struct glint_row *row, char text[128]) {
    const double *value = value_of(pass, row->image);
    if (!value) return row->name;
    snprintf(text, 128, "%.64s %.17g", row->name, *value);
    return text;
}

/* Whether the parameter of a row READS_LEVELS makes the pass read MIP levels of that image. A user's shader may always do so. */
static bool reads_levels(const struct graph_pass *pass, const struct glint_row *row) {
    const double *value = value_of(pass, row->name);
    return !value || *value != 0 || pass->entry->shader;
}

/* A pass that runs and reads MIP levels of an image that `maker` makes, even if no ray has a cone. */
static const struct graph_pass *find_level_reader(const struct graph *graph, const struct glint_pass *maker) {
    for (size_t i = 0; i < graph->pass_count; i++)
        for (size_t r = 0; graph->passes[i].runs && r < graph->passes[i].pass->row_count; r++) {
            const struct glint_row *row = &graph->passes[i].pass->rows[r];
            if (row->kind == GLINT_ROW_READS_LEVELS && glint_pass_output(maker, row->image) &&
                reads_levels(&graph->passes[i], row))
                return &graph->passes[i];
        }
    return NULL;
}

/* Whether an image must be made: a pass that runs reads it or the caller asks for it. What a user's shader writes is unknown. */
static bool is_read(const struct graph *graph, const struct graph_pass *maker, const char *image,
                    const struct glint_replay_options *options) {
    bool read = maker->entry->shader || list_has(options->outputs, image);
    for (size_t i = 0; i < graph->pass_count; i++) {
        const struct graph_pass *pass = &graph->passes[i];
        const struct glint_row *row = glint_pass_row(pass->pass, GLINT_ROW_READS_LEVELS, image);
        read |= pass->runs && glint_pass_row(pass->pass, GLINT_ROW_READ, image) && (!row || reads_levels(pass, row));
    }
    return read;
}

/* A dropped pass with rows ALIAS leaves images of the capture unchanged, so that its own images are aliases of those. A user's shader may
   change them, so that such a pass runs all the same. */
static void use_aliases(struct graph_pass *pass) {
    char text[128];
    if (!glint_pass_row(pass->pass, GLINT_ROW_ALIAS, NULL)) return;
    pass->runs = pass->entry->shader != NULL;
    pass->aliased = !pass->runs;
    if (pass->runs) text_list(pass->reason, sizeof pass->reason, "but the shader was replaced by the user");
    for (size_t r = 0; pass->aliased && r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        if (row->kind != GLINT_ROW_ALIAS || capture_row(row->image)) continue;
        snprintf(text, sizeof text, "%s is %s", row->image, row->name);
        text_list(pass->reason, sizeof pass->reason, text);
    }
}

/* Of the pass's rows CALLED_BY that count, one has to hold. Those that do, or all if none does, state their figures in the reason. */
static bool decide_by_callers(const struct graph *graph, struct graph_pass *pass, const struct facts *facts,
                              struct faults *faults, struct glint_error *err) {
    char texts[2][sizeof pass->reason] = {"", ""}, reason[192];
    bool called = false;
    for (size_t r = 0; r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        struct glint_error own = {0};
        if (row->kind != GLINT_ROW_CALLED_BY || !graph_calls(graph, pass->pass, row->image)) continue;
        if (facts->about(row->name) == FACT_UNKNOWN) {
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s is called by an unknown fact '%s'", pass->pass->slot,
                       pass->pass->variant, row->name);
            continue;
        }
        const bool holds = facts->holds(facts->user, row->name, reason, sizeof reason, &own);
        if (own.code != GLINT_OK) return glint_fail(err, own.code, "%s", own.message);
        called |= holds;
        if (!strstr(texts[holds], reason)) text_list(texts[holds], sizeof texts[holds], reason);
    }
    if (!pass->runs || (!texts[0][0] && !texts[1][0])) return true;
    if (!called) pass->runs = false, pass->reason[0] = 0;
    text_list(pass->reason, sizeof pass->reason, texts[called]);
    return true;
}

/* Whether the pass works on cube maps and the capture has none. */
static bool has_no_cubemaps(const struct glint_pass *pass, const struct facts *facts) {
    char reason[192];
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_NEEDS && facts->about(pass->rows[r].name) == FACT_CUBEMAPS)
            return !facts->holds(facts->user, pass->rows[r].name, reason, sizeof reason, NULL);
    return false;
}

/* With a row NEEDED_IF_READ a pass runs all the same when another one that runs reads its images, unless it has nothing to work on. */
static void run_for_reader(const struct graph *graph, struct graph_pass *pass, const struct facts *facts) {
    if (pass->runs || !glint_pass_row(pass->pass, GLINT_ROW_NEEDED_IF_READ, NULL) || has_no_cubemaps(pass->pass, facts))
        return;
    for (size_t i = 0; i < graph->pass_count; i++) {
        const struct graph_pass *reader = &graph->passes[i];
        if (!reader->runs || !glint_pass_depends(reader->pass, pass->pass)) continue;
        snprintf(pass->reason, sizeof pass->reason, "%s/%s reads its images", reader->pass->slot,
                 reader->pass->variant);
        pass->runs = true;
        return;
    }
}

/* Why none of the passes that read a pass's images uses one, or NULL: one does, there are none, or the caller looks at an image. */
static const char *find_unused(const struct graph *graph, const struct graph_pass *pass,
                               const struct glint_replay_options *options) {
    const char *why = NULL;
    for (size_t r = 0; r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        if (!glint_row_is_output(row)) continue;
        if (list_has(options->outputs, row->name) || list_has(options->results, row->name)) return NULL;
        for (size_t i = 0; i < graph->pass_count; i++) {
            const struct graph_pass *reader = &graph->passes[i];
            if (pass_reads_history(reader->pass, pass->pass)) return NULL;
            if (!glint_pass_row(reader->pass, GLINT_ROW_READ, row->name)) continue;
            const struct glint_row *replaced = graph_replaced(graph, reader, row->name);
            if (!replaced && !reader->unused) return NULL;
            why = replaced ? replaced->help : reader->unused;
        }
    }
    return why;
}

/* Decides by its rows NEEDS, CALLED_BY and FACT whether the pass runs and which facts are false. The reason states the figures. */
static bool decide_by_facts(const struct graph *graph, struct graph_pass *pass, const struct graph_inputs *inputs,
                            struct faults *faults, struct glint_error *err) {
    const struct facts *facts = &inputs->facts;
    char reason[192], text[128];
    uint32_t fact = 0;
    pass->runs = true;
    for (size_t r = 0; r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        if (row->kind != GLINT_ROW_NEEDS && row->kind != GLINT_ROW_FACT) continue;
        struct glint_error own = {0};
        if (row->kind == GLINT_ROW_FACT && glint_pass_output(pass->pass, row->name)) {
            const bool read = is_read(graph, pass, row->name, inputs->options);
            pass->false_facts |= (uint32_t)!read << fact++;
            snprintf(reason, sizeof reason, "no pass reads %s", row->name);
            if (!read && pass->runs) text_list(pass->reason, sizeof pass->reason, reason);
            continue;
        }
        const enum fact_about about = facts->about(fact_text(pass, row, text));
        if (about == FACT_UNKNOWN) {
            faults_add(faults, GLINT_ERROR_USAGE, "%s/%s needs an unknown fact '%s'", pass->pass->slot,
                       pass->pass->variant, row->name);
            continue;
        }
        bool holds = facts->holds(facts->user, fact_text(pass, row, text), reason, sizeof reason, &own);
        if (own.code != GLINT_OK) return glint_fail(err, own.code, "%s", own.message);
        const struct graph_pass *reader = !holds && about == FACT_CONES ? find_level_reader(graph, pass->pass) : NULL;
        if (reader) {
            snprintf(reason, sizeof reason, "%s/%s reads its levels", reader->pass->slot, reader->pass->variant);
            holds = true;
        }
        if (row->kind == GLINT_ROW_FACT) pass->false_facts |= (uint32_t)!holds << fact++;
        else if (!holds && pass->runs) pass->reason[0] = 0, pass->runs = false;
        const bool repeated = strstr(pass->reason, reason) != NULL; /* several facts may state the same figure */
        if (row->kind == GLINT_ROW_NEEDS && holds == pass->runs && !repeated)
            text_list(pass->reason, sizeof pass->reason, reason);
    }
    if (!decide_by_callers(graph, pass, facts, faults, err)) return false;
    run_for_reader(graph, pass, facts);
    if (!pass->runs) use_aliases(pass);
    if (!pass->reason[0]) snprintf(pass->reason, sizeof pass->reason, "always runs");
    return true;
}

static bool makes_list(const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (glint_row_is_output(&pass->rows[r]) && size_is_buffer(pass->rows[r].size)) return true;
    return false;
}

/* Goes from the last pass to the first, since whether a pass runs may depend on which later passes read its images. */
static bool decide_passes(struct graph *graph, const struct graph_inputs *inputs, struct faults *faults,
                          struct glint_error *err) {
    const struct glint_replay_options *options = inputs->options;
    for (size_t i = graph->pass_count; i-- > 0;) {
        struct graph_pass *pass = &graph->passes[i];
        const char *slot = pass->pass->slot, *why = NULL;
        if (options->passes && !list_has(options->passes, slot)) why = GLINT_REASON_NOT_ASKED;
        else if (list_has(options->skip, slot)) why = GLINT_REASON_SKIPPED;
        else if (list_has(options->force, slot)) why = "forced on request", pass->runs = true;
        else if (options->all && !options->passes && makes_list(pass->pass))
            why = "all pixels were requested, and a list would exclude some";
        else if (options->all && !has_no_cubemaps(pass->pass, &inputs->facts))
            why = "all passes were requested", pass->runs = true;
        else if (options->all) why = "the capture has no cube maps";
        else if (!options->passes && (pass->unused = find_unused(graph, pass, options))) why = pass->unused;
        else if (!decide_by_facts(graph, pass, inputs, faults, err)) return false;
        if (why) snprintf(pass->reason, sizeof pass->reason, "%s", why);
    }
    return true;
}

/* Drops passes whose row NEEDS_MADE names an image that no pass makes now, from the first pass to the last. */
static void drop_without_input(struct graph *graph, const struct glint_replay_options *options) {
    for (size_t i = 0; i < graph->pass_count; i++) {
        struct graph_pass *pass = &graph->passes[i];
        const struct glint_row *row = glint_pass_row(pass->pass, GLINT_ROW_NEEDS_MADE, NULL);
        const size_t maker = row ? graph_maker(graph, row->name) : graph->pass_count;
        if (!pass->runs || options->all || list_has(options->force, pass->pass->slot)) continue;
        if (maker == graph->pass_count || graph->passes[maker].runs) continue;
        const char *slot = graph->passes[maker].pass->slot;
        if (options->passes && !list_has(options->passes, slot)) continue; /* the image comes from a run */
        pass->runs = false;
        snprintf(pass->reason, sizeof pass->reason, "%.48s, whose %.48s it works on, does not run", slot, row->name);
    }
}

/* Adds to the reason of a pass that runs what it does without images of the capture. */
static void add_without(struct graph_pass *pass, const struct glint_capture *capture) {
    char text[200];
    for (size_t r = 0; capture && pass->runs && r < pass->pass->row_count; r++) {
        const struct glint_row *row = &pass->pass->rows[r];
        const struct glint_row *image = row->kind == GLINT_ROW_WITHOUT ? capture_row(row->name) : NULL;
        if (!image || graph_capture_has(capture, image)) continue;
        snprintf(text, sizeof text, "without %s: %s", row->name, row->help);
        text_list(pass->reason, sizeof pass->reason, text);
    }
}

static bool calls_for(const void *passes, size_t later, size_t earlier) {
    const struct graph_pass *reader = (const struct graph_pass *)passes + later;
    const struct graph_pass *maker = (const struct graph_pass *)passes + earlier;
    return reader->runs &&
           (glint_pass_depends(reader->pass, maker->pass) || pass_reads_history(reader->pass, maker->pass));
}

/* Drops passes that no requested image depends on. */
static void cull_passes(struct graph *graph, const struct glint_replay_options *options, struct faults *faults) {
    if (!options->outputs) return;
    bool *needed = calloc(graph->pass_count + 1, sizeof *needed);
    if (!needed) {
        faults_add(faults, GLINT_ERROR_MEMORY, "out of memory");
        return;
    }
    for (const char *const *name = options->outputs; *name; name++) {
        size_t maker = graph_maker(graph, *name);
        if (maker == graph->pass_count) {
            char known[600] = "";
            for (size_t i = 0; i < graph->pass_count; i++)
                for (size_t r = 0; r < graph->passes[i].pass->row_count; r++)
                    if (glint_row_is_output(&graph->passes[i].pass->rows[r]))
                        text_list(known, sizeof known, graph->passes[i].pass->rows[r].name);
            faults_add(faults, GLINT_ERROR_USAGE, "outputs: no pass writes '%s'; images: %s", *name, known);
        } else if (glint_pass_output(graph->passes[maker].pass, *name)->kind == GLINT_ROW_DIAGNOSTIC &&
                   !options->diagnostics)
            faults_add(faults, GLINT_ERROR_USAGE, "outputs: %s is a diagnostic image, and diagnostics are off", *name);
        else if (options->passes && !list_has(options->passes, graph->passes[maker].pass->slot))
            faults_add(faults, GLINT_ERROR_USAGE, "outputs: %s is made by %s, which is not among the requested passes",
                       *name, graph->passes[maker].pass->slot);
        else needed[maker] = true;
    }
    glint_passes_mark_needed(needed, graph->pass_count, calls_for, graph->passes);
    for (size_t i = graph->pass_count; i-- > 0;) {
        if (!needed[i]) graph->passes[i].aliased = false;
        if (graph->passes[i].runs && !needed[i]) {
            graph->passes[i].runs = false;
            snprintf(graph->passes[i].reason, sizeof graph->passes[i].reason, "no requested image depends on it");
        }
    }
    free(needed);
}

bool graph_decide(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err) {
    const struct glint_replay_options *options = inputs->options;
    struct faults *faults = &graph->faults;
    *faults = graph->declared;
    for (size_t i = 0; i < graph->pass_count; i++)
        graph->passes[i] = (struct graph_pass){
            .entry = graph->passes[i].entry, .pass = graph->passes[i].pass, .rank = graph->passes[i].rank};
    check_slots(graph, "passes", options->passes, faults);
    check_slots(graph, "skip", options->skip, faults);
    check_slots(graph, "force", options->force, faults);
    if (!decide_passes(graph, inputs, faults, err)) return false;
    drop_without_input(graph, options);
    cull_passes(graph, options, faults);
    for (size_t i = 0; i < graph->pass_count; i++) add_without(&graph->passes[i], inputs->capture);
    return true;
}
