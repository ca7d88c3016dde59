// Points compared with the shadow maps of the sun and of lamps. Next include of a pass that reads shadow_map.
#ifndef GLINT_SHADOW_LOOKUP
#define GLINT_SHADOW_LOOKUP

// The length in metres that a texel of a map covers across the light at a point.
float shadow_texel_m(int map, vec3 world) {
    mat4 uv_from_world = frame.shadow_uv_from_world[map];
    vec3 across = vec3(uv_from_world[0].x, uv_from_world[1].x, uv_from_world[2].x);
    return (uv_from_world * vec4(world, 1.0)).w / (length(across) * float(frame.shadow_place[map].z));
}

// Where a point, in camera-relative world space, lies in a map: (u, v, depth). False beside it.
bool place_in_map(int map, vec3 world, out vec3 place) {
    vec4 at = frame.shadow_uv_from_world[map] * vec4(world, 1.0);
    place = at.xyz / at.w;
    return at.w > 0.0 && all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(1.0)));
}

// The part of the compared texels that let the light pass. wide: texels along a side of the square; shift: of the square, in texels; bias_part: factor on
// what the engine adds to the stored depth.
float lit_by_map(int map, vec3 place, int wide, vec2 shift, float bias_part) {
    ivec2 size = ivec2(frame.shadow_place[map].zw), row = ivec2(0, frame.shadow_place[map].y);
    ivec2 first = ivec2(floor(place.xy * vec2(size) - 0.5 * float(wide - 1) + shift));
    float away = frame.shadow_depth[map].x, deep = place.z * away, bias = bias_part * frame.shadow_depth[map].y;
    int lit_texels = 0;
    for (int y = 0; y < wide; ++y)
        for (int x = 0; x < wide; ++x) {
            float stored = texelFetch(shadow_map, clamp(first + ivec2(x, y), ivec2(0), size - 1) + row, 0).x;
            if (!(deep > stored * away + bias)) ++lit_texels;
        }
    return float(lit_texels) / float(wide * wide);
}

// Whether the map is of all surfaces, not of a stencil class alone.
bool is_of_all(int map) { return frame.shadow_class[map].z == 0u; }
// Whether there is such a map of the sun. Those of lamps lie behind them.
bool is_map(int map) { return map < SUN_MAPS && frame.shadow_place[map].z != 0u && frame.shadow_class[map].w == 0u; }
#endif
