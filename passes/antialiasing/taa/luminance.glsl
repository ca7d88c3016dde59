// The downscaled picture: luminance as sums over blocks of pixels, from which a pixel can be taken out again.
#include "shared/luminance.glsl"

float brightness(vec3 color) { return max(luminance(color), 0.0); }

// The texels of the finer level that a texel covers: two each way, and in the last one those that remain.
ivec2 last_of(ivec2 texel, ivec2 size, ivec2 finer) {
    return mix(min(2 * texel + 1, finer - 1), finer - 1, equal(texel, size - 1));
}

// Sum and count of a texel of the level that is being made.
vec2 luminance_texel(ivec2 texel) {
    vec2 sum = vec2(0.0);
    ivec2 size = imageSize(luminance_levels);
    if (dispatch_level == 0u) {
        int wide = int(reduction(frame.size));
        ivec2 end = min(wide * (texel + 1), ivec2(frame.size.xy));
        for (int y = wide * texel.y; y < end.y; ++y)
            for (int x = wide * texel.x; x < end.x; ++x) {
                vec3 color = picture(ivec2(x, y));
                sum += finite(vec4(color, 0.0)) ? vec2(brightness(color), 1.0) : vec2(0.0);
            }
        return sum;
    }
    int level = int(dispatch_level) - 1;
    ivec2 last = last_of(texel, size, max(textureSize(finer_luminance, 0) >> level, 1));
    for (int y = 2 * texel.y; y <= last.y; ++y)
        for (int x = 2 * texel.x; x <= last.x; ++x) sum += texelFetch(finer_luminance, ivec2(x, y), level).xy;
    return sum;
}

// The mean luminance of the texel that holds a pixel of luminance `own`, without that pixel; 0 where there is no other.
float mean_without(ivec2 pixel, int level, float own) {
    ivec2 size = max(textureSize(finer_luminance, 0) >> level, 1);
    vec2 sum = texelFetch(finer_luminance, min(pixel / int(reduction(frame.size)) >> level, size - 1), level).xy;
    return sum.y > 1.0 ? max(sum.x - own, 0.0) / (sum.y - 1.0) : 0.0;
}

float surrounding_luminance(ivec2 pixel, float own) {
    int level = reduction(frame.size) > 1.0 ? 2 : 3;
    return mean_without(pixel, min(level, textureQueryLevels(finer_luminance) - 1), own);
}

float picture_mean() {
    vec2 sum = texelFetch(finer_luminance, ivec2(0), textureQueryLevels(finer_luminance) - 1).xy;
    return sum.y > 0.0 ? sum.x / sum.y : 0.0;
}
float picture_luminance(float own) { return mean_without(ivec2(0), textureQueryLevels(finer_luminance) - 1, own); }
