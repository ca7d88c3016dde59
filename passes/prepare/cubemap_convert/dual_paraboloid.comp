#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "dual_paraboloid.pass.h"
#include "shared/push_begin.glsl"
#include "dual_paraboloid.pass.h"
};
#include "shared/levels.glsl"
#include "shared/paraboloid.glsl"

// The mean colour of the cube map over a texel at a point of the plane.
vec4 mean_over_texel(vec2 place, float width, int layer) {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < taps * taps; ++i) {
        vec2 at = place + width * ((vec2(i % taps, i / taps) + 0.5) / float(taps) - 0.5);
        vec3 direction = paraboloid_axes(frame.up.xyz) * paraboloid_direction(at, (layer & 1) == 0);
        vec4 color = textureLod(samplerCubeArray(cubemap_color, linear_clamp), vec4(direction, layer / 2), 0.0);
        if (!finite(color)) continue;
        sum += color;
        total += 1.0;
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

vec4 coarser(ivec3 at, int size, int level, float widest) {
    int finer_size = textureSize(finer, level - 1).x;
    Footprint x = footprint(at.x, size, finer_size), y = footprint(at.y, size, finer_size);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int j = 0; j < y.count; ++j) {
        for (int i = 0; i < x.count; ++i) {
            ivec2 texel = ivec2(x.first + i, y.first + j);
            float weight = x.share[i] * y.share[j];
            if (solid_angle) weight *= paraboloid_solid_angle(paraboloid_place(vec2(texel) + 0.5, float(finer_size), widest));
            sum += weight * texelFetch(finer, ivec3(texel, at.z), level - 1);
            total += weight;
        }
    }
    return sum / total;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int size = imageSize(paraboloids).x, level = int(dispatch_level);
    if (at.x >= size || at.y >= size) return;
    float widest = float(frame.counts.z);
    vec2 place = paraboloid_place(vec2(at.xy) + 0.5, float(size), widest);
    vec4 color = vec4(0.0);
    if (level > 0) color = coarser(at, size, level, widest);
    else if (fill || dot(place, place) <= 1.0) color = mean_over_texel(place, 2.0 / float(size) * paraboloid_reach(widest), at.z);
    imageStore(paraboloids, at, color);
}
