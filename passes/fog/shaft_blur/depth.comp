#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "depth.pass.h"
#include "shared/push_begin.glsl"
#include "depth.pass.h"
};
#include "shared/camera.glsl"

// Sky lies as far as sky.
bool is_as_far(float own_m, float other_m) {
    if (!(own_m < LARGEST) || !(other_m < LARGEST)) return depth_part >= 10.0 || (!(own_m < LARGEST) && !(other_m < LARGEST));
    return depth_part >= 10.0 || abs(own_m - other_m) <= depth_part * min(own_m, other_m);
}

float lit_at(ivec2 texel) { return dispatch_phase == 0u ? texelFetch(shaft_half, texel, 0).x : texelFetch(across, texel, 0).x; }

float blurred(ivec2 texel) {
    float own_m = texelFetch(depth_half, texel, 0).x, sum = 0.0, total = 0.0;
    ivec2 axis = ivec2(dispatch_phase == 0u ? 1 : 0, dispatch_phase == 0u ? 0 : 1);
    for (int i = -radius; i <= radius; ++i) {
        ivec2 at = texel + i * axis;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(frame.size.zw)))) continue;
        if (i != 0 && !is_as_far(own_m, texelFetch(depth_half, at, 0).x)) continue;
        float weight = radius > 0 && abs(i) == radius ? 0.5 : 1.0;
        sum += weight * (1.0 - lit_at(at));
        total += weight;
    }
    return 1.0 - sum / total; // exactly 1 if all are
}

// If none of the four texels lies as far as the pixel, all count.
float upscaled(ivec2 pixel) {
    vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5, part = place - floor(place);
    float own_m = texelFetch(depth_full, pixel, 0).x, sum = 0.0, total = 0.0, sum_of_all = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        ivec2 texel = clamp(ivec2(floor(place)) + ivec2(i & 1, i >> 1), ivec2(0), ivec2(frame.size.zw) - 1);
        float weight = side.x * side.y, shaded = 1.0 - texelFetch(mixed, texel, 0).x;
        sum_of_all += weight * shaded;
        if (!is_as_far(own_m, texelFetch(depth_half, texel, 0).x)) continue;
        sum += weight * shaded;
        total += weight;
    }
    return 1.0 - (total > 0.0 ? sum / total : sum_of_all);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase == 2u) {
        if (all(lessThan(at, ivec2(frame.size.xy)))) imageStore(shafts, at, vec4(upscaled(at)));
        return;
    }
    if (any(greaterThanEqual(at, ivec2(frame.size.zw)))) return;
    if (dispatch_phase == 0u) imageStore(shaft_across, at, vec4(blurred(at)));
    else imageStore(shaft_blurred, at, vec4(blurred(at)));
}
