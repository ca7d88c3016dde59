#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "worker.pass.h"
#include "shared/push_begin.glsl"
#include "worker.pass.h"
};
#define LIST_WORD(place) (has_list_none ? texelFetch(list_none, place).x : has_list_a ? texelFetch(list_a, place).x : texelFetch(list_b, place).x)
#include "shared/work_list.glsl"

void main() {
    ivec2 texel = tile_texel(2.0);
    if (any(greaterThanEqual(texel, imageSize(worked)))) return;
    int kind = (texel.x + 3 * texel.y) % 5;
    float value = 10.0 + 1000.0 * float(uint(texel.x) + frame.size.z * uint(texel.y));
    if (tell && tile_range != ALL_TILES) value += float(tile_range + 1u) + (has_list_a ? 0.0 : 5.0);
    bool works = tile_works && (tell || kind == 1 || kind == 2);
    imageStore(worked, texel, vec4(works ? value : 7.0));
}
