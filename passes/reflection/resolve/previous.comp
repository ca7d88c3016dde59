#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "previous.pass.h"
#include "shared/push_begin.glsl"
#include "previous.pass.h"
};
#include "before.glsl"
#include "shared/work_list.glsl"

vec4 reflected_color(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cone = has_cone_half ? texelFetch(cone_half, pixel, 0).x : 0.0;
    vec4 surface = has_normal_half ? texelFetch(normal_half, pixel, 0) : texelFetch(normal_jittered, pixel, 0);
    Ray ray = ended_ray(position, surface, normal, texelFetch(travelled, pixel, 0).x, cone);
    bool on_screen = texelFetch(screen_finished, pixel, 0).x != 0u;
    if (!on_screen) return color_at_end(ray, false, texelFetch(cubemap_index, pixel, 0).x);
    uint source;
    vec4 color = color_before(ray, source);
    if (diagnostics) imageStore(previous_source, pixel, uvec4(source));
    return color;
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    if (diagnostics) imageStore(previous_source, pixel, uvec4(0u));
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    probe_texel(pixel);
    vec4 color = tile_works && reflects(depth_m, normal) ? reflected_color(pixel, depth_m, normal) : vec4(0.0);
    imageStore(reflection_half, pixel, color);
}
