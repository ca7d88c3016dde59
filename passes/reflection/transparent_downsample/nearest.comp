#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "nearest.pass.h"
#include "shared/push_begin.glsl"
#include "nearest.pass.h"
};
#include "prepare/downsample/lobe.glsl"
#define LIST_WORD(place) texelFetch(transparent_tiles, place).x
#include "shared/work_list.glsl"

bool surface_at(ivec2 pixel, out float depth_m, out vec4 surface) {
    depth_m = texelFetch(transparent_depth, pixel, 0).x;
    surface = texelFetch(transparent_normal, pixel, 0);
    return texelFetch(transparent_color, pixel, 0).a > 0.0 && reflects(depth_m, surface.xyz);
}

void main() {
    ivec2 texel = tile_texel(reduction(frame.size)), last = ivec2(frame.size.xy) - 1;
    if (any(greaterThanEqual(texel, imageSize(transparent_depth_half)))) return;
    int scale = int(reduction(frame.size));
    float nearest_m = INFINITE;
    vec4 nearest = vec4(0.0);
    uint chosen = 0u;
    for (int i = 0; i < scale * scale && tile_works; ++i) {
        ivec2 pixel = scale * texel + ivec2(i & 1, i >> 1);
        float depth_m;
        vec4 surface;
        if (any(greaterThan(pixel, last)) || !surface_at(pixel, depth_m, surface) || depth_m >= nearest_m) continue;
        nearest_m = depth_m;
        nearest = surface;
        chosen = uint(i);
    }
    float roughness = nearest.w > 0.0 ? min(nearest.w, 1.0) : 0.0;
    Drawn ray = Drawn(vec3(0.0), 0.0);
    if (nearest_m < LARGEST) {
        vec2 uv = picked_uv(texel, chosen, frame.size);
        vec3 view = view_position(uv, nearest_m, frame.view_from_uv, frame.depth_range.z);
        ray = drawn_ray(normalize(nearest.xyz), roughness, -normalize(mat3(frame.world_from_view) * view), uvec2(texel));
    }
    imageStore(transparent_depth_half, texel, vec4(nearest_m));
    imageStore(transparent_normal_jittered, texel, vec4(ray.normal, roughness));
    imageStore(transparent_cone, texel, vec4(ray.cone));
    imageStore(transparent_pick, texel, uvec4(chosen));
}
