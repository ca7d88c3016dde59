/* Prints how traced rays compare with a capture's truth: measure_truth PRESET CAPTURE [--roughness R] [slot.parameter=value]…
   The figures in passes/&/NOTES.md come from measure.sh, which calls this. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/study.h"

static void print_table(const struct glint_trace_table *table) {
    printf("%-9s %-16s %8s %7s %7s %10s %10s\n", "tracer", "reason", "rays", "share", "right", "median", "95th");
    for (size_t i = 0; i < table->count; ++i) {
        const struct glint_trace_row *r = &table->rows[i];
        printf("%-9s %-16s %8zu %6.1f%% %6.1f%% %9.2f%% %9.2f%%\n", r->tracer, r->reason, r->rays, 100 * r->share,
               100 * r->right, 100 * r->median_error, 100 * r->p95_error);
    }
}

static bool fail(const struct glint_error *err) {
    fprintf(stderr, "%s\n", err->message);
    return false;
}

static bool run(const char *preset, const char *path, char **assignments, int count, double roughness) {
    struct glint_error err = {0};
    struct glint_device *device = glint_device_create(NULL, &err);
    struct glint_pipeline *pipeline = device ? glint_pipeline_create(preset, &err) : NULL;
    struct glint_replay *replay = pipeline ? glint_replay_create(device, &err) : NULL;
    struct glint_capture *capture = replay ? glint_capture_open(path, NULL, &err) : NULL;
    struct glint_trace_table table;
    bool ok = capture != NULL && glint_pipeline_set(pipeline, "downsample.jitter=0", &err);
    for (int i = 0; ok && i < count; ++i) ok = glint_pipeline_set(pipeline, assignments[i], &err);
    ok = ok && glint_replay_load(replay, capture, &err) &&
         glint_replay_run(replay, pipeline, &(struct glint_replay_options){.diagnostics = true}, NULL, NULL, &err) &&
         glint_study_trace(replay, capture, roughness, &table, &err);
    if (ok) print_table(&table);
    else fail(&err);
    if (replay) glint_replay_load(replay, NULL, NULL);
    glint_capture_close(&capture);
    glint_replay_destroy(&replay);
    glint_pipeline_destroy(&pipeline);
    glint_device_destroy(&device);
    return ok;
}

int main(int argc, char **argv) {
    double roughness = 0.1;
    int first = 3;
    if (argc > 4 && strcmp(argv[3], "--roughness") == 0) {
        roughness = atof(argv[4]);
        first = 5;
    }
    if (argc < 3) {
        fprintf(stderr, "usage: measure_truth PRESET CAPTURE [--roughness R] [slot.parameter=value]...\n");
        return 2;
    }
    return run(argv[1], argv[2], argv + first, argc - first, roughness) ? 0 : 1;
}
