// The picture of this frame averaged with the history. Next include of a variant; it defines picture(pixel) before.
#include "previous_frame/earlier.glsl"
#include "shared/stable.glsl"
#include "luminance.glsl"
#include "neighbourhood.glsl"

// Without a history the picture is passed on as it is, for the next frame.
bool has_past() { return fact_history && frame.flags.x != 0u && frame.flags.y == 0u; }

struct Sample {
    vec3 color;
    float weight; // 0: none
};

// A sample much brighter than its surroundings is scaled down to what they allow.
vec3 limited(vec3 color, ivec2 pixel) {
    if (outlier >= 1e6) return color;
    float bright = brightness(color), most = outlier * max(surrounding_luminance(pixel, bright), picture_luminance(bright));
    return most > 0.0 && bright > most ? color * (most / bright) : color;
}

// The weight of a sample at a distance from the pixel's centre: a Gaussian with the deviation 0.47 pixels, as Karis's fit of a Blackman-Harris window.
float filter_weight(vec2 away) { return exp(-2.29 * dot(away, away)); }

// The pixel's colour in this frame alone. The sample of the texel at `offset` shows the picture without jitter at offset - jitter.
Sample current(ivec2 pixel) {
    if (reconstruction == reconstruction_box) {
        vec3 color = picture(pixel);
        return finite(vec4(color, 0.0)) ? Sample(limited(color, pixel), 1.0) : Sample(vec3(0.0), 0.0);
    }
    Sample sum = Sample(vec3(0.0), 0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 offset = ivec2(i % 3, i / 3) - 1, at = pixel + offset;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(frame.size.xy)))) continue;
        vec3 color = picture(at);
        if (!finite(vec4(color, 0.0))) continue;
        float weight = filter_weight(vec2(offset) - frame.jitter.xy);
        sum.color += weight * limited(color, at);
        sum.weight += weight;
    }
    sum.color = sum.weight > 0.0 ? sum.color / sum.weight : vec3(0.0);
    return sum;
}

// How far the pixel's picture moved since the previous frame, in uv and without jitter.
vec2 moved(ivec2 pixel) {
    ivec2 whose = pixel;
    float least_m = texelFetch(depth_full, pixel, 0).x, most = -1.0;
    for (int i = 0; i < 9 && vector != vector_own; ++i) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(frame.size.xy) - 1);
        if (vector == vector_nearest) {
            float depth_m = texelFetch(depth_full, at, 0).x;
            if (depth_m < least_m) least_m = depth_m, whose = at;
        } else {
            vec2 there = earlier_uv(at) - (vec2(at) + 0.5) / vec2(frame.size.xy) - jitter_shift();
            if (dot(there, there) > most) most = dot(there, there), whose = at;
        }
    }
    return earlier_uv(whose) - (vec2(whose) + 0.5) / vec2(frame.size.xy) - jitter_shift();
}

// The history of the pixel: colour and weight, 0 if there is none.
Sample past_of(ivec2 pixel) {
    vec2 away = moved(pixel), uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy) + away;
    float hidden = texelFetch(disocclusion, has_disocclusion ? pixel : ivec2(0), 0).x;
    if (!(history > 0.0) || !on_screen(uv) || hidden >= uncovered) return Sample(vec3(0.0), 0.0);
    bool still = all(lessThan(abs(away * vec2(frame.size.xy)), vec2(STILL_PX)));
    vec4 past = still ? texelFetch(previous_antialiased, pixel, 0) : past_at(uv * vec2(frame.size.xy));
    if (!finite(past) || !(past.a > 0.0)) return Sample(vec3(0.0), 0.0);
    if (neighbourhood != neighbourhood_none && (clamp_still || !still)) past.rgb = clamped(past.rgb, pixel);
    // A still pixel's history is its own mean, in which all surfaces within it have their part; a moving one's also contains hidden texels.
    float kept = uncovered > 1.0 || still ? 1.0 : 1.0 - hidden;
    return Sample(past.rgb, kept * min(past.a, history));
}

float share_of(Sample s) {
    if (!by_luminance) return s.weight;
    float mean = picture_mean();
    return mean > 0.0 ? s.weight / (1.0 + brightness(s.color) / mean) : s.weight;
}

vec4 antialiased_color(ivec2 pixel) {
    if (!has_past()) return vec4(picture(pixel), 1.0);
    Sample now = current(pixel), past = past_of(pixel);
    float a = share_of(past), b = share_of(now), total = a + b;
    if (!(total > 0.0)) return vec4(0.0);
    // This form leaves a picture that equals its history as it is, bit for bit.
    return vec4(storable(past.color + (now.color - past.color) * (b / total), frame.up.w), past.weight + now.weight);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase == 0u) {
        if (all(lessThan(pixel, imageSize(luminance_levels)))) imageStore(luminance_levels, pixel, has_past() ? vec4(luminance_texel(pixel), 0.0, 0.0) : vec4(0.0));
        return;
    }
    if (any(greaterThanEqual(pixel, imageSize(antialiased)))) return;
    vec4 color = antialiased_color(pixel);
    imageStore(antialiased, pixel, halves ? nearest_half(color) : color);
}
