// The light that arrives along a ray: from the picture where the ray ends on screen, or else from a volume of light or a cube map. Next include
// of a pass with the rows of slot.h and picture_rows.h, after a screen tracer.
const bool filter_color = true;
#include "previous_frame/picture.glsl"
#include "shared/active.glsl"
#include "shared/cube_filter.glsl"
#include "shared/cubemap.glsl"
#include "volume.glsl"

struct Arriving {
    vec3 light;
    float missed; // the part of the ray that found nothing, 0 to 1
    uint fetches;
};

// Where a ray through a point, relative to a cube map's centre, meets the surfaces that the map shows: the ray meets a sphere about the centre,
// whose radius is the distance in the direction of the point found before.
vec3 corrected(vec3 from, vec3 direction, uint place) {
    if (corrections == 0 || !has_distances(place)) return direction;
    vec3 at = direction;
    float along = dot(from, direction), away2 = dot(from, from);
    for (int i = 0; i < corrections; ++i) {
        float distance_m = textureLod(samplerCubeArray(cubemap_distance, nearest_clamp), vec4(at, place), 0.0).x;
        if (!(distance_m < LARGEST)) return direction;
        float inside2 = along * along - away2 + distance_m * distance_m;
        at = from + max(sqrt(max(inside2, 0.0)) - along, 0.0) * direction;
        if (dot(at, at) == 0.0) return direction;
    }
    return at;
}

// a: 1 where there is no sky.
vec4 sky_light(vec3 direction) { return frame.counts.w > 0u ? vec4(cube_finest(sky_cube, direction).rgb, 0.0) : vec4(0.0, 0.0, 0.0, 1.0); }

vec4 cubemap_light(vec3 position, vec3 direction, inout uint fetches) {
    uint place = frame.counts.x > 0u && has_active_center ? nearest_active(position) : 255u;
    fetches++;
    if (place >= frame.counts.x) return sky_light(direction);
    fetches += uint(corrections) + 1u;
    vec4 color = cube_finest(cubemap_color, vec4(corrected(position - active_centers[place].xyz, direction, place), place));
    return vec4(color.rgb, 0.0) + (1.0 - clamp(color.a, 0.0, 1.0)) * sky_light(direction);
}

// a: the part that found nothing.
vec4 light_off_screen(vec3 position, vec3 direction, inout uint fetches) {
    if (fallback == fallback_black) return vec4(0.0);
    if (fallback == fallback_captured) return vec4(0.0, 0.0, 0.0, 1.0);
    if (fallback == fallback_volume && has_volume()) return volume_light(position, direction, fetches);
    return cubemap_light(position, direction, fetches);
}

// The light of the picture at a ray's end; false: it shows something else there.
bool light_on_screen(vec3 end, bool endless, out vec3 light, inout uint fetches) {
    light = vec3(0.0);
    if (screen == screen_previous && has_previous_picture() && frame.flags.y == 0u) {
        vec3 place = place_before(end, endless);
        fetches += 2u;
        if (source_of(place) != SHOWN) return false;
        fetches += joint ? 5u : 1u;
        light = picture_before(place);
        return true;
    }
    vec3 view = mat3(frame.view_from_world) * end;
    float depth_m = view.z * frame.depth_range.z;
    if (!(depth_m > 0.0)) return false;
    vec2 uv = clamp(project(view, frame.uv_from_view, frame.depth_range.z), 0.0, 1.0);
    fetches += joint ? 5u : 1u;
    light = joint ? joint_texels(lit, depth_full, uv, endless ? INFINITE : depth_m, hidden_depth).rgb
                  : textureLod(sampler2D(lit, linear_clamp), uv, 0.0).rgb;
    return true;
}

// position, direction: of the ray, camera-relative world.
Arriving arriving_light(vec3 position, vec3 direction, Result traced) {
    Arriving result = Arriving(vec3(0.0), 0.0, 0u);
    bool endless = !(traced.travelled_m < LARGEST);
    vec3 stopped = endless ? position : position + traced.travelled_m * direction;
    if (!(traced.finished && light_on_screen(endless ? direction : stopped, endless, result.light, result.fetches))) {
        vec4 found = light_off_screen(lookup == lookup_stopped ? stopped : position, direction, result.fetches);
        result.light = found.rgb;
        result.missed = found.a;
    }
    // Pictures and volumes are others' values.
    bool valid = finite(vec4(result.light, result.missed));
    result.light = valid ? max(result.light, 0.0) : vec3(0.0);
    result.missed = valid ? result.missed : 1.0;
    return result;
}
