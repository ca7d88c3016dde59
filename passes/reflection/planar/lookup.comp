#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "lookup.pass.h"
#include "shared/push_begin.glsl"
#include "lookup.pass.h"
};
#include "shared/camera.glsl"
#define LIST_WORD(place) texelFetch(water_tiles, place).x
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

const float LEAST_RISE = 1e-3; // a ray that a ripple reflects downwards hits another ripple and continues nearly horizontally

vec3 mirror_ray(vec3 towards, vec3 normal, vec3 up) {
    vec3 ray = reflect(towards, normal);
    return normalize(ray + max(LEAST_RISE - dot(ray, up), 0.0) * up);
}

// A perturbed ray deviates from the one that the map was rendered for. It is assumed to end at about the depth that the map shows, and is
// sampled where the mirrored camera sees that end.
vec4 color_at_end(vec3 position, vec3 ray) {
    vec4 start = frame.mirror_uv_from_world * vec4(position, 1.0), along = frame.mirror_uv_from_world * vec4(ray, 0.0), end = start;
    for (int i = 0; i <= refinements && near; ++i) {
        if (!(end.w > 0.0)) return vec4(0.0);
        float depth_m = textureLod(sampler2D(planar_depth, nearest_clamp), end.xy / end.w, 0.0).x;
        float travelled_m = max((depth_m - start.w) / along.w, 0.0);
        probe(PROBE_mirrored_depth, vec4(end.xy / end.w * vec2(textureSize(planar_depth, 0)), depth_m, travelled_m));
        end = along.w > 0.0 && travelled_m < LARGEST ? start + travelled_m * along : along;
    }
    if (!near) end = along;
    if (!(end.w > 0.0)) return vec4(0.0);
    vec2 uv = end.xy / end.w;
    bool shown = uv == clamp(uv, 0.0, 1.0);
    vec3 color = textureLod(sampler2D(planar_color, linear_clamp), uv, 0.0).rgb;
    probe(PROBE_sample, vec4(IMAGE_planar_color, uv * vec2(textureSize(planar_color, 0)), float(shown)), vec4(color, 0.0));
    return shown && finite(vec4(color, 0.0)) ? vec4(color, 1.0) : vec4(0.0);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(planar_reflection)))) return;
    float depth_m = texelFetch(water_depth, pixel, 0).x;
    vec3 normal = texelFetch(water_normal, pixel, 0).xyz;
    vec4 color = vec4(0.0);
    probe_pixel(pixel);
    if (tile_works && reflects(depth_m, normal)) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        vec3 up = frame.mirror_plane.w < 0.0 ? -frame.mirror_plane.xyz : frame.mirror_plane.xyz; // towards the side of the camera
        color = color_at_end(position, mirror_ray(normalize(position), perturb ? normalize(normal) : up, up));
    }
    imageStore(planar_reflection, pixel, color);
}
