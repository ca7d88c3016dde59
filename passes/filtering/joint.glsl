// Joint filtering of full-resolution pictures. Next include of a pass with the parameter filter_color.
#ifndef GLINT_JOINT
#define GLINT_JOINT
#include "shared/constants.glsl"

// Interpolates those of the four texels around a point whose depth (+inf for sky) is within the tolerance. a: 0 if there are none and the
// nearest in depth is returned.
vec4 joint_texels(texture2D image, texture2D depths_m, vec2 uv, float depth_m, float tolerance) {
    vec2 place = uv * vec2(frame.size.xy) - 0.5, corner = floor(place), part = place - corner;
    vec4 seen_m = textureGather(sampler2D(depths_m, nearest_clamp), (corner + 1.0) / vec2(frame.size.xy)).wzxy;
    vec4 shares = vec4(1.0 - part.x, part.x, 1.0 - part.x, part.x) * vec4(1.0 - part.yy, part.yy), color = vec4(0.0);
    float inverse = depth_m < LARGEST ? 1.0 / depth_m : 0.0, least = LARGEST;
    int nearest = 0;
    if (!filter_color) shares = vec4(greaterThanEqual(shares, vec4(max(max(shares.x, shares.y), max(shares.z, shares.w)))));
    for (int i = 0; i < 4; ++i) {
        float apart = abs((seen_m[i] < LARGEST ? 1.0 / seen_m[i] : 0.0) - inverse);
        if (apart < least) nearest = i;
        least = min(least, apart);
        if (!(apart <= tolerance * inverse) || shares[i] <= 0.0) continue;
        ivec2 pixel = clamp(ivec2(corner) + ivec2(i & 1, i >> 1), ivec2(0), ivec2(frame.size.xy) - 1);
        color += shares[i] * vec4(texelFetch(image, pixel, 0).rgb, 1.0);
    }
    if (color.a > 0.0) return vec4(color.rgb / color.a, 1.0);
    ivec2 pixel = clamp(ivec2(corner) + ivec2(nearest & 1, nearest >> 1), ivec2(0), ivec2(frame.size.xy) - 1);
    return vec4(texelFetch(image, pixel, 0).rgb, 0.0);
}
#endif
