// The march along a chain of cube maps. Next include of a pass with the rows of march_rows.h, which calls load_active_centers().
#include "shared/active.glsl"
#include "shared/camera.glsl"
#include "shared/cocoon.glsl"
#include "shared/end_reasons.glsl"
#include "shared/random.glsl"
#include "shared/steps.glsl"
#include "place.glsl"
#include "probe.glsl"
#include "texels.glsl"
#include "volume.glsl"

const int COCOON_STEPS = 8, COCOON_REFINEMENTS = 3;
const int MOST_SAMPLES = 16; // upper bound for a step

struct Quality {
    int steps, refinements, level;
    float first_m, ratio, roughness;
};

bool through_cocoon() { return depth == depth_capped && has_cocoon_distance; }

// Distance of the surface that is visible from a cube map's centre in a direction; +inf for sky, negative for the cocoon's cap over the sky.
// Interpolation with a sky texel would yield inf or NaN; the nearest texel is used there, so that the result is finite or +inf.
float seen_in(texture2DArray faces, vec3 direction, uint place, int level) {
    if (!bilinear) {
        float texel_m = texelFetch(faces, face_texel(direction, place, int(frame.counts.z) >> level), level).x;
        return abs(texel_m) < LARGEST ? texel_m : INFINITE;
    }
    Patch texels = patch_of(faces, face_from_direction(direction), place, level);
    float own_m = nearest_of(texels), nearest_m = abs(own_m);
    if (!(nearest_m < LARGEST)) return INFINITE;
    texels.distance_m = abs(texels.distance_m);
    float smooth_m = mean_of(texels);
    if (abs(smooth_m) < LARGEST) nearest_m = clamp(smooth_m, nearest_m * (1.0 - clamp_part), nearest_m * (1.0 + clamp_part));
    return own_m < 0.0 ? -nearest_m : nearest_m;
}

// A level of a chain, clamped to those that exist.
int level_for(float roughness) {
    if (rough_level == 0.0 || roughness <= hq_roughness || !(through_cocoon() || has_cubemap_distance_mips)) return 0;
    return min(int(rough_level * roughness), findMSB(frame.counts.z));
}

float seen_distance(vec3 from_center, uint place, int level) {
    if (through_cocoon()) return seen_in(cocoon_distance, from_center, place, level);
    if (has_cubemap_distance_mips && level > 0) return seen_in(cubemap_distance_mips, from_center, place, level);
    if (surfaces == surfaces_exact) return on_planes(cubemap_distance, from_center, place);
    return seen_in(cubemap_distance, from_center, place, 0);
}

// The number of texture fetches of seen_distance().
uint fetches_of(int level) { return bilinear && level > 0 ? 4u : 1u; }

Quality quality_of(float roughness, uvec2 pixel) {
    bool smooth_surface = roughness <= hq_roughness;
    Quality q;
    q.roughness = roughness;
    q.steps = smooth_surface ? steps_hq : steps_lq;
    q.refinements = smooth_surface ? refinements : refinements_lq;
    float total_m = smooth_surface ? length_m : length_lq_m;
    if (first_step_m > 0.0) {
        q.first_m = min(first_step_m, total_m);
        q.ratio = geometric_ratio(total_m / q.first_m, q.steps);
    } else {
        float part = random_scale ? random4(pixel, random_frame(), RANDOM_STEP_SCALE).x : 0.5;
        q.ratio = smooth_surface ? mix(scale_min, scale_max, part) : mix(scale_min_lq, scale_max_lq, part);
        q.first_m = geometric_first_step(total_m, q.ratio, q.steps);
    }
    q.level = level_for(roughness);
    return q;
}

float mass_depth(vec3 from_center, float distance_m, vec3 direction, float step_m) {
    if (surfaces == surfaces_exact) return INFINITE; // discontinuities are detected when the step is small
    float advance_m = mass == mass_along ? step_m : abs(dot(from_center, direction)) / distance_m * step_m;
    return mass_m + mass_step * advance_m;
}

struct Result {
    float travelled_m;
    uint place, end, steps, fetches;
};

vec3 center_of(uint place) { return active_centers[place].xyz; }

bool sees_sky(vec3 from_center, inout Result result) {
    result.fetches++;
    ivec3 texel = face_texel(from_center, result.place, int(frame.counts.z));
    return !(texelFetch(cubemap_distance, texel, 0).x < LARGEST);
}

void end_in_sky(inout Result result) {
    result.end = END_sky;
    result.travelled_m = INFINITE;
    result.place = place_of_sky(result.place);
}

// A ray that hits the cocoon's cap over the sky ends in the sky. A wide cone stays on the cap, where alpha of the cube map's levels
// states how much of its surroundings is sky.
void end_on_cap(inout Result result, float roughness) {
    result.end = END_sky;
    if (roughness <= hq_roughness) end_in_sky(result);
}

// An occluded point lies between the occluding surface and the cocoon. Objects are assumed to be `solid` times as deep as the distance
// between these two: a point that is less far behind the surface lies inside an object, as does a point outside the cocoon:
// d - seen < solid (hull - seen) with hull = d / gauge.
bool in_something(vec3 from_center, uint place, inout Result result) {
    float gauge = cocoon_gauge(cocoon, from_center, place), distance_m = length(from_center);
    float seen_m = seen_in(cubemap_distance, from_center, place, 0), behind_m = distance_m - seen_m;
    result.fetches += 2u;
    if (!(gauge > 0.0)) return false; // all sky
    return gauge > 1.0 || (behind_m > 0.0 && behind_m * gauge < solid * (distance_m - seen_m * gauge));
}

// The end of a ray that is occluded in all cube maps, by the cocoon. A ray that does not leave the cocoon is sampled by its direction; one that
// leaves it through the cap over the sky ends in the sky.
void fall_back(inout Result result, vec3 origin, vec3 direction, uint best, float roughness) {
    if (fallback == fallback_black) {
        result.place = NO_PLACE;
        return;
    }
    result.place = best;
    if (fallback == fallback_lookup) {
        if (lookup == lookup_direction) result.travelled_m = INFINITE;
        return;
    }
    bool stopped = cocoon_start == cocoon_start_stopped;
    float start_m = stopped ? result.travelled_m : 0.0, end_m = 0.0;
    vec3 start = origin + start_m * direction - center_of(best);
    if (!(stopped && in_something(start, best, result))) {
        end_m = leaves_cocoon(cocoon, start, direction, best, COCOON_STEPS, COCOON_REFINEMENTS);
        result.fetches += uint(COCOON_STEPS + 1 + COCOON_REFINEMENTS);
    }
    result.travelled_m = end_m < 0.0 ? INFINITE : start_m + end_m;
    if (end_m >= 0.0 && sees_sky(start + end_m * direction, result)) end_on_cap(result, roughness);
}

// A sample of the ray: its parameter, and how far it is behind the visible surface in its direction, < 0 in front.
struct Sample {
    float t, gap, distance_m, seen_m;
    bool cap; // the visible surface is the cocoon's cap over the sky
};

Sample sample_at(vec3 from_center, vec3 direction, float t, uint place, int level) {
    precise vec3 at = from_center + direction * t;
    if (fact_some_distances && !has_distances(place)) return Sample(t, INFINITE, length(at), 0.0, false); // it sees no ray
    precise float distance_m = length(at), found = seen_distance(at, place, level), seen_m = abs(found);
    return Sample(t, distance_m - seen_m, distance_m, seen_m, found < 0.0);
}

void probe_sample(vec3 from_center, vec3 direction, Sample s, float step_m, uint place, int level, uint decision) {
    vec3 at = from_center + direction * s.t;
    if (through_cocoon())
        probe_face_texel(cocoon_distance, IMAGE_cocoon_distance, at, place, level, s.t, step_m, s.seen_m, decision);
    else if (has_cubemap_distance_mips && level > 0)
        probe_face_texel(cubemap_distance_mips, IMAGE_cubemap_distance_mips, at, place, level, s.t, step_m, s.seen_m, decision);
    else probe_face_texel(cubemap_distance, IMAGE_cubemap_distance, at, place, 0, s.t, step_m, s.seen_m, decision);
}
void probe_met(vec3 from_center, vec3 direction, float step_m, Result result, int level, uint decision) {
    if (!probing()) return;
    Sample s = sample_at(from_center, direction, result.travelled_m, result.place, level);
    probe_sample(from_center, direction, s, step_m, result.place, level, decision);
}

// Whether the sample lies on the visible surface, within the tolerance of `verify`.
bool on_surface(Sample s) { return s.seen_m < LARGEST && abs(s.gap) <= verify_part * s.seen_m; }

// Interpolates the hit between a sample in front and one behind, linearly by their gaps. A sample in front of the sky has a gap of -inf and
// does not help, nor does NONE.
precise float secant_between(Sample front, Sample behind) {
    if (!(front.gap > -LARGEST)) return behind.t;
    float gap = min(front.gap, 0.0);
    return mix(front.t, behind.t, gap / (gap - behind.gap));
}

// Skips the cube map's inner volume: the next sample is where the ray leaves it, so that a wall there lies between two samples.
float skipped(float t, float step_m, uint place, vec3 origin, vec3 direction) {
    return max(leaves_volume(active_volume, place, origin, direction, t, step_m) - step_m, t);
}

// The slides' loop. Deviations: the position along the ray is a single number t instead of a position that is transformed between the cube
// maps' spaces, so that errors do not accumulate; the step grows only while no hit is being refined, and doubles up to its former size
// after a refinement without a hit; and the chain is searched from its start for each sample, since fine steps, which notice every narrow
// occluded strip, would otherwise exhaust it. loop=printed omits the last two.
Result march(vec3 origin, vec3 direction, float start_m, uint best, Quality quality) {
    const Sample NONE = Sample(start_m, -INFINITE, 0.0, 0.0, false);
    probe_cubemap_ray(origin, direction, start_m, best);
    int longest = min(chain, int(frame.flags.z));
    uint fetches = fetches_of(quality.level);
    Result result = Result(start_m, best, END_steps_exhausted, 0u, 0u);
    vec3 from_center = origin - center_of(best);
    precise float step_m = quality.first_m;
    Sample front = NONE, behind = NONE, now = NONE;
    int used = 0, refused = 0, refined = 0;
    precise float full_step_m = 0.0; // the step size before a refinement
    bool emerged = false; // it has been in front of a surface since the last switch of cube maps
    if (skip_volume && fact_volumes) now.t = skipped(now.t, step_m, best, origin, direction);
    bool again = false; // repeat the step in the next cube map
    for (int i = 0, left = quality.steps; left > 0 && i < MOST_SAMPLES * quality.steps; ++i) {
        if (count == count_samples || !(again || step_m < full_step_m)) --left;
        again = false;
        result.steps++;
        result.fetches += fetches;
        now = sample_at(from_center, direction, now.t + step_m, result.place, quality.level);
        bool seen = !(now.gap > bias * now.seen_m + bias_m);
        emerged = emerged || seen;
        if (seen || (surfaces == surfaces_exact && !emerged && on_surface(now))) {
            probe_sample(from_center, direction, now, step_m, result.place, quality.level, seen ? DECISION_front : DECISION_at_start);
            front = now;
            if (loop == loop_restored) refused = 0;
            if (loop == loop_restored && refined > 0) continue;
            if (loop == loop_restored && step_m < full_step_m) {
                step_m = min(2.0 * step_m, full_step_m);
                continue;
            }
            step_m *= quality.ratio;
            full_step_m = 0.0;
            continue;
        }
        if (now.cap) { // there is no hit to refine
            result.travelled_m = secant_between(front, now);
            probe_sample(from_center, direction, now, step_m, result.place, quality.level, DECISION_sky);
            end_on_cap(result, quality.roughness);
            return result;
        }
        vec3 at = from_center + direction * now.t;
        if (now.gap < mass_depth(at, now.distance_m, direction, step_m)) {
            behind = now;
            // Sums of shrinking steps would exceed the length.
            if (count == count_strides || quality.ratio > 1.0) full_step_m = max(full_step_m, step_m);
            if (++refined < quality.refinements) {
                probe_sample(from_center, direction, now, step_m, result.place, quality.level, DECISION_bisect);
                now.t -= step_m;
                step_m *= loop == loop_printed ? 0.5 * quality.ratio : 0.5;
                continue;
            }
            result.travelled_m = secant ? secant_between(front, behind) : behind.t;
            result.end = END_hit;
            if (!verify || (surfaces == surfaces_exact && (on_surface(front) || on_surface(behind)))) {
                probe_met(from_center, direction, step_m, result, quality.level, DECISION_hit);
                return result;
            }
            result.fetches += fetches;
            Sample end = sample_at(from_center, direction, result.travelled_m, result.place, quality.level);
            probe_sample(from_center, direction, end, step_m, result.place, quality.level,
                         end.cap ? DECISION_sky : on_surface(end) ? DECISION_hit : DECISION_rejected);
            if (end.cap) end_on_cap(result, quality.roughness);
            if (end.cap || on_surface(end)) return result;
        }
        probe_sample(from_center, direction, now, step_m, result.place, quality.level, DECISION_occluded);
        if (++refused >= longest) {
            result.travelled_m = now.t;
            fall_back(result, origin, direction, best, quality.roughness);
            probe(PROBE_cubemap_fallback, vec4(result.place, now.t, result.travelled_m, 0.0));
            result.end = END_shadow_region;
            return result;
        }
        if (++used == longest) used = 0;
        result.place = texelFetch(active_chain, ivec2(used, best), 0).x;
        from_center = origin - center_of(result.place);
        if (step_back) now.t -= step_m;
        else step_m *= quality.ratio;
        if (skip_volume && fact_volumes) now.t = skipped(now.t, step_m, result.place, origin, direction);
        front = NONE; // samples of the last cube map are meaningless in this one
        if (loop == loop_restored) refined = 0;
        emerged = false;
        again = step_back;
    }
    result.travelled_m = now.t;
    result.end = END_steps_exhausted;
    if (refined > 0) {
        result.travelled_m = secant ? secant_between(front, behind) : behind.t;
        result.end = END_hit;
        probe_met(from_center, direction, step_m, result, quality.level, DECISION_hit);
        return result;
    }
    if (now.seen_m == INFINITE) {
        end_in_sky(result);
    } else if (now.cap) {
        end_on_cap(result, quality.roughness);
    } else if (exhausted == exhausted_fallback) {
        fall_back(result, origin, direction, best, quality.roughness);
        probe(PROBE_cubemap_fallback, vec4(result.place, now.t, result.travelled_m, 0.0));
        result.end = END_steps_exhausted;
    } else if (exhausted == exhausted_direction) {
        result.travelled_m = INFINITE;
    }
    return result;
}
