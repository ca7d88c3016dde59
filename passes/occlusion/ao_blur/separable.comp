#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "separable.pass.h"
#include "shared/push_begin.glsl"
#include "separable.pass.h"
};
#define BLURRED_SIZE ivec2(frame.size.zw)
#include "filtering/separable.glsl"

Surface surface_at(ivec2 texel) {
    Surface s;
    s.depth_m = texelFetch(depth_half, texel, 0).x;
    s.normal = texelFetch(normal_half, texel, 0).xyz;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    s.position = view_position(uv, s.depth_m, frame.view_from_uv, frame.depth_range.z);
    return s;
}

float visibility_at(ivec2 texel) {
    return dispatch_phase == 0u ? texelFetch(occlusion_half, texel, 0).x : texelFetch(across, texel, 0).x;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(frame.size.zw)))) return;
    if (dispatch_phase == 0u) imageStore(occlusion_across, texel, vec4(blurred(texel)));
    else imageStore(occlusion_blurred, texel, vec4(blurred(texel)));
}
