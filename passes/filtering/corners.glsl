// The four texels around a pixel, with their bilinear shares; 0 for those without a surface. Next include of a pass that reads depth_half.
struct Corners {
    ivec2 first;
    vec4 share, depth_m; // by x + 2y
};

ivec2 corner_texel(Corners corners, int i) {
    return clamp(corners.first + ivec2(i & 1, i >> 1), ivec2(0), ivec2(frame.size.zw) - 1);
}

Corners corners_of(ivec2 pixel) {
    vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5, part = place - floor(place);
    Corners corners;
    corners.first = ivec2(floor(place));
    for (int i = 0; i < 4; ++i) {
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        corners.depth_m[i] = texelFetch(depth_half, corner_texel(corners, i), 0).x;
        corners.share[i] = corners.depth_m[i] < LARGEST ? side.x * side.y : 0.0;
    }
    return corners;
}
