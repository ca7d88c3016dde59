// The cocoon as an image of its own, small enough to stay in the caches. A sample holds 1 / distance along the face's
// axis, which is linear over a face where the cocoon is a plane; samples lie on the borders of the faces, so that
// neighbouring faces agree there, and plain bilinear filtering is continuous all around. 0: no end, all is sky.
#ifndef GLINT_COCOON
#define GLINT_COCOON
#include "shared/cubemap.glsl"

const int COCOON_SIZE = 32;

vec3 direction_of_sample(ivec2 texel, int face) {
    return direction_from_face(vec3(vec2(texel) / float(COCOON_SIZE - 1), face));
}

// |v| / distance of the cocoon in direction v: 1 on it, less inside, and growing with |v|.
float cocoon_gauge(texture2DArray cocoon, vec3 v, uint place) {
    vec3 face = face_from_direction(v), a = abs(v);
    vec2 uv = (face.xy * float(COCOON_SIZE - 1) + 0.5) / float(COCOON_SIZE);
    float major = max(a.x, max(a.y, a.z));
    float found = textureLod(sampler2DArray(cocoon, linear_clamp), vec3(uv, 6.0 * float(place) + face.z), 0.0).x;
    return major > 0.0 ? major * found : 0.0;
}

// Where the ray from_center + t · direction leaves the cocoon for the first time; < 0: never. A ray that
// starts outside first enters the cocoon, unless it is inside for less than a step.
//
// Samples are even in w, t = reach · w/(1 - w): with reach = |from_center| their directions from the centre turn evenly,
// and the last is the ray's own. Times 1 - w, the place along the ray is mix(from_center, reach · direction, w), so that
// where the cocoon is a plane, gauge - 1 becomes linear in w, and the straight line between two samples meets it.
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
