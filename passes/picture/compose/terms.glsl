// What effects other than reflections make of the diffuse picture (shared/light_terms.glsl). Next include of a pass with the rows of slot.h.
#include "shared/light_terms.glsl"

// Light that the capture does not name cannot be replaced.
bool has_captured() { return has_indirect_lit && textureSize(indirect_lit, 0) == ivec2(frame.size.xy); }
bool is_replaced() { return has_indirect && bounce && !ambient && has_captured(); }

bool is_relit() { return has_light && relight && has_lamps_lit && textureSize(lamps_lit, 0) == ivec2(frame.size.xy); }

float kept_part(ivec2 pixel) {
    if (is_replaced()) return 0.0;
    if (!has_occlusion || !occlude) return 1.0;
    bool darkened = has_engine_ao && replace_ao && frame.captured_light.x > 0.0;
    return kept_light(texelFetch(occlusion, pixel, 0).x, darkened ? texelFetch(engine_ao, pixel, 0).x : 1.0);
}

vec3 diffuse_light(ivec2 pixel) { return has_lit_scattered && scatter ? texelFetch(lit_scattered, pixel, 0).rgb : texelFetch(lit, pixel, 0).rgb; }

vec3 with_terms(ivec2 pixel, vec3 color, float depth_m, vec3 normal) {
    bool traced = has_indirect && bounce && (ambient || is_replaced()), shaded = has_sun_shadow && shade,
         captured = has_captured() && ((has_occlusion && occlude) || is_replaced());
    if (!(traced || shaded || captured || is_relit()) || !reflects(depth_m, normal)) return color;
    vec4 base = texelFetch(albedo_full, pixel, 0);
    if (is_relit()) color += texelFetch(light, pixel, 0).rgb - texelFetch(lamps_lit, pixel, 0).rgb;
    SunTerm sun = SunTerm(vec3(0.0), 0.0, 1.0, 1.0);
    if (shaded) {
        sun.irradiance = frame.sun_irradiance.rgb;
        sun.cosine = dot(normalize(normal), frame.sun_direction.xyz);
        sun.mask = has_sun_mask ? texelFetch(sun_mask, pixel, 0).x : 1.0;
        // It may come from shadow maps.
        if (has_shadow_soft) sun.mask = min(sun.mask, texelFetch(shadow_soft, pixel, 0).x);
        else if (has_shadow_mask) sun.mask = min(sun.mask, texelFetch(shadow_mask, pixel, 0).x);
        sun.shadow = texelFetch(sun_shadow, pixel, 0).x;
    }
    vec3 light = changed_light(color, captured ? texelFetch(indirect_lit, pixel, 0).rgb : vec3(0.0), captured ? kept_part(pixel) : 1.0,
                               traced ? texelFetch(indirect, pixel, 0).rgb : vec3(0.0), base.rgb * (1.0 - base.a), sun);
    return storable(light, frame.up.w);
}
