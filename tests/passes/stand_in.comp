#version 460
// Stands in for resolve/hit: colours whose statistics are known. texel_scale chooses: 1 noise, evenly distributed in [0, 2);
// 2 the same with a hundredth of NaN and infinity; 3 the depth; 4 the normal;
// 5 the roughness.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "shared/constants.glsl"
#include "shared/random.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    vec4 u = random4(uvec2(pixel), random_frame(), 77u);
    vec4 color = vec4(2.0 * u.xyz, 1.0);
    if (texel_scale == 2.0 && u.w < 0.01) color.rgb = vec3(u.w < 0.005 ? INFINITE : sqrt(-1.0 - u.x));
    if (texel_scale == 3.0) color.rgb = vec3(texelFetch(depth_half, pixel, 0).x);
    if (texel_scale == 4.0) color.rgb = texelFetch(normal_jittered, pixel, 0).xyz;
    if (texel_scale == 5.0) color.rgb = vec3(texelFetch(normal_jittered, pixel, 0).w);
    imageStore(reflection_half, pixel, color);
}
