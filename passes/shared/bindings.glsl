// Next include of a declaration: its images become bindings, its SPEC and CHOICE rows specialization constants.
// A row's line number is its binding or constant id. Written images have no format here, so that the host may store
// them as half or float without a compile.
//
// An image with levels (a size class ..._MIPS) is written one level at a time, dispatch_level; imageSize() is that
// level's. Readers, and SELF in the pass that writes it, see all levels as one texture.
// Cube maps are written as WRITE(image2DArray, ...): layer 6 * cube + face (faces +X -X +Y -Y +Z -Z), and
// gl_GlobalInvocationID.z is the layer. They are read as textureCube or textureCubeArray,
// or as texture2DArray where the texel is known: layers as above, texelFetch, no filter and no search for the face.
// DISPATCH_LEVELS(image, first, last, order) is one dispatch for each level from the one to the other; -1 is the coarsest.
// DISPATCH_LEVELS_BY(image, width, first, last, order) counts from the finest level that is no wider than the parameter: 0 is that
// one, -1 the next finer; numbers beyond the levels that there are end at those.
// Dispatches of a pass run in the order of their rows; dispatch_phase is the row's number among them, from 0. It is a constant,
// so that what other phases do costs nothing: not all devices jump over what no invocation does.
//
// Lists (size class LIST) are buffers of uints: READ(utextureBuffer, ...), WRITE(uimageBuffer, ...). Words 0 to 2 are the
// workgroups that they are worked on with, word 3 is the number of items, which begin at word 256. Nobody clears them:
// what lies behind the items is the maker's own. DISPATCH over a list is one workgroup for each 32x32 pixels of HALF.
// A pass that declares DISPATCH(image) and after it DISPATCH_LIST(list) runs over the list alone when some pass made it, in
// the phase of that row, and otherwise over the image. A workgroup works on 64 items (item gl_LocalInvocationIndex + 64 *
// workgroup), and it writes what its pass says of the image's tile of the same number where the list leaves pixels out: lists
// have at least as many workgroups as HALF has tiles. See work_list.glsl.
// More rows DISPATCH_LIST may follow, for several lists of one pass; each is a phase.
//
// DISPATCH_TILES(range), behind a DISPATCH, has the pass run over the tiles of tile_list instead, where a pass made that: over
// those of that range (shared/tile_ranges.h), and with tile_works false over the rest, to write what images hold there. See
// tiles.glsl. DISPATCH_TILES_BY(smooth or rough, parameter): the parameter is the largest roughness of a smooth surface, or
// the least of a rough one.
//
// BLOCKS(across): an invocation works on so many texels each way, BLOCK * gl_GlobalInvocationID and what follows; on one, where
// invocations run side by side (a GPU).
//
// PASSES_ON(image, from) says that the pass, where its facts do not hold, would make the image of what it reads as it is: dropped,
// it is remembered as that. Of several rows the first whose image is made counts.
// INSTEAD(image, captured) says the same of an image of the capture, for this frame: while the pass is dropped, its image is that one.
// FACT(name) gives a constant fact_NAME: false when the survey has found that the frame has nothing of the kind, so that the
// code for it is left out (see passes/facts.h for the names). Of an image that the pass makes it is false when no pass that runs
// reads it: it is not made then, and must not be written.
// READS_LEVELS(image, parameter): the pass reads this one of its images only where the parameter is not 0, then even if no ray has
// a cone.
// OPTIONAL_READ gives a constant has_NAME: false when no pass makes the image and its "nothing" value is bound.
// HISTORY images hold what the pipeline's own image (none of the capture) held at the end of the frame before when
// frame.flags.x is 1; what a pass did not make then, because its frame had nothing to do for it, holds the image's "nothing"
// value. Otherwise they are stand-ins of one texel with that value.
// ALONG_RAYS(image, normals): of these cube maps the pass looks up what lies on the ways of the rays of `normals`, as the centres
// see them, and no farther than a texel beside them. In the pass that makes `image`: that holds normals, for mirrors those of
// `normals`. WITHIN(texels), behind a DISPATCH: faces that no way comes that near to may be left out then.
// ROLE(role, name) says what an image or a parameter is to replay and study, which know none by name (glint/passes.h).
// ASSUMED(parameter) says that a parameter stands for what the capture's data do not say, as how thick objects are.
layout(constant_id = 0) const bool diagnostics = false;
layout(constant_id = 999) const uint probe_pass = 0u; // while pixels are probed: the pass's place in the run, from 1 (probe/tell.glsl)
layout(constant_id = 3) const bool halves = true; // images declared as halves are that, and not floats instead
layout(constant_id = 4) const uint dispatch_phase = 0u;
const uint ALL_TILES = 0xFFFFFFFFu; // no list of tiles: all of the image
layout(constant_id = 995) const bool filter_by_hand = false; // cube maps, in shared/cube_filter.glsl
layout(constant_id = 996) const uint tile_wide = 2u; // pixels; 16: the list of strips (tile_list.h)
layout(constant_id = 997) const uint tile_range = ALL_TILES; // of tile_ranges.h, that the dispatch is over
layout(constant_id = 998) const bool tile_works = true;      // false: over the rest, where the pass has nothing to do
#define PASS(title, source)
#define SLOT(title)
#define READ(kind, name) layout(set = 0, binding = __LINE__) uniform kind name;
#define OPTIONAL_READ(kind, name, format, size, nothing) \
    READ(kind, name)                                     \
    layout(constant_id = 1000 + __LINE__) const bool has_##name = true;
#define SELF(kind, name, image) READ(kind, name)
#define HISTORY(kind, name, image) READ(kind, name)
#define WRITE(kind, name, format, unit, size, channels, nothing, meaning) \
    layout(set = 0, binding = __LINE__) uniform writeonly kind name;
#define DIAGNOSTIC(kind, name, format, unit, size, channels, nothing, meaning) \
    layout(set = 0, binding = __LINE__) uniform writeonly kind name;
#define SPEC(type, name, initial, lowest, highest, unit, source, help) \
    layout(constant_id = __LINE__) const type name = type(initial);
#define CHOICE2(name, initial, a, b, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define CHOICE3(name, initial, a, b, c, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; const int name##_##c = 2; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define CHOICE4(name, initial, a, b, c, d, source, help) \
    const int name##_##a = 0; const int name##_##b = 1; const int name##_##c = 2; const int name##_##d = 3; \
    layout(constant_id = __LINE__) const int name = name##_##initial;
#define PUSH(type, name, initial, lowest, highest, unit, source, help)
#define DISPATCH(image)
#define DISPATCH_LEVELS(image, first, last, order)
#define DISPATCH_LEVELS_BY(image, width, first, last, order)
#define DISPATCH_LIST(list)
#define DISPATCH_TILES(range)
#define DISPATCH_TILES_BY(range, parameter)
#define WORKGROUP(width, height)
#define BLOCKS(across) layout(constant_id = __LINE__) const int BLOCK = across;
#define FACT(fact) layout(constant_id = __LINE__) const bool fact_##fact = true;
#define PER_RAY
#define ACCUMULATE(image)
#define NEEDS(fact)
#define NEEDS_BY(fact, parameter)
#define READS_LEVELS(image, parameter)
#define PASSES_ON(image, from)
#define INSTEAD(image, captured)
#define SHOWS_ALL(parameter)
#define ASSUMED(parameter)
#define ALONG_RAYS(image, normals)
#define WITHIN(texels)
#define RESOLUTION(size)
#define ROLE(role, name)
#define REFERENCE
#define REFERENCE_NONE(why)
#define REFERENCE_SET(slot, parameter, value)
#define REFERENCE_WITH(slot, why)

// Ids 1 and 2 are the workgroup that the pass declares.
layout(local_size_x = 8, local_size_y = 8, local_size_x_id = 1, local_size_y_id = 2) in;

#define FIELD(type, name, meaning) type name;
layout(set = 1, binding = 0, std140) uniform Frame {
#include "frame_fields.h"
} frame;
#undef FIELD
// What random4() takes as the frame's number: another one for each ray of a frame.
uint random_frame() { return frame.counts.y + frame.flags.w * 0x9E3779B9u; }
layout(set = 1, binding = 1) uniform sampler linear_clamp;
layout(set = 1, binding = 2) uniform sampler nearest_clamp;
