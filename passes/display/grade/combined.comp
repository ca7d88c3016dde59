#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "combined.pass.h"
#include "shared/push_begin.glsl"
#include "combined.pass.h"
};
#include "shared/constants.glsl"
#include "this_frame/picture.glsl"
#include "shared/random.glsl"
#include "tone.glsl"

vec3 linear_picture(ivec2 pixel) {
    if (has_exposed) return texelFetch(exposed, pixel, 0).rgb;
    return has_bloomed ? texelFetch(bloomed, pixel, 0).rgb : last_picture(pixel);
}
#include "lens.glsl"

vec3 displayed(ivec2 pixel) { return texelFetch(before, clamp(pixel, ivec2(0), ivec2(frame.size.xy) - 1), 0).rgb; }
#include "smooth.glsl"

bool is_limited() { return encoding == encoding_srgb; }

// NaN is black.
vec3 curve(vec3 color) {
    vec3 c = mix(vec3(0.0), min(color, vec3(65504.0)), greaterThan(color, vec3(0.0)));
    if (tone == tone_reinhard) return reinhard(c, white);
    if (tone == tone_filmic) return filmic(c, white, bias);
    if (tone == tone_aces) return clamp(aces(c), 0.0, 1.0);
    return is_limited() ? c : color;
}
vec3 encoded(vec3 color) { return is_limited() ? srgb_encoded(clamp(color, 0.0, 1.0)) : color; }

// What the table makes of linear light is encoded for the display.
bool table_is_linear() { return frame.lut_stops.z != 0.0; }

// The table's colour, interpolated between its eight nearest ones.
vec3 from_table(vec3 color) {
    int n = textureSize(color_table, 0).x;
    vec3 place = clamp(color, 0.0, 1.0) * float(n - 1);
    ivec3 low = min(ivec3(place), ivec3(n - 2));
    vec3 part = place - vec3(low), sum = vec3(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2), at = low + corner;
        vec3 weight = mix(1.0 - part, part, vec3(corner));
        sum += weight.x * weight.y * weight.z * texelFetch(color_table, ivec2(at.x, at.y + n * at.z), 0).rgb;
    }
    return sum;
}

void store_toned(ivec2 pixel) {
    vec3 seen = through_lens(pixel), color = encoded(curve(seen));
    if (colors > 0.0 && textureSize(color_table, 0).x > 1) {
        vec3 graded_color = color;
        if (table_is_linear()) {
            vec3 light = mix(vec3(0.0), min(seen, vec3(LARGEST)), greaterThan(seen, vec3(0.0)));
            graded_color = from_table(table_place(light, frame.lut_stops.xy));
            if (!is_limited()) graded_color = srgb_decoded(clamp(graded_color, 0.0, 1.0));
        } else graded_color = from_table(color);
        color = mix(color, graded_color, colors);
    }
    imageStore(toned, pixel, vec4(color, 1.0));
}

vec3 dirt_at(ivec2 pixel) {
    return textureLod(sampler2D(lens_dirt, linear_clamp), (vec2(pixel) + 0.5) / vec2(frame.size.xy), 0.0).rgb;
}

// Uniform in an interval whose half length is √3 standard deviations.
void store_graded(ivec2 pixel) {
    vec3 color = smooth_edges ? smoothed(pixel) : displayed(pixel);
    if (grain > 0.0) color += grain * 3.4641016151377544 * (random4(uvec2(pixel), frame.counts.y, RANDOM_GRAIN).x - 0.5);
    if (dirty > 0.0) {
        vec3 added = dirty * dirt_at(pixel);
        if (any(notEqual(added, vec3(0.0)))) color += added;
    }
    if (is_limited()) color = clamp(color, 0.0, 1.0);
    imageStore(graded, pixel, vec4(color, 1.0));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(graded)))) return;
    if (dispatch_phase == 0u) store_toned(pixel);
    else store_graded(pixel);
}
