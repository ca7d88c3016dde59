// MIP chains: the texels of the finer level that a texel covers, and the taps that pre-filter a level.
#ifndef GLINT_LEVELS
#define GLINT_LEVELS
#include "shared/camera.glsl"
#include "shared/cone.glsl"

// A level is half as wide as the finer one, rounded down. Along one axis a texel covers two finer texels, or parts of three if the finer size is
// odd, with their exact shares.
struct Footprint {
    int first, count;
    vec3 share; // sum 1
};

Footprint footprint(int texel, int size, int finer) {
    int low = texel * finer, high = low + finer; // in units of 1/size of a finer texel
    Footprint f;
    f.first = low / size;
    f.count = (high - 1) / size - f.first + 1;
    f.share = vec3(0.0);
    for (int i = 0; i < f.count; ++i) {
        int start = (f.first + i) * size;
        f.share[i] = float(min(high, start + size) - max(low, start)) / float(finer);
    }
    return f;
}

// Mafia III talk, MIP pre-filtering: taps on the points of a lattice within the radius `reach`; 3 gives the 29 taps of the slides. The rim of the
// cone, at texel_scale texels, is half a step beyond the last tap.
bool is_tap(ivec2 point, int reach) { return point.x * point.x + point.y * point.y <= reach * reach; }

// The number of taps in row y on either side of the centre. The added half keeps the root of a square number from being rounded down.
int taps_beside(int y, int reach) { return int(sqrt(float(reach * reach - y * y) + 0.5)); }

// A tap of a cube map; the lattice lies in the tangent plane of the unit sphere. weight: the lobe cosⁿ of the level's cone, times cos³ for the
// solid angle of an area of that plane.
struct Tap {
    vec3 direction; // not of unit length
    float weight, lod;
};

Tap cube_tap(ivec2 point, vec3 axis, vec3 tangent, vec3 bitangent, float level, float face_size, int reach,
             float texel_scale, float threshold) {
    float rim = cone_tangent_of_level(level, face_size, texel_scale);
    vec2 offset = vec2(point) * rim / (float(reach) + 0.5);
    float r2 = dot(offset, offset);
    Tap tap;
    tap.direction = axis + offset.x * tangent + offset.y * bitangent;
    tap.weight = exp(-0.5 * (cone_power(rim, threshold) + 3.0) * log1p(r2));
    // The texels of the source are half the distance of the taps, so that bilinear taps leave no gaps and add no blur. A texel at v spans
    // (major/|v|)^1.5 of one at the centre of the face, an area of the plane (1/|v|)^1.5.
    vec3 a = abs(tap.direction);
    float root = inversesqrt(max(a.x, max(a.y, a.z)));
    float wide = rim / (float(reach) + 0.5) * 0.5 * face_size * root * root * root;
    tap.lod = clamp(log2(wide) - 1.0, 0.0, level);
    return tap;
}
#endif
