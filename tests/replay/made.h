/* Passes for tests with shaders under made/, and pipelines of them. */
#ifndef GLINT_TEST_MADE_H
#define GLINT_TEST_MADE_H

#include "fixture.h"
#include "pipeline.h"

extern const struct glint_pass made_chain, made_cubes, made_reader, made_sieve, made_worker, made_forger, made_memory,
    made_base, made_cast, made_catch, made_tally;

enum { MADE_MAX = 8 };
struct made {
    struct glint_pipeline pipeline;
    struct pipeline_pass passes[MADE_MAX];
    char shaders[MADE_MAX][512];
    double values[MADE_MAX][64];
};
/* `passes` is NULL-terminated and sorted by slot. */
void made_init(struct made *made, const struct glint_pass *const *passes);
#define MADE(made, ...) made_init(made, (const struct glint_pass *const[]){__VA_ARGS__, NULL})
void made_run(struct fixture *fixture, const struct made *made, const struct glint_replay_options *options);
/* Reads an image of the last run as floats; the caller frees it. */
float *made_read(struct fixture *fixture, const char *name);
/* Every suffix of the pipeline, and every single pass, starting from the images of the whole run, must give the same bits. */
void made_check_cuts(struct fixture *fixture, const struct made *made, struct glint_replay_options options);

#endif
