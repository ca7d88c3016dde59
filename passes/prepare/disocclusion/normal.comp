#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "normal.pass.h"
#include "shared/push_begin.glsl"
#include "normal.pass.h"
};

// Texels without a normal, as under sky, are of no other surface: depth decides.
bool is_other(ivec2 texel, ivec2 pixel) {
    vec3 then = texelFetch(previous_normal_kept, texel, 0).xyz, now = texelFetch(normal_full, pixel, 0).xyz;
    return normal > -1.0 && dot(then, then) > 0.25 && dot(now, now) > 0.25 && dot(normalize(then), normalize(now)) < normal;
}
#include "hidden.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(disocclusion)))) return;
    imageStore(disocclusion, pixel, vec4(hidden_at(pixel)));
    imageStore(depth_kept, pixel, texelFetch(depth_full, pixel, 0));
    imageStore(normal_kept, pixel, texelFetch(normal_full, pixel, 0));
}
