// A point of this frame in the previous frame's picture. Next include of a pass with the rows of picture_rows.h and the parameters joint and
// filter_color.
#include "filtering/joint.glsl"

const uint SHOWN = 1u, OUTSIDE = 2u, HIDDEN = 3u;

bool of_frame(texture2D image) { return textureSize(image, 0) == ivec2(frame.size.xy); }

// The position of a point in the previous frame, and its depth; +inf for the sky, 0 behind the camera. end: camera-relative world, or the
// direction of something endless.
vec3 place_before(vec3 end, bool endless) {
    vec3 now = mat3(frame.view_from_world) * end;
    float front = frame.depth_range.w;
    vec3 then = (frame.previous_view_from_world * vec4(end, endless ? 0.0 : 1.0)).xyz;
    float depth_m = then.z * front;
    if (!(depth_m > 0.0)) return vec3(0.0);
    vec2 uv = project(then, frame.previous_uv_from_view, front);
    if (motion && of_frame(motion_full)) {
        vec2 seen = project(now, frame.uv_from_view, frame.depth_range.z);
        ivec2 pixel = clamp(ivec2(seen * vec2(frame.size.xy)), ivec2(0), ivec2(frame.size.xy) - 1);
        uv = seen + texelFetch(motion_full, pixel, 0).xy;
        // Motion along the view direction is unknown, so that the depth of a static surface is assumed.
        if (of_frame(motion_depth_full)) depth_m = now.z * frame.depth_range.z + texelFetch(motion_depth_full, pixel, 0).x;
    }
    return vec3(uv, endless ? INFINITE : depth_m);
}

bool shows(vec2 uv, float depth_m) {
    if (!reject || !of_frame(previous_depth)) return true;
    ivec2 pixel = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    float seen_m = texelFetch(previous_depth, pixel, 0).x;
    if (!(depth_m < LARGEST)) return !(seen_m < LARGEST);
    return abs(seen_m - depth_m) <= hidden_depth * depth_m; // false for the sky's +inf
}

// If the previous frame has depths, only the texels that show the ray's end are interpolated.
bool uses_scene() { return color_source == color_source_scene && of_frame(previous_scene); }
vec3 picture_before(vec3 place) {
    bool scene = uses_scene(), parts = joint && of_frame(previous_depth);
    vec3 color = scene ? parts ? joint_texels(previous_scene, previous_depth, place.xy, place.z, hidden_depth).rgb
                               : textureLod(sampler2D(previous_scene, linear_clamp), place.xy, 0.0).rgb
                 : parts ? joint_texels(previous_lit, previous_depth, place.xy, place.z, hidden_depth).rgb
                         : textureLod(sampler2D(previous_lit, linear_clamp), place.xy, 0.0).rgb;
    return color;
}

bool has_previous_picture() { return of_frame(previous_lit) || of_frame(previous_scene); }

uint source_of(vec3 place) {
    if (frame.flags.y != 0u || !has_previous_picture() || !(place.z > 0.0)) return OUTSIDE;
    if (!all(greaterThanEqual(place.xy, vec2(0.0))) || !all(lessThanEqual(place.xy, vec2(1.0)))) return OUTSIDE;
    return shows(place.xy, place.z) ? SHOWN : HIDDEN;
}
