// Levels of cube maps: the box mean of the finer level, and its pre-filter. A single cube map is an array with one element.
#ifndef GLINT_CUBE_CHAIN
#define GLINT_CUBE_CHAIN
#include "shared/cubemap.glsl"
#include "shared/levels.glsl"
#include "shared/sampling.glsl"

// The direction of a texel's centre, and its cube map. `at` is a texel and its layer, 6 · cube + face.
vec4 texel_direction(ivec2 texel, int size, int layer) {
    return vec4(direction_from_face(vec3((vec2(texel) + 0.5) / float(size), layer % 6)), layer / 6);
}

int face_size(texture2DArray faces, int level) { return textureSize(faces, level).x; }

vec4 box_color(texture2DArray finer, ivec3 at, int size, int level) {
    int finer_size = face_size(finer, level - 1);
    Footprint x = footprint(at.x, size, finer_size), y = footprint(at.y, size, finer_size);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int j = 0; j < y.count; ++j) {
        for (int i = 0; i < x.count; ++i) {
            vec4 color = texelFetch(finer, ivec3(x.first + i, y.first + j, at.z), level - 1);
            if (!finite(color)) continue;
            sum += x.share[i] * y.share[j] * color;
            total += x.share[i] * y.share[j];
        }
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

vec4 prefiltered(textureCubeArray box, texture2DArray faces, ivec3 at, int size, int level, int reach, float texel_scale,
                 float threshold) {
    if (level == 0 || reach == 0) return texelFetch(faces, at, level);
    vec4 direction = texel_direction(at.xy, size, at.z), sum = vec4(0.0);
    vec3 axis = normalize(direction.xyz), tangent, bitangent;
    tangent_frame(axis, tangent, bitangent);
    float widest = float(face_size(faces, 0)), total = 0.0;
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            if (!is_tap(ivec2(x, y), reach)) continue;
            Tap tap = cube_tap(ivec2(x, y), axis, tangent, bitangent, float(level), widest, reach, texel_scale, threshold);
            vec4 color = textureLod(samplerCubeArray(box, linear_clamp), vec4(tap.direction, direction.w), tap.lod);
            if (!finite(color)) continue;
            sum += tap.weight * color;
            total += tap.weight;
        }
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}
#endif
