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

// Interpolated between texels, whose borders repeat; by hand, since samplers round the weights.
vec3 blurred_at(vec2 uv, int level) {
    ivec2 last = textureSize(bloom_blurred, level) - 1;
    vec2 place = uv * vec2(last + 1) - 0.5, part = place - floor(place);
    ivec2 low = clamp(ivec2(floor(place)), ivec2(0), last), high = clamp(ivec2(floor(place)) + 1, ivec2(0), last);
    return mix(mix(texelFetch(bloom_blurred, low, level).rgb, texelFetch(bloom_blurred, ivec2(high.x, low.y), level).rgb, part.x),
               mix(texelFetch(bloom_blurred, ivec2(low.x, high.y), level).rgb, texelFetch(bloom_blurred, high, level).rgb, part.x), part.y);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(bloomed)))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 color = last_picture(pixel), sum = vec3(0.0);
    float weight = 1.0, total = 0.0;
    for (int level = 0; level < min(mips, textureQueryLevels(bloom_blurred)); ++level) {
        sum += weight * blurred_at(uv, level);
        total += weight;
        weight *= spread;
    }
    vec3 added = strength * sum / total;
    if (any(notEqual(added, vec3(0.0)))) color = storable(color + added, frame.up.w);
    imageStore(bloomed, pixel, vec4(color, 1.0));
}
