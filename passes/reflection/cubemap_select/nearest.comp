#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "nearest.pass.h"
#include "shared/push_begin.glsl"
#include "nearest.pass.h"
};
#include "shared/active.glsl"
#include "shared/camera.glsl"
#define LIST_WORD(place) (has_cubemap_list ? texelFetch(cubemap_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(cubemap_best)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    uint best = 255u;
    if (tile_works && texelFetch(screen_finished, pixel, 0).x == 0u && reflects(depth_m, normal)) {
        vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
        vec3 position = mat3(frame.world_from_view) *
                        view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        best = nearest_active(position + mirror_direction(position, normal) * texelFetch(screen_travelled, pixel, 0).x);
    }
    imageStore(cubemap_best, pixel, uvec4(best));
}
