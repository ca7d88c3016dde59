#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cubemaps.pass.h"
#include "shared/push_begin.glsl"
#include "cubemaps.pass.h"
};
#include "shared/cocoon.glsl"
#include "shared/constants.glsl"

// Whether one of the four texels that meet at a corner shows the sky.
bool has_sky(vec3 corner) {
    if (dispatch_phase == 0u)
        return any(not(lessThan(textureGather(sampler2DArray(cubemap_distance, nearest_clamp), corner), vec4(LARGEST))));
    return any(not(greaterThanEqual(textureGather(sampler2DArray(cubemap_color, nearest_clamp), corner, 3), vec4(1.0))));
}

// A square of odd size also tests neighbours of its last texels, which belong to the same face.
void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at.xy, ivec2(COCOON_SIZE)))) return;
    int size = int(frame.counts.z);
    ivec2 first = at.xy * size / COCOON_SIZE + 1, end = (at.xy + 1) * size / COCOON_SIZE, corner = first;
    bool sky = false;
    do {
        sky = has_sky(vec3(vec2(corner) / float(size), at.z)) || sky;
        corner = corner.x + 2 <= end.x ? ivec2(corner.x + 2, corner.y) : ivec2(first.x, corner.y + 2);
    } while (corner.y <= end.y);
    if (dispatch_phase == 0u) imageStore(cubemap_open, at, uvec4(sky));
    else imageStore(cubemap_sky, at, uvec4(sky));
}
