/* Vectors of three floats: points, directions and linear Rec. 709 colours. */
#ifndef SAMPLES_VEC_H
#define SAMPLES_VEC_H

#include <math.h>
#include <stdint.h>

#define PI_F 3.14159265358979f

typedef struct vec3 {
    float x, y, z;
} vec3;

static inline vec3 v3(float x, float y, float z) {
    return (vec3){x, y, z};
}
static inline vec3 gray(float v) {
    return v3(v, v, v);
}
static inline vec3 add(vec3 a, vec3 b) {
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline vec3 sub(vec3 a, vec3 b) {
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline vec3 times(vec3 a, vec3 b) {
    return v3(a.x * b.x, a.y * b.y, a.z * b.z);
}
static inline vec3 scale(vec3 a, float s) {
    return v3(a.x * s, a.y * s, a.z * s);
}
/* a + b·s */
static inline vec3 along(vec3 a, vec3 b, float s) {
    return v3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}
static inline vec3 mix(vec3 a, vec3 b, float t) {
    return add(scale(a, 1 - t), scale(b, t));
}
static inline float dot(vec3 a, vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline float length(vec3 a) {
    return sqrtf(dot(a, a));
}
static inline float luminance(vec3 c) {
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}
static inline vec3 cross(vec3 a, vec3 b) {
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* The zero vector stays zero. */
static inline vec3 unit(vec3 a) {
    float l = length(a);
    return l > 0 ? scale(a, 1 / l) : a;
}
/* Mirror direction of `to_eye` about `normal`. */
static inline vec3 reflected(vec3 to_eye, vec3 normal) {
    return sub(scale(normal, 2 * dot(to_eye, normal)), to_eye);
}
/* Two axes that form a right-handed frame with the unit vector n (Duff et al. 2017, "Building an orthonormal basis, revisited"). */
static inline void frame_of(vec3 n, vec3 *t, vec3 *b) {
    float sign = copysignf(1, n.z), a = -1 / (sign + n.z), c = n.x * n.y * a;
    *t = v3(1 + sign * n.x * n.x * a, sign * c, -sign * n.x);
    *b = v3(c, sign + n.y * n.y * a, -n.y);
}

static inline float clampf(float v, float low, float high) {
    return v >= low ? v > high ? high : v : low; /* low where it is no number */
}
static inline float smooth(float low, float high, float v) {
    float t = clampf((v - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

#endif
