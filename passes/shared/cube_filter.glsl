// Bilinear and trilinear lookups of cube maps, seamless across edges, with results that do not depend on other invocations. llvmpipe filters
// the eight texels of a vector together: if one of them lies at a corner of the cube it computes a weighted sum for all eight, otherwise it
// interpolates twice, and the two differ in the last bit. A texel would then depend on the lookups of neighbouring, even inactive, invocations.
// filter_by_hand: on such devices texels are fetched one by one and interpolated here; other devices use their samplers.
#ifndef GLINT_CUBE_FILTER
#define GLINT_CUBE_FILTER

// Directions of the centres of the four texels around a direction; the weights sum to 1.
struct CubeTaps {
    vec3 direction[4];
    vec4 weight;
};

// Positions are in units of half a texel, so that centres are integers, on the cube with faces at ±size. A texel beyond an edge is the
// first one of the next face: the component that exceeds the edge is set to the face, and the major one moves back by one.
vec3 centre_on_cube(vec3 place, vec3 major, float size) {
    bool beyond = any(greaterThan(abs(place), vec3(size)));
    return beyond ? clamp(place, -size, size) - major * sign(place) : place;
}

CubeTaps cube_taps(vec3 direction, float size) {
    vec3 a = abs(direction);
    bool z = a.z >= a.x && a.z >= a.y, y = !z && a.y >= a.x;
    vec3 major = z ? vec3(0.0, 0.0, 1.0) : y ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 right = major.x > 0.0 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), down = 1.0 - major - right;
    float widest = max(max(a.x, max(a.y, a.z)), 1e-30); // the zero vector has no direction and gets the centre of a face
    precise vec3 texel = 0.5 * (direction * (size / widest) + size) - 0.5;
    vec3 first = mix(2.0 * floor(texel) + 1.0 - size, size * sign(direction), greaterThan(major, vec3(0.0)));
    precise vec3 part = texel - floor(texel);
    precise float across = dot(part, right), along = dot(part, down);
    CubeTaps taps;
    precise vec4 weight = vec4((1.0 - across) * (1.0 - along), across * (1.0 - along), (1.0 - across) * along, across * along);
    vec4 corner = vec4(0.0); // at a corner of the cube there is no fourth texel, and the others share its weight
    for (int i = 0; i < 4; ++i) {
        vec3 place = first + 2.0 * float(i & 1) * right + 2.0 * float(i >> 1) * down;
        corner[i] = dot(vec3(greaterThan(abs(place), vec3(size))), vec3(1.0)) > 1.5 ? 1.0 : 0.0;
        taps.direction[i] = centre_on_cube(place, major, size);
    }
    precise vec4 own = (1.0 - corner) * (weight + dot(weight, corner) * (1.0 / 3.0));
    taps.weight = own;
    return taps;
}

#define CUBE_FILTER(texture_kind, sampler_kind, coordinate, at_tap)                                                         \
    vec4 cube_level(texture_kind image, coordinate at, int level) {                                                         \
        CubeTaps taps = cube_taps(at.xyz, float(max(textureSize(sampler_kind(image, nearest_clamp), 0).x >> level, 1)));    \
        precise vec4 sum = vec4(0.0);                                                                                       \
        for (int i = 0; i < 4; ++i)                                                                                         \
            sum += taps.weight[i] * textureLod(sampler_kind(image, nearest_clamp), at_tap, float(level));                   \
        return sum;                                                                                                         \
    }                                                                                                                       \
    vec4 cube_finest(texture_kind image, coordinate at) {                                                                   \
        return filter_by_hand ? cube_level(image, at, 0) : textureLod(sampler_kind(image, linear_clamp), at, 0.0);          \
    }                                                                                                                       \
    vec4 cube_between(texture_kind image, coordinate at, float level) {                                                     \
        precise float within = clamp(level, 0.0, float(textureQueryLevels(sampler_kind(image, nearest_clamp)) - 1));        \
        precise float part = within - floor(within);                                                                        \
        precise vec4 finer = cube_level(image, at, int(within)), coarser = cube_level(image, at, int(ceil(within)));        \
        precise vec4 color = finer + part * (coarser - finer);                                                              \
        return color;                                                                                                       \
    }                                                                                                                       \
    vec4 cube_levels(texture_kind image, coordinate at, float level) {                                                      \
        return filter_by_hand ? cube_between(image, at, level) : textureLod(sampler_kind(image, linear_clamp), at, level);  \
    }
CUBE_FILTER(textureCube, samplerCube, vec3, taps.direction[i])
CUBE_FILTER(textureCubeArray, samplerCubeArray, vec4, vec4(taps.direction[i], at.w))
#undef CUBE_FILTER
#endif
