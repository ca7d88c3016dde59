#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "best_match.pass.h"
#include "shared/push_begin.glsl"
#include "best_match.pass.h"
};
#include "shared/camera.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"
#include "source.glsl"

// An invocation processes the four pixels of a half-resolution texel, which share their neighbouring texels. These are in shared memory, those of a
// workgroup and one more on each side, unless the pass runs over a list of tiles. At full resolution it processes one pixel and its
// texel.
struct Around {
    vec4 surface; // normal, in world space; w: roughness
    vec3 place;   // in full-resolution pixels; z: depth in m, 0 without a ray
};
const ivec2 GROUP = ivec2(8), AROUND = GROUP + 2;
shared Around group_around[AROUND.x * AROUND.y];

Around around_at(ivec2 texel) {
    ivec2 last = ivec2(frame.size.zw) - 1;
    bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last));
    texel = clamp(texel, ivec2(0), last);
    vec4 surface = texelFetch(normal_half, texel, 0);
    float depth_m = texelFetch(depth_half, texel, 0).x;
    uint picked = texelFetch(pick, texel, 0).x;
    return Around(surface, vec3(picked_position(texel, picked, frame.size),
                                !outside && is_pick_shown(picked) && reflects(depth_m, surface.xyz) ? depth_m : 0.0));
}

void load_group(ivec2 first) {
    for (int i = int(gl_LocalInvocationIndex); i < AROUND.x * AROUND.y; i += GROUP.x * GROUP.y)
        group_around[i] = around_at(first + ivec2(i % AROUND.x, i / AROUND.x));
    barrier();
}

struct Pixel {
    vec2 place; // in full-resolution pixels
    bool reflects;
    float depth_m, height_m; // height: of the pixel's plane over the camera
    vec3 plane;              // a sample at `place` and depth z has the height z (plane.xy · place + plane.z)
    vec4 surface;            // world space; w: roughness
};

Pixel pixel_at(ivec2 pixel, float depth_m, vec4 surface, bool shown) {
    Pixel p;
    p.place = vec2(pixel) + 0.5;
    p.reflects = shown && reflects(depth_m, surface.xyz);
    p.depth_m = depth_m;
    p.surface = vec4(normalize(surface.xyz), surface.w > 0.0 ? min(surface.w, 1.0) : 0.0);
    vec3 normal = mat3(frame.view_from_world) * p.surface.xyz;
    p.plane = vec3(normal.xy * frame.view_from_uv.xy / vec2(frame.size.xy),
                   dot(normal.xy, frame.view_from_uv.zw) + normal.z * frame.depth_range.z);
    p.height_m = depth_m * (dot(p.plane.xy, p.place) + p.plane.z);
    return p;
}

// The dissimilarity of a texel's surface to the pixel's; infinite if the texel has no ray.
float cost(Pixel p, vec4 surface, vec3 place) {
    vec3 apart = surface.xyz - p.surface.xyz;
    vec2 beside = place.xy - p.place;
    float height_m = place.z * (dot(p.plane.xy, place.xy) + p.plane.z) - p.height_m;
    float sum = depth_weight / p.depth_m * abs(height_m) + normal_weight * dot(apart, apart) +
                roughness_weight * abs(surface.w - p.surface.w) + distance_weight * dot(beside, beside);
    return place.z > 0.0 ? sum : INFINITE;
}

void store_nothing(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
    imageStore(reflection, pixel, vec4(0.0));
    imageStore(sharp_source, pixel, uvec4(0u));
}

void store(ivec2 pixel, Pixel p, bool found, ivec2 own, ivec2 best) {
    bool sharp = p.reflects && p.surface.w <= sharp_roughness;
    probe_pixel(pixel);
    imageStore(reflection, pixel, p.reflects && found ? taken_color(own + best, 1.0) : vec4(0.0));
    imageStore(sharp_source, pixel, uvec4(sharp ? uint(5 + best.x + 3 * best.y) : 0u));
}

// The best neighbouring texel, relative to the pixel's own. The four nearest texels are the own one and those on the pixel's side of it. On flat
// surfaces two texels are often equally good: differences below the rounding of half floats do not count, and the order decides. For normals
// that is the square of the rounding; for roughness two half steps, 2^-11.
const float ALIKE = 1e-3, ROUNDING = 1.0 / 2048.0;
void match_block(ivec2 own) {
    ivec2 size = ivec2(frame.size.xy);
    vec4 depths_m = textureGather(sampler2D(depth_full, nearest_clamp), vec2(2 * own + 1) / vec2(size)).wzxy;
    uint shown = shown_in_block(2 * own);
    Pixel p[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = 2 * own + ivec2(i & 1, i >> 1);
        p[i] = pixel_at(pixel, depths_m[i], texelFetch(normal_full, min(pixel, size - 1), 0), (shown >> i & 1u) != 0u);
    }
    vec4 least = vec4(LARGEST);
    float alike = ALIKE + roughness_weight * ROUNDING;
    ivec2 best[4] = ivec2[](ivec2(0), ivec2(0), ivec2(0), ivec2(0));
    ivec2 middle = ivec2(gl_LocalInvocationID.xy) + 1;
    for (int n = 0; n < 9; ++n) {
        ivec2 beside = ivec2(n % 3, n / 3) - 1;
        int at = (middle.y + beside.y) * AROUND.x + middle.x + beside.x;
        Around texel;
        if (tile_range == ALL_TILES) texel = group_around[at];
        else texel = around_at(own + beside);
        for (int i = 0; i < 4; ++i) {
            ivec2 side = 2 * ivec2(i & 1, i >> 1) - 1;
            if (!around && (beside.x == -side.x || beside.y == -side.y)) continue;
            float c = cost(p[i], texel.surface, texel.place);
            if (c < least[i] - alike) {
                least[i] = c;
                best[i] = beside;
            }
        }
    }
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = 2 * own + ivec2(i & 1, i >> 1);
        if (all(lessThan(pixel, size))) store(pixel, p[i], least[i] < LARGEST, own, best[i]);
    }
}

void main() {
    ivec2 own = tile_texel(reduction(frame.size)), size = ivec2(frame.size.zw);
    bool reduced = reduction(frame.size) == 2.0;
    if (!tile_works) {
        int wide = reduced ? 2 : 1;
        for (int i = 0; i < wide * wide; ++i) store_nothing(wide * own + ivec2(i % wide, i / wide));
        return;
    }
    if (reduced && tile_range == ALL_TILES) load_group(own - ivec2(gl_LocalInvocationID.xy) - 1);
    if (any(greaterThanEqual(own, size))) return;
    if (reduced) {
        match_block(own);
        return;
    }
    Pixel p = pixel_at(own, texelFetch(depth_full, own, 0).x, texelFetch(normal_full, own, 0), is_shown(own));
    bool found = is_pick_shown(texelFetch(pick, own, 0).x) &&
                 reflects(texelFetch(depth_half, own, 0).x, texelFetch(normal_half, own, 0).xyz);
    store(own, p, found, own, ivec2(0));
}
