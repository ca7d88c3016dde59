// Whether anything may occlude a receiver: the boxes of the cells around it (ao_bounds) against its tangent plane. Next include of a pass with the
// rows of points_rows.h, after points.glsl.

// The texels that show the cube around the receiver with half the side `reach`, with one more on each side: a texel may hold any of its pixels.
ivec4 texels_within(Receiver r, float reach) {
    ivec2 last = ivec2(frame.size.zw) - 1;
    vec2 depths = r.depth_m + vec2(-reach, reach);
    if (!(depths.x > 0.1 * r.depth_m)) return ivec4(0, 0, last);
    vec2 low = r.position.xy - reach, high = r.position.xy + reach;
    vec2 first = low / mix(vec2(depths.y), vec2(depths.x), lessThan(low, vec2(0.0)));
    vec2 second = high / mix(vec2(depths.x), vec2(depths.y), lessThan(high, vec2(0.0)));
    first = (first * frame.uv_from_view.xy + frame.uv_from_view.zw) * vec2(frame.size.zw);
    second = (second * frame.uv_from_view.xy + frame.uv_from_view.zw) * vec2(frame.size.zw);
    vec2 from = clamp(floor(min(first, second)) - 1.0, vec2(0.0), vec2(last)), to = clamp(floor(max(first, second)) + 1.0, vec2(0.0), vec2(last));
    return ivec4(from, to);
}

// nearby: only surfaces within the radius occlude; false: those in front of it, too.
bool may_be_occluded(Receiver r, bool nearby, inout Estimate result) {
    if (!cull || !has_bounds_low || !has_bounds_high) return true;
    ivec4 texels = texels_within(r, r.radius_m);
    int wide = max(texels.z - texels.x, texels.w - texels.y);
    int level = min(findMSB(uint(wide)) + 1, textureQueryLevels(bounds_low) - 1); // at most two cells each way
    ivec2 last = max(ivec2(frame.size.zw) >> level, ivec2(1)) - 1;
    ivec2 first = min(texels.xy >> level, last), end = min(texels.zw >> level, last);
    vec3 place = mat3(frame.world_from_view) * r.position, normal = mat3(frame.world_from_view) * r.normal;
    for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x) {
            vec4 low = texelFetch(bounds_low, ivec2(x, y), level), high = texelFetch(bounds_high, ivec2(x, y), level);
            result.fetches += 2u;
            if (low.w == 0.0) continue;
            vec3 from = low.xyz - place, to = high.xyz - place;
            if (nearby) {
                from = max(from, vec3(-1.001 * r.radius_m));
                to = min(to, vec3(1.001 * r.radius_m));
                if (any(greaterThan(from, to))) continue;
            }
            vec3 up = max(normal * from, normal * to);
            vec3 most = max(abs(from), abs(to));
            float rounding = 4e-6 * (length(place) + most.x + most.y + most.z);
            if (!(up.x + up.y + up.z + rounding <= lift * r.radius_m)) return true;
        }
    return false;
}
