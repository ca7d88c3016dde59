// The last of the half-resolution images that the pipeline makes.
vec4 half_color(ivec2 texel) {
    if (has_reflection_temporal) return texelFetch(reflection_temporal, texel, 0);
    if (has_reflection_blurred) return texelFetch(reflection_blurred, texel, 0);
    return texelFetch(reflection_half, texel, 0);
}
