#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "reflection/resolve/color.glsl"
#include "shared/reuse.glsl"
#include "shared/sampling.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"

// The texel whose ray is used: the one that upscale chose, otherwise the pixel's own.
ivec2 ray_texel(ivec2 pixel) {
    ivec2 own = pixel / int(reduction(frame.size));
    uint source = has_sharp_source ? texelFetch(sharp_source, pixel, 0).x : 0u;
    return source >= 1u && source <= 9u ? own + ivec2((source - 1u) % 3u, (source - 1u) / 3u) - 1 : own;
}

// Whether the texel has a usable ray.
bool has_ray(ivec2 texel) {
    return texelFetch(depth_half, texel, 0).x < LARGEST && is_pick_shown(texelFetch(pick, texel, 0).x);
}

struct End {
    float travelled_m;
    bool finished; // on screen
    uint place;    // of the cube map
};
End end_of(ivec2 texel) {
    return End(texelFetch(travelled, texel, 0).x, texelFetch(screen_finished, texel, 0).x != 0u,
               texelFetch(cubemap_index, texel, 0).x);
}

bool hit_on_screen(End end) { return end.finished && end.travelled_m < LARGEST; }

// The surface that the depth buffer holds at the screen position of a point.
struct Seen {
    bool found;             // the point is on screen
    float depth_m, point_m; // of that surface, +inf for sky, and of the point
    vec3 position, normal;  // of that surface
};
Seen visible_at(vec3 point) {
    precise vec3 view = mat3(frame.view_from_world) * point;
    Seen seen = Seen(false, INFINITE, view.z * frame.depth_range.z, vec3(0.0), vec3(0.0));
    vec2 uv = project(view, frame.uv_from_view, frame.depth_range.z), size = vec2(frame.size.xy);
    if (!(seen.point_m > 0.0) || any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return seen;
    ivec2 pixel = ivec2(uv * size);
    seen.found = true;
    seen.depth_m = texelFetch(depth_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    if (!reflects(seen.depth_m, surface.xyz)) return seen;
    seen.normal = normalize(surface.xyz);
    seen.position = mat3(frame.world_from_view) *
                    view_position((vec2(pixel) + 0.5) / size, seen.depth_m, frame.view_from_uv, frame.depth_range.z);
    return seen;
}

// Intersects the pixel's own ray with the surface near the hit of a neighbouring ray at `first_m`: iteratively with the plane of the
// surface that is visible at the previous intersection, until the intersection lies on the visible surface. 0 if it never does, since only
// visible hits count.
const int PLANES = 3;
const float ON_SURFACE = 1e-3; // relative to depth; twice the rounding of depths and normals in half floats
float own_hit(vec3 position, vec3 direction, float first_m) {
    precise float travelled_m = first_m;
    for (int i = 0; i < PLANES && travelled_m > 0.0 && travelled_m < LARGEST; ++i) {
        precise vec3 end = position + direction * travelled_m;
        Seen seen = visible_at(end);
        float toward = -dot(direction, seen.normal);
        if (!(toward > 0.0)) return 0.0;
        if (in_plane(end - seen.position, seen.normal, seen.depth_m, ON_SURFACE)) return travelled_m;
        travelled_m += dot(end - seen.position, seen.normal) / toward;
    }
    return 0.0;
}

// At silhouettes in the reflection, rays of neighbouring texels hit different surfaces, and the chosen texel's ray may differ from the
// pixel's own. The chosen hit is kept if the own ray confirms it. Otherwise the nearest confirmed hit of the four surrounding texels replaces
// it, unless the chosen ray ends off screen before that. If there is none, and the own ray visibly passes in front of the surface that the
// chosen ray hit, it is treated like a surrounding ray without a hit on screen.
const int AROUND = 4;
const float APART = 1.005; // ratio of distances below which two hits are of the same surface, so that only the first is tried
End own_end(ivec2 pixel, ivec2 chosen, End end, vec3 position, vec3 direction) {
    End past = end;
    if (end.finished && own_hit(position, direction, end.travelled_m) > 0.0) return end;
    ivec2 own = pixel / int(reduction(frame.size)), toward = 2 * (pixel & 1) - 1, last = ivec2(frame.size.zw) - 1;
    float hits_m[AROUND];
    for (int i = 0; i < AROUND; ++i) {
        ivec2 texel = clamp(own + ivec2(i & 1, i >> 1) * toward, ivec2(0), last);
        End beside = end_of(texel);
        bool taken = texel != chosen && has_ray(texel), hit = hit_on_screen(beside);
        hits_m[i] = taken && hit ? beside.travelled_m : INFINITE;
        if (taken && !hit && hit_on_screen(past)) past = beside;
    }
    float limit_m = end.finished ? INFINITE : end.travelled_m, tried_m = 0.0;
    for (int tries = 0; tries < AROUND; ++tries) {
        float first_m = INFINITE;
        for (int i = 0; i < AROUND; ++i) first_m = hits_m[i] > tried_m * APART ? min(first_m, hits_m[i]) : first_m;
        if (first_m == INFINITE) break;
        float hit_m = own_hit(position, direction, first_m);
        if (hit_m > 0.0 && hit_m < limit_m) return End(hit_m, true, end.place);
        tried_m = first_m;
    }
    if (!hit_on_screen(end)) return end;
    Seen seen = visible_at(position + direction * end.travelled_m);
    return seen.found && seen.point_m < seen.depth_m * (1.0 - ON_SURFACE) ? past : end;
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(reflection_sharp)))) return;
    vec4 color = texelFetch(reflection, pixel, 0), surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    ivec2 texel = ray_texel(pixel);
    probe_pixel(pixel);
    bool sharpened = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.xyz) && is_shown(pixel);
    if (sharpened && has_ray(texel)) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        float lobe = ndf == ndf_ggx ? ggx_cone(roughness * roughness, 0.0, threshold, 1.0)
                                    : blinn_phong_cone(roughness, 0.0, threshold, 1.0);
        float cone = min(cone_factor * lobe, WIDEST_CONE);
        vec3 position = mat3(frame.world_from_view) * view;
        End end = end_of(texel);
        if (neighbours) end = own_end(pixel, texel, end, position, mirror_direction(position, surface.xyz));
        vec4 sharp = color_at_end(ended_ray(position, vec4(surface.xyz, roughness), surface.xyz, end.travelled_m, cone), end.finished, end.place);
        if (sharp.a > 0.0) color = mix(sharp, color, blend > 0.0 ? fade(roughness, sharp_roughness - blend, sharp_roughness) : 0.0);
    }
    imageStore(reflection_sharp, pixel, finite(color) || !sharpened ? color : vec4(0.0));
}
