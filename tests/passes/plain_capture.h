/* The smallest capture that traces: a plane of one roughness that faces the camera. */
#ifndef GLINT_TESTS_PASSES_PLAIN_CAPTURE_H
#define GLINT_TESTS_PASSES_PLAIN_CAPTURE_H

#include <stdint.h>

/* The camera at the origin looks along -z at the plane z = -5 m with the given vertical field of view. No cube maps. */
void plain_capture(const char *path, uint32_t width, uint32_t height, float roughness, double fov_y_degrees);

#endif
