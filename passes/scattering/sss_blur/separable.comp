#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "separable.pass.h"
#include "shared/push_begin.glsl"
#include "separable.pass.h"
};
#include "shared/constants.glsl"

// The profile of skin of d'Eon et al. 2007, a sum of Gaussians: variances in mm², weights of red, green and blue, each of which add up to 1.
const int GAUSSIANS = 6;
const float variance[GAUSSIANS] = float[](0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41);
const vec3 share[GAUSSIANS] = vec3[](vec3(0.233, 0.455, 0.649), vec3(0.100, 0.336, 0.344), vec3(0.118, 0.198, 0.0), vec3(0.113, 0.007, 0.007),
                                     vec3(0.358, 0.004, 0.0), vec3(0.078, 0.0, 0.0));
const float REACH_MM = 8.2; // three standard deviations of the widest

// The error function to 1.5e-7 (Abramowitz, Stegun 1964, 7.1.26).
float error_function(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * abs(x));
    float tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) * exp(-x * x);
    return x < 0.0 ? tail - 1.0 : 1.0 - tail;
}

// How much light comes from one side, up to a distance: 1/2 for an infinite one.
vec3 light_within(float mm) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < GAUSSIANS; ++i) sum += share[i] * error_function(mm * inversesqrt(2.0 * variance[i]));
    return 0.5 * sum;
}

// Sample i to one side stands for the distances from edge(i - 0.5) to edge(i + 0.5), the last one for all that is beyond.
float edge(float i) {
    float part = i / (float(reach) + 0.5);
    return REACH_MM * part * part;
}
shared vec4 samples[33]; // rgb: weight; a: distance in mm

void fill_samples() {
    for (int i = 1 + int(gl_LocalInvocationIndex); i <= reach; i += 64) {
        float from = edge(float(i) - 0.5), to = edge(float(i) + 0.5);
        samples[i] = vec4((i == reach ? vec3(0.5) : light_within(to)) - light_within(from), 0.5 * (from + to));
    }
    barrier();
}

vec3 light_at(ivec2 pixel) { return dispatch_phase == 0u ? texelFetch(lit, pixel, 0).rgb : texelFetch(across, pixel, 0).rgb; }

// What a sample adds to the pixel's own colour.
vec3 difference(ivec2 pixel, vec3 own, float depth_m) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return vec3(0.0);
    if (!(texelFetch(skin_width, pixel, 0).x > 0.0)) return vec3(0.0);
    float apart = abs(texelFetch(depth_full, pixel, 0).x - depth_m);
    vec3 light = light_at(pixel);
    return finite(vec4(light, 0.0)) ? (light - own) * clamp(1.0 - 1000.0 * apart / depth_mm, 0.0, 1.0) : vec3(0.0);
}

vec3 scattered(ivec2 pixel, vec3 own, float wide) {
    int along = dispatch_phase == 0u ? 1 : 0; // not a choice of vectors by a constant, which some drivers get wrong
    ivec2 axis = ivec2(along, 1 - along);
    float depth_m = texelFetch(depth_full, pixel, 0).x, per_uv = along == 1 ? abs(frame.uv_from_view.x) : abs(frame.uv_from_view.y);
    float px_per_mm = 0.001 * per_uv / depth_m * float(along == 1 ? frame.size.x : frame.size.y);
    vec3 change = vec3(0.0);
    for (int i = 1; i <= reach; ++i) {
        int px = int(floor(samples[i].a * wide * px_per_mm + 0.5));
        change += samples[i].rgb * (difference(pixel + px * axis, own, depth_m) + difference(pixel - px * axis, own, depth_m));
    }
    return own + change;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    fill_samples();
    if (any(greaterThanEqual(pixel, imageSize(lit_scattered)))) return;
    vec3 color = light_at(pixel);
    float wide = width * texelFetch(skin_width, pixel, 0).x;
    if (wide > 0.0) color = scattered(pixel, color, wide);
    if (dispatch_phase != 0u && wide > 0.0) color = mix(texelFetch(lit, pixel, 0).rgb, color, strength);
    if (dispatch_phase == 0u) imageStore(lit_across, pixel, vec4(color, 1.0));
    else imageStore(lit_scattered, pixel, vec4(color, 1.0));
}
