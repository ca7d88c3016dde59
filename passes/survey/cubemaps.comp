#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cubemaps.pass.h"
#include "shared/push_begin.glsl"
#include "cubemaps.pass.h"
};
#include "shared/constants.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int squares = imageSize(cubemap_sky).x, size = int(frame.counts.z);
    if (any(greaterThanEqual(at.xy, ivec2(squares)))) return;
    ivec2 first = at.xy * size / squares, end = (at.xy + 1) * size / squares;
    uint sky = 0u;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            if (!(texelFetch(cubemap_distance, ivec3(x, y, at.z), 0).x < LARGEST)) sky |= 1u;
            if (!(texelFetch(cubemap_color, ivec3(x, y, at.z), 0).a >= 1.0)) sky |= 2u;
        }
    }
    imageStore(cubemap_sky, at, uvec4(sky));
}
