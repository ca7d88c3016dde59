// Makes a level of the distance chain, for both variants.
#include "shared/cube_chain.glsl"

float joined_distance(ivec3 at, int size, int level) {
    // Without distances the image is a single texel.
    if (level == 0) return texelFetch(cubemap_distance, min(at, textureSize(cubemap_distance, 0) - 1), 0).x;
    int finer = face_size(finer_distance, level - 1);
    Footprint x = footprint(at.x, size, finer), y = footprint(at.y, size, finer);
    float sum = 0.0, total = 0.0, least = INFINITE, most = 0.0;
    for (int j = 0; j < y.count; ++j) {
        for (int i = 0; i < x.count; ++i) {
            float distance_m = texelFetch(finer_distance, ivec3(x.first + i, y.first + j, at.z), level - 1).x;
            if (!(distance_m < LARGEST)) continue;
            sum += x.share[i] * y.share[j] * distance_m;
            total += x.share[i] * y.share[j];
            least = min(least, distance_m);
            most = max(most, distance_m);
        }
    }
    if (total == 0.0) return INFINITE;
    return join == join_mean ? sum / total : join == join_nearest ? least : most;
}
