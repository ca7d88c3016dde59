// Colour at the end of a screen ray, from the previous frame. Next include of a pass with the rows of before_rows.h.
#include "color.glsl"

const uint SHOWN = 1u, OUTSIDE = 2u, HIDDEN = 3u;

bool of_frame(texture2D image) { return textureSize(image, 0) == ivec2(frame.size.xy); }

// The position of the ray's end in the previous frame, and its depth; +inf for the sky, 0 behind the camera.
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
        // Motion along the view direction is unknown, so that the depth of a static surface is assumed.
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

// If the previous frame has depths, only the texels that show the ray's end are interpolated.
vec3 picture_before(vec3 place) {
    bool scene = color_source == color_source_scene && of_frame(previous_scene), parts = joint && of_frame(previous_depth);
    vec3 color = scene ? parts ? joint_texels(previous_scene, previous_depth, place.xy, place.z, hidden_depth).rgb
                               : textureLod(sampler2D(previous_scene, linear_clamp), place.xy, 0.0).rgb
                 : parts ? joint_texels(previous_lit, previous_depth, place.xy, place.z, hidden_depth).rgb
                         : textureLod(sampler2D(previous_lit, linear_clamp), place.xy, 0.0).rgb;
    return record_picture(scene ? IMAGE_previous_scene : IMAGE_previous_lit, place.xy, 0.0, color);
}

bool has_previous_picture() { return of_frame(previous_lit) || of_frame(previous_scene); }

uint source_of(vec3 place) {
    if (frame.flags.y != 0u || !has_previous_picture() || !(place.z > 0.0)) return OUTSIDE;
    if (!all(greaterThanEqual(place.xy, vec2(0.0))) || !all(lessThanEqual(place.xy, vec2(1.0)))) return OUTSIDE;
    return shows(place.xy, place.z) ? SHOWN : HIDDEN;
}

// The colour of a hit that was not visible in the previous frame, sampled from a cube map by its position.
Found not_shown(Ray ray) {
    const Found NOTHING = Found(vec4(0.0), 0.0);
    if (hidden == hidden_black) return NOTHING;
    if (ray.endless) return SKY;
    uint place = nearest_active(ray.end);
    return place < frame.counts.x ? found_in_cubemap(ray, place) : NOTHING;
}

vec4 color_before(Ray ray, out uint source) {
    vec3 place = place_before(ray);
    source = source_of(place);
    Found found;
    if (source == SHOWN) found = found_color(picture_before(place));
    else if (has_previous_picture()) found = not_shown(ray);
    else found = found_on_screen(ray); // a capture without the previous frame
    return found.color.a > 0.0 ? through_fog(found, ray) : found.color;
}
