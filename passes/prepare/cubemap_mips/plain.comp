#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "plain.pass.h"
#include "shared/push_begin.glsl"
#include "plain.pass.h"
};
#include "distances.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int size = imageSize(cubemap_color_mips).x, level = int(dispatch_level);
    if (at.x >= size || at.y >= size) return;
    vec4 color = level == 0 ? texelFetch(cubemap_color, at, 0) : box_color(finer_faces, at, size, level);
    imageStore(cubemap_color_mips, at, color);
    if (fact_cubemap_distance_mips) imageStore(cubemap_distance_mips, at, vec4(joined_distance(at, size, level)));
}
