#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "mips_sparse.pass.h"
#include "shared/push_begin.glsl"
#include "mips_sparse.pass.h"
};
#include "mips.glsl"

const uint LEAVE = 3u; // the dispatch phase after those of mips.glsl

uvec4 sides_in_block(ivec2 block, int level) {
    uvec4 all;
    for (int i = 0; i < 4; ++i) all[i] = texelFetch(sides, min(block + ivec2(i & 1, i >> 1), textureSize(sides, level) - 1), level).x;
    return all;
}

// Whether the texel of the next coarser level shows the surface of a texel. itself: it does since it was picked from this texel.
bool stands_for(ivec2 texel, int level, out bool itself) {
    ivec2 home = texel >> 1;
    itself = false;
    if (level + 1 >= textureQueryLevels(normals)) return false;
    if (any(greaterThanEqual(home, level_size(level + 1))) || !reflects(1.0, texelFetch(normals, home, level + 1).xyz)) return false;
    uint own = uint(texel.x & 1) | uint(texel.y & 1) << 1;
    uint from = picked_in_block(uint(texelFetch(vertex_normals, home, level + 1).w), level + 1);
    itself = from == own;
    return open_in_block(sides_in_block(2 * home, level), from)[own] > 0.0;
}

// Whether the ray of a texel is left to a coarser level, whose texel shows its surface.
bool is_left(ivec2 texel) {
    vec4 surface = texelFetch(normals, texel, 0);
    bool itself;
    if (!reflects(1.0, surface.xyz) || surface.w <= mip1_roughness || !stands_for(texel, 0, itself)) return false;
    if (!itself) return true;
    return surface.w > mip2_roughness && stands_for(texel >> 1, 1, itself) && !itself;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase != LEAVE) make_levels();
    else if (all(lessThan(texel, imageSize(untraced)))) {
        bool left = is_left(texel);
        imageStore(untraced, texel, uvec4(left ? 1u : 0u));
        if (left) imageStore(normal_jittered, texel, vec4(0.0, 0.0, 0.0, texelFetch(normals, texel, 0).w));
    }
}
