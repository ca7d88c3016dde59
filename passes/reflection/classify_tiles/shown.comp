#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "shown.pass.h"
#include "shared/push_begin.glsl"
#include "shown.pass.h"
};
#include "shared/camera.glsl"
#include "shared/shown.glsl"
#include "shared/list_maker.glsl"

// Values between the two classes count as rough: a half-resolution roughness may be a mean, which rounding can move past the limit.
uint class_of(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return 0u;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    bool shown = is_shown(pixel); // fetched before any value is used, so that the fetches do not wait for each other
    if (!shown || !(depth_m > 0.0 && depth_m < INFINITE)) return 0u; // downsample prefers pixels with a visible reflection, whatever their normal
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    bool smooth_one = roughness <= uintBitsToFloat(frame.work.z);
    bool rough_one = !smooth_one || roughness >= 0.999 * uintBitsToFloat(frame.work.w);
    return (smooth_one ? SMOOTH : 0u) | (rough_one ? ROUGH : 0u);
}

void main() { make_list(tile_list, dispatch_phase, 1.0); }
