// Points compared with the sun's shadow map. Next include of a pass that reads shadow_map.
#ifndef GLINT_SHADOW_MAP
#define GLINT_SHADOW_MAP

// The length in metres that a texel covers across the light at a point.
float shadow_texel_m(vec3 world) {
    vec3 across = vec3(frame.shadow_uv_from_world[0].x, frame.shadow_uv_from_world[1].x, frame.shadow_uv_from_world[2].x);
    return (frame.shadow_uv_from_world * vec4(world, 1.0)).w / (length(across) * float(textureSize(shadow_map, 0).x));
}

// The part of taps × taps texels around a point, in camera-relative world space, that let the sun pass; points outside of the map are lit.
// bias: what is added to the stored depth, away from the light.
float lit_by_map(vec3 world, int taps, float bias) {
    ivec2 size = textureSize(shadow_map, 0);
    vec4 at = frame.shadow_uv_from_world * vec4(world, 1.0);
    if (!(at.w > 0.0)) return 1.0;
    vec3 place = at.xyz / at.w;
    if (!(all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(1.0))))) return 1.0;
    ivec2 first = ivec2(floor(place.xy * vec2(size) - 0.5 * float(taps - 1)));
    float deep = place.z * frame.shadow_depth.x;
    int lit_texels = 0;
    for (int y = 0; y < taps; ++y)
        for (int x = 0; x < taps; ++x) {
            float stored = texelFetch(shadow_map, clamp(first + ivec2(x, y), ivec2(0), size - 1), 0).x;
            if (!(deep > stored * frame.shadow_depth.x + bias)) ++lit_texels;
        }
    return float(lit_texels) / float(taps * taps);
}
#endif
