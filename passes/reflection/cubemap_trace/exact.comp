#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "exact.pass.h"
#include "shared/push_begin.glsl"
#include "exact.pass.h"
};
#include "shared/active.glsl"
#include "shared/camera.glsl"
#include "shared/end_reasons.glsl"
#define LIST_WORD(place) (has_cubemap_list ? texelFetch(cubemap_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"
#include "place.glsl"
#include "sky.glsl"
#include "probe.glsl"
#include "texels.glsl"

float seen_distance(vec3 from_center, uint place) {
    int size = int(frame.counts.z);
    if (fact_some_distances && !has_distances(place)) return 1e-30; // it sees no ray
    if (!interpolate || size < 2) return texelFetch(cubemap_distance, face_texel(from_center, place, size), 0).x;
    return on_planes(cubemap_distance, from_center, place);
}

// The ray as one cube map sees it: at parameter t it is at foot + (from_foot + t) · direction, foot being nearest to the
// centre and `aside` from it.
struct View {
    vec3 foot;
    float from_foot, aside;
    uint place;
};

View view_of(vec3 origin, vec3 direction, uint place) {
    vec3 from_center = origin - active_centers[place].xyz;
    View view;
    view.from_foot = dot(from_center, direction);
    view.foot = from_center - view.from_foot * direction;
    view.aside = length(view.foot);
    view.place = place;
    return view;
}

vec3 at(View view, vec3 direction, float t) { return view.foot + (view.from_foot + t) * direction; }

// How far the ray is behind the visible surface, relative to the surface's distance; <= 0 in front.
float gap_at(View view, vec3 direction, float t, inout uint fetches) {
    vec3 from_center = at(view, direction, t);
    fetches++;
    return length(from_center) / seen_distance(from_center, view.place) - 1.0;
}

void probe_view(View view, vec3 direction, float t, float step_m, uint decision) {
    if (!probing()) return;
    vec3 from_center = at(view, direction, t);
    probe_face_texel(cubemap_distance, IMAGE_cubemap_distance, from_center, view.place, 0, t, step_m,
                     seen_distance(from_center, view.place), decision);
}
void probe_cell(View view, vec3 direction, float t, int level, float beyond) {
    if (!probing()) return;
    probe_face_texel(cubemap_distance_mips, IMAGE_cubemap_distance_mips, at(view, direction, t), view.place, level, t, 0.0,
                     beyond, !(beyond < LARGEST) ? DECISION_sky : beyond > t ? DECISION_skipped : DECISION_descend);
}

// The parameter at which the direction from the centre has turned by a number of texels; +inf if it never turns that far. With s along
// the ray from its foot, tan(angle) = s/aside; the addition theorem of the tangent. The distance from
// the centre at most doubles: near the end of the turn a step would otherwise be kilometres long, in which bisection finds no hit.
float next_t(View view, vec3 direction, float t, float texels) {
    vec3 from_center = at(view, direction, t);
    float k = texels * texel_angle(from_center, float(frame.counts.z)), s = view.from_foot + t;
    float turn = view.aside - s * k;
    if (!(turn > 0.0)) return INFINITE;
    float distance_m = length(from_center);
    return max(t + distance_m * min(k * distance_m / turn, 1.0), t * (1.0 + 1e-6) + 1e-6);
}

// A vector in the axes of a face: right, down, and out of the face.
vec3 on_face(vec3 d, int face) {
    float front = (face & 1) == 0 ? 1.0 : -1.0;
    if (face < 2) return vec3(-front * d.z, -d.y, front * d.x);
    if (face < 4) return vec3(d.x, front * d.z, front * d.y);
    return vec3(front * d.x, -d.y, front * d.z);
}

// Where the ray leaves a cone over a rectangle of the face, from the inside; +inf: never. A border b is the plane
// across = b · out.
float leaves(vec3 from, vec3 along, vec2 low, vec2 high) {
    vec2 to_low = along.xy - low * along.z, to_high = along.xy - high * along.z;
    vec2 by_low = mix(vec2(INFINITE), (low * from.z - from.xy) / to_low, lessThan(to_low, vec2(0.0)));
    vec2 by_high = mix(vec2(INFINITE), (high * from.z - from.xy) / to_high, greaterThan(to_high, vec2(0.0)));
    vec2 first = min(by_low, by_high);
    return max(min(first.x, first.y), 0.0);
}

// Where the ray leaves a texel of a coarser level, if all surfaces in that texel are farther from the centre than the ray gets on the
// way, which is farthest at one of the ends; otherwise t itself. +inf: the ray ends in the sky. Texels at the border of a face are
// interpolated with those of the next face, so the last texel is not entered; within a face there is no such border.
float beyond_cell(View view, vec3 direction, float t, int level, inout uint fetches) {
    vec3 from_center = at(view, direction, t), face = face_from_direction(from_center);
    float size = float(frame.counts.z), coarse = float(max(int(frame.counts.z) >> level, 1));
    Patch cells = patch_of(cubemap_distance_mips, face, view.place, level);
    fetches += 4u;
    // Planes between texels may be nearer than their corners by less than a texel's width.
    float least = min(min(cells.distance_m.x, cells.distance_m.y), min(cells.distance_m.z, cells.distance_m.w));
    least *= 1.0 - 2.0 / size;
    vec2 low = face.xy * coarse - 0.5 - cells.part, high = min(low + 2.0, coarse);
    low = mix(low / coarse + 1.0 / size, vec2(0.0), lessThanEqual(low, vec2(0.0)));
    high = mix(high / coarse - 1.0 / size, vec2(1.0), greaterThanEqual(high, vec2(coarse)));
    int number = int(face.z);
    float way = leaves(on_face(from_center, number), on_face(direction, number), 2.0 * low - 1.0, 2.0 * high - 1.0);
    if (!(way < LARGEST)) return least < LARGEST ? t : INFINITE;
    return max(length(from_center), length(at(view, direction, t + way))) < least ? t + way : t;
}

struct Result {
    float travelled_m;
    uint place, end, steps, fetches;
};

// Of the cube maps from which a point of the ray is visible, the one with the nearest centre, whose texels are finest there.
uint seer(vec3 origin, vec3 direction, float t, float allowed, inout uint fetches) {
    uint best = NO_PLACE;
    float best2 = INFINITE;
    for (uint i = 0u; i < frame.counts.x; ++i) {
        View view = view_of(origin, direction, i);
        vec3 from_center = at(view, direction, t);
        float distance2 = dot(from_center, from_center);
        if (distance2 >= best2 || gap_at(view, direction, t, fetches) > allowed) continue;
        best = i;
        best2 = distance2;
    }
    return best;
}

// The next cube map of the chain from which a point of the ray is visible, in cyclic order; used: the last one's index in the chain.
uint next_seer(vec3 origin, vec3 direction, float t, float allowed, uint best, inout int used, inout uint fetches) {
    int longest = int(frame.flags.z);
    for (int i = 1; i <= longest; ++i) {
        int next = (used + i) % longest;
        uint place = texelFetch(active_chain, ivec2(next, best), 0).x;
        if (gap_at(view_of(origin, direction, place), direction, t, fetches) > allowed) continue;
        used = next;
        return place;
    }
    return NO_PLACE;
}

// The length along the ray that spans one texel as seen from the centre.
float texel_along(View view, vec3 direction, float t) {
    vec3 from_center = at(view, direction, t);
    float k = texel_angle(from_center, float(frame.counts.z)), distance_m = length(from_center);
    return k * distance_m * distance_m / max(view.aside, k * distance_m);
}

// Along a ray the gap to a plane grows linearly, and at a corner of two planes its growth lies between those of both planes. A growth
// outside of that range from one texel to the next means an edge, across which the distances of texels of two surfaces were
// interpolated.
bool edge_at(View view, vec3 direction, float t, inout uint fetches) {
    float texel_m = texel_along(view, direction, t);
    float first = gap_at(view, direction, t - 1.5 * texel_m, fetches);
    float second = gap_at(view, direction, t - 0.5 * texel_m, fetches);
    float third = gap_at(view, direction, t + 0.5 * texel_m, fetches);
    vec3 grows = vec3(second, third, gap_at(view, direction, t + 1.5 * texel_m, fetches)) - vec3(first, second, third);
    return grows.y < min(grows.x, grows.z) - tolerance || grows.y > max(grows.x, grows.z) + tolerance;
}

// The state of a ray: the cube map that it is traced in, whether it is visible from there, and whether it has been in front of a surface there,
// which it can hit now.
struct Walk {
    View view;
    float t;
    bool seen, front;
    bool blocked; // it crossed a visible surface from behind
    uint best;
    int used; // index in the chain
    // The cube map in which the ray last became occluded by an edge, where that was, and whether there was sky behind it.
    uint last_place;
    float last_t;
    bool last_sky;
};

// Whether an occluded ray becomes visible past an edge. Otherwise it comes through a visible surface from behind: a wall has stopped it
// before, of which this cube map only shows the other side.
bool passes_edge(View view, vec3 direction, float hidden, float seen, inout uint fetches) {
    float gap = gap_at(view, direction, hidden, fetches);
    if (gap <= tolerance) return true;
    float gap_seen = gap_at(view, direction, seen, fetches);
    for (int i = 0; i < refinements; ++i) {
        float middle = 0.5 * (hidden + seen), gap_middle = gap_at(view, direction, middle, fetches);
        if (gap_middle <= tolerance) {
            seen = middle;
            gap_seen = gap_middle;
        } else {
            hidden = middle;
            gap = gap_middle;
        }
    }
    return gap - gap_seen > tolerance || edge_at(view, direction, 0.5 * (hidden + seen), fetches);
}

// Switches to the cube map from which the ray is visible at t_after, and from t_before on if it is in front of a surface there, too.
void change_view(inout Walk walk, vec3 origin, vec3 direction, float t_before, float t_after, inout uint fetches) {
    uint place = maps == maps_all ? seer(origin, direction, t_after, tolerance, fetches)
                                  : next_seer(origin, direction, t_after, tolerance, walk.best, walk.used, fetches);
    walk.seen = place != NO_PLACE;
    walk.view = view_of(origin, direction, walk.seen ? place : nearest_among(frame.distances.x, origin + t_after * direction));
    walk.t = t_after;
    walk.front = false;
    if (!walk.seen) return;
    walk.blocked = maps == maps_all && !passes_edge(walk.view, direction, t_before, t_after, fetches);
    walk.front = gap_at(walk.view, direction, t_after, fetches) <= 0.0;
    if (gap_at(walk.view, direction, t_before, fetches) > 0.0) return;
    walk.t = t_before;
    walk.front = true;
}

// A cube map whose centre is nearer has finer texels here.
void take_finer_view(inout Walk walk, vec3 origin, vec3 direction, inout uint fetches) {
    if (maps == maps_chain) return;
    uint nearest = nearest_among(frame.distances.x, origin + walk.t * direction);
    if (nearest == walk.view.place) return;
    View view = view_of(origin, direction, nearest);
    if (gap_at(view, direction, walk.t, fetches) <= 0.0) walk.view = view;
}

// Bisects the interval in which the ray gets farther behind a surface than allowed. True if it hits a surface there, on either side of
// an edge.
bool closes_in(View view, vec3 direction, float allowed, inout float low, inout float high, inout uint fetches) {
    for (int i = 0; i < refinements; ++i) {
        float middle = 0.5 * (low + high);
        if (gap_at(view, direction, middle, fetches) <= allowed) low = middle;
        else high = middle;
    }
    return gap_at(view, direction, low, fetches) >= allowed - tolerance ||
           gap_at(view, direction, high, fetches) <= allowed + tolerance;
}

void end_at(inout Result result, float travelled_m, uint place, uint end) {
    result.travelled_m = travelled_m;
    result.place = place;
    result.end = end;
}

// The end of a ray that is no longer visible from any cube map. The most likely guess is that what was last visible behind the ray
// continues behind the edge that occludes it: the sky, or a surface, whose colour is taken where it was visible. A ray that must have
// hit a wall does not end in the sky but near the occluder.
void end_occluded(inout Result result, Walk walk, vec3 direction, uint best) {
    if (occluded == occluded_stop) { // as march does
        end_at(result, INFINITE, best, END_shadow_region);
        return;
    }
    if (walk.last_place == NO_PLACE) { // it was never visible
        result.fetches++;
        float seen_m = seen_distance(direction, best);
        bool sky = !walk.blocked && !(seen_m < LARGEST);
        end_at(result, walk.blocked ? walk.t : seen_m, sky ? place_of_sky(best) : best, END_shadow_region);
        return;
    }
    if (walk.last_sky && walk.blocked) end_at(result, walk.t, walk.last_place, END_shadow_region);
    else if (walk.last_sky && frame.counts.w > 0u) end_at(result, INFINITE, NO_PLACE, END_shadow_region);
    else end_at(result, walk.last_t, walk.last_place, END_shadow_region);
}

const int FINEST_SKIP = 2; // its cells are wider than the texels that must not be skipped
const int PATIENCE = 4;    // steps until the next attempt to skip
const float UNSEEN = 4.0;  // occluded rays take longer steps, since each step tests all cube maps; this does not lower the number of correct hits

Result march(vec3 origin, vec3 direction, float start_m, uint best) {
    Result result = Result(start_m, NO_PLACE, END_steps_exhausted, 0u, 0u);
    probe_cubemap_ray(origin, direction, start_m, best);
    Walk walk;
    walk.best = best;
    walk.used = -1;
    walk.blocked = false;
    walk.last_place = NO_PLACE;
    int level = 4, wait = 0;
    change_view(walk, origin, direction, start_m, start_m, result.fetches);
    while (result.steps < uint(steps) && walk.t < length_m && (walk.seen || occluded == occluded_continue)) {
        result.steps++;
        if (skip && has_cubemap_distance_mips && walk.seen && --wait < 0) {
            float beyond = beyond_cell(walk.view, direction, walk.t, level, result.fetches);
            if (beyond > walk.t || level > FINEST_SKIP) probe_cell(walk.view, direction, walk.t, level, beyond);
            if (!(beyond < LARGEST)) {
                end_at(result, INFINITE, place_of_sky(walk.view.place), END_sky);
                return result;
            }
            if (beyond > walk.t) {
                walk.t = beyond * (1.0 + 1e-6) + 1e-6;
                walk.front = true;
                take_finer_view(walk, origin, direction, result.fetches);
                level = min(level + 1, findMSB(frame.counts.z));
                continue;
            }
            if (level > FINEST_SKIP) {
                level--;
                continue;
            }
            wait = PATIENCE;
        }
        float next = next_t(walk.view, direction, walk.t, walk.seen ? texel_part : UNSEEN * texel_part);
        if (!walk.seen) next = min(next, length_m);
        else if (!(next < LARGEST)) { // the direction no longer leaves the texel: it is sky, or the ray is behind its surface at twice the distance
            float last_m = seen_distance(direction, walk.view.place);
            result.fetches++;
            if (!(last_m < LARGEST)) {
                probe_view(walk.view, direction, walk.t, 0.0, DECISION_sky);
                end_at(result, INFINITE, place_of_sky(walk.view.place), END_sky);
                return result;
            }
            next = max(2.0 * (last_m + walk.view.aside) - walk.view.from_foot, 2.0 * walk.t);
        }
        float low = walk.t, high = next;
        if (walk.seen) {
            float gap = gap_at(walk.view, direction, next, result.fetches);
            if (gap <= 0.0) {
                probe_view(walk.view, direction, next, next - walk.t, DECISION_front);
                walk.t = next;
                walk.front = true;
                take_finer_view(walk, origin, direction, result.fetches);
                continue;
            }
            if (!walk.front && gap <= tolerance) { // still on the surface where it started
                probe_view(walk.view, direction, next, next - walk.t, DECISION_at_start);
                walk.t = next;
                continue;
            }
            // from there it may go behind another surface at once, as beside a corner
            if (closes_in(walk.view, direction, walk.front ? 0.0 : tolerance, low, high, result.fetches)) {
                end_at(result, 0.5 * (low + high), walk.view.place, END_hit);
                probe_view(walk.view, direction, result.travelled_m, high - low, DECISION_hit);
                return result;
            }
            walk.last_place = walk.view.place;
            walk.last_t = max(low - 1.5 * texel_along(walk.view, direction, low), 0.0); // keeps a distance from the edge, whose colour must not be mixed in
            walk.last_sky = !(seen_distance(at(walk.view, direction, walk.last_t), walk.view.place) < LARGEST);
            result.fetches++;
        }
        probe_view(walk.view, direction, high, high - low, DECISION_occluded);
        // This is the only inner loop, since a CPU driver runs every inner loop in each iteration and aborts a shader after a limited
        // number of iterations of all loops.
        change_view(walk, origin, direction, low, high, result.fetches);
        if (walk.blocked) break;
    }
    if (!walk.seen || walk.blocked) {
        end_occluded(result, walk, direction, best);
        return result;
    }
    result.fetches++; // a ray that remains in front of the sky ends there
    bool in_sky = !(seen_distance(at(walk.view, direction, walk.t), walk.view.place) < LARGEST);
    if (in_sky) end_at(result, INFINITE, place_of_sky(walk.view.place), END_sky);
    else end_at(result, walk.t, walk.view.place, END_steps_exhausted);
    return result;
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(travelled)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    float start_m = texelFetch(screen_travelled, pixel, 0).x;
    Result result = Result(start_m, NO_PLACE, END_not_traced, 0u, 0u);
    probe_texel(pixel);
    if (tile_works && texelFetch(screen_finished, pixel, 0).x == 0u && reflects(depth_m, normal.xyz)) {
        vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
        vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        vec3 direction = mirror_direction(origin, normal.xyz);
        uint best = texelFetch(cubemap_best, pixel, 0).x;
        if (frame.counts.x == 0u) result = Result(travelled_without_cubemaps(start_m, direction), NO_PLACE, END_no_cubemap, 0u, 0u);
        else if (!has_distances(best)) result = Result(INFINITE, best, END_fallback, 0u, 0u);
        else result = march(origin, direction, start_m, best);
    }
    probe_cubemap_end(result.travelled_m, result.place, result.end, result.steps, result.fetches);
    imageStore(travelled, pixel, vec4(result.travelled_m));
    imageStore(cubemap_index, pixel, uvec4(result.place));
    if (diagnostics) {
        imageStore(cubemap_end, pixel, uvec4(result.end));
        imageStore(cubemap_steps, pixel, uvec4(result.steps));
        imageStore(cubemap_fetches, pixel, uvec4(result.fetches));
    }
}
