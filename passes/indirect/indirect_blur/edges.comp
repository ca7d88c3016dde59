#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "edges.pass.h"
#include "shared/push_begin.glsl"
#include "edges.pass.h"
};

const uint ALONG_ROWS = 0u; // dispatch phase; then columns, or upscaling

vec4 level_texel(ivec2 texel, int level, float weight) {
    return dispatch_phase == ALONG_ROWS ? texelFetch(indirect_traced, texel, level) : texelFetch(levels, texel, level);
}
vec4 across_texel(ivec2 texel, int level, float weight) { return texelFetch(across, texel, level); }
float agreement(vec4 own, vec4 other) {
    vec3 apart = own.xyz - other.xyz;
    return 0.5 * dot(apart, apart) <= normal_part ? 1.0 : 0.0;
}
#include "reflection/blur/level_filter.glsl"

vec4 blurred(ivec2 texel, int level) {
    bool rows = dispatch_phase == ALONG_ROWS;
    vec4 own = rows ? texelFetch(indirect_traced, texel, level) : texelFetch(across, texel, level);
    if (radius == 0 || !has_ray(texel, level)) return own;
    int along_x = rows ? 1 : 0; // not a choice of vectors by a constant, which some drivers get wrong
    return along(texel, level, ivec2(along_x, 1 - along_x), rows ? SIDE_LEFT : SIDE_UP, rows ? SIDE_RIGHT : SIDE_DOWN);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int level = int(dispatch_level);
    ivec2 size = dispatch_phase == ALONG_ROWS ? imageSize(indirect_across) : imageSize(indirect_levels);
    if (any(greaterThanEqual(texel, size))) return;
    bool traced = texelFetch(indirect_traced, texel, level).a >= 0.0;
    vec4 color = vec4(-1.0);
    if (traced) {
        color = blurred(texel, level);
    } else if (dispatch_phase != ALONG_ROWS && level + 1 < textureQueryLevels(levels) && has_ray(texel, level)) {
        float found;
        color = upscaled(texel, level, found);
        if (found == 0.0) color = vec4(0.0);
    } else if (dispatch_phase != ALONG_ROWS) {
        color = vec4(0.0);
    }
    if (dispatch_phase == ALONG_ROWS) imageStore(indirect_across, texel, color);
    else imageStore(indirect_levels, texel, color);
}
