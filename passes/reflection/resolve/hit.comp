#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "color.glsl"
#include "shared/work_list.glsl"

vec4 reflected_color(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cone = has_cone_half ? texelFetch(cone_half, pixel, 0).x : 0.0;
    vec4 surface = has_normal_half ? texelFetch(normal_half, pixel, 0) : texelFetch(normal_jittered, pixel, 0);
    Ray ray = ended_ray(position, surface, normal, texelFetch(travelled, pixel, 0).x, cone);
    return color_at_end(ray, texelFetch(screen_finished, pixel, 0).x != 0u, texelFetch(cubemap_index, pixel, 0).x);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    probe_texel(pixel);
    vec4 color = tile_works && reflects(depth_m, normal) ? reflected_color(pixel, depth_m, normal) : vec4(0.0);
    imageStore(reflection_half, pixel, color);
}
