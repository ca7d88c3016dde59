#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "gbuffer.pass.h"
#include "shared/push_begin.glsl"
#include "gbuffer.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/luminance.glsl"
#include "lamps/lamp.glsl"
#define LIST_WORD(place) texelFetch(partial, place).x
#include "shared/work_list.glsl"

#define COUNT(name, bins, meaning) const int at_##name = 16 * __LINE__;
#define MINIMUM(name, meaning) COUNT(name, 1, meaning)
#define MAXIMUM(name, meaning) COUNT(name, 1, meaning)
#line 0
#include "figures.h"
#undef COUNT
#undef MINIMUM
#undef MAXIMUM
#line 25
const int ALL_FIGURES = 512;
const int FIGURES = whole ? ALL_FIGURES : at_surface_roughness; // words of a workgroup: plans only need the lines of figures.h before it
shared uint figures[ALL_FIGURES];
// The bits of non-negative floats have the order of their values.
const uint COUNTED = 0u, LOWEST = 1u, HIGHEST = 2u;
uint kind_of(int figure) {
#define COUNT(name, bins, meaning)
#define MINIMUM(name, meaning) if (figure == at_##name) return LOWEST;
#define MAXIMUM(name, meaning) if (figure == at_##name) return HIGHEST;
#include "figures.h"
    return COUNTED;
}

// Similar pixels are adjacent, so repetitions of a figure are counted and added when it changes.
struct Row {
    int figure;
    uint count;
};
void add_row(inout Row row) {
    if (row.count > 0u) atomicAdd(figures[row.figure], row.count);
    row.count = 0u;
}
void bin(inout Row row, int figure, int number, int most) {
    figure += clamp(number, 0, most);
    if (figure != row.figure) add_row(row);
    row.figure = figure;
    row.count++;
}

// The figures of an invocation, accumulated over its pixels.
struct Sums {
    Row by_surface_roughness, by_reflecting_roughness, by_metalness, by_weight;
    uvec2 stencil; // an id, and its number of consecutive pixels
    uint sky, surfaces, reflecting, above, open, sunlit, lamplit, luminous, stippled, skin, water, transparent, moved, moving;
    vec2 surface_roughness, reflecting_roughness, depth, light; // lowest, highest
    float transparent_roughest;
};
void extend(inout vec2 range, float value) { range = vec2(min(range.x, value), max(range.y, value)); }
float clamped(float roughness) { return roughness > 0.0 ? min(roughness, 1.0) : 0.0; } // NaN is 0

void add_stencil(inout uvec2 stencil) {
    for (uint left = stencil.y > 0u ? stencil.x : 0u; left != 0u; left &= left - 1u)
        atomicAdd(figures[at_stencil_bits + min(findLSB(left), 7)], stencil.y);
    stencil.y = 0u;
}

float weight_of(ivec2 pixel, float depth_m, vec4 surface, vec4 base, float specular) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cosine = clamp(dot(-normalize(mat3(frame.world_from_view) * view), normalize(surface.xyz)), 0.0, 1.0);
    float rise = texelFetch(fresnel_full, min(pixel, textureSize(fresnel_full, 0) - 1), 0).x;
    vec3 weight = environment_reflectance(reflectance_at_normal(base.rgb, base.a, specular, frame.material.x), clamped(surface.w), cosine, rise);
    return max(weight.r, max(weight.g, weight.b));
}

// How far the surface moved since the previous frame, and how far from where a static one would be, in pixels.
vec2 moved_px(ivec2 pixel, float depth_m, vec2 moved) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy), size = vec2(frame.size.xy);
    if (textureSize(motion_full, 0) != ivec2(frame.size.xy)) return vec2(0.0);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 then = (frame.previous_view_from_world * vec4(position, 1.0)).xyz;
    if (!(then.z * frame.depth_range.w > 0.0)) return vec2(length(moved * size), INFINITE);
    vec2 still = project(then, frame.previous_uv_from_view, frame.depth_range.w) - uv;
    vec2 jitter = frame.previous_uv_from_view.zw - frame.uv_from_view.zw;
    return vec2(length((moved - jitter) * size), length((moved - still) * size));
}

// Figures that no plan depends on.
void count_more(ivec2 pixel, float depth_m, vec4 surface, vec4 base, float specular, inout Sums sums) {
    float roughness = clamped(surface.w);
    extend(sums.depth, max(depth_m, 0.0));
    bin(sums.by_surface_roughness, at_surface_roughness, int(roughness * 10.0), 9);
    bin(sums.by_metalness, at_metalness, int(clamped(base.a) * 10.0), 9);
    vec2 motion = texelFetch(motion_full, min(pixel, textureSize(motion_full, 0) - 1), 0).xy;
    vec2 moved = moved_px(pixel, depth_m, motion);
    if (moved.x > 1.0 / 64.0) sums.moved++;
    if (moved.y > 0.125) sums.moving++;
    if (base.a == 0.0 && specular == 0.0) return;
    bin(sums.by_reflecting_roughness, at_reflecting_roughness, int(roughness * 10.0), 9);
    float weight = reflects(depth_m, surface.xyz) ? weight_of(pixel, depth_m, surface, base, specular) : 0.0;
    bin(sums.by_weight, at_weight, weight > 0.0 ? int(ceil(-log2(weight))) - 1 : 11, 11);
}

bool has_part(texture2D image) { return textureSize(image, 0) == ivec2(frame.size.xy); }

void count_picture(ivec2 pixel, inout Sums sums) {
    if (has_part(water_color) && texelFetch(water_color, pixel, 0).a > 0.0) sums.water++;
    if (has_part(transparent_color) && texelFetch(transparent_color, pixel, 0).a > 0.0) {
        sums.transparent++;
        sums.transparent_roughest = max(sums.transparent_roughest, clamped(texelFetch(transparent_normal, pixel, 0).w));
    }
    if (textureSize(stencil_full, 0) == ivec2(frame.size.xy)) {
        uint id = texelFetch(stencil_full, pixel, 0).x;
        if (id != sums.stencil.x) add_stencil(sums.stencil);
        sums.stencil = uvec2(id, sums.stencil.y + 1u);
    }
}

// Whether a lamp's light may reach the surface, cones aside, or does in the captured picture.
bool is_lamplit(ivec2 pixel, float depth_m) {
    if (frame.lamps.x == 0u) return false;
    if (has_part(lamps_lit) && any(notEqual(texelFetch(lamps_lit, pixel, 0).rgb, vec3(0.0)))) return true;
    vec3 world = surface_place(pixel, depth_m);
    for (int lamp = 0; lamp < int(frame.lamps.x); ++lamp)
        if (lamp_reaches(lamp, world, false, true)) return true;
    return false;
}

// Of the class or in the mask: passes may ask for either.
bool shows_skin(ivec2 pixel, float depth_m) {
    if (!(depth_m > 0.0 && depth_m < INFINITE)) return false;
    bool by_class = frame.skin.z != 0u && textureSize(stencil_full, 0) == ivec2(frame.size.xy);
    if (by_class && (texelFetch(stencil_full, pixel, 0).x & frame.skin.y) == frame.skin.x) return true;
    return has_part(skin_strength) && texelFetch(skin_strength, pixel, 0).x > 0.0;
}

// All texels are fetched before any is used, so that the fetches are independent.
void count_pixel(ivec2 pixel, inout Sums sums) {
    float depth_m = texelFetch(depth_full, pixel, 0).x, specular = texelFetch(specular_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0), base = texelFetch(albedo_full, pixel, 0);
    if (depth_m < INFINITE) {
        float roughness = clamped(surface.w);
        sums.surfaces++;
        if (!has_part(sun_mask) || texelFetch(sun_mask, pixel, 0).x > 0.0) sums.sunlit++;
        if (is_lamplit(pixel, depth_m)) sums.lamplit++;
        extend(sums.surface_roughness, roughness);
        if (!(base.a == 0.0 && specular == 0.0)) {
            sums.reflecting++;
            extend(sums.reflecting_roughness, roughness);
        }
        if (whole) count_more(pixel, depth_m, surface, base, specular, sums);
    } else sums.sky++;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 direction = mat3(frame.world_from_view) * view_position(uv, 1.0, frame.view_from_uv, frame.depth_range.z);
    if (dot(direction, frame.up.xyz) > 0.0) {
        sums.above++;
        if (!(depth_m < INFINITE)) sums.open++;
    }
    vec3 color = texelFetch(lit, pixel, 0).rgb;
    float light = luminance(color);
    if (!all(equal(color, vec3(0.0)))) sums.luminous++;
    if (light >= 0.0 && light < LARGEST) extend(sums.light, light);
    if (has_part(stipple_mask) && texelFetch(stipple_mask, pixel, 0).x > 0.5) sums.stippled++;
    if (shows_skin(pixel, depth_m)) sums.skin++;
    if (whole) count_picture(pixel, sums);
}

void add_range(int lowest, int highest, vec2 range) {
    if (range.x > range.y) return;
    atomicMin(figures[lowest], floatBitsToUint(range.x));
    atomicMax(figures[highest], floatBitsToUint(range.y));
}

void add_more(Sums sums) {
    add_row(sums.by_surface_roughness);
    add_row(sums.by_reflecting_roughness);
    add_row(sums.by_metalness);
    add_row(sums.by_weight);
    add_stencil(sums.stencil);
    atomicAdd(figures[at_water], sums.water);
    atomicAdd(figures[at_transparent], sums.transparent);
    atomicAdd(figures[at_moved], sums.moved);
    atomicAdd(figures[at_moving], sums.moving);
    add_range(at_nearest, at_farthest, sums.depth);
    if (sums.light.x <= sums.light.y) atomicMin(figures[at_darkest], floatBitsToUint(sums.light.x));
    atomicMax(figures[at_transparent_roughest], floatBitsToUint(sums.transparent_roughest));
}

const int LANES = int(gl_WorkGroupSize.x * gl_WorkGroupSize.y);

// 64 x 64 pixels, a few rows at a time.
void count_block(int place) {
    int lane = int(gl_LocalInvocationIndex);
    for (int i = lane; i < FIGURES; i += LANES) figures[i] = kind_of(i) == LOWEST ? 0xFFFFFFFFu : 0u;
    barrier();
    const vec2 NONE = vec2(INFINITE, -INFINITE);
    const Row EMPTY = Row(0, 0u);
    Sums sums = Sums(EMPTY, EMPTY, EMPTY, EMPTY, uvec2(0u), 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, NONE, NONE, NONE, NONE, 0.0);
    for (int row = lane / 64; row < 64; row += LANES / 64) {
        ivec2 pixel = 64 * ivec2(gl_WorkGroupID.xy) + ivec2(lane % 64, row);
        if (all(lessThan(pixel, ivec2(frame.size.xy)))) count_pixel(pixel, sums);
    }
    if (whole) add_more(sums);
    atomicAdd(figures[at_sky], sums.sky);
    atomicAdd(figures[at_surfaces], sums.surfaces);
    atomicAdd(figures[at_reflecting], sums.reflecting);
    atomicAdd(figures[at_above], sums.above);
    atomicAdd(figures[at_open], sums.open);
    atomicAdd(figures[at_sunlit], sums.sunlit);
    atomicAdd(figures[at_lamplit], sums.lamplit);
    atomicAdd(figures[at_luminous], sums.luminous);
    atomicMax(figures[at_brightest], floatBitsToUint(max(sums.light.y, 0.0)));
    atomicAdd(figures[at_stippled], sums.stippled);
    atomicAdd(figures[at_skin], sums.skin);
    add_range(at_surface_smoothest, at_surface_roughest, sums.surface_roughness);
    add_range(at_reflecting_smoothest, at_reflecting_roughest, sums.reflecting_roughness);
    barrier();
    for (int i = lane; i < FIGURES; i += LANES) imageStore(survey_blocks, place + i, uvec4(figures[i]));
}

// Each workgroup sums up some figures over all blocks.
void join_blocks(int first, int blocks) {
    int lane = int(gl_LocalInvocationIndex);
    for (int figure = int(workgroup_index()); figure < ALL_FIGURES; figure += blocks) {
        uint kind = kind_of(figure), own = kind == LOWEST ? 0xFFFFFFFFu : 0u;
        if (lane == 0) figures[0] = own;
        barrier();
        for (int block = lane; block < blocks && figure < FIGURES; block += LANES) {
            uint one = LIST_WORD(first + FIGURES * block + figure);
            own = kind == COUNTED ? own + one : kind == LOWEST ? min(own, one) : max(own, one);
        }
        if (kind == COUNTED) atomicAdd(figures[0], own);
        else if (kind == LOWEST) atomicMin(figures[0], own);
        else atomicMax(figures[0], own);
        barrier();
        if (lane == 0) imageStore(survey_figures, ivec2(figure, 0), uvec4(figures[0]));
        barrier();
    }
}

void main() {
    int blocks = int(gl_NumWorkGroups.x * gl_NumWorkGroups.y), first = LIST_ITEMS;
    if (dispatch_phase == 0u) count_block(first + FIGURES * int(workgroup_index()));
    else join_blocks(first, blocks);
}
