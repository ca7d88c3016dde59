// The active cube maps' centres, w: their fade, in shared memory, since every invocation reads several of them. Call
// load_active_centers() before any invocation returns.
#include "shared/constants.glsl"

const uint ACTIVE_MOST = 16u;
shared vec4 active_centers[ACTIVE_MOST];

void load_active_centers() {
    if (gl_LocalInvocationIndex < min(frame.counts.x, ACTIVE_MOST))
        active_centers[gl_LocalInvocationIndex] = texelFetch(active_center, ivec2(gl_LocalInvocationIndex, 0), 0);
    barrier();
}

// Rays cannot be traced in a cube map without distances; its texels of cubemap_distance are those of the sky.
bool has_distances(uint place) { return place < ACTIVE_MOST && (frame.distances.x >> place & 1u) != 0u; }

// The active cube map whose centre is nearest to a point, of those whose bit is set; 255 if there is none.
uint nearest_among(uint bits, vec3 point) {
    uint best = 255u;
    float best_distance2 = INFINITE;
    for (uint i = 0u; i < min(frame.counts.x, ACTIVE_MOST); ++i) {
        if ((bits >> i & 1u) == 0u) continue;
        vec3 offset = point - active_centers[i].xyz;
        float distance2 = dot(offset, offset);
        if (distance2 < best_distance2) {
            best_distance2 = distance2;
            best = i;
        }
    }
    return best;
}
uint nearest_active(vec3 point) { return nearest_among(~0u, point); }
