/* The answers that a judge compares with: found once for each question. */
#include "answers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>
#include <xxhash.h>

void answers_finish(struct answer **answers) {
    for (struct answer *answer = *answers, *next; answer; answer = next) {
        next = answer->next;
        glint_pixels_finish(&answer->pixels);
        free(answer->error);
        free(answer);
    }
    *answers = NULL;
}

/* A run's reflection, when it is a run of this capture, and its noise where it declares that. */
static bool read_run(const char *folder, struct glint_capture *capture, struct answer *answer,
                     struct glint_error *err) {
    char hash[33];
    struct glint_run *run = glint_run_open(folder, err);
    if (!run) return false;
    json_t *json = json_loads(glint_run_json(run), 0, NULL), *of = json_object_get(json, "capture");
    const char *theirs = json_string_value(json_object_get(of, "xxh3_128"));
    const char *path = json_string_value(json_object_get(of, "path"));
    bool ok = glint_capture_hash(capture, hash, err);
    if (ok && (!theirs || strcmp(theirs, hash) != 0))
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a run of %s (%s), found one of %s (%s)", folder,
                        glint_capture_path(capture), hash, path ? path : "another capture", theirs ? theirs : "?");
    ok = ok && glint_study_run_reflection(run, &answer->pixels, err) && glint_study_run_error(run, &answer->error, err);
    json_decref(json);
    glint_run_close(&run);
    return ok;
}

/* Where a reference is kept: told apart by capture and question. */
static bool kept_path(const char *folder, struct glint_capture *capture, const char *question, char *path, size_t size,
                      struct glint_error *err) {
    char hash[33];
    if (!glint_capture_hash(capture, hash, err)) return false;
    const uint64_t key = XXH3_64bits_withSeed(question, strlen(question), XXH3_64bits(hash, strlen(hash)));
    return snprintf(path, size, "%s/reference-%016llx", folder, (unsigned long long)key) < (int)size ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
}

/* With the noise that is left in it. */
static bool trace_reference(const struct asking *ask, const char *folder, struct answer *answer,
                            struct glint_error *err) {
    const struct glint_reference_options options = {
        .folder = folder, .all = ask->options->all, .keep_bytes = ask->options->keep_bytes};
    const uint32_t rays = ask->options->reference_rays ? ask->options->reference_rays : GLINT_JUDGE_RAYS;
    struct glint_pipeline *pipeline = glint_study_reference(ask->pipeline, err);
    struct glint_reference *reference =
        pipeline ? glint_reference_create(ask->replay, ask->capture, pipeline, &options, err) : NULL;
    const bool ok =
        reference &&
        glint_reference_trace(reference, rays, ask->options->reference_noise, ask->progress, ask->user, err) &&
        glint_reference_pixels(reference, &answer->pixels, &answer->error, err);
    if (reference) glint_reference_destroy(&reference);
    if (pipeline) glint_pipeline_destroy(&pipeline);
    return ok;
}

static bool find_reference(const struct asking *ask, struct answer *answer, struct glint_error *err) {
    char path[4096];
    if (ask->options->reference_run) return read_run(ask->options->reference_run, ask->capture, answer, err);
    if (!ask->options->reference_folder) return trace_reference(ask, NULL, answer, err);
    return kept_path(ask->options->reference_folder, ask->capture, answer->question, path, sizeof path, err) &&
           trace_reference(ask, path, answer, err);
}

const struct answer *answers_get(struct answer **answers, enum glint_answer kind, const struct asking *ask,
                                 struct glint_error *err) {
    char question[QUESTION_SIZE];
    study_question(ask->pipeline, question);
    for (struct answer *answer = *answers; answer; answer = answer->next)
        if (answer->kind == kind && !strcmp(answer->question, question)) return answer;
    struct answer *answer = calloc(1, sizeof *answer);
    if (!answer) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    answer->kind = kind;
    memcpy(answer->question, question, sizeof question);
    bool ok = kind == GLINT_ANSWER_TRUTH
                  ? glint_study_truth(ask->capture, ask->pipeline, &answer->pixels, &answer->error, err)
                  : find_reference(ask, answer, err);
    if (!ok) answers_finish(&answer);
    else answer->next = *answers, *answers = answer;
    return answer;
}
