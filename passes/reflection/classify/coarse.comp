#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "coarse.pass.h"
#include "shared/push_begin.glsl"
#include "coarse.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/list_maker.glsl"

const int TILE = 4; // pixels, either way

bool worth(ivec2 pixel) {
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    if (!reflects(depth_m, normal.xyz) || normal.w > max_roughness) return false;
    uint chosen = texelFetch(pick, pixel, 0).x;
    vec2 at = picked_position(pixel, chosen, frame.size);
    ivec2 full = min(ivec2(at), ivec2(frame.size.xy) - 1);
    vec4 base = texelFetch(albedo_full, full, 0);
    vec3 f0 = reflectance_at_normal(base.rgb, base.a, texelFetch(specular_full, full, 0).x, frame.material.x);
    if (max(f0.r, max(f0.g, f0.b)) <= min_reflectance) return false;
    if (!by_view) return true;
    vec3 position = mat3(frame.world_from_view) *
                    view_position(at / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    return dot(mirror_direction(position, normal.xyz), -normalize(position)) < viewer_to;
}

shared uint tile_worth[gl_WorkGroupSize.x * gl_WorkGroupSize.y / uint(TILE * TILE)];

void reject_tiles() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), local = ivec2(gl_LocalInvocationID.xy) / TILE;
    int tile = local.y * int(gl_WorkGroupSize.x) / TILE + local.x;
    if (gl_LocalInvocationIndex < tile_worth.length()) tile_worth[gl_LocalInvocationIndex] = 0u;
    barrier();
    bool shown = all(lessThan(pixel, ivec2(frame.size.zw)));
    if (shown && worth(pixel)) atomicOr(tile_worth[tile], 1u);
    barrier();
    if (shown) imageStore(screen_rejected, pixel, uvec4(1u - tile_worth[tile]));
}

uint class_of(ivec2 texel) {
    if (any(greaterThanEqual(texel, ivec2(frame.size.zw)))) return 0u;
    vec4 normal = texelFetch(normal_jittered, texel, 0);
    bool traced = texelFetch(rejected, texel, 0).x == 0u && reflects(texelFetch(depth_half, texel, 0).x, normal.xyz);
    return !traced ? 0u : normal.w <= hq_roughness ? SMOOTH : ROUGH;
}

void main() {
    if (dispatch_phase == 0u) reject_tiles();
    else make_list(screen_list, dispatch_phase - 1u, reduction(frame.size));
}
