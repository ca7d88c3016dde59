#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "gather.pass.h"
#include "shared/push_begin.glsl"
#include "gather.pass.h"
};
#include "shared/camera.glsl"

// The last texels take what is left of the picture.
float least_of_block(ivec2 texel, ivec2 size) {
    int wide = 4 * int(reduction(frame.size)); // EIGHTH is a quarter of HALF, which may be all of the picture
    ivec2 last = ivec2(frame.size.xy) - 1, from = texel * wide, to = min(from + wide - 1, last);
    if (texel.x == size.x - 1) to.x = last.x;
    if (texel.y == size.y - 1) to.y = last.y;
    float least = 1.0;
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) least = min(least, texelFetch(shadow_mask, ivec2(x, y), 0).x);
    return least;
}

// Of the texel and those around it: each gather takes the four texels that meet at a corner of it.
float least_around(ivec2 texel, ivec2 size) {
    float least = 1.0;
    for (int corner = 0; corner < 4; ++corner) {
        vec2 at = vec2(texel + ivec2(corner & 1, corner >> 1)) / vec2(size);
        vec4 four = textureGather(sampler2D(eighth, nearest_clamp), at);
        least = min(least, min(min(four.x, four.y), min(four.z, four.w)));
    }
    return least;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(shadow_early);
    if (any(greaterThanEqual(texel, size))) return;
    if (dispatch_phase == 0u) imageStore(shadow_eighth, texel, vec4(least_of_block(texel, size)));
    else imageStore(shadow_early, texel, vec4(least_around(texel, size)));
}
