// Colour at the end of a ray (Mafia III talk, Color resolve shaders), filtered over the ray's cone. Next include of a pass with the rows of
// sources.h, which calls load_active_centers().
#include "shared/active.glsl"
#include "shared/camera.glsl"
#include "shared/cone.glsl"
#include "shared/cube_filter.glsl"
#include "shared/fog.glsl"
#include "filtering/joint.glsl"
#include "shared/paraboloid.glsl"
#include "shared/probe/record.glsl"

bool has_probe() { return engine_probe && fact_probe && frame.far_light.x > 0.0; }
// A box holds the surroundings of a place, which cube maps know better.
bool probe_is_sky() { return has_probe() && (frame.far_light.y == 0.0 || frame.counts.x == 0u); }

const float MIN_SHARE = 1.0 / 64.0; // a level with a smaller fraction of sky, or of surfaces, is mostly rounding error

// A traced ray. `end`: camera-relative world; a unit direction if the ray does not end. mirror, roughness: of the surface's lobe, of which the ray
// is a sample.
struct Ray {
    vec3 position, direction, end, mirror;
    float travelled_m, cone, roughness;
    bool endless;
};

// surface: its normal and roughness; normal: the one that the ray is reflected by.
Ray ended_ray(vec3 position, vec4 surface, vec3 normal, float travelled_m, float cone) {
    Ray ray;
    ray.position = position;
    ray.direction = mirror_direction(position, normal);
    ray.mirror = ray.direction;
    if (has_probe()) ray.mirror = mirror_direction(position, surface.xyz);
    ray.roughness = surface.w;
    ray.travelled_m = travelled_m;
    ray.cone = cone;
    ray.endless = !(travelled_m < LARGEST);
    ray.end = ray.endless ? ray.direction : position + ray.direction * travelled_m;
    return ray;
}

void probe_color(uint image, uint place, vec2 uv, float level, vec4 color) {
    probe(PROBE_color, vec4(image, place, uv * vec2(frame.size.xy)), vec4(level, color.rgb), vec4(color.a));
}
vec3 record_sky(uint image, float level, vec3 color) {
    probe_color(image, ACTIVE_MOST, vec2(0.0), level, vec4(color, 1.0));
    return color;
}
vec3 record_picture(uint image, vec2 uv, float level, vec3 color) {
    probe_color(image, ACTIVE_MOST, uv, level, vec4(color, 1.0));
    return color;
}
// alone: divides by the fraction of surfaces, without the sky.
vec4 record_cubemap(uint image, vec4 at, float level, vec4 color, bool alone) {
    if (alone) color = vec4(color.rgb / max(color.a, MIN_SHARE), 1.0);
    probe_color(image, uint(at.w), vec2(0.0), level, color);
    return color;
}

// The level that the engine looks up for a roughness, between the two whose roughnesses are next to it.
float probe_level(float roughness) {
    int last = int(frame.far_light.x) - 1, above = 0;
    while (above < last && frame.probe_roughness[above >> 2][above & 3] < roughness) ++above;
    if (above == 0) return 0.0;
    float low = frame.probe_roughness[(above - 1) >> 2][(above - 1) & 3], high = frame.probe_roughness[above >> 2][above & 3];
    return float(above) - clamp((high - roughness) / (high - low), 0.0, 1.0);
}

// From the centre to where the mirror ray leaves the box, if there is one (S. Lagarde, A. Zanuttini, Local Image-based Lighting With
// Parallax-corrected Cubemap, SIGGRAPH 2012).
vec3 probe_direction(Ray ray) {
    if (frame.far_light.y == 0.0) return ray.mirror;
    vec3 from = ray.position - frame.probe_center.xyz;
    vec3 border = mix(frame.probe_low.xyz, frame.probe_high.xyz, greaterThan(ray.mirror, vec3(0.0)));
    vec3 leaves = mix(vec3(INFINITE), (border - from) / ray.mirror, notEqual(ray.mirror, vec3(0.0)));
    return from + max(min(leaves.x, min(leaves.y, leaves.z)), 0.0) * ray.mirror;
}

vec3 probe_color(Ray ray) {
    float level = probe_level(ray.roughness);
    return record_sky(IMAGE_probe_levels, level, cube_levels(probe_levels, probe_direction(ray), level).rgb);
}

vec3 sky_color(Ray ray) {
    if (!fact_sky_seen) return vec3(0.0);
    if (probe_is_sky()) return probe_color(ray);
    if (ray.cone > 0.0 && cone_cubemap && has_sky_mips) {
        float level = cone_level_cube(ray.cone, INFINITE, 1.0, float(frame.counts.w), texel_scale);
        return record_sky(IMAGE_sky_mips, level, cube_levels(sky_mips, ray.direction, level).rgb);
    }
    return record_sky(IMAGE_sky, 0.0, cube_finest(sky, ray.direction).rgb);
}

// What a ray's end shows: a colour, and the share of the sky that is added to it. Only through_fog() looks the sky up: functions are inlined, so
// that a lookup in each place that may need it would be most of the shader, and of the time to compile it.
struct Found {
    vec4 color;
    float sky;
};
const Found SKY = Found(vec4(0.0, 0.0, 0.0, 1.0), 1.0);
Found found_color(vec3 color) { return Found(vec4(color, 1.0), 0.0); }

Found picture(vec2 uv, ivec2 pixel, Ray ray, float depth_m) {
    if (ray.cone > 0.0 && cone_screen && has_lit_mips) {
        float pixels_at_1m = abs(frame.uv_from_view.x) * float(frame.size.x);
        float level = cone_level_screen(ray.cone, ray.endless ? 1.0 : ray.travelled_m, depth_m, pixels_at_1m, texel_scale,
                                        float(findMSB(max(frame.size.x, frame.size.y))));
        if (level > 0.0 && ray.endless && joint && has_sky_mips && frame.counts.w > 0u) return SKY;
        vec4 color = level > 0.0 ? textureLod(sampler2D(lit_mips, linear_clamp), uv, level) : vec4(0.0);
        // A level without sky at this place has no colour for a ray that does not end.
        if (color.a > (ray.endless ? 1.0 - MIN_SHARE : MIN_SHARE))
            return found_color(record_picture(IMAGE_lit_mips, uv, level, color.rgb / color.a));
    }
    vec3 color = joint          ? joint_texels(lit, depth_full, uv, ray.endless ? INFINITE : depth_m, depth_tolerance).rgb
                 : filter_color ? textureLod(sampler2D(lit, linear_clamp), uv, 0.0).rgb
                                : texelFetch(lit, pixel, 0).rgb;
    return found_color(record_picture(IMAGE_lit, uv, 0.0, color));
}

Found found_on_screen(Ray ray) {
    const Found NOTHING = Found(vec4(0.0), 0.0);
    vec3 end = mat3(frame.view_from_world) * ray.end;
    float depth_m = end.z * frame.depth_range.z;
    if (!(depth_m > 0.0)) return NOTHING;
    vec2 uv = clamp(project(end, frame.uv_from_view, frame.depth_range.z), 0.0, 1.0);
    ivec2 pixel = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    if (check_depth && !ray.endless) {
        float seen_m = texelFetch(depth_full, pixel, 0).x;
        if (!(abs(seen_m - depth_m) <= depth_tolerance * depth_m)) return NOTHING;
    }
    return picture(uv, pixel, ray, depth_m);
}

// Paraboloids replace the cube maps if the pipeline converts them: one fetch without face selection.
vec4 paraboloid_texel(Ray ray, vec4 at, bool alone) {
    vec3 d = normalize(at.xyz) * paraboloid_axes(frame.up.xyz), uv = paraboloid_uv(d, float(frame.counts.z));
    float level = 0.0;
    if (ray.cone > 0.0 && cone_cubemap) {
        float spread = ray.endless ? 1.0 : ray.travelled_m / length(at.xyz);
        level = paraboloid_level(cone_tangent(ray.cone) * spread, d.z, float(frame.counts.z), texel_scale);
    }
    uv.z += 2.0 * at.w;
    return record_cubemap(IMAGE_paraboloids, at, level, textureLod(sampler2DArray(paraboloids, linear_clamp), uv, level), alone);
}

vec4 cubemap_texel(Ray ray, vec4 at, bool alone) {
    if (has_paraboloids) return paraboloid_texel(ray, at, alone);
    if (ray.cone > 0.0 && cone_cubemap && has_cubemap_color_mips) {
        float level = cone_level_cube(ray.cone, ray.travelled_m, length(at.xyz), float(frame.counts.z), texel_scale);
        if (level > 0.0)
            return record_cubemap(IMAGE_cubemap_color_mips, at, level, cube_levels(cubemap_color_mips, at, level), alone);
    }
    vec4 color = filter_color ? cube_finest(cubemap_color, at)
                              : textureLod(samplerCubeArray(cubemap_color, nearest_clamp), at, 0.0);
    return record_cubemap(IMAGE_cubemap_color, at, 0.0, color, alone);
}

// Where three faces meet, a sampler's weights of eight bits may sum to 255/256, both in a level and in its lookup, which is not sky. The
// transition to opaque is gradual, so that rounding does not decide.
float opacity(float alpha) { return min(alpha / (1.0 - 1.0 / 128.0), 1.0); }

// A ray that ended on a surface excludes the sky beside it, which rays that end in the sky contribute. Which of both it is depends on the cube
// map's nearest texels, not on the width of the cone.
Found found_in_cubemap(Ray ray, uint place) {
    vec4 at = vec4(ray.endless ? ray.direction : ray.end - active_centers[place].xyz, place);
    bool surface = joint && !ray.endless;
    if (surface && fact_sky_seen && cube_finest(cubemap_color, at).a < 0.5) return SKY;
    vec4 color = cubemap_texel(ray, at, surface);
    return Found(vec4(color.rgb, 1.0), surface || !fact_sky_seen ? 0.0 : 1.0 - opacity(color.a));
}

// Adds the sky's share, and the fog in front: it covers what is behind it, or adds its own colour in front of surfaces; the sky's image shows the
// sky as it is seen through such fog.
vec4 through_fog(Found found, Ray ray) {
    bool foggy = fog && frame.fog_color.w > 0.0, adds = frame.material.y != 0.0;
    bool toward_sky = foggy && !adds && fog_target == fog_target_sky && frame.counts.w > 0u;
    vec3 color = found.color.rgb, sky = found.sky > 0.0 || toward_sky ? sky_color(ray) : vec3(0.0);
    if (found.sky > 0.0) color += sky * found.sky;
    if (!foggy || (adds && ray.endless)) return vec4(color, found.color.a);
    float height = frame.fog_height.x + dot(ray.position, frame.up.xyz);
    float depth = fog_optical_depth(frame.fog_color.w, height, dot(ray.direction, frame.up.xyz), frame.fog_height.y,
                                    ray.travelled_m);
    float covered = fog_factor(depth);
    if (adds) return vec4(color + covered * frame.fog_color.rgb, found.color.a);
    return vec4(mix(color, toward_sky ? sky : frame.fog_color.rgb, covered), found.color.a);
}

// What is not finite stays in the pixel that the capture has it for: a ray that meets it has no source.
vec4 source_color(vec4 color) { return finite(color) ? color : vec4(0.0); }

// finished: it ended on screen; place: otherwise the cube map in which it ended, or none. a: 0 if there is no source.
vec4 color_at_end(Ray ray, bool finished, uint place) {
    Found found = SKY;
    if (finished) found = found_on_screen(ray);
    else if (place < frame.counts.x) found = found_in_cubemap(ray, place);
    else if (!ray.endless) return vec4(0.0);
    return source_color(through_fog(found, ray));
}
