#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "tiles.pass.h"
#include "shared/push_begin.glsl"
#include "tiles.pass.h"
};
#include "shared/camera.glsl"
#include "shared/compact.glsl"

uint class_of(ivec2 pixel, ivec2 size) {
    if (any(greaterThanEqual(pixel, size))) return CLASSES;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    if (!reflects(texelFetch(depth_half, pixel, 0).x, normal.xyz)) return CLASSES;
    return normal.w <= hq_roughness ? 0u : 1u;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.size.zw);
    if (dispatch_phase == 0u) count_tile(screen_tiles, class_of(pixel, size));
    else if (dispatch_phase == 1u) sum_tiles(tiles, screen_groups, tile_count(size));
    else store_items(tiles, groups, screen_list, tile_count(size), pixel, class_of(pixel, size));
}
