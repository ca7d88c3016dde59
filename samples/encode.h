/* Encodes values as engines store them. Each function is the inverse of the capture reader's. */
#ifndef SAMPLES_ENCODE_H
#define SAMPLES_ENCODE_H

#include "view.h"

/* `depth` is along the view axis, INFINITY for sky; logarithmic depth is between VIEW_NEAR and VIEW_FAR. */
float encode_depth(enum glint_depth_encoding encoding, const struct view *view, float depth);
/* z of octahedral and view_xy normals is 0. */
vec3 encode_normal(enum glint_normal_encoding encoding, enum glint_normal_space space, const struct view *view,
                   vec3 normal);
float encode_roughness(enum glint_roughness_encoding encoding, float roughness);
/* The depth in engine units that corresponds to the largest value of packed motion.Z. */
#define MOTION_DEPTH_RANGE 16.0
float encode_motion_depth(enum glint_motion_depth_encoding encoding, float metres);
void encode_motion(enum glint_motion_encoding encoding, const struct view *view, const float uv[2], float out[2]);
vec3 encode_color(enum glint_color_encoding encoding, double pre_exposure, vec3 color);

/* The usual storage of an encoding: the type for the writer, and the engine's name for it. */
struct storage {
    enum glint_type type;
    const char *name;
};
struct storage storage_depth(enum glint_depth_encoding encoding);
struct storage storage_normal(enum glint_normal_encoding encoding);
struct storage storage_roughness(enum glint_roughness_encoding encoding);
struct storage storage_motion_depth(enum glint_motion_depth_encoding encoding);
struct storage storage_motion(enum glint_motion_encoding encoding);

#endif
