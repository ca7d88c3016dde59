#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "prefilter.pass.h"
#include "shared/push_begin.glsl"
#include "prefilter.pass.h"
};
#include "shared/cube_chain.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int size = imageSize(sky_mips).x, level = int(dispatch_level);
    if (at.x >= size || at.y >= size) return;
    if (dispatch_phase == 0u)
        imageStore(sky_box, at, level == 0 ? texelFetch(sky, at, 0) : box_color(finer_faces, at, size, level));
    else
        imageStore(sky_mips, at, prefiltered(finer_color, finer_faces, at, size, level, reach, texel_scale, threshold));
}
