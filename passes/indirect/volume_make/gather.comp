#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "gather.pass.h"
#include "shared/push_begin.glsl"
#include "gather.pass.h"
};
#include "shared/active.glsl"
#include "shared/cubemap.glsl"
#include "shared/luminance.glsl"

float distance_of(uint place, vec3 direction) {
    return textureLod(samplerCubeArray(cubemap_distance, nearest_clamp), vec4(direction, place), 0.0).x;
}

// The nearest of the cube maps that see a point, or of all if none does.
uint cubemap_of(vec3 point, out bool open) {
    uint seeing = 0u;
    for (uint i = 0u; i < min(frame.counts.x, ACTIVE_MOST); ++i) {
        vec3 way = point - active_centers[i].xyz;
        if (!has_distances(i) || !(length(way) > distance_of(i, way) + tolerance * cell_m)) seeing |= 1u << i;
    }
    open = seeing != 0u;
    return nearest_among(open ? seeing : ~0u, point);
}

vec3 color_of(uint place, vec3 direction) {
    vec4 color = textureLod(samplerCubeArray(cubemap_color, nearest_clamp), vec4(direction, place), 0.0);
    vec3 light = color.rgb;
    if (frame.counts.w > 0u && color.a < 1.0)
        light += (1.0 - clamp(color.a, 0.0, 1.0)) * textureLod(samplerCube(sky, nearest_clamp), direction, 0.0).rgb;
    return finite(vec4(light, 0.0)) ? max(light, 0.0) : vec3(0.0);
}

// A texel of the cube map as the point sees it: a patch of a surface at its distance. w: its solid angle, but for how the patch is turned. Patches
// nearer to the point than a quarter of their distance from the centre are taken to be that far.
vec4 patch_from(vec3 point, uint place, vec3 on_face, float area) {
    float length2 = dot(on_face, on_face);
    vec3 direction = on_face * inversesqrt(length2);
    float angle = area * inversesqrt(length2) / length2, distance_m = distance_of(place, direction);
    if (!moved || !has_distances(place) || !(distance_m < LARGEST)) return vec4(direction, angle);
    vec3 way = active_centers[place].xyz + distance_m * direction - point;
    float away2 = dot(way, way);
    return vec4(away2 > 0.0 ? way * inversesqrt(away2) : direction, angle * min(distance_m * distance_m / max(away2, 1e-12), 16.0));
}

void main() {
    load_active_centers();
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(volume_radiance);
    if (any(greaterThanEqual(at, size))) return;
    ivec3 cell = ivec3(at.x, at.y % int(frame.grid.y), at.y / int(frame.grid.y));
    vec3 point = (vec3(cell) + 0.5 - 0.5 * vec3(frame.grid.xyz)) * cell_m, light = vec3(0.0), main_direction = vec3(0.0), middle = vec3(0.0);
    bool open;
    uint place = cubemap_of(point, open);
    float total = 0.0, bright = 0.0, side = 1.0 / float(taps);
    for (int i = 0; place < frame.counts.x && i < 6 * taps * taps; ++i) {
        ivec2 tap = ivec2(i % taps, i / taps % taps);
        vec3 on_face = direction_from_face(vec3((vec2(tap) + 0.5) * side, i / (taps * taps)));
        vec4 seen = patch_from(point, place, on_face, 4.0 * side * side);
        vec3 color = color_of(place, on_face);
        float weight = seen.w * luminance(color);
        light += seen.w * color;
        main_direction += weight * seen.xyz;
        middle += seen.w * seen.xyz;
        total += seen.w;
        bright += weight;
    }
    imageStore(volume_radiance, at, vec4(total > 0.0 ? light / total : vec3(0.0), open ? 1.0 : 0.0));
    // The solid angles of all directions have no direction; what they have here is the error of those that are estimated.
    imageStore(volume_direction, at, vec4(bright > 0.0 ? main_direction / bright - middle / total : vec3(0.0), cell_m));
}
