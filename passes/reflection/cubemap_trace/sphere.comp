#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "sphere.pass.h"
#include "shared/push_begin.glsl"
#include "sphere.pass.h"
};
#include "proxy.glsl"

// A volume of planes is replaced by a sphere around the cube map's centre whose radius is their mean distance.
Result end_of(vec3 origin, vec3 direction, float start_m, uint best) {
    vec3 center = active_centers[best].xyz;
    if (!fact_volumes) return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - center, direction, default_m), 0u);
    vec4 head = texelFetch(active_volume, ivec2(0, best), 0);
    int planes = int(head.x);
    vec4 sphere = vec4(center, 0.0);
    if (head.y > 0.0) {
        sphere = texelFetch(active_volume, ivec2(1 + planes, best), 0);
    } else {
        for (int i = 0; i < planes; ++i) {
            vec4 plane = texelFetch(active_volume, ivec2(1 + i, best), 0);
            sphere.w -= (dot(plane.xyz, center) + plane.w) / float(planes);
        }
    }
    float radius = head.y > 0.0 || planes > 0 ? sphere.w + grow_m : default_m;
    uint fetches = 1u + (head.y > 0.0 ? 1u : uint(planes));
    return end_on_proxy(origin, direction, start_m, best, within_sphere(origin - sphere.xyz, direction, radius), fetches);
}
