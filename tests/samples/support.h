/* Common to the tests of samples: a folder for files, reading of captures, rays from a capture's matrices. */
#ifndef TESTS_SAMPLES_SUPPORT_H
#define TESTS_SAMPLES_SUPPORT_H

#include "glint/samples.h"
#include "unit.h"

/* Creates and removes a folder, with cmocka's signatures. */
int folder_make(void **state);
int folder_remove(void **state);
/* The path of a file in the folder; valid until the next eight calls. */
const char *in_folder(void **state, const char *name);

/* Writes a sample, or fails the test with the error's message. */
void write_sample(const char *scene, const char *path, const struct glint_sample_options *options);
struct glint_capture *open_capture(const char *path);
/* Channels of a part, separated by spaces, as floats; the caller frees. */
float *read_part(struct glint_capture *capture, const char *part, const char *channels, uint32_t *width,
                 uint32_t *height);

/* The position of the camera, from world_to_view alone. */
void camera_eye(const struct glint_camera *camera, double eye[3]);
/* The direction through the centre of a pixel, with length 1 along the view axis, from the matrices alone. */
void camera_ray(const struct glint_camera *camera, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                double direction[3]);
void camera_project(const struct glint_camera *camera, const double point[3], double uv[2]);
/* Direction of a texel by Vulkan's cube face table, not normalised. */
void vulkan_texel(uint32_t face, uint32_t x, uint32_t y, uint32_t size, double direction[3]);
/* The texel that Vulkan selects for a direction. */
void vulkan_select(const double direction[3], uint32_t size, uint32_t *face, uint32_t *x, uint32_t *y);

bool same_bytes(const char *a, const char *b);

#endif
