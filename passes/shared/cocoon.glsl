// The cocoon as a separate image that is small enough for the caches. A sample holds 1 / distance along the face's axis, which is linear on a
// face where the cocoon is planar. Samples lie on the borders of the faces, so that neighbouring faces agree there and bilinear filtering is
// continuous across them. 0: sky, no cocoon.
#ifndef GLINT_COCOON
#define GLINT_COCOON
#include "shared/cubemap.glsl"

const int COCOON_SIZE = 32;

vec3 direction_of_sample(ivec2 texel, int face) {
    return direction_from_face(vec3(vec2(texel) / float(COCOON_SIZE - 1), face));
}

// |v| / distance of the cocoon in direction v: 1 on the cocoon, less inside, proportional to |v|.
float cocoon_gauge(texture2DArray cocoon, vec3 v, uint place) {
    vec3 face = face_from_direction(v), a = abs(v);
    vec2 uv = (face.xy * float(COCOON_SIZE - 1) + 0.5) / float(COCOON_SIZE);
    float major = max(a.x, max(a.y, a.z));
    float found = textureLod(sampler2DArray(cocoon, linear_clamp), vec3(uv, 6.0 * float(place) + face.z), 0.0).x;
    return major > 0.0 ? major * found : 0.0;
}

// The t at which the ray from_center + t · direction first leaves the cocoon; < 0: never. A ray that starts outside first enters it, unless
// it is inside for less than a step. Samples are evenly spaced in w with t = reach · w/(1 - w). With reach = |from_center| their directions from
// the centre are at even angles, and the last one is the ray's own. Multiplied by 1 - w, the position is mix(from_center, reach · direction, w),
// so that gauge - 1 is linear in w where the cocoon is planar, and the secant between two samples hits it exactly.
float leaves_cocoon(texture2DArray cocoon, vec3 from_center, vec3 direction, uint place, int steps, int refinements) {
    float reach = max(length(from_center), 0.1), low = 0.0, high = 2.0, low_gap = 0.0, high_gap = 0.0;
    vec3 far = reach * direction;
    bool inside = false;
    for (int i = 0; i <= steps; ++i) { // no early exit, so that the fetches are independent
        float w = float(i) / float(steps), gap = cocoon_gauge(cocoon, mix(from_center, far, w), place) - (1.0 - w);
        if (high <= 1.0) continue;
        if (gap <= 0.0) {
            inside = true;
            low = w;
            low_gap = gap;
        } else if (inside) {
            high = w;
            high_gap = gap;
        }
    }
    if (high > 1.0) return -1.0;
    for (int i = 0; i < refinements; ++i) {
        float w = mix(low, high, low_gap / (low_gap - high_gap));
        float gap = cocoon_gauge(cocoon, mix(from_center, far, w), place) - (1.0 - w);
        if (gap <= 0.0) {
            low = w;
            low_gap = gap;
        } else {
            high = w;
            high_gap = gap;
        }
    }
    float w = mix(low, high, low_gap / (low_gap - high_gap));
    return reach * w / (1.0 - w);
}
#endif
