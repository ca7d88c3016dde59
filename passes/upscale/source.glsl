// The last of the half-resolution images that the pipeline makes.
vec4 half_color(ivec2 texel) {
    if (texelFetch(reflection_temporal, ivec2(0), 0).a >= 0.0) return texelFetch(reflection_temporal, texel, 0);
    if (texelFetch(reflection_blurred, ivec2(0), 0).a >= 0.0) return texelFetch(reflection_blurred, texel, 0);
    return texelFetch(reflection_half, texel, 0);
}
