// The light of a texel at the pipeline's resolution, before the temporal filter. Next include of a pass that reads indirect_traced and
// indirect_levels. Where nothing upscaled the traced level, its nearest texel.
vec4 half_light(ivec2 texel) {
    if (has_indirect_levels) return texelFetch(indirect_levels, texel, 0);
    vec4 color = vec4(-1.0);
    for (int level = 0; level < textureQueryLevels(indirect_traced) && color.a < 0.0; ++level)
        color = texelFetch(indirect_traced, min(texel >> level, textureSize(indirect_traced, level) - 1), level);
    return max(color, 0.0);
}
