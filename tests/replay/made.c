/* Passes for tests. Their declarations are read like those of passes/. */
#include "made.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"
#include "unit.h"
#define PASS_ID chain
#include "made/chain.pass.h"
#undef PASS_ID
#define PASS_ID cubes
#include "made/cubes.pass.h"
#undef PASS_ID
#define PASS_ID reader
#include "made/reader.pass.h"
#undef PASS_ID
#define PASS_ID sieve
#include "made/sieve.pass.h"
#undef PASS_ID
#define PASS_ID worker
#include "made/worker.pass.h"
#undef PASS_ID
#define PASS_ID forger
#include "made/forger.pass.h"
#undef PASS_ID
#define PASS_ID memory
#include "made/memory.pass.h"
#undef PASS_ID
#define PASS_ID base
#include "made/base.pass.h"
#undef PASS_ID
#define PASS_ID cast
#include "made/cast.pass.h"
#undef PASS_ID
#define PASS_ID catch
#include "made/catch.pass.h"
#undef PASS_ID
#define PASS_ID tally
#include "made/tally.pass.h"
#undef PASS_ID

#include "shared/work_list.h"
#include "rows.h"
static const struct glint_row chain_rows[] = {
#define PASS_ID chain
#include "made/chain.pass.h"
#undef PASS_ID
};
static const struct glint_row cubes_rows[] = {
#define PASS_ID cubes
#include "made/cubes.pass.h"
#undef PASS_ID
};
static const struct glint_row reader_rows[] = {
#define PASS_ID reader
#include "made/reader.pass.h"
#undef PASS_ID
};
static const struct glint_row sieve_rows[] = {
#define PASS_ID sieve
#include "made/sieve.pass.h"
#undef PASS_ID
};
static const struct glint_row worker_rows[] = {
#define PASS_ID worker
#include "made/worker.pass.h"
#undef PASS_ID
};
static const struct glint_row forger_rows[] = {
#define PASS_ID forger
#include "made/forger.pass.h"
#undef PASS_ID
};
static const struct glint_row memory_rows[] = {
#define PASS_ID memory
#include "made/memory.pass.h"
#undef PASS_ID
};
static const struct glint_row base_rows[] = {
#define PASS_ID base
#include "made/base.pass.h"
#undef PASS_ID
};
static const struct glint_row cast_rows[] = {
#define PASS_ID cast
#include "made/cast.pass.h"
#undef PASS_ID
};
static const struct glint_row catch_rows[] = {
#define PASS_ID catch
#include "made/catch.pass.h"
#undef PASS_ID
};
static const struct glint_row tally_rows[] = {
#define PASS_ID tally
#include "made/tally.pass.h"
#undef PASS_ID
};

#define DEFINE(name)                                                                                                   \
    const struct glint_pass made_##name = {.slot = #name,                                                              \
                                           .variant = "made",                                                          \
                                           .title = title_##name,                                                      \
                                           .source = source_##name,                                                    \
                                           .rows = name##_rows,                                                        \
                                           .row_count = sizeof name##_rows / sizeof name##_rows[0]}
DEFINE(chain);
DEFINE(cubes);
DEFINE(reader);
DEFINE(sieve);
DEFINE(worker);
DEFINE(forger);
DEFINE(memory);
DEFINE(tally);
DEFINE(catch);
DEFINE(cast);
DEFINE(base);

void made_init(struct made *made, const struct glint_pass *const *passes) {
    *made = (struct made){.pipeline = {.name = (char *)"made"}};
    made->pipeline.passes = made->passes;
    for (size_t i = 0; passes[i]; i++) {
        assert_true(i < MADE_MAX && passes[i]->row_count <= 64);
        snprintf(made->shaders[i], sizeof made->shaders[i], "%s/%s.comp", MADE_SHADERS, passes[i]->slot);
        for (size_t r = 0; r < passes[i]->row_count; r++) made->values[i][r] = passes[i]->rows[r].initial;
        made->passes[i] = (struct pipeline_pass){passes[i], made->values[i], made->shaders[i]};
        made->pipeline.count++;
    }
}

void made_run(struct fixture *fixture, const struct made *made, const struct glint_replay_options *options) {
    struct glint_error err = {0};
    if (!glint_replay_run(fixture->replay, &made->pipeline, options, NULL, NULL, &err)) fail_msg("%s", err.message);
    fixture_check_messages(fixture);
}

float *made_read(struct fixture *fixture, const char *name) {
    struct glint_error err = {0};
    const struct glint_image *image = glint_replay_find_image(fixture->replay, name);
    if (!image) fail_msg("no image %s", name);
    float *pixels = calloc((size_t)image->width * image->height * image->components, sizeof *pixels);
    assert_non_null(pixels);
    if (!glint_replay_read_image(fixture->replay, image, GLINT_F32, pixels, &err)) fail_msg("%s", err.message);
    return pixels;
}

void made_check_cuts(struct fixture *fixture, const struct made *made, struct glint_replay_options options) {
    struct snapshot whole, part;
    char folder[128];
    const char *slots[MADE_MAX + 1] = {NULL};
    size_t count;
    options.no_cache = true;
    made_run(fixture, made, &options);
    snapshot_take(&whole, fixture->replay);
    fixture_write_run(fixture, "whole", folder);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++) slots[i] = results[i].pass->slot;
    options.inputs = folder;
    for (size_t cut = 0; cut < count; cut++)
        for (int alone = 0; alone < 2; alone++) {
            const char *one[] = {slots[cut], NULL};
            options.passes = alone ? one : slots + cut;
            made_run(fixture, made, &options);
            snapshot_take(&part, fixture->replay);
            assert_true(snapshot_compare(&part, &whole) > 0);
            assert_true(fixture_result(fixture, slots[cut])->ran);
            snapshot_free(&part);
        }
    snapshot_free(&whole);
}
