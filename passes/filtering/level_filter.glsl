// Blurs and upscales levels up to the edges between surfaces. Next include of a pass that reads edge_levels and vertex_normal_levels of
// downsample/mips, or the same of all surfaces, and `levels`, an image with as many levels, with the parameters radius and edges. It defines before
// vec4 surface_of(ivec2 texel, int level)                    xyz: normal, 0 where no ray starts; w: roughness
// vec4 level_texel(ivec2 texel, int level, float weight)     a texel of a level; weight: what it counts, for records
// vec4 across_texel(ivec2 texel, int level, float weight)    the same after the blur along rows
// float agreement(vec4 own, vec4 other)                      of two surfaces, 0 to 1; xyz: unit normal, w: roughness
#include "shared/camera.glsl"
#include "shared/edges.glsl"

bool has_ray(ivec2 texel, int level) { return reflects(1.0, surface_of(texel, level).xyz); }

uvec4 edges_in_block(ivec2 block, int level) {
    vec2 between = vec2(block + 1) / vec2(textureSize(edge_levels, level));
    if (!edges) return uvec4(255u);
    if (level == 0) return textureGather(usampler2D(edge_levels, nearest_clamp), between).wzxy;
    uvec4 all;
    for (int i = 0; i < 4; ++i) all[i] = texelFetch(edge_levels, block + ivec2(i & 1, i >> 1), level).x;
    return all;
}

uint picked_from(ivec2 texel, int level) { return picked_in_block(uint(texelFetch(vertex_normal_levels, texel, level).w), level); }

// A Gaussian along rows or columns that ends where the surface ends.
vec4 along(ivec2 texel, int level, ivec2 step, uint back, uint forth) {
    ivec2 size = textureSize(levels, level);
    bool rows = step.x == 1;
    vec4 sum = rows ? level_texel(texel, level, 1.0) : across_texel(texel, level, 1.0);
    float total = 1.0, scale = -2.0 / float(max(radius * radius, 1)); // σ is half the radius
    for (int way = -1; way <= 1; way += 2) {
        float open = 1.0;
        for (int i = 1; i <= radius; ++i) {
            ivec2 at = texel + way * i * step;
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
            if (edges) open *= open_side(texelFetch(edge_levels, at - way * step, level).x, way < 0 ? back : forth);
            if (open == 0.0) break;
            float weight = open * exp(scale * float(i * i));
            sum += weight * (rows ? level_texel(at, level, weight) : across_texel(at, level, weight));
            total += weight;
        }
    }
    return sum / total;
}

// How much a texel belongs to the surface that its parent texel was picked from.
float of_home(ivec2 texel, int level) {
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1;
    if (any(greaterThan(home, last)) || !has_ray(home, level + 1)) return 0.0;
    uint own = uint(texel.x & 1) | uint(texel.y & 1) << 1;
    return open_in_block(edges_in_block(2 * home, level), picked_from(home, level + 1))[own];
}

// For a texel that does not: the neighbouring parent texels to which its surface continues.
vec4 upscaled_from_beside(ivec2 texel, int level, out float found) {
    ivec2 side = 2 * (texel & 1) - 1;
    uvec2 ways = uvec2(side.x < 0 ? SIDE_LEFT : SIDE_RIGHT, side.y < 0 ? SIDE_UP : SIDE_DOWN);
    uint e = texelFetch(edge_levels, texel, level).x;
    vec4 sum = vec4(0.0);
    found = 0.0;
    for (int i = 0; i < 2; ++i) {
        ivec2 at = texel + (i == 0 ? ivec2(side.x, 0) : ivec2(0, side.y));
        float open = open_side(e, ways[i]); // 0 at the picture's border
        if (open > 0.0) open *= of_home(at, level);
        if (open == 0.0) continue;
        sum += open * level_texel(at >> 1, level + 1, open);
        found += open;
    }
    sum = found > 0.0 ? sum / found : sum;
    found = min(found, 1.0);
    return sum;
}

// If there is none, as on thin bars: the surrounding texels, weighted by their agreement.
vec4 upscaled_by_agreement(ivec2 texel, int level, out float found) {
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1, side = 2 * (texel & 1) - 1;
    vec4 own = surface_of(texel, level), sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = clamp(home + ivec2(i & 1, i >> 1) * side, ivec2(0), last);
        vec4 other = surface_of(at, level + 1);
        if (!reflects(1.0, other.xyz)) continue;
        float weight = ((i & 1) == 0 ? 3.0 : 1.0) * (i < 2 ? 3.0 : 1.0) * agreement(own, other);
        sum += weight * level_texel(at, level + 1, weight);
        total += weight;
    }
    found = min(total, 1.0);
    return total > 0.0 ? sum / total : vec4(0.0);
}

// Bilinear interpolation of the coarser level without texels beyond edges; found: the fraction that belongs to the texel's own surface.
vec4 upscaled(ivec2 texel, int level, out float found) {
    found = 0.0;
    if (level + 1 >= textureQueryLevels(levels)) return vec4(0.0);
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1, side = 2 * (texel & 1) - 1;
    found = of_home(texel, level);
    if (found == 0.0) {
        vec4 color = upscaled_from_beside(texel, level, found);
        return found > 0.0 ? color : upscaled_by_agreement(texel, level, found);
    }
    uvec2 ways = uvec2(side.x < 0 ? SIDE_LEFT : SIDE_RIGHT, side.y < 0 ? SIDE_UP : SIDE_DOWN);
    ivec2 beside = clamp(home + ivec2(side.x, 0), ivec2(0), last), below = clamp(home + ivec2(0, side.y), ivec2(0), last);
    uint e = edges ? texelFetch(edge_levels, home, level + 1).x : 255u;
    vec2 open = vec2(open_side(e, ways.x), open_side(e, ways.y));
    float corner = 0.0;
    if (open.x > 0.0) corner = open.x * (edges ? open_side(texelFetch(edge_levels, beside, level + 1).x, ways.y) : 1.0);
    if (open.y > 0.0)
        corner = max(corner, open.y * (edges ? open_side(texelFetch(edge_levels, below, level + 1).x, ways.x) : 1.0));
    vec4 weights = vec4(9.0, 3.0 * open, corner);
    vec4 sum = weights.x * level_texel(home, level + 1, weights.x);
    if (weights.y > 0.0) sum += weights.y * level_texel(beside, level + 1, weights.y);
    if (weights.z > 0.0) sum += weights.z * level_texel(below, level + 1, weights.z);
    if (weights.w > 0.0) sum += weights.w * level_texel(clamp(home + side, ivec2(0), last), level + 1, weights.w);
    return sum / dot(weights, vec4(1.0));
}
