// Colour at the end of a screen ray, from the previous frame. Next include of a pass with the rows of before_rows.h.
#include "color.glsl"
#include "previous_frame/picture.glsl"

// The colour of a hit that was not visible in the previous frame, sampled from a cube map by its position.
Found not_shown(Ray ray) {
    const Found NOTHING = Found(vec4(0.0), 0.0);
    if (hidden == hidden_black) return NOTHING;
    if (ray.endless) return SKY;
    uint place = nearest_active(ray.end);
    return place < frame.counts.x ? found_in_cubemap(ray, place) : NOTHING;
}

vec4 color_before(Ray ray, out uint source) {
    vec3 place = place_before(ray.end, ray.endless);
    source = source_of(place);
    Found found;
    uint image = uses_scene() ? IMAGE_previous_scene : IMAGE_previous_lit;
    if (source == SHOWN) found = found_color(record_picture(image, place.xy, 0.0, picture_before(place)));
    else if (has_previous_picture()) found = not_shown(ray);
    else found = found_on_screen(ray); // a capture without the previous frame
    return source_color(found.color.a > 0.0 ? through_fog(found, ray) : found.color);
}
