// Between the middles of texels, by hand, since samplers round the weights. Next include of a pass that defines vec3 level_color(ivec2 texel, int level).

// The colour at a place, in texels from the corner of a level of this size, whose borders repeat.
vec3 color_between(vec2 place, ivec2 size, int level) {
    vec2 from = place - 0.5, part = from - floor(from);
    ivec2 corner = ivec2(floor(from)), low = clamp(corner, ivec2(0), size - 1), high = clamp(corner + 1, ivec2(0), size - 1);
    return mix(mix(level_color(low, level), level_color(ivec2(high.x, low.y), level), part.x),
               mix(level_color(ivec2(low.x, high.y), level), level_color(high, level), part.x), part.y);
}
