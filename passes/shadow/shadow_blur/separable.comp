#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "separable.pass.h"
#include "shared/push_begin.glsl"
#include "separable.pass.h"
};
#define BLURRED_SIZE ivec2(frame.size.xy)
#include "filtering/separable.glsl"

Surface surface_at(ivec2 texel) {
    Surface s;
    s.depth_m = texelFetch(depth_full, texel, 0).x;
    s.normal = texelFetch(normal_full, texel, 0).xyz;
    vec2 uv = (vec2(texel) + 0.5) / vec2(frame.size.xy);
    s.position = view_position(uv, s.depth_m, frame.view_from_uv, frame.depth_range.z);
    return s;
}

float visibility_at(ivec2 texel) {
    return dispatch_phase == 0u ? texelFetch(shadow_mask, texel, 0).x : texelFetch(across, texel, 0).x;
}

// Whether all pixels within the radius are lit, so that the blur would change none of them.
bool is_lit_around(ivec2 pixel) {
    int wide = 4 * int(reduction(frame.size)); // of the blocks of shadow_early
    if (!has_shadow_early || radius > wide) return false;
    return texelFetch(shadow_early, min(pixel / wide, textureSize(shadow_early, 0) - 1), 0).x >= 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, BLURRED_SIZE))) return;
    float visible = 1.0;
    if (!is_lit_around(pixel)) visible = blurred(pixel);
    if (dispatch_phase == 0u) imageStore(shadow_across, pixel, vec4(visible));
    else imageStore(shadow_soft, pixel, vec4(visible));
}
