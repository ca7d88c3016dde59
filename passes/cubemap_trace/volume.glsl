// Inner volumes: known to be empty, so that a ray inside has nothing to meet before it leaves.
#ifndef GLINT_VOLUME
#define GLINT_VOLUME
#include "shared/constants.glsl"

// Row `place` of the table: (number of planes, 1 with a sphere, 0, 0), then planes (n, d) with n·p + d <= 0 inside, then the
// sphere (centre, radius). Returns where the ray leaves the volume, or start_m when it is not inside there. A start on
// the border, as on a floor that closes a room, is inside.
float leaves_volume(texture2D table, uint place, vec3 origin, vec3 direction, float start_m) {
    vec4 head = texelFetch(table, ivec2(0, place), 0);
    int planes = int(head.x);
    if (planes == 0 && head.y == 0.0) return start_m;
    vec3 at = origin + direction * start_m;
    float border_m = 1e-3 + 1e-5 * length(at), end_m = LARGEST;
    for (int i = 0; i < planes; ++i) {
        vec4 plane = texelFetch(table, ivec2(1 + i, place), 0);
        float outside_m = dot(plane.xyz, at) + plane.w, rate = dot(plane.xyz, direction);
        if (outside_m > border_m) return start_m;
        if (rate > 0.0) end_m = min(end_m, start_m + max(-outside_m, 0.0) / rate);
    }
    if (head.y > 0.0) {
        vec4 sphere = texelFetch(table, ivec2(1 + planes, place), 0);
        vec3 from_center = at - sphere.xyz;
        float half_b = dot(from_center, direction), c = dot(from_center, from_center) - sphere.w * sphere.w;
        if (c > 0.0) return start_m;
        end_m = min(end_m, start_m + sqrt(half_b * half_b - c) - half_b);
    }
    return end_m < LARGEST ? end_m : start_m;
}
#endif
