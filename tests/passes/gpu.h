/* Common to the device tests of passes/: a replay on the test device, and captures in a folder of their own. Every error is a failed
   assertion. */
#ifndef GLINT_TESTS_PASSES_GPU_H
#define GLINT_TESTS_PASSES_GPU_H

#include "glint/replay.h"
#include "glint/samples.h"

struct plain;
struct gpu {
    struct glint_device *device;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    bool float_precision, all;
    char folder[64];
};

/* Setup and teardown of a cmocka group: *state is a struct gpu with the pipeline of plain.json. The teardown fails if the validation
   layer reported anything, unless GLINT_TEST_UNCHECKED is set, for mutants. */
int gpu_set_up(void **state);
int gpu_tear_down(void **state);
/* Creates the pipeline of plain.json again. */
void gpu_reset(struct gpu *gpu);
void gpu_set(struct gpu *gpu, const char *assignment);
void gpu_use(struct gpu *gpu, const char *assignment);
/* Sets slots to none; the list ends with NULL. */
void gpu_without(struct gpu *gpu, const char *const *slots);
void gpu_shader(struct gpu *gpu, const char *slot, const char *file);
/* A path in the folder; valid until the next call with the same buffer. */
const char *gpu_path(const struct gpu *gpu, const char *name, char path[256]);
/* Writes a capture there. */
void plain_capture(const char *path, const struct plain *plain);
/* Writes the sample as `name` unless it exists, and loads it. */
void gpu_sample(struct gpu *gpu, const char *scene, const char *name, const struct glint_sample_options *options);
void gpu_load(struct gpu *gpu, const char *name);
/* Runs with diagnostics. */
void gpu_run(struct gpu *gpu);
/* Whether a slot of the last run ran, and why; fails without such a slot. */
const struct glint_pass_result *gpu_result(const struct gpu *gpu, const char *slot);
/* Reads an image of the last run; the caller frees it. width and height may be NULL. */
float *gpu_floats(struct gpu *gpu, const char *image, uint32_t *width, uint32_t *height);
uint32_t *gpu_uints(struct gpu *gpu, const char *image, uint32_t *width, uint32_t *height);

/* Reads channels of a part of the capture, interleaved; the caller frees them. */
float *gpu_part(struct gpu *gpu, const char *name, const char *const *channels, size_t count);

/* The value below which this fraction of the values lies; sorts them. */
double quantile(double *values, size_t count, double part);

#endif
