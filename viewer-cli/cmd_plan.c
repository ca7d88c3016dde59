/* glint plan: what would run, what not, and why. */
#include <stdlib.h>
#include <string.h>

#include "pass_names.h"
#include "pipe.h"
#include "pipeline_args.h"
#include "table.h"

struct arguments {
    struct pipeline_args pipeline;
    const char *capture;
    bool json, dot;
};

enum { KEY_DOT = 256 };

static const struct argp_option options[] = {
    PIPELINE_OPTIONS,
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {"dot", KEY_DOT, NULL, 0, "Print the graph of passes and images for Graphviz", 0},
    {0},
};
static const struct example examples[] = {
    {"glint plan street.exr", "which passes would run, and why"},
    {"glint plan street.exr --outputs travelled", "only what one image needs"},
    {"glint plan street.exr --dot | dot -Tsvg > plan.svg", "draw the graph"},
    {0},
};

extern const struct command cmd_plan;

static error_t parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case 'j':
        a->json = true;
        return 0;
    case KEY_DOT:
        a->dot = true;
        return 0;
    case ARGP_KEY_ARG:
        if (a->capture) argp_error(state, "one capture at a time: %s and %s", a->capture, arg);
        a->capture = arg;
        return 0;
    case ARGP_KEY_NO_ARGS:
        argp_error(state, "which capture?");
        return 0;
    }
    return pipeline_args_parse(key, arg, state, &a->pipeline);
}

static void print_plan(const struct glint_plan_entry *entries, size_t count) {
    static const char *const titles[] = {"<slot", "<variant", "<runs", "<why", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < count; i++) {
        table_cell(table, "%s", entries[i].pass->slot);
        table_cell(table, "%s", entries[i].pass->variant);
        table_cell(table, "%s", entries[i].runs ? "yes" : "no");
        table_cell(table, "%s", entries[i].reason);
    }
    table_print(table, stdout);
    table_destroy(&table);
}

static enum status print_plan_json(const char *capture, const struct glint_pipeline *pipeline,
                                   const struct glint_plan_entry *entries, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:b, s:s}", "slot", entries[i].pass->slot, "variant",
                                              entries[i].pass->variant, "runs", entries[i].runs, "reason",
                                              entries[i].reason));
    return print_json(
        json_pack("{s:s, s:s, s:o}", "capture", capture, "preset", glint_pipeline_name(pipeline), "passes", list));
}

/* Passes are boxes, images ellipses; what does not run is dashed. Names are C identifiers, so nothing needs a quote. */
static void print_dot(const struct glint_plan_entry *entries, size_t count) {
    puts("digraph plan {\n    rankdir=LR;\n    node [fontname=\"Helvetica\", fontsize=10];");
    for (size_t i = 0; i < count; i++) {
        const struct glint_pass *pass = entries[i].pass;
        printf("    \"pass %s\" [shape=box, style=\"rounded%s\", label=\"%s\\n%s\"];\n", pass->slot,
               entries[i].runs ? "" : ",dashed", pass->slot, pass->variant);
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            const char *slot = "";
            if (row->kind == GLINT_ROW_READ) {
                bool captured = image_find(row->name, &slot) && !strcmp(slot, "capture");
                printf("    \"%s\"%s;\n", row->name, captured ? " [style=filled, fillcolor=\"#e8eef4\"]" : "");
                printf("    \"%s\" -> \"pass %s\";\n", row->name, pass->slot);
            } else if (row->kind == GLINT_ROW_WRITE) printf("    \"pass %s\" -> \"%s\";\n", pass->slot, row->name);
        }
    }
    puts("}");
}

static enum status plan(const struct arguments *a, struct glint_pipeline *pipeline, struct glint_replay *replay) {
    struct glint_replay_options options = pipeline_args_options(&a->pipeline);
    struct glint_error err = {0};
    const struct glint_plan_entry *entries = NULL;
    size_t count = 0;
    if (!glint_replay_plan(replay, pipeline, &options, &entries, &count, &err)) return command_fail(&cmd_plan, &err);
    if (a->json) return print_plan_json(a->capture, pipeline, entries, count);
    if (a->dot) print_dot(entries, count);
    else print_plan(entries, count);
    return STATUS_DONE;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_plan, argc, argv, &a);
    struct glint_error err = {0};
    struct glint_replay *replay = NULL;
    struct pipe pipe = {0};
    enum status status;
    struct glint_pipeline *pipeline = pipeline_args_create(&a.pipeline, &err);
    const char *path = pipeline ? pipe_input(&pipe, a.capture, &err) : NULL;
    struct glint_capture *capture = path ? glint_capture_open(path, NULL, &err) : NULL;
    if (capture) replay = glint_replay_create(NULL, &err);
    if (replay && glint_replay_load(replay, capture, &err)) status = plan(&a, pipeline, replay);
    else status = command_fail(&cmd_plan, &err);
    glint_replay_destroy(&replay);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    glint_pipeline_destroy(&pipeline);
    pipeline_args_finish(&a.pipeline);
    return status;
}

const struct command cmd_plan = {
    .name = "plan",
    .arguments = "F",
    .summary = "what would run, what not, and why",
    .description =
        "Shows what replay would do with a capture: one line for each pass, whether it runs, and the rule or "
        "the figure that decides it. Needs no Vulkan device.",
    .options = options,
    .parse = parse,
    .examples = examples,
    .run = run,
};
