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
    if (texelFetch(screen_finished, pixel, 0).x != 0u) return 2u;
    return normal.w <= hq_roughness ? 0u : 1u;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.size.zw);
    uint lane = gl_LocalInvocationIndex, group = workgroup_index(), tile_total = tile_count(size);
    if (dispatch_phase == 0u) {
        uint counts = counted_tile(class_of(pixel, size));
        if (lane == 0u) imageStore(cubemap_tiles, list_texel(group), uvec4(counts));
    } else if (dispatch_phase == 1u) {
        if (64u * group >= tile_total) return;
        uvec2 sums = summed_tiles(tiles, tile_total);
        if (lane < 2u) imageStore(cubemap_groups, list_texel(2u * group + lane), uvec4(sums[lane]));
    } else {
        uint kind = class_of(pixel, size);
        Places places = places_of(tiles, groups, tile_total, kind);
        if (kind < CLASSES) imageStore(cubemap_list, list_texel(places.item), uvec4(item_of(pixel)));
        if (group > 0u) return;
        for (uint k = 0u; k < CLASSES; ++k)
            if (places.filler[k] < places.ends[k]) imageStore(cubemap_list, list_texel(places.filler[k]), uvec4(NO_ITEM));
        if (lane < 4u) imageStore(cubemap_list, ivec2(lane, 0), uvec4(places.header[lane]));
    }
}
