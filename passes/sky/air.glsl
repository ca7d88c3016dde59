// Rays through the air over a planet's ground, or over flat ground where the capture has no atmosphere. Altitudes are in m above the ground. A ray
// starts at an altitude `high` and rises by `slope` metres a metre there.
#ifndef GLINT_AIR
#define GLINT_AIR
#include "shared/camera.glsl"

// Half the curvature of the ground, 1/m.
float curve() { return frame.atmosphere.x > 0.0 ? 0.5 / frame.atmosphere.x : 0.0; }

// The altitude a at a place of the ray: a (1 + a · curve) is a polynomial of the place, by which nothing cancels, as it would in distances from
// the planet's middle.
float altitude_at(float high, float slope, float along_m) {
    float c = curve(), level = high * (1.0 + high * c) + along_m * ((1.0 + 2.0 * high * c) * slope + along_m * c);
    return level / (0.5 + 0.5 * sqrt(max(1.0 + 4.0 * c * level, 0.0)));
}

// The rise per metre towards a direction at a place of the ray, where the planet's up has turned. upward, ahead: cosines between the direction
// and up at the start, and the ray.
float slope_towards(float high, float slope, float along_m, float upward, float ahead) {
    float c = curve(), level = high * (1.0 + high * c) + along_m * ((1.0 + 2.0 * high * c) * slope + along_m * c);
    return ((1.0 + 2.0 * high * c) * upward + 2.0 * c * along_m * ahead) * inversesqrt(max(1.0 + 4.0 * c * level, 1e-6));
}

// The places between which the ray, prolonged both ways, is below an altitude; the first is the larger one where it never is.
vec2 below(float high, float slope, float altitude) {
    float c = curve(), b = (1.0 + 2.0 * high * c) * slope, rest = (high - altitude) * (1.0 + (high + altitude) * c);
    if (abs(b) < 1e-7) b = 1e-7;
    float inner = b * b - 4.0 * c * rest;
    if (inner < 0.0) return vec2(LARGEST, -LARGEST);
    float q = -0.5 * (b + (b < 0.0 ? -1.0 : 1.0) * sqrt(inner)), one = rest / q, other = c > 0.0 ? q / c : q > 0.0 ? LARGEST : -LARGEST;
    return vec2(min(one, other), max(one, other));
}
// Where a ray from no lower than the ground meets it, or a negative number. On the ground a falling ray meets it where it starts.
float ground_at(float high, float slope) {
    vec2 inside = below(max(high, 0.0), slope, 0.0);
    return inside.y > max(inside.x, 0.0) ? inside.x : -1.0;
}
bool meets_ground(float high, float slope) { return ground_at(high, slope) >= 0.0; }

// Where steps of a ray begin and end: shorter ones near its start. part: in [0, 1].
float step_place(vec2 range, float part) { return mix(range.x, range.y, part * part); }

// Molecules and particles between two places, as metres of air at the ground that hold as many: exact for a density that falls exponentially
// between the two, as it does along a straight line over flat ground.
vec2 air_between(float first_m, float last_m, float altitude_first, float altitude_last) {
    vec2 heights = vec2(frame.rayleigh.w, frame.mie.z), fall = abs(altitude_last - altitude_first) / heights;
    vec2 mean = vec2(1.0);
    for (int i = 0; i < 2; ++i)
        if (fall[i] > 1e-6) mean[i] = -expm1(-fall[i]) / fall[i];
    return (last_m - first_m) * mean * exp(-min(altitude_first, altitude_last) / heights); // from the lower end: exponents are not positive
}
vec2 air_along(float high, float slope, vec2 range, int steps) {
    vec2 sum = vec2(0.0);
    float place = range.x, altitude = altitude_at(high, slope, place);
    for (int i = 1; i <= steps; ++i) {
        float next = step_place(range, float(i) / float(steps)), then = altitude_at(high, slope, next);
        sum += air_between(place, next, altitude, then);
        place = next, altitude = then;
    }
    return sum;
}
vec3 air_depth(vec2 air) { return frame.rayleigh.rgb * air.x + vec3(frame.mie.y * air.y); }

// The part of the sun's light that comes through the air to an altitude.
vec3 sun_through_air(float high, float slope, int steps) {
    if (!(frame.atmosphere.x > 0.0)) return vec3(1.0);
    high = max(high, 0.0);
    if (meets_ground(high, slope)) return vec3(0.0);
    float end = below(high, slope, frame.atmosphere.y).y;
    return end > 0.0 ? exp(-air_depth(air_along(high, slope, vec2(0.0, end), steps))) : vec3(1.0);
}

// Sunlight that molecules and particles between two places of a ray scatter to its start, without phase functions, and the part of light from behind that
// passes them. Within a step light is absorbed as evenly as it is scattered, so that no step sends on more than it gets.
struct Scattered {
    vec3 molecules, particles, passed;
};
Scattered scattered(float high, float slope, vec2 range, vec3 direction, int steps, int light_steps) {
    float upward = dot(frame.sun_direction.xyz, frame.up.xyz), ahead = dot(frame.sun_direction.xyz, direction);
    Scattered s = Scattered(vec3(0.0), vec3(0.0), vec3(1.0));
    float place = range.x, altitude = altitude_at(high, slope, place);
    for (int i = 1; i <= steps; ++i) {
        float next = step_place(range, float(i) / float(steps)), then = altitude_at(high, slope, next), middle = 0.5 * (place + next);
        vec2 air = air_between(place, next, altitude, then);
        vec3 depth = air_depth(air), kept = exp(-depth);
        vec3 mean = mix(1.0 - 0.5 * depth, (1.0 - kept) / max(depth, vec3(1e-20)), greaterThan(depth, vec3(1e-3)));
        vec3 sun = sun_through_air(altitude_at(high, slope, middle), slope_towards(high, slope, middle, upward, ahead), light_steps);
        s.molecules += s.passed * mean * sun * air.x;
        s.particles += s.passed * mean * sun * air.y;
        s.passed *= kept;
        place = next, altitude = then;
    }
    float light = dot(frame.sun_direction.xyz, frame.sun_direction.xyz) > 0.0 ? 1.0 : 0.0;
    s.molecules *= light * frame.sun_above.rgb * frame.rayleigh.rgb;
    s.particles *= light * frame.sun_above.rgb * frame.mie.x;
    return s;
}

// Scattered light per solid angle. Lord Rayleigh 1871; L. Henyey, J. Greenstein, Diffuse radiation in the galaxy, 1941.
float rayleigh_phase(float cosine) { return 3.0 / (16.0 * PI) * (1.0 + cosine * cosine); }
float mie_phase(float cosine, float asymmetry) {
    float from = 1.0 + asymmetry * asymmetry - 2.0 * asymmetry * cosine;
    return (1.0 - asymmetry * asymmetry) / (4.0 * PI * from * sqrt(from));
}

// The view ray of a place of the picture, in world axes.
vec3 ray_at(vec2 uv) {
    return normalize(mat3(frame.world_from_view) * view_position(uv, 1.0, frame.view_from_uv, frame.depth_range.z));
}
#endif
