#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "map.pass.h"
#include "shared/push_begin.glsl"
#include "map.pass.h"
};
#include "shared/camera.glsl"
#include "shared/shadow_map.glsl"
#include "shared/sun.glsl"

// Compared above the surface, so that steep ones do not shade themselves.
float lit_above(vec3 world, vec3 normal) {
    return lit_by_map(world + offset * shadow_texel_m(world) * normal, taps, bias_part * frame.shadow_depth.y);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shadow_mask)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x, visible = 1.0;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz;
    if (mask == mask_captured && depth_m > 0.0 && depth_m < LARGEST) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        if (textureSize(sun_mask, 0) == ivec2(frame.size.xy)) visible = valid_mask(texelFetch(sun_mask, pixel, 0).x);
        else if (reflects(depth_m, normal)) visible = lit_above(mat3(frame.world_from_view) * view, normalize(normal));
    }
    imageStore(shadow_mask, pixel, vec4(visible));
}
