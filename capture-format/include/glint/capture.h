/* Captures: the inputs of one frame in a multi-part OpenEXR file, specified in FORMAT.md. Engines link libglint-capture and call
   the writer; glint itself uses the reader.

   Matrices are row-major doubles for column vectors: view = world_to_view · world, clip = view_to_clip · view.
   Lengths are in engine units; metres_per_unit converts them. Every struct may be zero-initialised: zero selects the default that
   is stated at the field. Strings are UTF-8. They and all other data are copied: no pointer of the caller's is used after a call
   returns. An object may be used by one thread at a time, different objects by different threads. */
#ifndef GLINT_CAPTURE_H
#define GLINT_CAPTURE_H

#include <stdint.h>

#include "glint/air.h"
#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_FORMAT_VERSION 1

/* ---- Encodings: how the engine stored a channel. The reader decodes every encoding to the canonical one, which is 0. ---- */

enum glint_depth_encoding {
    GLINT_DEPTH_VIEW_LINEAR,         /* distance along the view axis in units; +inf under sky */
    GLINT_DEPTH_DEVICE,              /* NDC z of view_to_clip in [0, 1]; 1 is sky */
    GLINT_DEPTH_REVERSED,            /* the same with the near plane at 1; 0 is sky */
    GLINT_DEPTH_REVERSED_INFINITE,   /* near plane at 1, no far plane; 0 is infinity and sky */
    GLINT_DEPTH_LOGARITHMIC,         /* log(z/near)/log(far/near); 1 is sky */
    GLINT_DEPTH_LOGARITHMIC_REVERSED /* 1 minus logarithmic; 0 is sky */
};
enum glint_normal_encoding {
    GLINT_NORMAL_SIGNED,     /* X Y Z in [-1, 1] */
    GLINT_NORMAL_UNORM,      /* (n + 1)/2 in X Y Z */
    GLINT_NORMAL_OCTAHEDRAL, /* octahedral map in [0, 1]², channels X Y */
    GLINT_NORMAL_VIEW_XY,  /* view-space (n + 1)/2 in channels X Y; Z is reconstructed and points towards the camera */
    GLINT_NORMAL_SPHEREMAP /* view-space X Y: (e + 1)/2 with |e|² = (1 - cosine towards the camera) / 2 */
};
enum glint_normal_space { GLINT_SPACE_WORLD, GLINT_SPACE_VIEW };
enum glint_roughness_encoding {
    GLINT_ROUGHNESS_PERCEPTUAL, /* r in [0, 1]; GGX alpha = r² */
    GLINT_ROUGHNESS_ALPHA,      /* r² */
    GLINT_ROUGHNESS_GLOSS,      /* 1 - r */
    GLINT_ROUGHNESS_POWER,      /* Blinn-Phong power 2/r⁴ - 2 */
    GLINT_ROUGHNESS_LOG2_POWER  /* (log2 of that power - gloss_offset) / gloss_scale */
};
enum glint_motion_encoding {
    GLINT_MOTION_UV,      /* previous uv of the surface point minus its current uv, each with the jitter of its frame */
    GLINT_MOTION_NDC,     /* the same difference in NDC, y as clip_y says */
    GLINT_MOTION_PIXELS,  /* the same difference in pixels */
    GLINT_MOTION_PACKED16 /* uint channels: uv = (v - 32768)/32767 · motion_range */
};
enum glint_motion_depth_encoding {
    GLINT_MOTION_DEPTH_VIEW_LINEAR, /* previous view depth of the surface point minus its current one, in units */
    GLINT_MOTION_DEPTH_PACKED16     /* uint channel: units = (v - 32768)/32767 · motion_depth_range */
};
enum glint_color_encoding {
    GLINT_COLOR_LINEAR,      /* scene-referred, Rec. 709 primaries */
    GLINT_COLOR_PRE_EXPOSED, /* linear times pre_exposure */
    GLINT_COLOR_SRGB         /* sRGB transfer curve, values above 1 allowed (extended) */
};

struct glint_encodings {
    enum glint_depth_encoding depth;
    enum glint_normal_encoding normal;
    enum glint_normal_encoding vertex_normal;
    enum glint_normal_space normal_space;
    enum glint_roughness_encoding roughness;
    enum glint_motion_encoding motion;
    enum glint_color_encoding color;
    enum glint_motion_depth_encoding motion_depth;
};

/* ---- Frame attributes ---- */

enum glint_axis { GLINT_AXIS_Y, GLINT_AXIS_Z, GLINT_AXIS_X, GLINT_AXIS_NEG_Y, GLINT_AXIS_NEG_Z, GLINT_AXIS_NEG_X };
enum glint_clip_y { GLINT_CLIP_Y_UP, GLINT_CLIP_Y_DOWN };
enum glint_clip_z { GLINT_CLIP_Z_ZERO_TO_ONE, GLINT_CLIP_Z_MINUS_ONE_TO_ONE };

struct glint_camera {
    double world_to_view[16]; /* rotation, which may mirror, and translation; no scale */
    double view_to_clip[16];  /* perspective, jitter included: rows (a 0 c 0) (0 b d 0) (0 0 A B) (0 0 ±1 0) */
    /* Set by the reader if the stored rotation R is only precise to a float: the deviation of R·Rᵀ from the identity. world_to_view
       is then the nearest exact rotation, with the camera position of the stored matrix. */
    double rotation_error;
};
/* The camera's world position in units. It is solved for, since -Rᵀ·t of a rotation that is orthonormal to a float's 1e-7 only is
   wrong by 12 mm at 1,000 km from the origin. */
void glint_camera_position(const struct glint_camera *camera, double position[3]);
/* The camera as the two standard attributes of OpenEXR give it, for other programs: row-major matrices for row vectors, p' = p · M. worldToCamera
   leads to camera space in units, +x to the right of the picture, +y to its top, +z away from the camera. worldToNDC leads, after
   division by the fourth component, to (0, 0) at the top left and (1, 1) at the bottom right corner of the display window, jitter included;
   its third component is z of glint's clip space. */
void glint_camera_standard(const struct glint_camera *camera, enum glint_clip_y clip_y, double world_to_camera[16],
                           double world_to_ndc[16]);

/* How the engine's materials differ from those of this format. */
struct glint_material_model {
    double metal_reflectance;         /* of a metal at normal incidence, as a multiple of its albedo, at most 1; 0: 1 */
    double roughest_reflection;       /* surfaces of at least this roughness reflect nothing in the engine; 0: all do */
    double gloss_scale, gloss_offset; /* log2_power: power = 2^(scale · stored + offset); 0: 10 and 1 */
};

/* The sun, or the moon, or whatever light is infinitely far away. */
struct glint_sun {
    double direction[3];       /* unit vector in world space towards it */
    double angular_radius_rad; /* of its disc; 0: a point */
    float irradiance[3];       /* radiance · sr, on a surface that faces it; 0: not known */
};

/* A point light, or a spot light if it has a cone. */
#define GLINT_MAX_LIGHTS 64
struct glint_cone {
    double axis[3];              /* unit vector in world space along which the light shines */
    double inner_rad, outer_rad; /* angles from the axis: full intensity up to the first, none from the second on */
};
struct glint_light {
    double position[3]; /* world */
    float intensity[3]; /* radiant: at d metres the irradiance on a surface that faces it is this divided by d² */
    double range;       /* units: the light ends at this distance; 0: it has no end */
    double radius;      /* units: of the lamp, within which nothing casts a shadow; 0: a point */
    bool has_cone;
    struct glint_cone cone;
};

struct glint_stencil_class {
    uint32_t value, mask; /* a pixel belongs to the class if (id & mask) == value; mask 0: all bits */
    char name[32];        /* "sky", "foreground", "character", "vegetation", "water", … */
};
#define GLINT_MAX_STENCIL_CLASSES 32

struct glint_frame {
    struct glint_camera camera;
    struct glint_camera previous; /* the camera one frame earlier */
    bool has_previous;
    bool cut;               /* camera cut: history of the previous frame is invalid */
    bool has_player;        /* false: cube maps are selected around the camera */
    double player[3];       /* world position of the player, around whom cube maps are selected */
    double jitter_px[2];    /* sub-pixel offset that view_to_clip contains; +x right, +y down */
    double exposure;        /* factor from scene-referred to display; 0: 1 */
    bool has_lut_stops;     /* false: `lut` is a table of sRGB-encoded colours */
    double lut_stops[2];    /* `lut` maps exposed linear light: log2 of what its ends are for, but for an offset */
    double pre_exposure;    /* factor contained in pre-exposed colour; 0: 1 */
    double metres_per_unit; /* 0: 1 */
    double depth_near;      /* near and far of logarithmic depth, units */
    double depth_far;
    double motion_range;       /* packed motion: the uv offset of the largest value; 0: 1 */
    double motion_depth_range; /* packed motion depth: the depth difference of the largest value, units; 0: 1 */
    uint32_t number;           /* frame number; seeds random numbers that differ from frame to frame */
    enum glint_axis up;        /* default +Y */
    enum glint_clip_y clip_y;  /* default: NDC +1 is the top of the picture */
    enum glint_clip_z clip_z;  /* default: [0, 1] */
    bool has_fog;
    struct glint_fog fog;
    bool has_atmosphere, has_clouds;
    struct glint_atmosphere atmosphere;
    struct glint_clouds clouds;
    bool has_material;
    struct glint_material_model material;
    struct glint_stencil_class classes[GLINT_MAX_STENCIL_CLASSES];
    uint32_t class_count;
    bool has_sun;
    struct glint_sun sun;
    struct glint_light lights[GLINT_MAX_LIGHTS];
    uint32_t light_count;
};

/* Warnings about a valid frame, one sentence each: a camera's rotation is too imprecise that far from the origin. Returns their number. */
enum { GLINT_NOTES = 2, GLINT_NOTE_LENGTH = 400 };
size_t glint_frame_notes(const struct glint_frame *frame, char notes[GLINT_NOTES][GLINT_NOTE_LENGTH]);

/* ---- Cube maps and planar reflections ---- */

enum glint_volume { GLINT_VOLUME_NONE, GLINT_VOLUME_BOX, GLINT_VOLUME_SPHERE, GLINT_VOLUME_HULL };
#define GLINT_MAX_PLANES 64

struct glint_cubemap {
    double center[3]; /* world position */
    bool outdoor;
    double fade; /* blend weight in (0, 1] while the engine fades the cube map in or out; 0: 1 */
    uint32_t age_frames;
    /* A volume around the centre that contains no surface at all, furniture included, so that rays may start where they leave it.
       It is not the room's proxy geometry. Positions are relative to the centre, in units. */
    enum glint_volume inner;
    double box_min[3], box_max[3];
    double sphere_center[3], sphere_radius;
    double planes[GLINT_MAX_PLANES][4]; /* inside: n·p + d <= 0 */
    uint32_t plane_count;
};

/* A sky box. */
struct glint_sky {
    bool has_ground;
    double ground; /* elevation in degrees, -90 to 90, below which it shows painted ground */
};

/* A level of a probe that the engine pre-filtered by roughness: what its surfaces reflect where nothing nearer was found. A part each:
   the finest is probe.NNN, the next ones are probe.NNN.level1, probe.NNN.level2, …, each of half the face size. */
#define GLINT_MAX_LEVELS 16
struct glint_probe_box {
    double center[3];      /* world position */
    double min[3], max[3]; /* relative to the centre, in units: all in the probe is taken to lie on it */
};
struct glint_probe {
    bool has_roughness;
    double roughness; /* perceptual, of the surfaces that look up this level; without: spread over [0, 1] */
    /* Of the finest level: */
    bool has_ground;
    double ground; /* as in struct glint_sky */
    bool has_box;  /* without: everything in the probe is infinitely far away */
    struct glint_probe_box box;
};

/* A planar reflection: a render mirrored in `plane` (world, n·p + d = 0) by its own camera. */
struct glint_planar {
    double plane[4];
    struct glint_camera camera;
};

/* ---- Light and shadow ---- */

struct glint_indirect {
    bool occluded; /* the engine's own ambient occlusion is already in it, and in `lit` */
};

/* shadow = world_to_shadow · world; divided by w, x from -1 to 1 is the map from left to right, y as clip_y says, z the stored depth. */
struct glint_shadow {
    double world_to_shadow[16]; /* row-major, for column vectors, invertible: orthographic or perspective */
    double range[2];            /* the depths nearest to the light and farthest from it, in [0, 1]; both 0: 0 and 1 */
    double bias;                /* added to the stored depth, away from the light, before the engine compares */
    bool has_light, has_stencil_class; /* false: the sun's; of all surfaces */
    /* Numbers in glint_frame. Surfaces of the class are compared with this map and with the light's other maps, those of others are not. */
    uint32_t light, stencil_class;
};

/* A grid of ambient cubes, slices one below the other: a part of cells_x × (cells_y · slices) pixels. Cell (i, j, k) lies from (i, j, k) to
   (i + 1, j + 1, k + 1) of grid = world_to_grid · world. */
struct glint_light_volume {
    double world_to_grid[16];
    uint32_t slices; /* cells along z */
};

/* Light that the air scatters towards the camera, in cells of the view frustum, slices one below the other as above. Slice k of n begins at
   the view-linear depth near + (far - near) · k/n, or near · (far/near)^(k/n) if they are exponential. */
#define GLINT_MAX_FROXEL_SLICES 1024
struct glint_froxels {
    uint32_t slices;
    double near_depth, far_depth; /* units: where the first slice begins, and the last one ends */
    bool exponential;             /* near_depth is above 0 then */
};

/* How far a path tracer went for truth.occlusion and truth.sun, in units. */
struct glint_truth {
    double radius; /* truth.occlusion: surfaces farther away do not occlude */
    double length; /* truth.sun: surfaces farther away cast no contact shadow */
};

/* ---- Parts ---- */

/* The type of a channel in the caller's memory. The file stores it exactly, as half, float or uint. */
enum glint_type {
    GLINT_F16,
    GLINT_F32,
    GLINT_U8,
    GLINT_U16,
    GLINT_U32,
    GLINT_UNORM8,
    GLINT_UNORM16,
    GLINT_SNORM8,
    GLINT_SNORM16
};

struct glint_channel {
    const char *name; /* "depth.Z", "R"; see the role's row in FORMAT.md */
    enum glint_type type;
    const void *data;
    size_t x_stride_bytes, y_stride_bytes; /* 0: tightly packed */
    const char *storage; /* the engine's own format ("D24", "R11G11B10"), which is its precision; NULL: from `type` */
};

/* An additional attribute of a part, stored unchanged. */
enum glint_attribute_type { GLINT_ATTRIBUTE_STRING, GLINT_ATTRIBUTE_DOUBLE, GLINT_ATTRIBUTE_INT };
struct glint_attribute {
    const char *name;
    enum glint_attribute_type type;
    const char *string;
    double number; /* for double and int */
};

struct glint_part {
    const char *name; /* the role, with a number if there may be several: "gbuffer", "cubemap.003", "previous.lit" */
    uint32_t width, height;
    const struct glint_channel *channels;
    size_t channel_count;
    struct glint_encodings encodings;
    const struct glint_cubemap *cubemap;     /* required for cubemap.NNN */
    const struct glint_planar *planar;       /* required for planar.NNN */
    const struct glint_sky *sky;             /* sky only; may be NULL */
    const struct glint_probe *probe;         /* probe.NNN and its levels only; may be NULL */
    const struct glint_indirect *indirect;   /* indirect only; may be NULL */
    const struct glint_shadow *shadow;       /* required for shadow.NNN */
    const struct glint_light_volume *volume; /* required for volume.NNN */
    const struct glint_froxels *froxels;     /* required for froxels */
    const struct glint_truth *truth;         /* required for truth.occlusion and truth.sun */
    const char *sibling; /* cubemap.NNN only: a file in the same folder whose part of this name is used; no channels */
    const struct glint_attribute *attributes;
    size_t attribute_count;
};

/* ---- Writer ---- */

/* PXR24 loses 8 bits of float. */
enum glint_compression { GLINT_ZIP, GLINT_NONE, GLINT_ZIPS, GLINT_PIZ, GLINT_PXR24, GLINT_RLE };

struct glint_writer_options {
    enum glint_compression compression;
    uint32_t threads; /* 0: one for each core */
    bool background;  /* glint_writer_finish returns at once; a worker thread compresses and writes the file */
};

struct glint_writer;

/* NULL on failure. The file appears under `path` only when it is complete. `options` may be NULL. */
struct glint_writer *glint_writer_create(const char *path, const struct glint_writer_options *options,
                                         struct glint_error *err);
/* Call it once, before or after adding the parts. */
bool glint_writer_set_frame(struct glint_writer *writer, const struct glint_frame *frame, struct glint_error *err);
/* Checks the part against its role and copies the pixels. The writer stays usable after a part is rejected. */
bool glint_writer_add_part(struct glint_writer *writer, const struct glint_part *part, struct glint_error *err);
/* The file is complete on return; in background mode the call returns as soon as it has copied the data. The frame and the required
   roles must have been added, except for a file of cube maps only, which other captures name as `sibling`. Siblings that parts name
   must be complete, since they are hashed now, on the worker in background mode. */
bool glint_writer_finish(struct glint_writer *writer, struct glint_error *err);
/* In background mode, waits for the worker and returns its result. Otherwise returns the result of glint_writer_finish. */
bool glint_writer_wait(struct glint_writer *writer, struct glint_error *err);
/* Waits for the worker, frees the writer and clears the pointer. If the writer was not finished, no file is left. */
void glint_writer_destroy(struct glint_writer **writer);

/* ---- Reader ---- */

struct glint_limits {
    uint64_t file_bytes;   /* 0: 64 GiB */
    uint64_t memory_bytes; /* memory of one open capture at a time; 0: 4 GiB */
    uint32_t width;        /* of any part; 0: 32768 (heights: six times that) */
    uint32_t parts;        /* 0: 1024 */
    bool no_link;          /* the path may not be a symbolic link, because somebody else chose the name */
};

enum glint_stored { GLINT_STORED_HALF, GLINT_STORED_FLOAT, GLINT_STORED_UINT };

struct glint_channel_info {
    char name[256];
    enum glint_stored stored;
    char storage[64]; /* the engine's format as declared, or the EXR type */
};

struct glint_role;
struct glint_part_info {
    char name[256];
    const struct glint_role *role; /* NULL if this version does not know it; the part can be read all the same */
    int32_t index;                 /* the NNN of its name, or -1 */
    int32_t level;                 /* the L of .levelL, or 0 */
    bool previous;                 /* previous.ROLE */
    uint32_t width, height;
    const struct glint_channel_info *channels; /* in the file's order */
    size_t channel_count;
    struct glint_encodings encodings;
    bool has_cubemap, has_planar, has_sky, has_probe, has_indirect, has_shadow, has_volume, has_froxels, has_truth;
    struct glint_cubemap cubemap;
    struct glint_planar planar;
    struct glint_sky sky;
    struct glint_probe probe;
    struct glint_indirect indirect;
    struct glint_shadow shadow;
    struct glint_light_volume volume;
    struct glint_froxels froxels;
    struct glint_truth truth;
    char sibling[256];     /* the file that holds the pixels, and whose size and channels are reported here; "": none */
    char sibling_hash[33]; /* XXH3-128 of that file, which was verified; "" without a sibling */
    const struct glint_attribute *attributes; /* attributes unknown to glint (string, double, int, float) */
    size_t attribute_count;
};

struct glint_capture;

/* Opens a capture, reads its headers and attributes and checks them against FORMAT.md. No pixel is read. NULL on failure. */
struct glint_capture *glint_capture_open(const char *path, const struct glint_limits *limits, struct glint_error *err);
void glint_capture_close(struct glint_capture **capture);

const char *glint_capture_path(const struct glint_capture *capture);
const struct glint_frame *glint_capture_frame(const struct glint_capture *capture);
size_t glint_capture_part_count(const struct glint_capture *capture);
const struct glint_part_info *glint_capture_part(const struct glint_capture *capture, size_t i);
/* The part of this name ("gbuffer", "cubemap.003"), or NULL. */
const struct glint_part_info *glint_capture_find(const struct glint_capture *capture, const char *name);
/* The levels of probe.NNN from the finest on, and the roughness that each is for. Returns their number, 0 if there is no such probe. */
size_t glint_capture_probe(const struct glint_capture *capture, int32_t index,
                           const struct glint_part_info *levels[GLINT_MAX_LEVELS], double roughness[GLINT_MAX_LEVELS]);
/* Whether the part has the channel: one that is stored, or the reconstructed Z of a normal. */
bool glint_part_has_channel(const struct glint_part_info *part, const char *channel);
/* The same, or one that is read as a fixed value because the part does not have it. */
bool glint_part_can_read(const struct glint_part_info *part, const char *channel);
/* Whether the format requires this channel of this part. */
bool glint_part_needs_channel(const struct glint_part_info *part, const char *channel);
/* The XXH3-128 of the file's bytes as 32 hexadecimal digits and a NUL. Reads the whole file. */
bool glint_capture_hash(struct glint_capture *capture, char hex[33], struct glint_error *err);

/* Reads channels of one part, decoded to canonical values and interleaved: out[(y·width + x)·count + i] is channels[i]. Reads and
   decompresses only this part, on `threads` threads (0: all cores). `type` is GLINT_F16, GLINT_F32 or, for uint channels,
   GLINT_U8/U16/U32. A channel name of NULL yields 0; one that the part does not have yields the value that its role states for
   this case, and is otherwise an error. Canonical values are view depth in
   metres (+inf for sky), unit world-space normals X Y Z, perceptual roughness, motion in uv (motion.Z in metres), linear colour
   and distance.Z in metres. Normals that are zero or not finite are returned as stored. Values that need no decoding and no
   conversion keep every bit; a float too large for GLINT_F16 becomes infinity. */
bool glint_capture_read(struct glint_capture *capture, const struct glint_part_info *part, const char *const *channels,
                        size_t count, enum glint_type type, void *out, uint32_t threads, struct glint_error *err);
/* Reads values as stored, without decoding, as GLINT_F32 (which widens half) or GLINT_U32. */
bool glint_capture_read_raw(struct glint_capture *capture, const struct glint_part_info *part,
                            const char *const *channels, size_t count, enum glint_type type, void *out,
                            uint32_t threads, struct glint_error *err);

/* Perturbs the values that later calls of glint_capture_read return by the rounding error of the engine's storage format: each
   stored value moves by half a step of the format before it is decoded, up or down at random for each pixel and channel. A float
   moves by a whole step or not at all, since half a step would round. Values that engines write on purpose do not move: 0, the ends
   of a fixed-point range, sky. `seed` 0 ends the perturbation. `only` is NULL for all values, or a NULL-terminated list of parts or
   roles ("lit", "cubemap") which may name one of their channels or layers ("gbuffer:normal"); one that the capture does not have is an
   error. Ids and raw reads never change. */
bool glint_capture_perturb(struct glint_capture *capture, uint32_t seed, const char *const *only,
                           struct glint_error *err);
/* A number that differs between perturbations; 0 if there is none. */
uint64_t glint_capture_perturbed(const struct glint_capture *capture);

/* The step between neighbouring values of a channel's storage at a stored value, in stored units: that of the declared storage format
   or of the channel's type in the file, whichever is coarser. 0 if the part has no such channel or it holds integers. */
double glint_channel_step(const struct glint_capture *capture, const struct glint_part_info *part, const char *channel,
                          double stored);
/* The depth resolution of a part's depth.Z at a distance: the difference in metres between the two representable depths around it.
   +inf if the farther one is sky. NaN if the part has no depth, or none at that distance (before near, beyond far). */
double glint_depth_step(const struct glint_capture *capture, const struct glint_part_info *part, double at_m);

/* Checks every rule of FORMAT.md. Pixels are checked only if the headers are valid, since these say how to decode them. Calls
   `report` on the calling thread once for each rule that a channel violates; *violations receives the number of calls. False on an
   I/O, memory or limit failure only. The file may also be one of cube maps only. */
typedef void (*glint_report)(void *user, const char *rule, const char *message);
bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err);

/* Names of common parts. */
#define GLINT_PART_GBUFFER "gbuffer"
#define GLINT_PART_LIT "lit"
#define GLINT_PART_INDIRECT "indirect"
#define GLINT_PART_SCENE "scene"
#define GLINT_PART_SKY "sky"
#define GLINT_PART_PROBE "probe.000" /* the only probe that passes use */
#define GLINT_PART_WATER "water"
#define GLINT_PART_TRANSPARENT "transparent"
#define GLINT_PART_MIRROR "planar.000" /* the only planar map that passes use */

/* ---- The registry of roles, which writer, reader, validation and the tables of FORMAT.md are generated from ---- */

struct glint_role_channel {
    const char *name;     /* "depth.Z" */
    bool required;        /* every part of the role must have the channel */
    const char *unit;     /* of decoded values */
    const char *encoding; /* the encoding that applies: "depth", "normal", …, or "" */
    const char *meaning;
    double absent; /* what a part without the channel is read as; NaN: it cannot be read then */
};
enum glint_shape {
    GLINT_SHAPE_FRAME,  /* the G-buffer's size */
    GLINT_SHAPE_CUBE,   /* N × 6N */
    GLINT_SHAPE_LEVELS, /* N × 6N, with coarser levels as parts of their own: NAME.level1 … */
    GLINT_SHAPE_TABLE,  /* N × N²: a table of colours, N slices of N × N below each other */
    GLINT_SHAPE_ANY
};
/* Whether the part is six faces below each other. */
bool glint_shape_is_cube(enum glint_shape shape);
struct glint_role {
    const char *name; /* "gbuffer", "cubemap"; after a name that ends in '.' ("engine.") any text may follow */
    enum glint_shape shape;
    bool required, numbered, may_be_previous, reserved;
    const struct glint_role_channel *channels; /* NULL: any */
    size_t channel_count;
    const char *meaning;
};
const struct glint_role *glint_roles(size_t *count);
/* The role of a part's name, its number (or -1) and whether it is previous.ROLE; NULL if unknown. */
const struct glint_role *glint_role_find(const char *part, int32_t *index, bool *previous);
/* The name of an encoding in files and on the command line ("reversed_infinite"); NULL past the last. */
const char *glint_encoding_name(const char *which /* "depth", "normal", … */, int value);
/* The value of a name, or -1. */
int glint_encoding_value(const char *which, const char *name);

#ifdef __cplusplus
}
#endif
#endif
