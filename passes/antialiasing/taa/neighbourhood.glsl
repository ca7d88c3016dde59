// The history between texels, and the colours that it is clamped to.
vec3 limited(vec3 color, ivec2 pixel);

// Pictures that move less do not move: the rounding errors of uv reach a tenth of it in a picture of 4,096 pixels.
const float STILL_PX = 1.0 / 256.0;

vec4 past_texel(vec2 place) { return textureLod(sampler2D(previous_antialiased, linear_clamp), place / vec2(frame.size.xy), 0.0); }

// Catmull-Rom of 4 × 4 texels as 9 bilinear samples: the two inner ones of each axis are one. The weight is interpolated linearly.
vec4 past_bicubic(vec2 place) {
    vec2 center = floor(place - 0.5) + 0.5, f = place - center;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f)), w3 = f * f * (-0.5 + 0.5 * f), between = w2 / (w1 + w2);
    vec2 at[3] = vec2[](center - 1.0, center + between, center + 2.0), weight[3] = vec2[](w0, w1 + w2, w3);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; ++i)
        sum += weight[i % 3].x * weight[i / 3].y * past_texel(vec2(at[i % 3].x, at[i / 3].y)).rgb;
    return vec4(max(sum, 0.0), past_texel(place).a);
}
vec4 past_at(vec2 place) { return history_filter == history_filter_bicubic ? past_bicubic(place) : past_texel(place); }

vec3 to_axes(vec3 c) {
    return space == space_rgb ? c : vec3(dot(c, vec3(0.25, 0.5, 0.25)), dot(c, vec3(0.5, 0.0, -0.5)), dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 from_axes(vec3 c) { return space == space_rgb ? c : vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

// M. Salvi, An Excursion in Temporal Supersampling, GDC 2016: mean and deviation of the 3 × 3 neighbours, here from sums of differences to the
// first one, so that equal neighbours leave no rounding error.
vec3 clamped(vec3 past, ivec2 pixel) {
    vec3 first = vec3(0.0), low = vec3(LARGEST), high = vec3(-LARGEST), sum = vec3(0.0), squares = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(frame.size.xy) - 1);
        vec3 color = picture(at);
        if (!finite(vec4(color, 0.0))) continue;
        color = to_axes(limited(color, at));
        if (count == 0.0) first = color;
        low = min(low, color), high = max(high, color);
        sum += color - first;
        squares += (color - first) * (color - first);
        count += 1.0;
    }
    if (count == 0.0) return past;
    if (neighbourhood == neighbourhood_variance) {
        vec3 offset = sum / count, reach = window * sqrt(max(squares / count - offset * offset, 0.0));
        low = first + offset - reach, high = first + offset + reach;
    }
    return max(from_axes(clamp(to_axes(past), low, high)), 0.0);
}
