#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "combined.pass.h"
#include "shared/push_begin.glsl"
#include "combined.pass.h"
};
#include "shared/constants.glsl"
#include "this_frame/picture.glsl"

vec3 level_color(ivec2 texel, int level) { return texelFetch(bloom_blurred, texel, level).rgb; }
#include "filtering/between.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(bloomed)))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 color = last_picture(pixel), sum = vec3(0.0);
    float weight = 1.0, total = 0.0;
    for (int level = 0; level < min(mips, textureQueryLevels(bloom_blurred)); ++level) {
        ivec2 size = textureSize(bloom_blurred, level);
        sum += weight * color_between(uv * vec2(size), size, level);
        total += weight;
        weight *= spread;
    }
    vec3 added = strength * sum / total;
    if (any(notEqual(added, vec3(0.0)))) color = storable(color + added, frame.up.w);
    imageStore(bloomed, pixel, vec4(color, 1.0));
}
