#include "gpu.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/sort.h"
#include "plain_capture.h"
#include "unit.h"

static void require(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

void gpu_reset(struct gpu *gpu) {
    struct glint_error err = {0};
    glint_pipeline_destroy(&gpu->pipeline);
    gpu->pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    require(gpu->pipeline != NULL, &err);
    gpu->float_precision = gpu->all = false;
}

int gpu_set_up(void **state) {
    struct glint_error err = {0};
    struct gpu *gpu = calloc(1, sizeof *gpu);
    assert_non_null(gpu);
    const char *parent = getenv("TMPDIR");
    snprintf(gpu->folder, sizeof gpu->folder, "%s/glint-passes-XXXXXX", parent ? parent : "/tmp");
    assert_non_null(mkdtemp(gpu->folder));
    gpu->device =
        glint_device_create(&(struct glint_device_options){.validation = !getenv("GLINT_TEST_UNCHECKED")}, &err);
    require(gpu->device != NULL, &err);
    gpu->replay = glint_replay_create(gpu->device, &err);
    require(gpu->replay != NULL, &err);
    gpu_reset(gpu);
    *state = gpu;
    return 0;
}

static void remove_folder(const char *folder) {
    DIR *dir = opendir(folder);
    for (const struct dirent *entry; dir && (entry = readdir(dir));) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.') unlink(path);
    }
    if (dir) closedir(dir);
    rmdir(folder);
}

int gpu_tear_down(void **state) {
    struct gpu *gpu = *state;
    const char *last = "";
    uint32_t messages = glint_device_messages(gpu->device, &last);
    if (messages > 0) fprintf(stderr, "validation: %u messages, the last one: %s\n", messages, last);
    glint_replay_load(gpu->replay, NULL, NULL);
    glint_capture_close(&gpu->capture);
    glint_pipeline_destroy(&gpu->pipeline);
    glint_replay_destroy(&gpu->replay);
    glint_device_destroy(&gpu->device);
    remove_folder(gpu->folder);
    free(gpu);
    return messages > 0 ? -1 : 0;
}

void gpu_set(struct gpu *gpu, const char *assignment) {
    struct glint_error err = {0};
    require(glint_pipeline_set(gpu->pipeline, assignment, &err), &err);
}

void gpu_use(struct gpu *gpu, const char *assignment) {
    struct glint_error err = {0};
    require(glint_pipeline_use(gpu->pipeline, assignment, &err), &err);
}

void gpu_without(struct gpu *gpu, const char *const *slots) {
    char assignment[64];
    for (; *slots; slots++) {
        snprintf(assignment, sizeof assignment, "%s=none", *slots);
        gpu_use(gpu, assignment);
    }
}

float *gpu_part(struct gpu *gpu, const char *name, const char *const *channels, size_t count) {
    struct glint_error err = {0};
    const struct glint_part_info *info = glint_capture_find(gpu->capture, name);
    assert_non_null(info);
    float *values = malloc((size_t)info->width * info->height * count * sizeof *values);
    assert_non_null(values);
    if (!glint_capture_read(gpu->capture, info, channels, count, GLINT_F32, values, 0, &err))
        fail_msg("%s", err.message);
    return values;
}

void gpu_shader(struct gpu *gpu, const char *slot, const char *file) {
    struct glint_error err = {0};
    char assignment[1024];
    snprintf(assignment, sizeof assignment, "%s=%s/%s", slot, GLINT_TEST_SHADERS, file);
    require(glint_pipeline_shader(gpu->pipeline, assignment, &err), &err);
}

void plain_capture(const char *path, const struct plain *plain) {
    struct glint_error err = {0};
    require(plain_write(path, plain, &err), &err);
}

const char *gpu_path(const struct gpu *gpu, const char *name, char path[256]) {
    snprintf(path, 256, "%s/%s.exr", gpu->folder, name);
    return path;
}

void gpu_load(struct gpu *gpu, const char *name) {
    struct glint_error err = {0};
    char path[256];
    require(glint_replay_load(gpu->replay, NULL, &err), &err);
    glint_capture_close(&gpu->capture);
    gpu->capture = glint_capture_open(gpu_path(gpu, name, path), NULL, &err);
    require(gpu->capture != NULL, &err);
    require(glint_replay_load(gpu->replay, gpu->capture, &err), &err);
}

void gpu_sample(struct gpu *gpu, const char *scene, const char *name, const struct glint_sample_options *options) {
    struct glint_error err = {0};
    char path[256];
    struct glint_sample_options few = *options;
    if (few.light_samples == 0) few.light_samples = 4; /* the noise of baked light does not matter here */
    if (access(gpu_path(gpu, name, path), R_OK) != 0)
        require(glint_sample_write(scene, path, &few, NULL, NULL, &err), &err);
    gpu_load(gpu, name);
}

void gpu_run(struct gpu *gpu) {
    struct glint_error err = {0};
    struct glint_replay_options options = {
        .diagnostics = true, .float_precision = gpu->float_precision, .all = gpu->all};
    require(glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err), &err);
}

static void *read_texels(struct gpu *gpu, const char *name, enum glint_type type, uint32_t *width, uint32_t *height) {
    struct glint_error err = {0};
    const struct glint_image *image = glint_replay_find_image(gpu->replay, name);
    if (!image) fail_msg("image %s: the run has none", name);
    if (width) *width = image->width;
    if (height) *height = image->height;
    void *out = malloc((size_t)image->width * image->height * image->components * sizeof(float));
    assert_non_null(out);
    require(glint_replay_read_image(gpu->replay, image, type, out, &err), &err);
    return out;
}

float *gpu_floats(struct gpu *gpu, const char *image, uint32_t *width, uint32_t *height) {
    return read_texels(gpu, image, GLINT_F32, width, height);
}

uint32_t *gpu_uints(struct gpu *gpu, const char *image, uint32_t *width, uint32_t *height) {
    return read_texels(gpu, image, GLINT_U32, width, height);
}

double quantile(double *values, size_t count, double part) {
    assert_true(count > 0);
    glint_sort_doubles(values, count);
    size_t i = (size_t)(part * (double)count);
    return values[i < count ? i : count - 1];
}

const struct glint_pass_result *gpu_result(const struct gpu *gpu, const char *slot) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(gpu->replay, &count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(results[i].pass->slot, slot)) return &results[i];
    fail_msg("the pipeline has no slot %s", slot);
    return NULL;
}
