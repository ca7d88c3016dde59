// Cells of a volume of low-frequency light.
#ifndef GLINT_LIGHT_VOLUME
#define GLINT_LIGHT_VOLUME

// The texel of a cell: slices lie one below the other. grid: frame.grid.
ivec2 cell_texel(ivec3 cell, uvec4 grid) { return ivec2(cell.x, cell.y + cell.z * int(grid.y)); }

// An ambient cube (J. McTaggart, Half-Life 2 / Valve Source Shading, 2004): what a white surface sends back that faces a unit direction.
vec3 ambient_cube(vec3 positive[3], vec3 negative[3], vec3 direction) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; ++i) sum += direction[i] * direction[i] * (direction[i] < 0.0 ? negative[i] : positive[i]);
    return sum;
}
vec3 ambient_cube_mean(vec3 positive[3], vec3 negative[3]) {
    return (positive[0] + positive[1] + positive[2] + negative[0] + negative[1] + negative[2]) / 6.0;
}

// The same for light of a mean radiance and a main direction, the mean of all directions weighted by their luminance. Light that varies linearly
// with the direction has the radiance mean · (1 + 3 main · d), and irradiance / π weakens the linear part to 2/3 (R. Ramamoorthi, P. Hanrahan, An
// Efficient Representation for Irradiance Environment Maps, 2001).
vec3 directed_irradiance(vec3 mean, vec3 main, vec3 direction) { return mean * (1.0 + 2.0 * dot(main, direction)); }

// Radiance made of irradiance / π in a direction and of its mean. contrast: factor on the difference, 3/2 undoes what weakens its linear part.
vec3 contrasted(vec3 mean, vec3 irradiance, float contrast) { return max(mean + contrast * (irradiance - mean), 0.0); }
#endif
