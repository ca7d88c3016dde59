#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "shared/camera.glsl"
#include "shared/fog.glsl"

vec3 sky_color(vec3 direction) { return textureLod(samplerCube(sky, linear_clamp), direction, 0.0).rgb; }

// The picture where a ray ended. `end` is a position, or a direction when the ray went on for ever.
vec4 screen_color(vec3 end, bool endless) {
    float depth_m = end.z * frame.depth_range.z;
    if (!(depth_m > 0.0)) return vec4(0.0);
    vec2 uv = clamp(project(end, frame.uv_from_view, frame.depth_range.z), 0.0, 1.0);
    ivec2 pixel = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    if (check_depth && !endless) {
        float seen_m = texelFetch(depth_full, pixel, 0).x;
        if (!(abs(seen_m - depth_m) <= depth_tolerance * depth_m)) return vec4(0.0);
    }
    return vec4(filter_color ? textureLod(sampler2D(lit, linear_clamp), uv, 0.0).rgb : texelFetch(lit, pixel, 0).rgb, 1.0);
}

vec4 cubemap_lookup(vec3 from_center, vec3 direction, uint place) {
    vec4 at = vec4(from_center, place);
    vec4 color = filter_color ? textureLod(samplerCubeArray(cubemap_color, linear_clamp), at, 0.0)
                              : textureLod(samplerCubeArray(cubemap_color, nearest_clamp), at, 0.0);
    if (color.a < 1.0) color.rgb += sky_color(direction) * (1.0 - color.a);
    return vec4(color.rgb, 1.0);
}

vec3 through_fog(vec3 color, vec3 position, vec3 direction, float travelled_m) {
    float height = frame.fog_height.x + dot(position, frame.up.xyz);
    float depth = fog_optical_depth(frame.fog_color.w, height, dot(direction, frame.up.xyz), frame.fog_height.y, travelled_m);
    vec3 target = fog_target == fog_target_sky && frame.counts.w > 0u ? sky_color(direction) : frame.fog_color.rgb;
    return mix(color, target, fog_factor(depth));
}

vec4 reflected_color(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(position, normal);
    float travelled_m = texelFetch(travelled, pixel, 0).x;
    bool endless = !(travelled_m < LARGEST);
    vec3 end = endless ? direction : position + direction * travelled_m;
    vec4 color;
    if (texelFetch(screen_finished, pixel, 0).x != 0u) {
        color = screen_color(mat3(frame.view_from_world) * end, endless);
    } else {
        uint place = texelFetch(cubemap_index, pixel, 0).x;
        if (place < frame.counts.x) {
            vec3 center = texelFetch(active_center, ivec2(place, 0), 0).xyz;
            color = cubemap_lookup(endless ? direction : end - center, direction, place);
        } else if (endless) {
            color = vec4(sky_color(direction), 1.0);
        } else {
            return vec4(0.0);
        }
    }
    if (fog && frame.fog_color.w > 0.0) color.rgb = through_fog(color.rgb, position, direction, travelled_m);
    return color;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    vec4 color = reflects(depth_m, normal) ? reflected_color(pixel, depth_m, normal) : vec4(0.0);
    imageStore(reflection_half, pixel, color);
}
