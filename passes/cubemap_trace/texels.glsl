// Distances of the texels around a direction.
#ifndef GLINT_TEXELS
#define GLINT_TEXELS
#include "shared/cubemap.glsl"

// Four texels of a face between which a place on it lies, in gather's order (0,1) (1,1) (1,0) (0,0), and where between. Near
// the border the face's last two rows are continued. Interpolated here, because what a sampler makes of them may depend
// on the neighbouring invocations, which are others when a list is worked on.
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
#endif
