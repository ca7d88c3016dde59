// A ray on screen. At parameter s its position is start + s · across (full-resolution pixels), and its inverse depth is linear in s: with w
// for depth and P, D for the projected origin and direction, the ray parameter is t = s P.w/(1 - s D.w), so 1/w = (1 - s D.w)/P.w.
// Next include of a pass with the parameter length_m.
#include "shared/camera.glsl"
#include "shared/end_reasons.glsl"
#include "shared/probe/record.glsl"

struct ScreenRay {
    vec3 origin, direction; // view
    vec2 start, across;
    float depth_m, rate; // P.w and D.w
    float inverse, inverse_rate;
    float end;           // the last s on screen, in front of the near plane and within the length
    uint limit;          // which of these limits it is, as an end reason
    bool vanishes;       // the end is the ray's vanishing point, beyond which there is nothing
};

precise float travelled_at(ScreenRay ray, float s) { return s * ray.depth_m / (1.0 - s * ray.rate); }
precise float inverse_depth_at(ScreenRay ray, float s) { return ray.inverse + s * ray.inverse_rate; }

// Where a coordinate leaves [0, size].
precise float exit(float start, float across, float size) {
    if (across > 0.0) return max(size - start, 0.0) / across;
    return across < 0.0 ? start / -across : LARGEST;
}

ScreenRay screen_ray(vec2 start, vec3 position, vec3 direction) {
    float front = frame.depth_range.z;
    ScreenRay ray;
    ray.origin = position;
    ray.direction = direction;
    ray.start = start;
    ray.depth_m = position.z * front;
    ray.rate = direction.z * front;
    ray.inverse = 1.0 / ray.depth_m;
    ray.inverse_rate = -ray.rate / ray.depth_m;
    precise vec2 across = direction.xy - position.xy / ray.depth_m * ray.rate;
    ray.across = across * frame.uv_from_view.xy * vec2(frame.size.xy);
    ray.end = min(exit(start.x, ray.across.x, float(frame.size.x)), exit(start.y, ray.across.y, float(frame.size.y)));
    ray.limit = END_left_screen;
    float near = min(frame.depth_range.x, ray.depth_m), in_front = (ray.depth_m - near) / (-ray.rate * near);
    if (ray.rate < 0.0 && in_front < ray.end) {
        ray.end = in_front;
        ray.limit = END_faced_viewer;
    }
    bool shows_vanishing_point = ray.rate > 0.0 && 1.0 / ray.rate <= ray.end;
    float at_length = ray.depth_m + length_m * ray.rate, in_length = length_m / at_length;
    if (at_length > 0.0 && in_length < ray.end) {
        ray.end = in_length;
        ray.limit = END_steps_exhausted;
    }
    ray.vanishes = shows_vanishing_point && (1.0 / ray.rate - ray.end) * length(ray.across) < reduction(frame.size);
    probe(PROBE_screen_ray, vec4(start, ray.depth_m, position.x), vec4(position.yz, direction.xy),
          vec4(direction.z, start + ray.end * ray.across, ray.limit));
    return ray;
}

// Records the test of a texel of depth_half that the ray crosses from s_from to s, which are equal for a sample. surface: the inverse depth
// that the ray's was compared with.
void probe_texel_seen(ScreenRay ray, float s_from, float s, ivec2 texel, float surface, uint decision) {
    if (!probing()) return;
    probe(PROBE_screen_texel, vec4(travelled_at(ray, s_from), travelled_at(ray, s), ray.start + s * ray.across),
          vec4(1.0 / inverse_depth_at(ray, s_from), 1.0 / inverse_depth_at(ray, s), texel),
          vec4(texelFetch(depth_half, texel, 0).x, 1.0 / surface, decision, 0.0));
}

struct Result {
    float travelled_m;
    bool finished;
    uint end, steps, fetches;
};

void probe_screen_end(Result result) {
    probe(PROBE_screen_end, vec4(result.travelled_m, result.finished, result.end, result.steps), vec4(result.fetches));
}
