#include "shared/probe/record.glsl"

// The last half-resolution image that the pipeline writes.
vec4 half_color(ivec2 texel) {
    if (has_reflection_temporal) return texelFetch(reflection_temporal, texel, 0);
    if (has_reflection_blurred) return texelFetch(reflection_blurred, texel, 0);
    return texelFetch(reflection_half, texel, 0);
}

// The same, recorded with a weight.
vec4 taken_color(ivec2 texel, float weight) {
    vec4 color = half_color(texel);
    probe(PROBE_neighbour, vec4(texel, weight, color.r), vec4(color.gb, 0.0, 0.0));
    return weight * color;
}
