/* Captures: one frame's inputs in a multi-part OpenEXR file. FORMAT.md is the specification; this is the C API.
   An engine links libglint-capture and calls the writer; glint itself uses the reader.

   Matrices are row-major doubles for column vectors: view = world_to_view · world, clip = view_to_clip · view.
   Lengths are in engine units (metres_per_unit says what a unit is). Every struct may be zero-initialised: zero means
   the default that is named beside the field. Strings are UTF-8 and copied. No call keeps a pointer of the caller's
   after it returned. Objects may be used by one thread at a time; different objects by different threads. */
#ifndef GLINT_CAPTURE_H
#define GLINT_CAPTURE_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_FORMAT_VERSION 1

/* ---- Encodings: how an engine stored what a role means. 0 is the canonical one, which the reader decodes to. ---- */

enum glint_depth_encoding {
    GLINT_DEPTH_VIEW_LINEAR,         /* distance along the view axis in units; +inf under sky */
    GLINT_DEPTH_DEVICE,              /* NDC z of view_to_clip in [0, 1]; 1 is sky */
    GLINT_DEPTH_REVERSED,            /* the same with near at 1; 0 is sky */
    GLINT_DEPTH_REVERSED_INFINITE,   /* near at 1, 0 is infinity and sky */
    GLINT_DEPTH_LOGARITHMIC,         /* log(z/near)/log(far/near); 1 is sky */
    GLINT_DEPTH_LOGARITHMIC_REVERSED /* one minus that; 0 is sky */
};
enum glint_normal_encoding {
    GLINT_NORMAL_SIGNED,     /* X Y Z in [-1, 1] */
    GLINT_NORMAL_UNORM,      /* (n + 1)/2 in X Y Z */
    GLINT_NORMAL_OCTAHEDRAL, /* octahedral map in [0, 1]², channels X Y */
    GLINT_NORMAL_VIEW_XY     /* (n + 1)/2 in channels X Y, view axes; Z towards the camera follows */
};
enum glint_normal_space { GLINT_SPACE_WORLD, GLINT_SPACE_VIEW };
enum glint_roughness_encoding {
    GLINT_ROUGHNESS_PERCEPTUAL, /* r in [0, 1]; GGX alpha = r² */
    GLINT_ROUGHNESS_ALPHA,      /* r² */
    GLINT_ROUGHNESS_GLOSS,      /* 1 - r */
    GLINT_ROUGHNESS_POWER       /* Blinn-Phong power 2/r⁴ - 2 */
};
enum glint_motion_encoding {
    GLINT_MOTION_UV,      /* uv of the same surface point in the previous frame minus uv now, each with its jitter */
    GLINT_MOTION_NDC,     /* the same difference in NDC, y as clip_y says */
    GLINT_MOTION_PIXELS,  /* the same difference in pixels */
    GLINT_MOTION_PACKED16 /* uint channels: uv = (v - 32768)/32767 · motion_range */
};
enum glint_motion_depth_encoding {
    GLINT_MOTION_DEPTH_VIEW_LINEAR, /* depth in the previous frame minus now, units */
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

/* ---- What holds for the whole frame ---- */

enum glint_axis { GLINT_AXIS_Y, GLINT_AXIS_Z, GLINT_AXIS_X, GLINT_AXIS_NEG_Y, GLINT_AXIS_NEG_Z, GLINT_AXIS_NEG_X };
enum glint_clip_y { GLINT_CLIP_Y_UP, GLINT_CLIP_Y_DOWN };
enum glint_clip_z { GLINT_CLIP_Z_ZERO_TO_ONE, GLINT_CLIP_Z_MINUS_ONE_TO_ONE };

struct glint_camera {
    double world_to_view[16]; /* rotation (a mirroring one is allowed) and translation; no scale */
    double view_to_clip[16];  /* perspective, jitter included: rows (a 0 c 0) (0 b d 0) (0 0 A B) (0 0 ±1 0) */
    /* Set by the reader where the stored rotation is less than double precise: how far R·Rᵀ is from the identity.
       world_to_view is then the nearest rotation about the stored matrix's position: its transpose is its inverse. */
    double rotation_error;
};
/* The world position that world_to_view takes to the view's origin, in units. It solves for it: with a rotation that is
   orthonormal to a float's 1e-7 alone, -Rᵀ·t is off by 12 mm at 1,000 km. */
void glint_camera_position(const struct glint_camera *camera, double position[3]);

struct glint_fog {
    float color[3];      /* radiance far inside the fog */
    double density;      /* extinction per unit at `base` */
    double base;         /* coordinate along up */
    double scale_height; /* units for a fall to 1/e; 0: the same at every height */
};

struct glint_stencil_class {
    uint32_t value, mask; /* pixel belongs when (id & mask) == value; mask 0: all bits */
    char name[32];        /* "sky", "foreground", "character", "vegetation", "water", … */
};
#define GLINT_MAX_STENCIL_CLASSES 32

struct glint_frame {
    struct glint_camera camera;
    struct glint_camera previous; /* the camera one frame earlier */
    bool has_previous;
    bool cut;               /* nothing of the previous frame is of use */
    bool has_player;        /* false: cube maps are selected around the camera */
    double player[3];       /* world position */
    double jitter_px[2];    /* sub-pixel offset by which view_to_clip moves the picture; +x right, +y down */
    double exposure;        /* factor from scene-referred to display; 0: 1 */
    double pre_exposure;    /* factor contained in pre-exposed colour; 0: 1 */
    double metres_per_unit; /* 0: 1 */
    double depth_near;      /* for logarithmic depth */
    double depth_far;
    double motion_range;       /* for packed motion: the uv offset of the largest value; 0: 1 */
    double motion_depth_range; /* the same for its packed depth, units; 0: 1 */
    uint32_t number;           /* frame number; seeds what changes from frame to frame */
    enum glint_axis up;        /* default +Y */
    enum glint_clip_y clip_y;  /* default: NDC +1 is the top of the picture */
    enum glint_clip_z clip_z;  /* default: [0, 1] */
    bool has_fog;
    struct glint_fog fog;
    struct glint_stencil_class classes[GLINT_MAX_STENCIL_CLASSES];
    uint32_t class_count;
};

/* Sentences on what a valid frame should be asked about: cameras whose stored rotation is so imprecise that it can be
   seen at their distance from the origin. Returns how many. */
enum { GLINT_NOTES = 2, GLINT_NOTE_LENGTH = 400 };
size_t glint_frame_notes(const struct glint_frame *frame, char notes[GLINT_NOTES][GLINT_NOTE_LENGTH]);

/* ---- What holds for one cube map ---- */

enum glint_volume { GLINT_VOLUME_NONE, GLINT_VOLUME_BOX, GLINT_VOLUME_SPHERE, GLINT_VOLUME_HULL };
#define GLINT_MAX_PLANES 64

struct glint_cubemap {
    double center[3]; /* world position */
    bool outdoor;
    double fade; /* weight while it is added or removed, (0, 1]; 0: 1 */
    uint32_t age_frames;
    /* A volume of air around the centre, into which no surface reaches, furniture included: rays begin where they leave it.
       Not the room's walls. Positions relative to the centre, in units. */
    enum glint_volume inner;
    double box_min[3], box_max[3];
    double sphere_center[3], sphere_radius;
    double planes[GLINT_MAX_PLANES][4]; /* inside: n·p + d <= 0 */
    uint32_t plane_count;
};

/* A planar reflection: a render mirrored in `plane` (world, n·p + d = 0) by its own camera. */
struct glint_planar {
    double plane[4];
    struct glint_camera camera;
};

/* ---- Parts ---- */

/* How the caller's memory holds a channel. The file stores half, float or uint, whichever is exact. */
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
    size_t x_stride_bytes, y_stride_bytes; /* 0: tight */
    const char *storage; /* the engine's own format ("D24", "R11G11B10"): how precise it was; NULL: from `type` */
};

/* Further attributes of a part, kept as they are. */
enum glint_attribute_type { GLINT_ATTRIBUTE_STRING, GLINT_ATTRIBUTE_DOUBLE, GLINT_ATTRIBUTE_INT };
struct glint_attribute {
    const char *name;
    enum glint_attribute_type type;
    const char *string;
    double number; /* for double and int */
};

struct glint_part {
    const char *name; /* a role, with its number where it has one: "gbuffer", "cubemap.003", "previous.lit" */
    uint32_t width, height;
    const struct glint_channel *channels;
    size_t channel_count;
    struct glint_encodings encodings;
    const struct glint_cubemap *cubemap; /* required for cubemap.NNN */
    const struct glint_planar *planar;   /* required for planar.NNN */
    const char
        *sibling; /* cubemap.NNN only: a file in the same folder that holds a part of this name; no channels then */
    const struct glint_attribute *attributes;
    size_t attribute_count;
};

/* ---- Writer ---- */

enum glint_compression {
    GLINT_ZIP,
    GLINT_NONE,
    GLINT_ZIPS,
    GLINT_PIZ,
    GLINT_PXR24 /* loses 8 bits of float */,
    GLINT_RLE
};

struct glint_writer_options {
    enum glint_compression compression;
    uint32_t threads; /* 0: one for each core */
    bool background;  /* glint_writer_finish returns at once; a worker compresses and renames */
};

struct glint_writer;

/* NULL on failure. Nothing appears under `path` before the capture is complete; options may be NULL. */
struct glint_writer *glint_writer_create(const char *path, const struct glint_writer_options *options,
                                         struct glint_error *err);
/* Once, before or after the parts. */
bool glint_writer_set_frame(struct glint_writer *writer, const struct glint_frame *frame, struct glint_error *err);
/* Checks the part against its role and copies the pixels. The writer stays usable after a refused part. */
bool glint_writer_add_part(struct glint_writer *writer, const struct glint_part *part, struct glint_error *err);
/* Blocking: the file is complete on return. Background: returns when nothing of the caller's is needed any more. A
   file of cube maps only (for `sibling`) needs no frame; every other needs the frame and the required roles. Siblings
   that parts name must be complete by then: they are hashed here, on the worker in background mode. */
bool glint_writer_finish(struct glint_writer *writer, struct glint_error *err);
/* Background mode: waits for the file and returns the worker's result; blocking mode: returns the last result. */
bool glint_writer_wait(struct glint_writer *writer, struct glint_error *err);
/* Waits, frees, clears the pointer; without a finish before it, nothing is left on disk. NULL is allowed. */
void glint_writer_destroy(struct glint_writer **writer);

/* ---- Reader ---- */

struct glint_limits {
    uint64_t file_bytes;   /* 0: 64 GiB */
    uint64_t memory_bytes; /* all that one open capture may hold at a time; 0: 4 GiB */
    uint32_t width;        /* of any part; 0: 32768 (heights: six times that) */
    uint32_t parts;        /* 0: 1024 */
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
    const struct glint_role *role; /* NULL: not known to this version; kept and passed on */
    int32_t index;                 /* the NNN of its name, or -1 */
    bool previous;                 /* previous.ROLE */
    uint32_t width, height;
    const struct glint_channel_info *channels; /* in the file's order */
    size_t channel_count;
    struct glint_encodings encodings;
    bool has_cubemap, has_planar;
    struct glint_cubemap cubemap;
    struct glint_planar planar;
    char sibling[256];     /* "" or the file that holds the pixels; sizes and channels are that file's */
    char sibling_hash[33]; /* its XXH3-128, which was compared with the file; "" without a sibling */
    const struct glint_attribute *attributes; /* those that glint does not know (string, double, int, float) */
    size_t attribute_count;
};

struct glint_capture;

/* Opens, reads headers and attributes, checks them against FORMAT.md; decodes no pixel. NULL on failure. */
struct glint_capture *glint_capture_open(const char *path, const struct glint_limits *limits, struct glint_error *err);
void glint_capture_close(struct glint_capture **capture);

const char *glint_capture_path(const struct glint_capture *capture);
const struct glint_frame *glint_capture_frame(const struct glint_capture *capture);
size_t glint_capture_part_count(const struct glint_capture *capture);
const struct glint_part_info *glint_capture_part(const struct glint_capture *capture, size_t i);
/* By name ("gbuffer", "cubemap.003"); NULL when the capture has none. */
const struct glint_part_info *glint_capture_find(const struct glint_capture *capture, const char *name);
/* Whether glint_capture_read can return it: the part's own channels, and the Z of a normal that is stored without. */
bool glint_part_has_channel(const struct glint_part_info *part, const char *channel);
/* 32 hexadecimal digits over the file's bytes (XXH3-128) and a NUL. Reads the file once. */
bool glint_capture_hash(struct glint_capture *capture, char hex[33], struct glint_error *err);

/* Reads channels of one part, decoded to canonical values, interleaved: out[(y·width + x)·count + i] is channels[i].
   Only this part's chunks are read and decompressed, on `threads` threads (0: all cores). `type` is GLINT_F16, GLINT_F32
   or, for uint channels, GLINT_U8/U16/U32. A name of NULL yields 0. Canonical: depth in metres (+inf sky), unit world
   normals X Y Z, perceptual roughness, motion in uv (motion.Z in metres), linear colour, distance.Z in metres.
   A channel that the part lacks is an error. Normals of length zero or not finite are returned as stored. Bits are kept
   where nothing is decoded and the types agree; a float too large for GLINT_F16 becomes infinity. */
bool glint_capture_read(struct glint_capture *capture, const struct glint_part_info *part, const char *const *channels,
                        size_t count, enum glint_type type, void *out, uint32_t threads, struct glint_error *err);
/* The same without decoding: values as stored, GLINT_F32 (half widened) or GLINT_U32. */
bool glint_capture_read_raw(struct glint_capture *capture, const struct glint_part_info *part,
                            const char *const *channels, size_t count, enum glint_type type, void *out,
                            uint32_t threads, struct glint_error *err);

/* From now on glint_capture_read returns values that the engine may as well have had in mind: before they are decoded, each
   moves by half a step of its channel's declared storage format, up or down as `seed` draws it for each pixel and
   channel; 0: as they are stored. What engines write on purpose stays: 0, the ends of a fixed-point range, sky. A value of
   float moves by a whole step or not at all, as half of one rounds. `only`: NULL for all, or a NULL-terminated list of
   parts or roles ("lit", "cubemap"), with a channel or a layer of theirs ("gbuffer:normal"); one that the capture lacks
   is an error. Ids and raw reads never move. */
bool glint_capture_perturb(struct glint_capture *capture, uint32_t seed, const char *const *only,
                           struct glint_error *err);
/* A number that tells such perturbations apart; 0 without one. */
uint64_t glint_capture_perturbed(const struct glint_capture *capture);

/* One step of what held a channel at a stored value, in stored units: of the declared storage format or of the channel's type
   in the file, whichever is coarser. 0: the part has no such channel, or it holds whole numbers. */
double glint_channel_step(const struct glint_capture *capture, const struct glint_part_info *part, const char *channel,
                          double stored);
/* What a part's depth.Z tells apart at a distance: how far the two values that the distance lies between are from each other,
   in metres. +inf: the farther one is sky. NaN: the part has no depth, or none at that distance (before near, beyond far). */
double glint_depth_step(const struct glint_capture *capture, const struct glint_part_info *part, double at_m);

/* Checks every rule of FORMAT.md; pixels when the headers keep theirs, for what they mean depends on those. Calls
   `report` once for each rule and channel that is broken, on the calling thread; false on an I/O, memory or limit failure
   only. *violations receives the count. Takes a file of cube maps only, too. */
typedef void (*glint_report)(void *user, const char *rule, const char *message);
bool glint_capture_validate(const char *path, const struct glint_limits *limits, glint_report report, void *user,
                            size_t *violations, struct glint_error *err);

/* Parts that most readers look for. */
#define GLINT_PART_GBUFFER "gbuffer"
#define GLINT_PART_LIT "lit"
#define GLINT_PART_SCENE "scene"
#define GLINT_PART_SKY "sky"
#define GLINT_PART_WATER "water"
#define GLINT_PART_TRANSPARENT "transparent"
#define GLINT_PART_MIRROR "planar.000" /* the one planar map that passes see */

/* ---- The registry of roles, from which writer, reader, validate, info and FORMAT.md's tables derive ---- */

struct glint_role_channel {
    const char *name;     /* "depth.Z" */
    bool required;        /* when the role is present */
    const char *unit;     /* after decoding */
    const char *encoding; /* which declared encoding applies: "depth", "normal", …, or "" */
    const char *meaning;
};
enum glint_shape { GLINT_SHAPE_FRAME /* the G-buffer's size */, GLINT_SHAPE_CUBE /* N × 6N */, GLINT_SHAPE_ANY };
struct glint_role {
    const char *name; /* "gbuffer", "cubemap"; a role that ends in '.' ("engine.") takes a free rest */
    enum glint_shape shape;
    bool required, numbered, may_be_previous, reserved;
    const struct glint_role_channel *channels; /* NULL: any */
    size_t channel_count;
    const char *meaning;
};
const struct glint_role *glint_roles(size_t *count);

/* Names of enum values in files and on the command line ("reversed_infinite"), NULL past the last. */
const char *glint_encoding_name(const char *which /* "depth", "normal", … */, int value);
/* -1 when there is no such name. */
int glint_encoding_value(const char *which, const char *name);

#ifdef __cplusplus
}
#endif
#endif
