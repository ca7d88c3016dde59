#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "box.pass.h"
#include "shared/push_begin.glsl"
#include "box.pass.h"
};
#include "proxy.glsl"

// A hull is intersected by its planes as a box is; a sphere is replaced by its bounding cube.
Result end_of(vec3 origin, vec3 direction, float start_m, uint best) {
    vec3 center = active_centers[best].xyz;
    if (!fact_volumes) return end_on_proxy(origin, direction, start_m, best, within_cube(origin - center, direction, default_m), 0u);
    vec4 head = texelFetch(active_volume, ivec2(0, best), 0);
    int planes = int(head.x);
    vec2 span = ALWAYS;
    for (int i = 0; i < planes; ++i) {
        vec4 plane = texelFetch(active_volume, ivec2(1 + i, best), 0);
        span = within_plane(span, dot(plane.xyz, origin) + plane.w - grow_m, dot(plane.xyz, direction));
    }
    if (planes == 0 && head.y > 0.0) {
        vec4 sphere = texelFetch(active_volume, ivec2(1, best), 0);
        span = within_cube(origin - sphere.xyz, direction, sphere.w + grow_m);
    } else if (planes == 0) {
        span = within_cube(origin - center, direction, default_m);
    }
    return end_on_proxy(origin, direction, start_m, best, span, 1u + uint(planes) + uint(head.y));
}
