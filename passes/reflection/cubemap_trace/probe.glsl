// Records of tracers through cube maps for probed pixels. Next include of a pass of the slot.
#ifndef GLINT_CUBEMAP_PROBE
#define GLINT_CUBEMAP_PROBE
#include "shared/cubemap.glsl"
#include "shared/probe/record.glsl"

void probe_cubemap_ray(vec3 origin, vec3 direction, float start_m, uint best) {
    probe(PROBE_cubemap_ray, vec4(origin, direction.x), vec4(direction.yz, start_m, best));
}
void probe_cubemap_end(float travelled_m, uint place, uint end, uint steps, uint fetches) {
    probe(PROBE_cubemap_end, vec4(travelled_m, place, end, steps), vec4(fetches));
}

// Records a test of the nearest texel of an image in a direction from a cube map's centre.
void probe_face_texel(texture2DArray faces, uint image, vec3 from_center, uint place, int level, float travelled_m,
                      float step_m, float surface_m, uint decision) {
    if (!probing()) return;
    ivec3 texel = face_texel(from_center, place, max(int(frame.counts.z) >> level, 1));
    probe(PROBE_cubemap_texel, vec4(travelled_m, step_m, place, texel.z - 6 * int(place)),
          vec4(texel.xy, level, image),
          vec4(texelFetch(faces, texel, level).x, length(from_center), surface_m, decision));
}
#endif
