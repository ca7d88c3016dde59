// The volume of light around the camera: the capture's ambient cubes (capture-format/FORMAT.md, Volumes of light), or the cells of volume_make.
// Next include of a pass with the rows of slot.h.
#include "shared/light_volume.glsl"

// Facts are constants, which leave out code; with all passes they may be true where the frame says otherwise.
bool is_captured() { return fact_light_volume && frame.grid.w != 0u; }
bool has_volume() { return !fact_no_light_volume || is_captured() || has_volume_radiance; }

// In cells, their middles at whole numbers.
vec3 place_in_volume(vec3 position) {
    if (is_captured()) return (frame.grid_from_world * vec4(position, 1.0)).xyz - 0.5;
    return position / texelFetch(volume_direction, ivec2(0), 0).w + 0.5 * vec3(frame.grid.xyz) - 0.5;
}

vec3 captured_cell(ivec2 at, vec3 direction, out bool open) {
    vec3 positive[3] = vec3[](texelFetch(volume_px, at, 0).rgb, texelFetch(volume_py, at, 0).rgb, texelFetch(volume_pz, at, 0).rgb);
    vec3 negative[3] = vec3[](texelFetch(volume_nx, at, 0).rgb, texelFetch(volume_ny, at, 0).rgb, texelFetch(volume_nz, at, 0).rgb);
    vec3 mean = ambient_cube_mean(positive, negative);
    open = any(greaterThan(mean, vec3(0.0))); // a cell inside of an object has no light
    return contrasted(mean, ambient_cube(positive, negative, direction), contrast);
}

vec3 made_cell(ivec2 at, vec3 direction, out bool open) {
    vec4 mean = texelFetch(volume_radiance, at, 0);
    open = mean.a > 0.5;
    return contrasted(mean.rgb, directed_irradiance(mean.rgb, texelFetch(volume_direction, at, 0).xyz, direction), contrast);
}

// The small weight of a cell inside of an object, which counts where all eight are.
const float CLOSED = 1e-6;

// Interpolates the eight cells around a point, those outside of the volume being the nearest ones inside. a: 1 where none of them is valid.
vec4 volume_light(vec3 position, vec3 direction, inout uint fetches) {
    ivec3 cells = ivec3(frame.grid.xyz);
    vec3 place = clamp(place_in_volume(position), vec3(0.0), vec3(cells - 1)), corner = floor(place), part = place - corner;
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 side = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 share = mix(1.0 - part, part, vec3(side));
        float weight = share.x * share.y * share.z;
        if (!(weight > 0.0)) continue;
        ivec2 at = cell_texel(min(ivec3(corner) + side, cells - 1), frame.grid);
        bool open;
        vec3 light = is_captured() ? captured_cell(at, direction, open) : made_cell(at, direction, open);
        fetches += is_captured() ? 6u : 2u;
        if (!finite(vec4(light, 0.0))) continue;
        if (leaks && !open) weight *= CLOSED;
        sum += weight * light;
        total += weight;
    }
    return total > 0.0 ? vec4(sum / total, 0.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
