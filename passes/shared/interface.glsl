// The interface of every pass besides its declaration: constants that the host sets, the frame, the samplers. The generated
// shared/bindings.glsl includes it. Other bindings of set 0 and other constants are rows of the declaration (passes/row_kinds.py).
layout(constant_id = 0) const bool diagnostics = false;
#ifdef NO_PROBES // the module of runs without probed pixels (spirv.py)
const uint probe_pass = 0u;
#else
layout(constant_id = 999) const uint probe_pass = 0u; // while pixels are probed: the pass's place in the run, from 1 (shared/probe/record.glsl)
#endif
layout(constant_id = 3) const bool halves = true; // false: images declared as half floats are full floats
layout(constant_id = 4) const uint dispatch_phase = 0u; // the number of this dispatch among the pass's rows DISPATCH…
const uint ALL_TILES = 0xFFFFFFFFu; // no list: the dispatch covers the whole image
layout(constant_id = 995) const bool filter_by_hand = false; // cube maps are filtered by shared/cube_filter.glsl, not by a sampler
layout(constant_id = 997) const uint tile_range = ALL_TILES; // the range of a list that the dispatch covers (shared/work_list.h)
layout(constant_id = 998) const bool tile_works = true; // false: the dispatch covers the other tiles, where the pass only writes fallback values

// Ids 1 and 2 are the workgroup's size, from the row WORKGROUP.
layout(local_size_x = 8, local_size_y = 8, local_size_x_id = 1, local_size_y_id = 2) in;

#include "lamps.h"
#include "shadow_maps.h"
#define FIELD(type, name, meaning) type name;
layout(set = 1, binding = 0, std140) uniform Frame {
#include "frame_fields.h"
} frame;
#undef FIELD
// The frame number that random4() takes: a different one for each ray of a frame.
uint random_frame() { return frame.counts.y + frame.flags.w * 0x9E3779B9u; }
layout(set = 1, binding = 1) uniform sampler linear_clamp;
layout(set = 1, binding = 2) uniform sampler nearest_clamp;

// Stores into images of half floats: finite values beyond their range become the largest, which a conversion would make infinite. What is not finite
// stays so, for lengths may be infinite, and a NaN is to be found where it arose.
const bool HALF_RGBA16F = true, HALF_RG16F = true, HALF_R16F = true, HALF_RGBA32F = false, HALF_RG32F = false, HALF_R32F = false,
           HALF_R8UI = false, HALF_R32UI = false;
vec4 half_range(vec4 value) { return mix(value, clamp(value, -65504.0, 65504.0), lessThan(abs(value), vec4(1.0 / 0.0))); }
vec4 in_range(vec4 value, bool is_half) { return halves && is_half ? half_range(value) : value; }
uvec4 in_range(uvec4 value, bool is_half) { return value; }
#define STORE(image, at, value) imageStore(image, at, in_range(value, is_half_##image))
#define imageStore(image, at, value) STORE(image, at, value)
