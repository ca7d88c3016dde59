#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "map.pass.h"
#include "shared/push_begin.glsl"
#include "map.pass.h"
};
#include "shared/camera.glsl"
#include "shared/sun.glsl"

// The part of the compared texels that let the sun pass; points outside of the map are lit.
float lit_by_map(vec3 world, vec3 normal) {
    ivec2 size = textureSize(shadow_map, 0);
    vec4 at = frame.shadow_uv_from_world * vec4(world, 1.0);
    vec3 across = vec3(frame.shadow_uv_from_world[0].x, frame.shadow_uv_from_world[1].x, frame.shadow_uv_from_world[2].x);
    float texel_m = at.w / (length(across) * float(size.x));
    at = frame.shadow_uv_from_world * vec4(world + offset * texel_m * normal, 1.0);
    if (!(at.w > 0.0)) return 1.0;
    vec3 place = at.xyz / at.w;
    if (!(all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(1.0))))) return 1.0;
    ivec2 first = ivec2(floor(place.xy * vec2(size) - 0.5 * float(taps - 1)));
    float deep = place.z * frame.shadow_depth.x, bias = bias_part * frame.shadow_depth.y;
    int lit_texels = 0;
    for (int y = 0; y < taps; ++y)
        for (int x = 0; x < taps; ++x) {
            float stored = texelFetch(shadow_map, clamp(first + ivec2(x, y), ivec2(0), size - 1), 0).x;
            if (!(deep > stored * frame.shadow_depth.x + bias)) ++lit_texels;
        }
    return float(lit_texels) / float(taps * taps);
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
        else if (reflects(depth_m, normal)) visible = lit_by_map(mat3(frame.world_from_view) * view, normalize(normal));
    }
    imageStore(shadow_mask, pixel, vec4(visible));
}
