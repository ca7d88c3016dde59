#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "sieve.pass.h"
#include "shared/push_begin.glsl"
#include "sieve.pass.h"
};

void close_list(writeonly uimage2D list, uint count) {
    imageStore(list, ivec2(0, 0), uvec4((count + 63u) / 64u));
    imageStore(list, ivec2(1, 0), uvec4(1u));
    imageStore(list, ivec2(2, 0), uvec4(1u));
    imageStore(list, ivec2(3, 0), uvec4(count));
}

void main() {
    if (gl_GlobalInvocationID != uvec3(0u)) return;
    uint a = 0u, b = 0u;
    for (uint y = 0u; y < frame.size.w; ++y)
        for (uint x = 0u; x < frame.size.z; ++x) {
            uint kind = (x + 3u * y) % 5u, item = x + (y << 16u);
            if (kind == 0u) imageStore(list_a, ivec2(a % 256u, 1u + a / 256u), uvec4(item)), ++a;
            else if (kind < 3u && !empty) imageStore(list_b, ivec2(b % 256u, 1u + b / 256u), uvec4(item)), ++b;
        }
    close_list(list_a, a);
    close_list(list_b, b);
}
