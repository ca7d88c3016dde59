#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "sieve.pass.h"
#include "shared/push_begin.glsl"
#include "sieve.pass.h"
};
#include "shared/work_list.h"

uint count = 0u; // of tiles that are in the lists

void add_kind(bool rough, bool smooth_one) {
    for (uint y = 0u; y < frame.size.w; ++y)
        for (uint x = 0u; x < frame.size.z; ++x) {
            uint kind = (x + 3u * y) % 5u, item = x + (y << 16u);
            if (rough == (kind == 0u) && smooth_one == (kind == 1u || kind == 2u)) {
                imageStore(list_a, LIST_ITEMS + int(count), uvec4(item));
                imageStore(list_b, LIST_ITEMS + int(count), uvec4(item));
                ++count;
            }
        }
}

// 64 tiles of one texel to a workgroup.
void close_range(int range, uint begin, uint end) {
    uvec4 groups = uvec4((end - begin + 63u) / 64u, 1u, 1u, end - begin);
    for (int i = 0; i < 4; ++i) {
        imageStore(list_a, 12 * range + 8 + i, uvec4(groups[i]));
        imageStore(list_b, 12 * range + 8 + i, uvec4(groups[i]));
    }
    for (int i = 0; i < 2; ++i) {
        imageStore(list_a, LIST_RANGES + 2 * range + i, uvec4(i == 0 ? begin : end - begin));
        imageStore(list_b, LIST_RANGES + 2 * range + i, uvec4(i == 0 ? begin : end - begin));
    }
}

void main() {
    if (gl_GlobalInvocationID != uvec3(0u)) return;
    add_kind(true, false);
    uint rough = count;
    add_kind(false, true);
    uint shown = count;
    add_kind(false, false);
    uint first = empty ? shown : rough;
    close_range(RANGE_shown, 0u, shown);
    close_range(RANGE_shown + 1, shown, count);
    close_range(RANGE_smooth, first, shown);
    close_range(RANGE_smooth + 1, shown, count + first);
    close_range(RANGE_rough, 0u, rough);
    close_range(RANGE_rough + 1, rough, count);
}
