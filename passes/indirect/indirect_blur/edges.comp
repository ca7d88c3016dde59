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
vec4 surface_of(ivec2 texel, int level) { return texelFetch(vertex_normal_levels, texel, level); }
float agreement(vec4 own, vec4 other) {
    vec3 apart = own.xyz - other.xyz;
    return 0.5 * dot(apart, apart) <= normal_part ? 1.0 : 0.0;
}
#include "filtering/level_filter.glsl"

vec4 blurred(ivec2 texel, int level) {
    bool rows = dispatch_phase == ALONG_ROWS;
    vec4 own = rows ? texelFetch(indirect_traced, texel, level) : texelFetch(across, texel, level);
    if (radius == 0 || !has_ray(texel, level)) return own;
    int along_x = rows ? 1 : 0; // not a choice of vectors by a constant, which some drivers get wrong
    return along(texel, level, ivec2(along_x, 1 - along_x), rows ? SIDE_LEFT : SIDE_UP, rows ? SIDE_RIGHT : SIDE_DOWN);
}

// Where no texel of the coarser level is of the surface, such as on a thin bar: the mean of those around it.
vec4 upscaled_from_others(ivec2 texel, int level) {
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = clamp(home + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        if (!has_ray(at, level + 1)) continue;
        sum += texelFetch(levels, at, level + 1);
        total += 1.0;
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

vec4 finer(ivec2 texel, int level) {
    float found = 0.0;
    if (level + 1 >= textureQueryLevels(levels) || !has_ray(texel, level)) return vec4(0.0);
    vec4 color = upscaled(texel, level, found);
    return found > 0.0 ? color : upscaled_from_others(texel, level);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int level = int(dispatch_level);
    bool rows = dispatch_phase == ALONG_ROWS, traced;
    if (any(greaterThanEqual(texel, rows ? imageSize(indirect_across) : imageSize(indirect_levels)))) return;
    traced = texelFetch(indirect_traced, texel, level).a >= 0.0;
    if (rows) imageStore(indirect_across, texel, traced ? blurred(texel, level) : vec4(-1.0));
    else imageStore(indirect_levels, texel, traced ? blurred(texel, level) : finer(texel, level));
}
