/* The uniform block of all passes, filled from the attributes of the capture's frame. */
#ifndef GLINT_REPLAY_FRAME_BLOCK_H
#define GLINT_REPLAY_FRAME_BLOCK_H

#include <stdint.h>

#include "glint/capture.h"
#include "shared/lamps.h"
#include "shared/shadow_maps.h"

/* std140, as passes/shared/interface.glsl declares it: column-major matrices. */
typedef struct {
    float column[4][4];
} mat4;
typedef struct {
    float x, y, z, w;
} vec4;
typedef struct {
    uint32_t x, y, z, w;
} uvec4;
struct frame_block {
#define FIELD(type, name, meaning) type name;
#include "shared/frame_fields.h"
#undef FIELD
};

struct frame_sizes {
    uint32_t full[2], half[2], planar[2], shadow[2], grid[2], table[2], dirt[2], froxels[2];
    uint32_t slices, active, chain, cube_face, sky_face, probe_face, probe_mips;
    bool is_cpu;  /* that of struct glint_device_info */
    bool history; /* images of the previous frame are available */
};

/* Index of the up axis and its sign. */
int up_axis(enum glint_axis up, double *sign);
void frame_block_fill(struct frame_block *block, const struct glint_frame *frame, const struct frame_sizes *sizes);
/* Sets the fields of the planar reflection map, which stay 0 without one. */
void frame_block_mirror(struct frame_block *block, const struct glint_frame *frame, const struct glint_planar *planar);
/* The shadow maps that passes use: at most SUN_MAPS of the sun in the order of their numbers, then those of lamps, SHADOW_MAPS in all, up to the
   first that has not its place in SHADOW_ROWS rows. */
size_t frame_choose_maps(const struct glint_part_info *const parts[], size_t count,
                         const struct glint_part_info *maps[SHADOW_MAPS]);
size_t frame_shadow_maps(const struct glint_capture *capture, const struct glint_part_info *maps[SHADOW_MAPS]);
/* Sets the fields of the lamps, the one that covers most of the screen first. `number` receives the place of each of the capture's lamps. */
void frame_block_lamps(struct frame_block *block, const struct glint_frame *frame, uint32_t number[LAMPS]);
/* Sets the fields of these maps; `number` is that of frame_block_lamps. */
void frame_block_shadows(struct frame_block *block, const struct glint_capture *capture, const uint32_t number[LAMPS]);
/* Sets what the capture says of its part `indirect`, and its exposure. */
void frame_block_captured_light(struct frame_block *block, const struct glint_capture *capture);
/* Sets the fields of what rays find that nothing nearer continues: sky, probe, painted ground. */
void frame_block_far(struct frame_block *block, const struct glint_capture *capture);
/* Sets the grid of the volume of light: the capture's, or where there is none one of GRID_CELLS³ cells that a pass may fill. */
#define PART_GRID "volume.000" /* the only volume of light that passes use */
#define PART_COLORS "lut"
#define PART_DIRT "dirt"
#define PART_FROXELS "froxels"
enum { GRID_CELLS = 24 };
void frame_block_grid(struct frame_block *block, const struct glint_frame *frame, const struct glint_part_info *volume);
/* Sets the slices of light in the air, of a capture that has them; NULL: it has none. */
void frame_block_froxels(struct frame_block *block, const struct glint_frame *frame,
                         const struct glint_part_info *froxels);

#endif
