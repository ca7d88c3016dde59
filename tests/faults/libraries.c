/* What libglint-pack, libglint-replay and libglint-study do, without the program glint, which holds a reserve of memory for Jansson
   (io/memory.c): here Jansson's allocations fail like all others. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/capture.h"
#include "glint/judge.h"
#include "glint/pack.h"
#include "glint/reference.h"
#include "glint/replay.h"

static void note(void *user, enum glint_pack_note kind, const char *key, const char *text) {
    (void)user;
    printf("%d %s: %s\n", (int)kind, key, text);
}

static void fault(void *user, const char *text) {
    (void)user;
    fprintf(stderr, "%s\n", text);
}

static const struct glint_pack_options pack_options = {.threads = 1, .note = note, .fault = fault};

static bool pack(char **words, struct glint_error *err) {
    return glint_pack(words[0], words[1], &pack_options, err);
}

static bool extract(char **words, struct glint_error *err) {
    return glint_extract(words[0], words[1], &pack_options, err);
}

/* A capture that is loaded, on the first device, and a pipeline. */
struct loaded {
    struct glint_device *device;
    struct glint_capture *capture;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
};

static bool load(struct loaded *loaded, char **words, struct glint_error *err) {
    const struct glint_device_options options = {0};
    return (loaded->pipeline = glint_pipeline_create(words[1], err)) != NULL &&
           (loaded->capture = glint_capture_open(words[0], NULL, err)) != NULL &&
           (loaded->device = glint_device_create(&options, err)) != NULL &&
           (loaded->replay = glint_replay_create(loaded->device, err)) != NULL &&
           glint_replay_load(loaded->replay, loaded->capture, err);
}

static void unload(struct loaded *loaded) {
    glint_replay_destroy(&loaded->replay);
    glint_device_destroy(&loaded->device);
    glint_capture_close(&loaded->capture);
    glint_pipeline_destroy(&loaded->pipeline);
}

static bool print(char *text, struct glint_error *err) {
    if (!text) return !err->code && glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    puts(text);
    free(text);
    return true;
}

static bool replay(char **words, struct glint_error *err) {
    const struct glint_replay_options options = {0};
    struct loaded loaded = {0};
    struct glint_run *run = NULL;
    const bool ok = load(&loaded, words, err) &&
                    glint_replay_run(loaded.replay, loaded.pipeline, &options, NULL, NULL, err) &&
                    glint_replay_write(loaded.replay, words[2], NULL, NULL, err) &&
                    print(glint_replay_json(loaded.replay, err), err) &&
                    (run = glint_run_open(words[2], err)) != NULL && puts(glint_run_json(run)) >= 0;
    glint_run_close(&run);
    unload(&loaded);
    return ok;
}

static bool reference(char **words, struct glint_error *err) {
    const struct glint_reference_options options = {.folder = words[2]};
    struct glint_reference_sensitivity sensitivity = {0};
    struct loaded loaded = {0};
    struct glint_pipeline *converged = NULL;
    struct glint_reference *traced = NULL;
    const bool ok =
        load(&loaded, words, err) && (converged = glint_study_reference(loaded.pipeline, err)) != NULL &&
        (traced = glint_reference_create(loaded.replay, loaded.capture, converged, &options, err)) != NULL &&
        glint_reference_trace(traced, 16, 0, NULL, NULL, err) &&
        glint_reference_sensitivity(traced, 16, NULL, NULL, &sensitivity, err) &&
        print(glint_reference_json(traced), err);
    glint_reference_destroy(&traced);
    glint_pipeline_destroy(&converged);
    unload(&loaded);
    return ok;
}

/* Against the reference of a run folder. */
static bool judge(char **words, struct glint_error *err) {
    const struct glint_judge_options options = {.reference = true, .reference_run = words[2]};
    struct loaded loaded = {0};
    struct glint_judge *judge = NULL;
    const struct glint_pixels *target = NULL;
    const float *error;
    const bool ok =
        load(&loaded, words, err) && (judge = glint_judge_create(loaded.device, &options, err)) != NULL &&
        glint_judge_load(judge, loaded.capture, err) &&
        (target = glint_judge_target(judge, GLINT_TARGET_REFERENCE, loaded.pipeline, &error, NULL, NULL, err)) != NULL;
    if (ok) printf("%u x %u\n", target->width, target->height);
    glint_judge_destroy(&judge);
    unload(&loaded);
    return ok;
}

static const struct call {
    const char *name;
    int words;
    bool (*run)(char **words, struct glint_error *err);
} calls[] = {
    {"pack", 2, pack}, {"extract", 2, extract}, {"replay", 3, replay}, {"reference", 3, reference}, {"judge", 3, judge},
};

int main(int argc, char **argv) {
    struct glint_error err = {0};
    for (size_t i = 0; argc > 1 && i < sizeof calls / sizeof *calls; i++)
        if (!strcmp(argv[1], calls[i].name) && argc == 2 + calls[i].words) {
            const bool ok = calls[i].run(argv + 2, &err) && !ferror(stdout) && fflush(stdout) == 0;
            if (!ok) fprintf(stderr, "%s\n", err.code ? err.message : "stdout: not everything could be written");
            return !ok;
        }
    return 2;
}
