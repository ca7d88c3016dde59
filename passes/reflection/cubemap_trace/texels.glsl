// Distances of the texels around a direction.
#ifndef GLINT_TEXELS
#define GLINT_TEXELS
#include "shared/cubemap.glsl"

// The four texels of a face around a point, in gather's order (0,1) (1,1) (1,0) (0,0), and the interpolation weights. Beyond the border the
// face's last two rows are extrapolated. They are interpolated here, because a sampler's result may depend on neighbouring invocations,
// which are different ones if the pass runs over a list.
struct Patch {
    vec4 distance_m;
    vec2 part;
};

// face: what face_from_direction() gives.
Patch patch_of(texture2DArray faces, vec3 face, uint place, int level) {
    float size = float(max(int(frame.counts.z) >> level, 1)), per_size = 1.0 / size;
    vec2 texel = face.xy * size - 0.5, corner = clamp(floor(texel), vec2(0.0), vec2(max(size - 2.0, 0.0)));
    float layer = 6.0 * float(place) + face.z;
    Patch p;
    p.part = texel - corner;
    if (level == 0) {
        p.distance_m = textureGather(sampler2DArray(faces, nearest_clamp), vec3((corner + 1.0) * per_size, layer));
        return p;
    }
    ivec3 low = ivec3(corner, layer), high = min(low + ivec3(1, 1, 0), ivec3(ivec2(size - 1.0), low.z));
    p.distance_m = vec4(texelFetch(faces, ivec3(low.x, high.y, low.z), level).x, texelFetch(faces, high, level).x,
                        texelFetch(faces, ivec3(high.x, low.y, low.z), level).x, texelFetch(faces, low, level).x);
    return p;
}

float nearest_of(Patch p) {
    return p.part.x < 0.5 ? (p.part.y < 0.5 ? p.distance_m.w : p.distance_m.x)
                          : (p.part.y < 0.5 ? p.distance_m.z : p.distance_m.y);
}
float mean_of(Patch p) {
    return mix(mix(p.distance_m.w, p.distance_m.z, p.part.x), mix(p.distance_m.x, p.distance_m.y, p.part.x), p.part.y);
}

// Distance of the surface in a direction, +inf for sky. On a plane, major axis over distance is linear in the position
// on the face, also across its border. If the four texels are not of one plane, the nearest texel is used.
float on_planes(texture2DArray faces, vec3 from_center, uint place) {
    float size = float(frame.counts.z);
    vec3 face = face_from_direction(from_center), a = abs(from_center);
    Patch texels = patch_of(faces, face, place, 0);
    vec2 corner = face.xy * size - 0.5 - texels.part;
    vec2 low = 2.0 * (corner + 0.5) / size - 1.0, high = low + 2.0 / size;
    vec4 u = vec4(low.x, high.x, high.x, low.x), v = vec4(high.y, high.y, low.y, low.y);
    vec4 q = sqrt(1.0 + u * u + v * v) / texels.distance_m;
    float least = min(min(q.x, q.y), min(q.z, q.w)), most = max(max(q.x, q.y), max(q.z, q.w));
    if (abs(q.x - q.w - (q.y - q.z)) <= 0.02 * least && most < 2.0 * least) {
        float on_plane = mean_of(Patch(q, texels.part));
        return length(from_center) / max(a.x, max(a.y, a.z)) / max(on_plane, 0.5 * least);
    }
    return nearest_of(texels);
}
#endif
