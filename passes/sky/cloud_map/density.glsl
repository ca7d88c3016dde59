// The density of clouds (FORMAT.md, Atmosphere and clouds). Next include of a pass with the rows of slot.h.
#include "sky/air.glsl"

const int SLICES = 8;

// Of a texel up to one beside the square, into it.
ivec2 around(ivec2 texel, ivec2 size) { return ivec2(uvec2(texel + size) % uvec2(size)); }

// Between four texels of a square that repeats; `first` is the row at which its slice begins.
float in_slice(texture2D image, vec2 part, ivec2 size, int first) {
    vec2 place = part * vec2(size) - 0.5, low = floor(place), weight = place - low;
    ivec2 a = around(ivec2(low), size), b = around(ivec2(low) + 1, size);
    float left_top = texelFetch(image, ivec2(a.x, a.y + first), 0).x, right_top = texelFetch(image, ivec2(b.x, a.y + first), 0).x,
          left = texelFetch(image, ivec2(a.x, b.y + first), 0).x, right = texelFetch(image, ivec2(b.x, b.y + first), 0).x;
    return mix(mix(left_top, right_top, weight.x), mix(left, right, weight.x), weight.y);
}

// Between the middles of two slices; beyond the first and last middle it stays.
float in_layer(texture2D image, vec2 part, float rise) {
    ivec2 size = textureSize(image, 0) / ivec2(1, SLICES);
    float place = clamp(rise * float(SLICES) - 0.5, 0.0, float(SLICES - 1));
    int low = min(int(place), SLICES - 2);
    return mix(in_slice(image, part, size, low * size.y), in_slice(image, part, size, (low + 1) * size.y), place - float(low));
}

float in_noise(vec3 part) {
    int size = textureSize(cloud_noise, 0).x;
    float place = part.z * float(size) - 0.5, low = floor(place);
    int a = around(ivec2(int(low)), ivec2(size)).x, b = around(ivec2(int(low) + 1), ivec2(size)).x;
    return mix(in_slice(cloud_noise, part.xy, ivec2(size), a * size), in_slice(cloud_noise, part.xy, ivec2(size), b * size), place - low);
}

// The pass may run without.
bool has_clouds() { return frame.cloud_tile.x > 0.0 && textureSize(cloud_density, 0).y >= SLICES; }

vec2 horizontal(vec3 world) {
    return frame.up.x != 0.0 ? world.yz : frame.up.y != 0.0 ? world.xz : world.xy;
}

// In [0, 1], at a point relative to the camera.
float cloud_density_at(vec3 world, float altitude) {
    float rise = (altitude - frame.cloud_layer.x) / (frame.cloud_layer.y - frame.cloud_layer.x);
    if (rise < 0.0 || rise > 1.0) return 0.0;
    vec2 across = horizontal(world), part = fract(frame.cloud_place.xy + across / frame.cloud_tile.x);
    float full = in_layer(cloud_density, part, rise);
    if (!(full > 0.0)) return 0.0;
    if (textureSize(cloud_height, 0) == textureSize(cloud_density, 0))
        full *= clamp(1.0 + float(SLICES) * (in_layer(cloud_height, part, rise) - rise), 0.0, 1.0);
    if (!(full > 0.0) || frame.cloud_tile.z == 0.0 || textureSize(cloud_noise, 0).x < 2) return full;
    vec3 place = vec3(frame.cloud_place.zw + across / frame.cloud_tile.y, altitude / frame.cloud_tile.y);
    return max(full - frame.cloud_tile.z * in_noise(fract(place)), 0.0);
}
