// The linear march. Next include of a pass with the rows of linear_rows.h.
#include "screen_ray.glsl"

// Half-resolution texels. Texel `from` holds the pixel where the ray starts; other texels are assumed to hold the same pixel of their blocks.
struct Grid {
    vec2 from, across; // the position of the ray in texels is from + s · across
    vec2 offset;       // of a texel's pixel in its block, in full-resolution pixels
    float scale;       // full-resolution pixels of a texel
    vec2 last, per_size; // the last texel; 1/size
};

precise vec2 texel_at(Grid grid, float s) { return grid.from + s * grid.across; }

ivec2 nearest_texel(vec2 texel) { return clamp(ivec2(floor(texel + 0.5)), ivec2(0), ivec2(frame.size.zw) - 1); }

// Inverse depth of the depth buffer at a position; 0 for sky. Between four texels of one surface 1/z is bilinear, which is
// exact on planes; across a discontinuity the nearest texel is used.
precise float seen_inverse(vec2 texel, Grid grid) {
    if (!interpolate) return texelFetch(inverse_half, nearest_texel(texel), 0).x;
    texel = clamp(texel, vec2(0.0), grid.last);
    vec2 corner = min(floor(texel), max(grid.last - 1.0, 0.0)), part = texel - corner;
    // Gather's order: (0,1) (1,1) (1,0) (0,0).
    vec4 z = textureGather(sampler2D(inverse_half, nearest_clamp), (corner + 1.0) * grid.per_size);
    float low = min(min(z.x, z.y), min(z.z, z.w)), high = max(max(z.x, z.y), max(z.z, z.w));
    // One surface: 1/z changes equally on opposite sides, as on a plane, and only by a small fraction.
    if (abs(z.x - z.w - (z.y - z.z)) <= 0.02 * low && high < 2.0 * low)
        return mix(mix(z.w, z.z, part.x), mix(z.x, z.y, part.x), part.y);
    return part.x < 0.5 ? (part.y < 0.5 ? z.w : z.x) : (part.y < 0.5 ? z.z : z.y);
}

// The surface of one texel as a plane, in view space.
struct Facet {
    vec3 position, normal;
};

Facet facet_at(vec2 place, Grid grid) {
    ivec2 texel = nearest_texel(place);
    vec2 uv = (vec2(texel) * grid.scale + grid.offset) / vec2(frame.size.xy);
    float depth_m = texelFetch(depth_half, texel, 0).x;
    return Facet(view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z),
                 mat3(frame.view_from_world) * texelFetch(normal_half, texel, 0).xyz);
}

// The parameter at which the ray hits the surface: on the facet of the sample behind it if that is within a texel of the last step, otherwise
// interpolated between the two samples. gap: 1/ray depth - 1/surface depth, negative behind.
precise float meeting(ScreenRay ray, Facet facet, float s_front, float gap_front, float s, float gap, float scale) {
    float t = dot(facet.normal, facet.position - ray.origin) / dot(facet.normal, ray.direction);
    float on_facet = t / (ray.depth_m + t * ray.rate), texel = scale / length(ray.across);
    if (t > 0.0 && on_facet >= s_front - texel && on_facet <= s + texel) return on_facet;
    if (s_front == 0.0) return s; // no sample was in front
    return mix(s_front, s, clamp(gap_front / (gap_front - gap), 0.0, 1.0));
}

// Whether the surface at the ray's position at s is within the thickness of the ray.
bool shows(ScreenRay ray, float s, Grid grid) {
    float depth_m = 1.0 / inverse_depth_at(ray, s), seen_m = 1.0 / seen_inverse(texel_at(grid, s), grid);
    return abs(depth_m - seen_m) <= thickness * depth_m + thickness_m; // false for the sky's +inf
}

Result march(ScreenRay ray, Grid grid, float shift) {
    Result result = Result(0.0, false, ray.limit, 0u, 0u);
    precise float s_front = 0.0, gap_front = 0.0, s_before = 0.0, s_clear = 0.0;
    bool been_behind = false;
    float exponent = first_step > 0.0 && steps > 1 ? -log(first_step) / log(float(steps)) : growth;
    for (int i = 1; i <= steps; ++i) {
        precise float s = ray.end * pow((float(i) - shift) * (1.0 / float(steps)), exponent);
        precise float inverse = inverse_depth_at(ray, s);
        precise vec2 texel = texel_at(grid, s);
        precise float seen = seen_inverse(texel, grid);
        precise float gap = inverse - seen;
        result.steps++;
        result.fetches++;
        if (gap >= -bias * inverse) {
            probe_texel_seen(ray, s, s, nearest_texel(texel), seen, DECISION_front);
            s_before = s_front = s;
            gap_front = gap;
            if (!been_behind) s_clear = s;
            continue;
        }
        // Compares the ray's nearest depth within the step with the far side of the visible surface.
        float least_m = 1.0 / max(inverse, inverse_depth_at(ray, s_before)), seen_m = 1.0 / seen;
        s_before = s;
        uint reason = END_behind, decision = DECISION_behind;
        if (least_m - seen_m <= thickness * seen_m + thickness_m) {
            Facet facet = facet_at(texel, grid);
            result.fetches += 2u;
            if (!back_faces || dot(facet.normal, ray.direction) < 0.0) {
                float s_end = refine ? meeting(ray, facet, s_front, gap_front, s, gap, grid.scale) : s;
                if (verify) result.fetches++;
                if (!verify || shows(ray, s_end, grid)) {
                    probe_texel_seen(ray, s_end, s_end, nearest_texel(texel), seen, DECISION_hit);
                    return Result(travelled_at(ray, s_end), true, END_hit, result.steps, result.fetches);
                }
                decision = DECISION_rejected;
            } else {
                reason = END_back_face;
                decision = DECISION_back_face;
            }
        }
        probe_texel_seen(ray, s, s, nearest_texel(texel), seen, decision);
        been_behind = true;
        result.end = reason;
        if (!pass_behind) break;
    }
    result.travelled_m = travelled_at(ray, s_clear);
    return result;
}
