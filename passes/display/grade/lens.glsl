// What a lens does to the linear picture. Next include of a pass that defines vec3 linear_picture(ivec2 pixel).
vec3 level_color(ivec2 pixel, int level) { return linear_picture(pixel); }
#include "filtering/between.glsl"

// From the middle of the picture in pixels; the corners are at the distance 1.
vec2 from_middle(vec2 place) { return (place - 0.5 * vec2(frame.size.xy)) / (0.5 * length(vec2(frame.size.xy))); }

vec3 through_lens(ivec2 pixel) {
    vec2 away = from_middle(vec2(pixel) + 0.5);
    float r2 = dot(away, away);
    vec3 color;
    if (distortion == 0.0) color = linear_picture(pixel);
    else color = color_between(0.5 * vec2(frame.size.xy) + away * (0.5 * length(vec2(frame.size.xy)) * (1.0 + distortion * r2) / (1.0 + distortion)),
                               ivec2(frame.size.xy), 0);
    return vignette > 0.0 ? color * (1.0 - vignette * smoothstep(vignette_from, 1.0, sqrt(r2))) : color;
}
