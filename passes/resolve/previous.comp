#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "previous.pass.h"
#include "shared/push_begin.glsl"
#include "previous.pass.h"
};
#include "resolve/color.glsl"

const uint SHOWN = 1u, OUTSIDE = 2u, HIDDEN = 3u;

bool of_frame(texture2D image) { return textureSize(image, 0) == ivec2(frame.size.xy); }

// Where the end of the ray was seen in the previous frame, and how deep it lay; +inf for the sky. Depth 0: behind the camera.
vec3 place_before(Ray ray) {
    vec3 now = mat3(frame.view_from_world) * ray.end;
    float front = frame.depth_range.w;
    vec3 then = (frame.previous_view_from_world * vec4(ray.end, ray.endless ? 0.0 : 1.0)).xyz;
    float depth_m = then.z * front;
    if (!(depth_m > 0.0)) return vec3(0.0);
    vec2 uv = project(then, frame.previous_uv_from_view, front);
    if (motion && of_frame(motion_full)) {
        vec2 seen = project(now, frame.uv_from_view, frame.depth_range.z);
        ivec2 pixel = clamp(ivec2(seen * vec2(frame.size.xy)), ivec2(0), ivec2(frame.size.xy) - 1);
        uv = seen + texelFetch(motion_full, pixel, 0).xy;
        // Without its motion along the view, a surface that moves is where a still one would be.
        if (of_frame(motion_depth_full)) depth_m = now.z * frame.depth_range.z + texelFetch(motion_depth_full, pixel, 0).x;
    }
    return vec3(uv, ray.endless ? INFINITE : depth_m);
}

bool shows(vec2 uv, float depth_m) {
    if (!reject || !of_frame(previous_depth)) return true;
    ivec2 pixel = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    float seen_m = texelFetch(previous_depth, pixel, 0).x;
    if (!(depth_m < LARGEST)) return !(seen_m < LARGEST);
    return abs(seen_m - depth_m) <= hidden_depth * depth_m; // false for the sky's +inf
}

vec3 picture_before(vec2 uv) {
    return picture_of == picture_of_scene && of_frame(previous_scene)
               ? textureLod(sampler2D(previous_scene, linear_clamp), uv, 0.0).rgb
               : textureLod(sampler2D(previous_lit, linear_clamp), uv, 0.0).rgb;
}

uint source_of(vec3 place) {
    bool pictured = frame.flags.y == 0u && (of_frame(previous_lit) || of_frame(previous_scene));
    if (!pictured || !(place.z > 0.0)) return OUTSIDE;
    if (!all(greaterThanEqual(place.xy, vec2(0.0))) || !all(lessThanEqual(place.xy, vec2(1.0)))) return OUTSIDE;
    return shows(place.xy, place.z) ? SHOWN : HIDDEN;
}

// A hit that the previous frame does not show. Where it lies is known, so that any cube map can say what is there.
vec4 not_shown(Ray ray, ivec2 pixel) {
    uint place = texelFetch(cubemap_best, pixel, 0).x;
    if (hidden == hidden_black) return vec4(0.0);
    if (ray.endless || place >= frame.counts.x) return ray.endless ? vec4(sky_color(ray), 1.0) : vec4(0.0);
    return cubemap_lookup(ray, place);
}

vec4 reflected_color(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cone = has_cone_half ? texelFetch(cone_half, pixel, 0).x : 0.0;
    Ray ray = ended_ray(position, normal, texelFetch(travelled, pixel, 0).x, cone);
    bool on_screen = texelFetch(screen_finished, pixel, 0).x != 0u;
    if (!on_screen) return color_at_end(ray, false, texelFetch(cubemap_index, pixel, 0).x);
    vec3 place = place_before(ray);
    uint source = source_of(place);
    if (diagnostics) imageStore(previous_source, pixel, uvec4(source));
    vec4 color = source == SHOWN ? vec4(picture_before(place.xy), 1.0) : not_shown(ray, pixel);
    if (color.a > 0.0 && fog && frame.fog_color.w > 0.0) color.rgb = through_fog(color.rgb, ray);
    return color;
}

void main() {
    load_active_centers();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    if (diagnostics) imageStore(previous_source, pixel, uvec4(0u));
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec3 normal = texelFetch(normal_jittered, pixel, 0).xyz;
    vec4 color = reflects(depth_m, normal) ? reflected_color(pixel, depth_m, normal) : vec4(0.0);
    imageStore(reflection_half, pixel, color);
}
