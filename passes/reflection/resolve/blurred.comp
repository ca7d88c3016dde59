#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "blurred.pass.h"
#include "shared/push_begin.glsl"
#include "blurred.pass.h"
};
#include "shared/camera.glsl"
#include "shared/cone.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

// Fades from 0 at `none` to 1 at `full`, in either direction; a step if both are equal.
float fade(float none, float full, float at) {
    if (none == full) return at > full ? 1.0 : 0.0;
    float x = clamp((at - none) / (full - none), 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

// Fades by the distance to the nearest border. The source's product of smoothsteps is 0 in the outer 5 % on one side but fades up to the
// border on the other, and keeps a ray if either axis is inside.
float edge_attenuation(vec2 uv) {
    vec2 inside = min(uv, 1.0 - uv);
    return fade(0.0, edge_fade, min(inside.x, inside.y));
}

vec3 picture(vec2 uv, bool finished_picture) {
    return (finished_picture ? textureLod(sampler2D(scene, linear_clamp), uv, 0.0)
                             : textureLod(sampler2D(lit, linear_clamp), uv, 0.0)).rgb;
}

void probe_sample(vec2 uv, bool finished_picture, float weight, vec3 color) {
    uint image = finished_picture ? IMAGE_scene : IMAGE_lit;
    probe(PROBE_sample, vec4(image, uv * vec2(frame.size.xy), weight), vec4(color, 0.0));
}

// The mean over a square without values that are not finite.
vec3 box(vec2 uv, float radius, bool finished_picture) {
    if (radius < 0.5 || taps == 1) {
        vec3 color = picture(uv, finished_picture);
        probe_sample(uv, finished_picture, 1.0, color);
        return color;
    }
    // Half the distance between two taps. Positions are whole multiples of it, so that they do not depend on how the shader was specialized:
    // a quotient of constants is rounded exactly where the loop is unrolled, and a product with a rounded reciprocal where it is not.
    precise vec2 apart = radius / (float(taps) * vec2(frame.size.xy));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps * taps; ++i) {
        precise vec2 place = uv + vec2(2 * ivec2(i % taps, i / taps) + 1 - taps) * apart;
        vec3 color = picture(place, finished_picture);
        bool usable = all(lessThan(abs(color), vec3(LARGEST)));
        probe_sample(place, finished_picture, float(usable), color);
        if (usable) sum += vec4(color, 1.0);
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
}

struct End {
    vec4 color, attenuation;
};

End end_of(ivec2 pixel, float depth_m, vec3 normal) {
    End nothing = End(vec4(0.0), vec4(0.0));
    if (texelFetch(screen_finished, pixel, 0).x == 0u) return nothing;
    vec2 from = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(from, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(position, normal);
    float travelled_m = texelFetch(screen_travelled, pixel, 0).x;
    bool endless = !(travelled_m < LARGEST);
    vec3 end = mat3(frame.view_from_world) * (endless ? direction : position + direction * travelled_m);
    float end_depth = end.z * frame.depth_range.z;
    if (!(end_depth > 0.0)) return nothing;
    vec2 uv = clamp(project(end, frame.uv_from_view, frame.depth_range.z), 0.0, 1.0);
    ivec2 at = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    vec4 attenuation = vec4(1.0);
    if (viewer) attenuation.x = fade(viewer_to, viewer_from, dot(direction, -normalize(position)));
    if (edge) attenuation.y = edge_attenuation(uv);
    if (back_face && !endless) attenuation.z = fade(back_from, back_to, dot(normalize(texelFetch(normal_full, at, 0).xyz), -direction));
    if (foreground && frame.foreground.z != 0u) {
        uint id = texelFetch(stencil_full, min(at, textureSize(stencil_full, 0) - 1), 0).x; // without ids the image is a single texel
        if ((id & frame.foreground.y) == frame.foreground.x) attenuation.w = 0.0;
    }
    float angle = has_cone_half ? texelFetch(cone_half, pixel, 0).x : 0.0;
    float spread = endless ? 1.0 / end_depth : travelled_m / end_depth; // for a unit direction
    float radius = blur * cone_tangent(angle) * spread * abs(frame.uv_from_view.x) * float(frame.size.x);
    bool finished_picture = deferred && textureSize(scene, 0) == textureSize(lit, 0);
    return End(vec4(box(uv, min(radius, blur_limit), finished_picture), 1.0), attenuation);
}

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    End end = End(vec4(0.0), vec4(0.0));
    probe_texel(pixel);
    if (tile_works && reflects(depth_m, normal)) end = end_of(pixel, depth_m, normal);
    imageStore(reflection_half, pixel, end.color);
    float part = end.attenuation.x * end.attenuation.y * end.attenuation.z * end.attenuation.w;
    part = is_pick_shown(texelFetch(pick, pixel, 0).x) ? part : 0.0;
    probe(PROBE_attenuation, end.attenuation, vec4(part));
    imageStore(contribution, pixel, vec4(part));
    if (diagnostics) imageStore(attenuation, pixel, end.attenuation);
}
