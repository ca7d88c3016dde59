// What effects other than reflections make of the diffuse picture:
//   lit - (1 - occlusion) · indirect_lit + indirect · albedo - sun · (sun_mask - min(sun_mask, sun_shadow))
// Next include of a pass with the rows of slot.h.

// What the captured indirect light becomes.
vec3 indirect_change(ivec2 pixel) {
    float kept = 0.0;
    if (!has_indirect || ambient) {
        kept = texelFetch(occlusion, pixel, 0).x;
        bool darkened = has_engine_ao && frame.captured_light.x > 0.0;
        if (replace_ao && darkened) kept /= max(texelFetch(engine_ao, pixel, 0).x, 1.0 / 64.0);
    }
    return (kept - 1.0) * texelFetch(indirect_lit, pixel, 0).rgb;
}

// The light of the sun that the captured mask lets through and the traced shadow does not.
vec3 sun_change(ivec2 pixel, vec3 normal, vec3 albedo) {
    float mask = has_sun_mask ? texelFetch(sun_mask, pixel, 0).x : 1.0, shadow = texelFetch(sun_shadow, pixel, 0).x;
    float cosine = max(dot(normalize(normal), frame.sun_direction.xyz), 0.0);
    return (min(mask, shadow) - mask) * cosine / PI * frame.sun_irradiance.rgb * albedo;
}

vec3 with_terms(ivec2 pixel, vec3 color, float depth_m, vec3 normal) {
    bool traced = has_indirect && bounce, shaded = has_sun_shadow && shade,
         captured = has_indirect_lit && ((has_occlusion && occlude) || (has_indirect && !ambient));
    if (!(traced || shaded || captured) || !reflects(depth_m, normal)) return color;
    vec4 base = texelFetch(albedo_full, pixel, 0);
    vec3 albedo = base.rgb * (1.0 - base.a);
    if (captured) color += indirect_change(pixel);
    if (traced) color += texelFetch(indirect, pixel, 0).rgb * albedo;
    if (shaded) color += sun_change(pixel, normal, albedo);
    return storable(max(color, 0.0), frame.up.w);
}
