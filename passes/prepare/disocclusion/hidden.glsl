// Which of a surface's history texels show another surface. Next include of a variant; it defines is_other(texel, pixel) before.
#include "previous_frame/earlier.glsl"

// The capture's own depth of the previous frame is preferred to what this pipeline kept.
float shown_depth(ivec2 texel) {
    bool captured = textureSize(previous_depth, 0) == ivec2(frame.size.xy);
    return captured ? texelFetch(previous_depth, texel, 0).x : texelFetch(previous_depth_kept, texel, 0).x;
}

// The change of depth over a pixel of this frame or, `then`, of the previous one, of the flatter side each way: at a silhouette the other side is
// another surface.
float change_of(ivec2 pixel, bool then) {
    float sum = 0.0, depth_m = then ? shown_depth(pixel) : texelFetch(depth_full, pixel, 0).x;
    for (int axis = 0; axis < 2; ++axis) {
        float least = LARGEST;
        for (int side = -1; side <= 1; side += 2) {
            ivec2 at = pixel;
            at[axis] += side;
            if (at[axis] < 0 || at[axis] >= int(frame.size[axis])) continue;
            least = min(least, abs((then ? shown_depth(at) : texelFetch(depth_full, at, 0).x) - depth_m));
        }
        sum += least < LARGEST ? least : 0.0;
    }
    return sum;
}

float earlier_depth(ivec2 pixel, float depth_m) {
    if (has_motion() && textureSize(motion_depth_full, 0) == ivec2(frame.size.xy)) return depth_m + texelFetch(motion_depth_full, pixel, 0).x;
    return earlier_view((vec2(pixel) + 0.5) / vec2(frame.size.xy), depth_m).z * frame.depth_range.w;
}

float tolerance_of(ivec2 pixel, float earlier_m) { return slope * change_of(pixel, false) + precision_part * abs(earlier_m); }

// Whether the nearer surface that the previous frame shows in a texel is still beside the pixel and moved in the picture as the pixel's own did, by `away` in
// uv: then neither uncovered the other. own_m: the depth up to which what is beside the pixel is nearer than its own surface.
bool moved_together(ivec2 texel, ivec2 pixel, vec2 away, float own_m) {
    if (!(together > 0.0) || !has_motion() || hidden_by == hidden_by_any) return false;
    float shown_m = shown_depth(texel), change_m = slope * change_of(texel, true);
    for (int i = 0; i < 9; ++i) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(frame.size.xy) - 1);
        float depth_m = texelFetch(depth_full, at, 0).x;
        if (at == pixel || is_sky(depth_m)) continue;
        float then_m = earlier_depth(at, depth_m);
        if (!(then_m < own_m) || !(abs(then_m - shown_m) <= change_m + tolerance_of(at, then_m))) continue;
        if (length((earlier_uv(at) - (vec2(at) + 0.5) / vec2(frame.size.xy) - away) * vec2(frame.size.xy)) <= together) return true;
    }
    return false;
}

// A difference within the slope of either surface is none: at a crease one of them is flat.
bool is_hidden(ivec2 texel, float expected_m, bool sky, float tolerance_m) {
    if (precision_part >= 10.0) return false;
    float shown_m = shown_depth(texel);
    if (sky || is_sky(shown_m)) return sky ? !is_sky(shown_m) : hidden_by == hidden_by_any;
    float nearer_m = expected_m - shown_m;
    if (hidden_by == hidden_by_any) nearer_m = abs(nearer_m);
    return nearer_m > tolerance_m && nearer_m > tolerance_m + slope * change_of(texel, true);
}

// The fraction of the history's four texels, by their bilinear weights.
float hidden_at(ivec2 pixel) {
    if (frame.flags.x == 0u || frame.flags.y != 0u) return 1.0;
    vec2 uv = earlier_uv(pixel), place = uv * vec2(frame.size.xy) - 0.5;
    if (!on_screen(uv - jitter_shift())) return 1.0;
    float depth_m = texelFetch(depth_full, pixel, 0).x, expected_m = earlier_depth(pixel, depth_m);
    bool sky = is_sky(depth_m);
    float tolerance_m = sky ? 0.0 : tolerance_of(pixel, expected_m);
    ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.xy) - 1;
    vec2 part = place - vec2(corner), away = uv - (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    float hidden = 0.0, total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        float weight = side.x * side.y;
        if (weight < 1e-3) continue; // at a texel's centre rounding must not bring in its neighbours
        bool other = is_hidden(texel, expected_m, sky, tolerance_m) && !moved_together(texel, pixel, away, sky ? INFINITE : expected_m - tolerance_m);
        other = other || (!sky && is_other(texel, pixel));
        hidden += other ? weight : 0.0;
        total += weight;
    }
    return total > 0.0 ? hidden / total : 1.0;
}
