#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "max.pass.h"
#include "shared/push_begin.glsl"
#include "max.pass.h"
};
#include "shared/cocoon.glsl"
#include "shared/cube_chain.glsl"

// A constant in the two phases with the most fetches, since not all devices skip a fetch whose result is unused.
bool is_captured(int level) { return dispatch_phase == 0u || (dispatch_phase > 1u && level == 0); }

float captured(ivec3 at) { return texelFetch(cubemap_distance, at, 0).x; }
float texel_of(ivec3 at, int level) { return is_captured(level) ? captured(at) : texelFetch(faces, at, level).x; }

float farther(float farthest_m, float distance_m) { return distance_m < LARGEST ? max(farthest_m, distance_m) : farthest_m; }

// The farthest of the four texels that meet at a corner.
float farthest_around(ivec3 corner, int level) {
    float farthest_m = -1.0;
    if (is_captured(level)) {
        vec3 place = vec3(vec2(corner.xy) / float(face_size(cubemap_distance, 0)), corner.z);
        vec4 four = textureGather(sampler2DArray(cubemap_distance, nearest_clamp), place);
        for (int i = 0; i < 4; ++i) farthest_m = farther(farthest_m, four[i]);
    } else {
        for (int i = 0; i < 4; ++i) farthest_m = farther(farthest_m, texelFetch(faces, corner - ivec3(i & 1, i >> 1, 0), level).x);
    }
    return farthest_m;
}

// Reduction: the farthest texel that is not sky among 2x2 texels of the finer level, or 3x3 where its size is odd. The finest level, which
// holds the captured distances, is written last.
float farthest_child(ivec3 at, int width, int level) {
    if (level == 0) return captured(at);
    int odd = face_size(faces, level - 1) - 2 * width;
    ivec2 first = 2 * at.xy + 1, corner = first;
    float farthest_m = -1.0;
    do {
        farthest_m = max(farthest_m, farthest_around(ivec3(corner, at.z), level - 1));
        corner = corner.x < first.x + odd ? ivec2(corner.x + 1, corner.y) : ivec2(first.x, corner.y + 1);
    } while (corner.y <= first.y + odd);
    return farthest_m < 0.0 ? INFINITE : farthest_m;
}

// There is no coarser level to fill the coarsest one from: a face of sky takes the farthest distance of the whole cube map.
float farthest_of_map(int layer, int level) {
    float farthest_m = -1.0;
    for (int face = 0; face < 6; ++face)
        farthest_m = farther(farthest_m, farthest_child(ivec3(0, 0, layer - layer % 6 + face), 1, level));
    return farthest_m < 0.0 ? INFINITE : farthest_m;
}

float distance_in(vec3 v, float cube, int level) {
    return textureLod(samplerCubeArray(chain, linear_clamp), vec4(v, cube), float(level)).x;
}

// Weighted MAX over the coarser level, which contains sky only if all of it is. The pivot is the sample in the texel's own direction;
// other samples have less weight the farther they are from it. Deviation: samples are taken in pairs on either side of the pivot, by
// the mean of their |v| / distance. On a plane that mean is the pivot's value, so that a wall does not move, however obliquely it is
// seen; at a pole both samples of a pair lie on the background.
float weighted_max(vec4 direction, int level) {
    int coarser = level + 1;
    float pivot = distance_in(direction.xyz, direction.w, coarser);
    if (!(pivot < LARGEST)) return INFINITE;
    vec3 axis = normalize(direction.xyz), tangent, bitangent;
    tangent_frame(axis, tangent, bitangent);
    float rim = cone_tangent_of_level(0.0, float(face_size(faces, coarser)), kernel);
    float power = cone_power(rim, threshold), depth_m = pivot;
    for (int y = 0; y <= reach && reach > 0; ++y) { // one tap of each pair: those of a row, from the pivot on
        int wide = taps_beside(y, reach), x = y == 0 ? 1 : -wide;
        do {
            vec2 offset = vec2(x, y) * rim / (float(reach) + 0.5);
            vec3 aside = offset.x * tangent + offset.y * bitangent;
            float length_of_both = sqrt(1.0 + dot(offset, offset)), weight = pow(length_of_both, -power);
            float first = distance_in(axis + aside, direction.w, coarser), second = distance_in(axis - aside, direction.w, coarser);
            if (maximum == maximum_pairs) {
                float mean = 0.5 * (length_of_both / first + length_of_both / second);
                depth_m = max(depth_m, 1.0 / mix(1.0 / pivot, mean, weight));
            } else {
                depth_m = max(depth_m, pivot + (max(first, second) - pivot) * weight);
            }
        } while (++x <= wide);
    }
    return depth_m;
}

int cocoon_level() { return int(ceil(log2(max(float(face_size(faces, 0)) / float(size), 1.0)) - 1e-4)); }

// From the coarsest level to that of the cocoon: coarser levels only fill sky texels, the cocoon's own level is smoothed everywhere.
void fill_level(ivec3 at, int width, int level) {
    int coarsest = textureQueryLevels(samplerCubeArray(chain, nearest_clamp)) - 1;
    float distance_m = texel_of(at, level);
    bool is_sky = fact_cube_sky && !(distance_m < LARGEST);
    if (!is_sky && level != cocoon_level()) return;
    if (level < coarsest) distance_m = weighted_max(texel_direction(at.xy, width, at.z), level);
    else if (is_sky) distance_m = farthest_of_map(at.z, level);
    imageStore(cocoon_distance, at, vec4(distance_m < LARGEST ? distance_m : INFINITE)); // filtering may have made it NaN
}

// Levels finer than the cocoon's take the cocoon where they have sky.
void cap_level(ivec3 at, int width, int level) {
    bool caps = fact_cube_sky && cap_sky;
    if (!caps && level > 0) return;
    float distance_m = caps ? texel_of(at, level) : captured(at);
    if (caps && !(distance_m < LARGEST)) {
        float cap_m = distance_in(texel_direction(at.xy, width, at.z).xyz, float(at.z / 6), cocoon_level());
        distance_m = cap_m < LARGEST ? -cap_m : INFINITE;
    } else if (level > 0) {
        return;
    }
    imageStore(cocoon_distance, at, vec4(distance_m));
}

void keep_cocoon(ivec3 at) {
    if (any(greaterThanEqual(at.xy, ivec2(COCOON_SIZE)))) return;
    vec3 direction = direction_of_sample(at.xy, at.z % 6);
    float distance_m = distance_in(direction, float(at.z / 6), cocoon_level());
    imageStore(cocoon, at, vec4(distance_m < LARGEST ? length(direction) / distance_m : 0.0)); // filtering may have made +inf NaN
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (dispatch_phase == 5u) {
        keep_cocoon(at);
        return;
    }
    if (dispatch_phase == 2u && !fact_cube_sky) return; // without sky there is nothing for coarser levels to fill
    int width = imageSize(cocoon_distance).x, level = int(dispatch_level);
    if (at.x >= width || at.y >= width) return;
    if (dispatch_phase < 2u) imageStore(cocoon_distance, at, vec4(farthest_child(at, width, level)));
    else if (dispatch_phase < 4u) fill_level(at, width, level);
    else cap_level(at, width, level);
}
