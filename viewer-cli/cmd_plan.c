/* glint plan: shows which passes would run, and why. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "capture/missing.h"
#include "glint/savings.h"
#include "options/pass_names.h"
#include "io/pipe.h"
#include "options/pipeline_args.h"
#include "io/progress.h"
#include "io/table.h"

struct arguments {
    struct pipeline_args pipeline;
    const char *capture;
    uint32_t rounds; /* of --measure; 0: without it */
    bool json, dot;
};

enum { KEY_DOT = 256, KEY_MEASURE };

/* clang-format off */
static const struct argp_option options[] = {
    PIPELINE_OPTIONS,
    {"measure", KEY_MEASURE, "N", 0, "Measure on the device what the plan saves: run N rounds each with the plan and with --all, alternating", 0},
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {"dot", KEY_DOT, NULL, 0, "Print the graph of passes and images for Graphviz", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint plan street.exr", "shows which passes would run, and why"},
    {"glint plan street.exr --measure 10", "also measures the milliseconds that are saved"},
    {"glint plan street.exr --outputs travelled", "plans only what one image needs"},
    {"glint plan street.exr --skip blur --force cocoon", "overrides the plan for two passes"},
    {"glint plan street.exr --dot | dot -Tsvg > plan.svg", "draws the graph"},
    {0},
};

static const struct arg_target targets[] = {
    STORED(ARGP_KEY_ARG, struct arguments, capture), STORED('j', struct arguments, json),
    STORED(KEY_DOT, struct arguments, dot),          STORED_NUMBER(KEY_MEASURE, struct arguments, rounds, 1, 100000),
    PIPELINE_TARGETS(struct arguments, pipeline),    {0},
};

/* A plan, and its times on the device if they were measured. */
struct answer {
    const struct glint_plan_entry *entries;
    size_t count;
    struct glint_savings savings;
    const struct glint_cube_faces *faces;
    struct missing missing;
};

static double milliseconds(uint64_t ns) {
    return (double)ns * 1e-6;
}

static double saved_ms(const struct glint_saving *saving) {
    return milliseconds(saving->whole_ns) - milliseconds(saving->planned_ns);
}

/* Prints the saved time if it was measured, else the pixels or texels that a skipped pass would have processed. */
static void print_saved(struct table *table, const struct answer *answer, size_t i) {
    const struct glint_plan_entry *entry = &answer->entries[i];
    if (answer->savings.passes && answer->savings.passes[i].whole_ns)
        table_cell(table, "%.3f of %.3f ms", saved_ms(&answer->savings.passes[i]),
                   milliseconds(answer->savings.passes[i].whole_ns));
    else if (!entry->runs && entry->texels)
        table_cell(table, "%llu %s", (unsigned long long)entry->texels, entry->cached_work ? "texels" : "pixels");
    else table_cell(table, "%s", "");
}

static void print_times(const char *what, const struct glint_savings_time *time) {
    printf("%s: planned %.3f ms, with --all %.3f ms: %.1f %% (interquartile range %.1f to %.1f %%)\n", name_text(what),
           milliseconds(time->planned.median_ns), milliseconds(time->whole.median_ns), 100 * time->ratio[1],
           100 * time->ratio[0], 100 * time->ratio[2]);
}

static void print_plan(const struct answer *answer) {
    static const char *const titles[] = {"<slot", "<variant", "<runs", ">saves", "<why", NULL};
    const struct glint_savings *savings = &answer->savings;
    struct table *table = table_create(titles);
    for (size_t i = 0; i < answer->count; i++) {
        const struct glint_plan_entry *entry = &answer->entries[i];
        table_cell(table, "%s", entry->pass->slot);
        table_cell(table, "%s", entry->pass->variant);
        table_cell(table, "%s", entry->runs ? "yes" : "no");
        print_saved(table, answer, i);
        table_cell(table, "%s", entry->reason);
    }
    table_print(table, stdout);
    table_destroy(&table);
    if (answer->faces->uploaded_of)
        printf("\ncube-map faces: %s%llu of %llu are uploaded, %llu of %llu are filtered\n",
               savings->passes ? "" : "at most ", /* only a device can find which faces rays reach */
               (unsigned long long)answer->faces->uploaded, (unsigned long long)answer->faces->uploaded_of,
               (unsigned long long)answer->faces->filtered, (unsigned long long)answer->faces->filtered_of);
    if (!savings->passes) return;
    putchar('\n');
    print_times("all passes", &savings->all);
    print_times("without work on cube maps, which is done when one changes", &savings->frame);
    printf("of the planned time, the survey takes %.3f ms; %u alternating rounds\n", milliseconds(savings->survey_ns),
           savings->rounds);
}

static json_t *times_json(const struct glint_savings_time *time) {
    return json_pack("{s:f, s:f, s:[f, f, f]}", "planned_ms", milliseconds(time->planned.median_ns), "all_ms",
                     milliseconds(time->whole.median_ns), "ratio", time->ratio[0], time->ratio[1], time->ratio[2]);
}

static enum status print_plan_json(const char *capture, const struct glint_pipeline *pipeline,
                                   const struct answer *answer) {
    const struct glint_savings *savings = &answer->savings;
    json_t *list = json_array();
    for (size_t i = 0; i < answer->count; i++) {
        const struct glint_plan_entry *entry = &answer->entries[i];
        json_t *row = json_pack("{s:s, s:s, s:b, s:s, s:b, s:I}", "slot", entry->pass->slot, "variant",
                                entry->pass->variant, "runs", entry->runs, "reason", entry->reason, "cached_work",
                                entry->cached_work, "texels", (json_int_t)entry->texels);
        if (savings->passes)
            json_object_set_new(row, "saves",
                                json_pack("{s:f, s:f}", "planned_ms", milliseconds(savings->passes[i].planned_ns),
                                          "all_ms", milliseconds(savings->passes[i].whole_ns)));
        json_array_append_new(list, row);
    }
    const struct glint_cube_faces *faces = answer->faces;
    json_t *root =
        json_pack("{s:s, s:s, s:o, s:{s:[II], s:[II]}}", "capture", capture, "preset", glint_pipeline_name(pipeline),
                  "passes", list, "cube_faces", "uploaded", (json_int_t)faces->uploaded, (json_int_t)faces->uploaded_of,
                  "filtered", (json_int_t)faces->filtered, (json_int_t)faces->filtered_of);
    json_object_set_new(root, "missing", missing_json(&answer->missing));
    if (savings->passes)
        json_object_set_new(root, "measured",
                            json_pack("{s:i, s:f, s:o, s:o}", "rounds", (int)savings->rounds, "survey_ms",
                                      milliseconds(savings->survey_ns), "all", times_json(&savings->all), "frame",
                                      times_json(&savings->frame)));
    return print_json(root);
}

/* Passes are boxes, images are ellipses, and passes that do not run are dashed. Names are C identifiers and need no escaping. */
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

static bool measure_plan(const struct arguments *a, struct glint_pipeline *pipeline, struct glint_replay *replay,
                         struct answer *answer, struct glint_error *err) {
    const struct glint_replay_options options = pipeline_args_options(&a->pipeline);
    struct progress progress;
    progress_begin(&progress);
    const bool ok =
        glint_study_savings(replay, pipeline, &options, a->rounds, &answer->savings, progress_report, &progress, err);
    progress_end(&progress);
    return ok;
}

static enum status plan(const struct arguments *a, struct glint_pipeline *pipeline, struct glint_replay *replay) {
    const struct glint_replay_options options = pipeline_args_options(&a->pipeline);
    struct glint_error err = {0};
    struct answer answer = {.faces = glint_replay_cube_faces(replay)};
    enum status status = STATUS_DONE;
    if ((a->rounds && !measure_plan(a, pipeline, replay, &answer, &err)) ||
        !glint_replay_plan(replay, pipeline, &options, &answer.entries, &answer.count, &err))
        status = command_fail(&cmd_plan, &err);
    missing_add(&answer.missing, replay);
    if (status == STATUS_DONE && a->json) status = print_plan_json(a->capture, pipeline, &answer);
    else if (status == STATUS_DONE && a->dot) print_dot(answer.entries, answer.count);
    else if (status == STATUS_DONE) print_plan(&answer);
    if (status == STATUS_DONE) missing_note(&cmd_plan, &answer.missing, 0);
    glint_savings_finish(&answer.savings);
    return status;
}

static enum status cmd_plan_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_plan, argc, argv, &a);
    struct glint_error err = {0};
    struct glint_replay *replay = NULL;
    struct glint_device *device = NULL;
    struct pipe pipe = {0};
    enum status status;
    struct glint_pipeline *pipeline = pipeline_args_create(&a.pipeline, &err);
    const char *path = pipeline ? pipe_input(&pipe, a.capture, &err) : NULL;
    struct glint_capture *capture = path ? glint_capture_open(path, NULL, &err) : NULL;
    if (capture && a.rounds) device = pipeline_args_device(&a.pipeline, &err);
    if (capture && (device || !a.rounds)) replay = glint_replay_create(device, &err);
    if (replay && glint_replay_load(replay, capture, &err)) status = plan(&a, pipeline, replay);
    else status = command_fail(&cmd_plan, &err);
    glint_replay_destroy(&replay);
    glint_device_destroy(&device);
    glint_capture_close(&capture);
    pipe_finish(&pipe);
    glint_pipeline_destroy(&pipeline);
    pipeline_args_finish(&a.pipeline);
    return status;
}

const struct command cmd_plan = {
    .name = "plan",
    .arguments = "F",
    .summary = "show which passes would run, and why",
    .description =
        "Shows what replay would do with a capture: for each pass, whether it runs, the rule and the figure that "
        "decide this, and what is saved: pixels, texels of cube maps, or with --measure time. The plan changes no "
        "bit of the image; --all runs everything, and --skip and --force override the plan for single passes. A "
        "Vulkan device is needed only for --measure.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .examples = examples,
    .run = cmd_plan_run,
};
