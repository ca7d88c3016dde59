/* Finds the targets that pipelines are compared with, once for each combination of parameters that define them. */
#include "targets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>
#include <xxhash.h>

#include "no_memory.h"

void targets_finish(struct target **targets) {
    for (struct target *target = *targets, *next; target; target = next) {
        next = target->next;
        glint_pixels_finish(&target->pixels);
        free(target->error);
        free(target);
    }
    *targets = NULL;
}

/* Reads the result in a run, which must be of this capture and answer the same question, and its standard error if the run stores one. */
static bool read_run(const char *folder, const struct target_request *request, struct target *target,
                     struct glint_error *err) {
    struct glint_capture *capture = request->capture;
    char hash[33];
    struct glint_run *run = glint_run_open(folder, err);
    if (!run) return false;
    json_t *json = json_loads(glint_run_json(run), 0, NULL), *of = json_object_get(json, "capture");
    const char *theirs = json_string_value(json_object_get(of, "xxh3_128"));
    const char *path = json_string_value(json_object_get(of, "path"));
    const struct glint_effect *effect = request->options->effect;
    bool ok = json ? glint_capture_hash(capture, hash, err) : no_memory(err, folder);
    if (ok && (!theirs || strcmp(theirs, hash) != 0))
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a run of %s (%s), found one of %s (%s)", folder,
                        glint_capture_path(capture), hash, path ? path : "another capture", theirs ? theirs : "?");
    ok = ok && glint_study_fits(run, folder, request->pipeline, effect, err) &&
         glint_study_run_result(run, effect, &target->pixels, err) &&
         glint_study_run_error(run, effect, &target->error, err);
    json_decref(json);
    glint_run_close(&run);
    return ok;
}

/* The folder that stores the reference of a capture, an effect and a question. */
static bool reference_path(const struct target_request *request, const char *question, char *path, size_t size,
                           struct glint_error *err) {
    const char *folder = request->options->reference_folder, *effect = request->options->effect->name;
    char hash[33];
    if (!glint_capture_hash(request->capture, hash, err)) return false;
    const uint64_t key = XXH3_64bits_withSeed(question, strlen(question), XXH3_64bits(hash, strlen(hash)));
    return snprintf(path, size, "%s/%s-%016llx", folder, effect, (unsigned long long)key) < (int)size ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

static bool trace_reference(const struct target_request *request, const char *folder, struct target *target,
                            struct glint_error *err) {
    const struct glint_reference_options options = {.effect = request->options->effect,
                                                    .folder = folder,
                                                    .cache = request->options->cache,
                                                    .all = request->options->all,
                                                    .keep_bytes = request->options->keep_bytes};
    const uint32_t rays = request->options->reference_rays ? request->options->reference_rays : GLINT_JUDGE_RAYS;
    struct glint_pipeline *pipeline = glint_study_reference(request->pipeline, err);
    struct glint_reference *reference =
        pipeline ? glint_reference_create(request->replay, request->capture, pipeline, &options, err) : NULL;
    const bool ok = reference &&
                    glint_reference_trace(reference, rays, request->options->reference_noise, request->progress,
                                          request->user, err) &&
                    glint_reference_pixels(reference, &target->pixels, &target->error, err);
    if (reference) glint_reference_destroy(&reference);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return ok;
}

static bool find_reference(const struct target_request *request, struct target *target, struct glint_error *err) {
    char path[4096];
    if (request->options->reference_run) return read_run(request->options->reference_run, request, target, err);
    if (!request->options->reference_folder) return trace_reference(request, NULL, target, err);
    return reference_path(request, target->question, path, sizeof path, err) &&
           trace_reference(request, path, target, err);
}

const struct target *targets_get(struct target **targets, enum glint_target kind, const struct target_request *request,
                                 struct glint_error *err) {
    char question[QUESTION_SIZE];
    study_question(request->pipeline, request->options->effect, question);
    for (struct target *target = *targets; target; target = target->next)
        if (target->kind == kind && !strcmp(target->question, question)) return target;
    struct target *target = calloc(1, sizeof *target);
    if (!target) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    target->kind = kind;
    memcpy(target->question, question, sizeof question);
    bool ok = kind == GLINT_TARGET_TRUTH ? glint_study_truth(request->capture, request->options->effect,
                                                             request->pipeline, &target->pixels, &target->error, err)
                                         : find_reference(request, target, err);
    if (!ok) targets_finish(&target);
    else target->next = *targets, *targets = target;
    return target;
}
