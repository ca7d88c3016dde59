// Which of a surface's history texels show another surface. Next include of a variant; it defines is_other(texel, pixel) before.
#include "shared/earlier.glsl"

// The change of depth over a pixel, of the flatter side each way: at a silhouette the other side is another surface.
float change_of(ivec2 pixel, float depth_m) {
    float sum = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 step = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), last = ivec2(frame.size.xy) - 1;
        float before = texelFetch(depth_full, clamp(pixel - step, ivec2(0), last), 0).x, after = texelFetch(depth_full, clamp(pixel + step, ivec2(0), last), 0).x;
        bool first = pixel[axis] == 0, end = pixel[axis] == last[axis];
        float change = min(first ? LARGEST : abs(before - depth_m), end ? LARGEST : abs(after - depth_m));
        sum += change < LARGEST ? change : 0.0;
    }
    return sum;
}

float earlier_depth(ivec2 pixel, float depth_m) {
    if (has_motion() && textureSize(motion_depth_full, 0) == ivec2(frame.size.xy)) return depth_m + texelFetch(motion_depth_full, pixel, 0).x;
    return earlier_view((vec2(pixel) + 0.5) / vec2(frame.size.xy), depth_m).z * frame.depth_range.w;
}

// The capture's own depth of the previous frame is preferred to what this pipeline kept.
float shown_depth(ivec2 texel) {
    bool captured = textureSize(previous_depth, 0) == ivec2(frame.size.xy);
    return captured ? texelFetch(previous_depth, texel, 0).x : texelFetch(previous_depth_kept, texel, 0).x;
}

bool is_hidden(float shown_m, float expected_m, bool sky, float tolerance_m) {
    if (precision_part >= 10.0) return false;
    if (sky || is_sky(shown_m)) return sky ? !is_sky(shown_m) : hidden_by == hidden_by_any;
    return shown_m < expected_m - tolerance_m || (hidden_by == hidden_by_any && shown_m > expected_m + tolerance_m);
}

// The fraction of the history's four texels, by their bilinear weights.
float hidden_at(ivec2 pixel) {
    if (frame.flags.x == 0u || frame.flags.y != 0u) return 1.0;
    vec2 uv = earlier_uv(pixel), place = uv * vec2(frame.size.xy) - 0.5;
    if (!on_screen(uv - jitter_shift())) return 1.0;
    float depth_m = texelFetch(depth_full, pixel, 0).x, expected_m = earlier_depth(pixel, depth_m);
    bool sky = is_sky(depth_m);
    float tolerance_m = sky ? 0.0 : slope * change_of(pixel, depth_m) + precision_part * abs(expected_m);
    ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.xy) - 1;
    vec2 part = place - vec2(corner);
    float hidden = 0.0, total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        float weight = side.x * side.y;
        if (weight < 1e-3) continue; // at a texel's centre rounding must not bring in its neighbours
        bool other = is_hidden(shown_depth(texel), expected_m, sky, tolerance_m) || (!sky && is_other(texel, pixel));
        hidden += other ? weight : 0.0;
        total += weight;
    }
    return total > 0.0 ? hidden / total : 1.0;
}
