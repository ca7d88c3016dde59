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

/* A run's reflection, when it is a run of this capture. */
static bool read_run(const char *folder, struct glint_capture *capture, struct glint_pixels *pixels,
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
    ok = ok && glint_study_run_reflection(run, pixels, err);
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

enum { OUTPUTS = 32 };

/* What may be the reflection; the other images need not stay. */
static void list_outputs(const struct glint_pipeline *pipeline, const char *outputs[OUTPUTS]) {
    size_t count = 0;
    for (size_t p = 0; p < glint_pipeline_pass_count(pipeline); p++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, p);
        for (size_t r = 0; r < pass->row_count && count < OUTPUTS - 1; r++)
            if (pass->rows[r].kind == GLINT_ROW_WRITE && pass->rows[r].size == GLINT_SIZE_FULL &&
                !strcmp(pass->rows[r].unit, "radiance"))
                outputs[count++] = pass->rows[r].name;
    }
    outputs[count] = NULL;
}

static bool replay_reference(const struct asking *ask, const char *keep, struct glint_pixels *pixels,
                             struct glint_error *err) {
    struct glint_pipeline *reference = glint_study_reference(ask->pipeline, err);
    const char *outputs[OUTPUTS];
    /* Its images are floats: what it is off by should not be how it is stored. */
    const struct glint_replay_options options = {
        .all = ask->options->all, .float_precision = true, .outputs = outputs, .keep_bytes = ask->options->keep_bytes};
    if (reference) list_outputs(reference, outputs);
    bool ok = reference && glint_replay_run(ask->replay, reference, &options, ask->progress, ask->user, err) &&
              glint_study_reflection(ask->replay, pixels, err) &&
              (!keep || glint_replay_write(ask->replay, keep, NULL, NULL, err));
    if (reference) glint_pipeline_destroy(&reference);
    return ok;
}

static bool find_reference(const struct asking *ask, const char *question, struct glint_pixels *pixels,
                           struct glint_error *err) {
    char path[4096];
    struct glint_error ignored = {0};
    if (ask->options->reference_run) return read_run(ask->options->reference_run, ask->capture, pixels, err);
    if (!ask->options->reference_folder) return replay_reference(ask, NULL, pixels, err);
    if (!kept_path(ask->options->reference_folder, ask->capture, question, path, sizeof path, err)) return false;
    if (read_run(path, ask->capture, pixels, &ignored)) return true;
    glint_pixels_finish(pixels);
    return replay_reference(ask, path, pixels, err);
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
                  : find_reference(ask, question, &answer->pixels, err);
    if (!ok) answers_finish(&answer);
    else answer->next = *answers, *answers = answer;
    return answer;
}
