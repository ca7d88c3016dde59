// Inner volumes, which contain no surface, so that a ray can skip them.
#ifndef GLINT_VOLUME
#define GLINT_VOLUME
#include "shared/constants.glsl"

// Row `place` of the table: (number of planes, 1 with a sphere, 0, 0), then planes (n, d) with n·p + d <= 0 inside, then the
// sphere (centre, radius). Returns where the ray leaves the volume, or start_m if it does not enter it within the next
// step, which would not be tested either. So a volume need not touch the surfaces around it.
float leaves_volume(texture2D table, uint place, vec3 origin, vec3 direction, float start_m, float step_m) {
    vec4 head = texelFetch(table, ivec2(0, place), 0);
    int planes = int(head.x);
    if (planes == 0 && head.y == 0.0) return start_m;
    vec3 at = origin + direction * start_m;
    float in_m = 0.0, out_m = LARGEST;
    for (int i = 0; i < planes; ++i) {
        vec4 plane = texelFetch(table, ivec2(1 + i, place), 0);
        float outside_m = dot(plane.xyz, at) + plane.w, rate = dot(plane.xyz, direction);
        if (rate < 0.0) in_m = max(in_m, -outside_m / rate);
        else if (rate > 0.0) out_m = min(out_m, -outside_m / rate);
        else if (outside_m > 0.0) return start_m;
    }
    if (head.y > 0.0) {
        vec4 sphere = texelFetch(table, ivec2(1 + planes, place), 0);
        vec3 from_center = at - sphere.xyz;
        float half_b = dot(from_center, direction), root = half_b * half_b - dot(from_center, from_center) + sphere.w * sphere.w;
        if (root < 0.0) return start_m;
        in_m = max(in_m, -half_b - sqrt(root));
        out_m = min(out_m, -half_b + sqrt(root));
    }
    return in_m <= step_m && in_m < out_m && out_m < LARGEST ? start_m + out_m : start_m;
}
#endif
