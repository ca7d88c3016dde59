// Point and spot lights at a place of camera-relative world space. Everything is precise: a place that a mask or a rectangle leaves out has to be
// one where the light is exactly 0.
#ifndef GLINT_LAMP
#define GLINT_LAMP
#include "shared/camera.glsl"

// The place of the surface in a pixel.
precise vec3 surface_place(ivec2 pixel, float depth_m) {
    return mat3(frame.world_from_view) * view_position((vec2(pixel) + 0.5) / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
}

bool is_spot(int lamp) { return frame.lamp_cone[lamp].y > -2.0; }
precise vec3 way_to_lamp(int lamp, vec3 place) { return frame.lamp_place[lamp].xyz - place; }
// Cosine of the angle between a spot light's axis and the way from it.
precise float cosine_to_axis(int lamp, vec3 way, float distance_m) { return -dot(way, frame.lamp_axis[lamp].xyz) / distance_m; }

// Whether the lamp's light may reach a place: within its range and its cone. cones: spot lights shine in their cones alone; range: light ends.
bool lamp_reaches(int lamp, vec3 place, bool cones, bool range) {
    precise vec3 way = way_to_lamp(lamp, place);
    precise float square = dot(way, way), end = frame.lamp_place[lamp].w;
    if (range && !(square < end * end)) return false;
    return !(cones && is_spot(lamp)) || cosine_to_axis(lamp, way, sqrt(square)) > frame.lamp_cone[lamp].y;
}

// How light fades out towards its range: squares as a part of the range's, and towards the rim of a cone: 1 where it begins to fade, 0 at the rim.
const int FADE_SQUARED = 0, FADE_FOURTH = 1, FADE_CONE_SMOOTH = 0, FADE_CONE_SQUARED = 1;
precise float range_fade(float part, int fade) {
    float left = fade == FADE_SQUARED ? 1.0 - part : fade == FADE_FOURTH ? 1.0 - part * part : 1.0;
    return left * left;
}
precise float cone_fade(float part, int fade) {
    float inside = clamp(part, 0.0, 1.0);
    return fade == FADE_CONE_SMOOTH ? inside * inside * (3.0 - 2.0 * inside) : fade == FADE_CONE_SQUARED ? inside * inside : 1.0;
}

// Irradiance at a place, of a surface that faces the lamp, by its radiant intensity. A surface is never nearer to its middle than its radius.
struct LampFades {
    bool cones, range;
    int of_range, of_cone;
};
precise float lamp_factor(int lamp, vec3 place, LampFades fades) {
    if (!lamp_reaches(lamp, place, fades.cones, fades.range)) return 0.0;
    vec3 way = way_to_lamp(lamp, place);
    float square = dot(way, way), radius = frame.lamp_light[lamp].w, end = frame.lamp_place[lamp].w, factor = 1.0;
    if (fades.range && end < INFINITE) factor = range_fade(square / (end * end), fades.of_range);
    if (fades.cones && is_spot(lamp)) {
        vec2 cone = frame.lamp_cone[lamp].xy;
        factor *= cone_fade((cosine_to_axis(lamp, way, sqrt(square)) - cone.y) / max(cone.x - cone.y, 1e-6), fades.of_cone);
    }
    return square > 0.0 ? factor / max(square, radius * radius) : 0.0;
}
#endif
