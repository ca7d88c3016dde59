#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cubemaps.pass.h"
#include "shared/push_begin.glsl"
#include "cubemaps.pass.h"
};
#include "shared/constants.glsl"

bool has_sky(ivec3 texel) {
    return dispatch_phase == 0u ? !(texelFetch(cubemap_distance, texel, 0).x < LARGEST) : !(texelFetch(cubemap_color, texel, 0).a >= 1.0);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int squares = imageSize(cubemap_sky).x, size = int(frame.counts.z);
    if (any(greaterThanEqual(at.xy, ivec2(squares)))) return;
    ivec2 first = at.xy * size / squares, end = (at.xy + 1) * size / squares;
    bool sky = false;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) sky = sky || has_sky(ivec3(x, y, at.z));
    if (dispatch_phase == 0u) imageStore(cubemap_open, at, uvec4(sky));
    else imageStore(cubemap_sky, at, uvec4(sky));
}
