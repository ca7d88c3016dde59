// MIP chains: which texels of the finer level make a texel of the next, and the taps that pre-filter a level.
#ifndef GLINT_LEVELS
#define GLINT_LEVELS
#include "shared/camera.glsl"
#include "shared/cone.glsl"

// A level is half as wide as the finer one, rounded down. Along one axis a texel covers two texels of it, or parts of
// three when it is odd, by their exact shares.
struct Footprint {
    int first, count;
    vec3 share; // sum 1
};

Footprint footprint(int texel, int size, int finer) {
    int low = texel * finer, high = low + finer; // in size-ths of a finer texel
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

// Mafia III talk, MIP pre-filtering: taps on the points of a lattice that are no farther than `reach`; 3 makes the slides' 29. The
// cone's rim, texel_scale texels away, lies half a step beyond the last.
bool is_tap(ivec2 point, int reach) { return point.x * point.x + point.y * point.y <= reach * reach; }

// How many of them lie in row y on either side of the middle. The half keeps the root of a square from rounding below it.
int taps_beside(int y, int reach) { return int(sqrt(float(reach * reach - y * y) + 0.5)); }

// A tap of a cube map: the lattice lies in the plane that touches the unit sphere. weight: the lobe cosⁿ whose cone the
// level stands for, times cos³ for the solid angle of a piece of that plane.
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
    // The source's texels are half as wide as the taps are apart, so that bilinear taps leave no gaps and add no blur of
    // their own. A texel at v spans (major/|v|)^1.5 of one at the face's centre, a piece of the plane (1/|v|)^1.5.
    vec3 a = abs(tap.direction);
    float root = inversesqrt(max(a.x, max(a.y, a.z)));
    float wide = rim / (float(reach) + 0.5) * 0.5 * face_size * root * root * root;
    tap.lod = clamp(log2(wide) - 1.0, 0.0, level);
    return tap;
}
#endif
