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
#include "shared/compact.glsl"

const int TILE = 4; // pixels; an invocation lists one

bool worth(ivec2 pixel) {
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    if (!reflects(depth_m, normal.xyz) || normal.w > max_roughness) return false;
    uint chosen = texelFetch(pick, pixel, 0).x;
    vec2 at = picked_position(pixel, chosen, frame.size);
    ivec2 full = min(ivec2(at), ivec2(frame.size.xy) - 1);
    vec4 base = texelFetch(albedo_full, full, 0);
    vec3 f0 = reflectance_at_normal(base.rgb, base.a, texelFetch(specular_full, full, 0).x);
    if (max(f0.r, max(f0.g, f0.b)) <= min_reflectance) return false;
    if (!by_view) return true;
    vec3 position = mat3(frame.world_from_view) *
                    view_position(at / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    return dot(mirror_direction(position, normal.xyz), -normalize(position)) < viewer_to;
}

// Asked for the sixteen pixels of a tile one after the other, so that the tile is looked at once.
ivec2 tile_known = ivec2(-1);
bool tile_worth = false;

uint class_of(ivec2 pixel) {
    ivec2 tile = pixel / TILE;
    if (tile != tile_known) {
        tile_known = tile;
        tile_worth = false;
        ivec2 last = ivec2(frame.size.zw) - 1;
        for (int i = 0; i < TILE * TILE && !tile_worth; ++i)
            tile_worth = worth(min(tile * TILE + ivec2(i % TILE, i / TILE), last));
    }
    imageStore(screen_rejected, pixel, uvec4(tile_worth ? 0u : 1u));
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    if (!tile_worth || !reflects(texelFetch(depth_half, pixel, 0).x, normal.xyz)) return CLASSES;
    return normal.w <= hq_roughness ? 0u : 1u;
}

void main() { list_block(screen_list); }
