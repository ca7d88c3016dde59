// Intersects rays with the proxy shape that approximates the surroundings of a cube map. The shape is the cube map's inner volume, enlarged;
// a cube map without one has a shape of fixed size around its centre.
#include "shared/cube_filter.glsl"
#include "single.glsl"

// The interval of a ray inside a convex shape, (enters, leaves); enters > leaves if it misses.
const vec2 ALWAYS = vec2(-LARGEST, LARGEST);

vec2 within_plane(vec2 span, float outside_m, float rate) {
    if (rate > 0.0) span.y = min(span.y, -outside_m / rate);
    else if (rate < 0.0) span.x = max(span.x, -outside_m / rate);
    else if (outside_m > 0.0) span = -ALWAYS;
    return span;
}

vec2 within_sphere(vec3 from_center, vec3 direction, float radius) {
    float along = -dot(from_center, direction);
    // The distance from the axis by the rejected component: a difference of squares would cancel far away.
    vec3 aside = from_center + along * direction;
    float root = radius * radius - dot(aside, aside);
    return root < 0.0 ? -ALWAYS : along + vec2(-sqrt(root), sqrt(root));
}

vec2 within_cube(vec3 from_center, vec3 direction, float radius) {
    vec2 span = ALWAYS;
    for (int i = 0; i < 3; ++i) {
        float rate = abs(direction[i]), at = direction[i] < 0.0 ? -from_center[i] : from_center[i];
        span = within_plane(span, at - radius, rate);
        span = within_plane(span, -at - radius, -rate);
    }
    return span;
}

// A ray that misses the proxy, or had left it before its screen trace ended, is sampled where that ended or by its direction.
Result end_on_proxy(vec3 origin, vec3 direction, float start_m, uint best, vec2 span, uint fetches) {
    if (!(span.x <= span.y && span.y > 0.0 && span.y < LARGEST)) {
        probe(PROBE_cubemap_proxy, vec4(best, span, -1.0));
        Result result = by_direction(best);
        result.fetches = fetches;
        return result;
    }
    Result result = Result(max(span.y, start_m), best, END_hit, fetches);
    if (!sky) {
        probe(PROBE_cubemap_proxy, vec4(best, span, -1.0));
        return result;
    }
    result.fetches++;
    vec4 at = vec4(origin + result.travelled_m * direction - active_centers[best].xyz, best);
    float alpha = cube_finest(cubemap_color, at).a;
    probe(PROBE_cubemap_proxy, vec4(best, span, alpha));
    if (alpha > 0.0) return result;
    return Result(INFINITE, place_of_sky(best), END_sky, result.fetches);
}
