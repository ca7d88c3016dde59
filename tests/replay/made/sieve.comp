#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "sieve.pass.h"
#include "shared/push_begin.glsl"
#include "sieve.pass.h"
};

void close_list(writeonly uimageBuffer list, uint count) {
    uvec2 tiles = (frame.size.zw + 7u) / 8u;
    imageStore(list, 0, uvec4(max((count + 63u) / 64u, tiles.x * tiles.y)));
    imageStore(list, 1, uvec4(1u));
    imageStore(list, 2, uvec4(1u));
    imageStore(list, 3, uvec4(count));
}

void main() {
    if (gl_GlobalInvocationID != uvec3(0u)) return;
    uint a = 0u, b = 0u;
    for (uint y = 0u; y < frame.size.w; ++y)
        for (uint x = 0u; x < frame.size.z; ++x) {
            uint kind = (x + 3u * y) % 5u, item = x + (y << 16u);
            if (kind == 0u) imageStore(list_a, 256 + int(a), uvec4(item)), ++a;
            else if (kind < 3u && !empty) imageStore(list_b, 256 + int(b), uvec4(item)), ++b;
        }
    close_list(list_a, a);
    close_list(list_b, b);
}
