/* The passes' declarations as C data, generated from the rows of passes/EFFECT/SLOT/VARIANT.pass.h. */
#ifndef GLINT_PASSES_H
#define GLINT_PASSES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "glint/capture.h"
#include "glint/row_kinds.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What an image or parameter is for. Replay and study find images and parameters by role and know none by name. */
enum glint_pass_role {
    GLINT_ROLE_CUBEMAP_ORDER,        /* table of the active cube maps: their numbers in the capture, in order */
    GLINT_ROLE_SURVEY_FIGURES,       /* statistics of the frame: passes/survey/figures.h */
    GLINT_ROLE_SURVEY_OPEN_FACES,    /* where active cube maps have texels without a finite distance */
    GLINT_ROLE_SURVEY_SKY_FACES,     /* where their alpha lets the sky show */
    GLINT_ROLE_SURVEY_REACHED_FACES, /* the faces that mirror rays reach */
    GLINT_ROLE_COMPOSED,             /* the picture, into which the slot composes the results of effects */
    GLINT_ROLE_LOBE,           /* the parameter that names the lobe that rays are drawn from: truth.reflection.LOBE */
    GLINT_ROLE_DEFINES_RESULT, /* a parameter that defines which image is estimated, not how well: the reference adopts it */
    GLINT_ROLE_SHADOW_MASK, /* the parameter that says whether contact shadows are combined with the captured mask */
    /* Images of rays, one ray a texel. */
    GLINT_ROLE_RAY_NORMAL,   /* normal and roughness of the surface that the ray starts from */
    GLINT_ROLE_RAY_PICK,     /* the pixel that the ray starts from */
    GLINT_ROLE_RAY_DISTANCE, /* distance travelled, by the last tracer of the pipeline */
    GLINT_ROLE_RAY_RADIANCE, /* radiance that arrives along the ray */
    GLINT_ROLE_CONTRIBUTION, /* weight of the traced reflection, besides its alpha, when it is blended over the picture */
    GLINT_ROLE_SCREEN_FINISHED, /* whether the ray ends on screen */
    GLINT_ROLE_SCREEN_END,      /* end reason of the screen trace */
    GLINT_ROLE_SCREEN_FETCHES,  /* its texture fetches */
    GLINT_ROLE_CUBEMAP_END,     /* end reason of the cube-map trace */
    GLINT_ROLE_CUBEMAP_FETCHES
};

enum glint_value_type { GLINT_VALUE_INT, GLINT_VALUE_FLOAT, GLINT_VALUE_BOOL, GLINT_VALUE_UINT };

/* Sizes of images.

   The classes of the picture are FULL, the capture's resolution, and FULL divided by a power of two, its shift: HALF (1), QUARTER, EIGHTH and
   so on; GLINT_SIZE_PICTURE makes those without a name. HALF is the resolution of the pipeline: half of FULL, rounded up, or all of it if the
   pipeline traces every pixel (row RESOLUTION). A shift beyond 1 is as large as MIP level shift - 1 of HALF, so that QUARTER is half of HALF,
   rounded down, and at least one texel. While HALF is full, QUARTER thus is half.
   ..._MIPS is the class with all MIP levels down to 1 × 1, ..._MIPS(n) with the n finest ones, or fewer if it has fewer. */
#define GLINT_SIZE_PICTURE(shift, levels)                                                                              \
    (16 * (shift) + ((levels) < 2 ? 1 - (levels) : (levels))) /* levels: 0 is all */
#define GLINT_SIZE_FULL_MIPS(levels) GLINT_SIZE_PICTURE(0, levels)
#define GLINT_SIZE_HALF_MIPS(levels) GLINT_SIZE_PICTURE(1, levels)
#define GLINT_SIZE_QUARTER_MIPS(levels) GLINT_SIZE_PICTURE(2, levels)
enum glint_size_class {
    GLINT_SIZE_FULL = GLINT_SIZE_PICTURE(0, 1),
    GLINT_SIZE_HALF = GLINT_SIZE_PICTURE(1, 1),
    GLINT_SIZE_QUARTER = GLINT_SIZE_PICTURE(2, 1),
    GLINT_SIZE_EIGHTH = GLINT_SIZE_PICTURE(3, 1),
    GLINT_SIZE_SIXTEENTH = GLINT_SIZE_PICTURE(4, 1),
    GLINT_SIZE_FULL_MIPS = GLINT_SIZE_PICTURE(0, 0),
    GLINT_SIZE_HALF_MIPS = GLINT_SIZE_PICTURE(1, 0),
    GLINT_SIZE_QUARTER_MIPS = GLINT_SIZE_PICTURE(2, 0),
    /* Other images. */
    GLINT_SIZE_CUBEMAPS = 256, /* cube-map array with the capture's face size, one cube for each active cube map */
    GLINT_SIZE_COCOON,         /* the same with faces of 32 × 32 */
    GLINT_SIZE_SKY,            /* the sky's cube map */
    GLINT_SIZE_ACTIVE,         /* 2D, active cube maps × 1 */
    GLINT_SIZE_CHAIN,          /* 2D, chain length × active cube maps */
    GLINT_SIZE_VOLUME,         /* 2D, texels of the longest description of an inner volume × active cube maps */
    GLINT_SIZE_FIGURES,        /* 2D, 512 × 1 */
    GLINT_SIZE_PLANAR,         /* 2D, the size of the capture's planar reflection map */
    GLINT_SIZE_SHADOW,         /* 2D, the shadow maps one below the other (passes/shared/shadow_maps.h) */
    GLINT_SIZE_TABLE,          /* 2D, the size of the capture's table of colours */
    GLINT_SIZE_DIRT,           /* 2D, the size of the capture's dirt on the lens */
    GLINT_SIZE_PART,           /* 2D, the size of the capture's part that the image comes from */
    GLINT_SIZE_GRID,           /* 2D, slices of the capture's volume of light, or of 24³ cells that a pass fills */
    GLINT_SIZE_FROXELS,        /* 2D, slices of the capture's light in the air one below the other */
    GLINT_SIZE_FROXEL_SLICE,   /* 2D, the size of one of them */
    GLINT_SIZE_CUBEMAPS_MIPS,
    GLINT_SIZE_SKY_MIPS,
    GLINT_SIZE_PROBE_MIPS,       /* the levels of the capture's probe, however many it has */
    GLINT_SIZE_PARABOLOIDS_MIPS, /* 2D array of two hemispheres for each active cube map, as wide as its faces */
    /* A buffer of uints that is shown as an image 256 wide: a list of tiles of the picture (passes/shared/work_list.h). A DISPATCH over it
       starts a workgroup for each 64 × 64 pixels of the picture. It is never taken from a run folder, and no pass has to make it: its
       readers then run over whole images. */
    GLINT_SIZE_LIST
};
static inline bool glint_size_is_picture(enum glint_size_class size) {
    return size < GLINT_SIZE_CUBEMAPS;
}
/* Of a class of the picture: its shift, and its number of MIP levels, 0 for all. */
static inline unsigned glint_size_shift(enum glint_size_class size) {
    return (unsigned)size / 16;
}
static inline unsigned glint_size_levels(enum glint_size_class size) {
    const unsigned code = (unsigned)size % 16;
    return code < 2 ? 1 - code : code;
}

/* The order in which the levels of a row DISPATCH_LEVELS run. */
enum glint_level_order { GLINT_ORDER_down /* fine to coarse */, GLINT_ORDER_up /* coarse to fine */ };

enum glint_format {
    GLINT_FORMAT_R8UI,
    GLINT_FORMAT_R32UI,
    GLINT_FORMAT_R16F,
    GLINT_FORMAT_RG16F,
    GLINT_FORMAT_RGBA16F,
    GLINT_FORMAT_R32F,
    GLINT_FORMAT_RG32F,
    GLINT_FORMAT_RGBA32F
};

struct glint_row {
    enum glint_row_kind kind;
    uint32_t id; /* binding or specialization constant id, which is the row's line number */
    const char *name;
    /* images */
    const char *glsl; /* texture2D, image2D, … */
    enum glint_format format;
    enum glint_size_class size;
    const char *unit;     /* images and parameters */
    const char *channels; /* "R G B A", "Z", "X Y Z roughness" */
    double fallback;      /* value of every texel when the pass that makes the image was dropped */
    const char *role;     /* CAPTURE: the part's role; `source` lists its channels, "-" for a component that stays 0 */
    bool required;        /* CAPTURE: false: the image holds its fallback value if the capture lacks the part */
    bool optional; /* READ: no pass has to make the image; this row then states its format, size and fallback value */
    const char
        *beside;       /* READ of an image of the capture: made images beside which it is read, or NULL (READ_BESIDE) */
    const char *image; /* READ_OWN, WRITE_LEVELS, HISTORY: the image; NULL: `name` */
    const char *
        assigned; /* REFERENCE_SET: an assignment for glint_pipeline_set. DISPATCH_LEVELS, IN_PLACE_OF: a parameter, or NULL */
    /* DISPATCH_LEVELS: first and last level, both included; a negative number counts from the coarsest level, which is -1. With a
       parameter they count from the finest level that is no wider than the parameter's value. */
    int first, last;
    int chain; /* DISPATCH_LEVELS: levels that each dispatch writes on a GPU (DISPATCH_CHAIN), which begin behind those of a DISPATCH; 0: one */
    enum glint_level_order order;
    /* parameters */
    enum glint_value_type type;
    double initial, lowest, highest;
    const char *const *choices; /* CHOICE: names of 0, 1, …, NULL at the end */
    /* all */
    const char *source; /* the source document and section */
    const char *help;   /* meaning of an image, help of a parameter */
};

struct glint_host_context;
/* The function of a pass that runs on the host and fills small images (tables) from the capture's attributes. */
typedef bool (*glint_host_pass)(struct glint_host_context *context, struct glint_error *err);

struct glint_pass {
    const char
        *effect; /* the family of slots that it belongs to, which is the first folder of its path: "reflection" */
    const char *folder; /* the folder of its files under passes/: "reflection/blur" */
    const char *slot, *variant;
    const char *title, *source;
    const struct glint_row *rows; /* in the order of the declaration; the slot's rows stand where it includes slot.h */
    size_t row_count;
    const uint32_t *spirv; /* NULL for a host pass */
    size_t spirv_bytes;
    const uint32_t *unprobed; /* the same without the code that records probed pixels */
    size_t unprobed_bytes;
    glint_host_pass host; /* NULL for a shader */
};

/* All passes, ordered by slot and variant name. */
const struct glint_pass *glint_passes(size_t *count);
/* The variant of a slot that the pipeline leaves out, where no pass of the slot has this name. */
#define GLINT_NO_VARIANT "none"
const struct glint_pass *glint_pass_find(const char *slot, const char *variant);
/* Whether a parameter of the pass is ASSUMED: it replaces information that captures do not contain, such as a thickness. */
bool glint_pass_assumes(const struct glint_pass *pass, const struct glint_row *parameter);

/* ---- Effects ---- */

/* The pixels of a picture in which an effect is judged. */
enum glint_judged {
    GLINT_JUDGED_REFLECTING, /* surfaces with specular or metalness */
    GLINT_JUDGED_SURFACES,   /* all but sky */
    GLINT_JUDGED_ALL         /* sky, too */
};
enum { GLINT_EFFECT_RESULTS = 4, GLINT_EFFECT_CLASSES = 3 };
/* A family of slots that makes one term of the picture, from the rows of passes/EFFECT/effect.h. The slots are those whose passes name it as
   their `effect`. */
struct glint_effect {
    const char *name; /* of its folder: "reflection" */
    const char *title, *noun, *about;
    const char *results[GLINT_EFFECT_RESULTS +
                        1];        /* images that may be its result, the preferred first; NULL behind the last */
    const char *channels;          /* of the truth, and as many of the result: "R G B" */
    const char *truth;             /* the part, or with truth_has_choices its name before ".CHOICE" */
    const char *no_truth;          /* why there is no truth; NULL: there is one */
    enum glint_pass_role truth_by; /* the parameter whose choice that is */
    bool truth_has_choices;
    enum glint_pass_role channel_by; /* the parameter whose choice is the place of the channel among channel_choices */
    const char *channel_choices;     /* NULL: the channel is no choice */
    const char *rays;                /* the part whose distance.Z is where rays of class 1 truly end, or NULL */
    enum glint_judged judged;
    const char *fact; /* of passes/facts.h: without it a frame does not call for the effect */
    const char *class_title, *class_part, *class_channel; /* what pixels are classed by */
    struct {
        const char *name;
        double most;                 /* the highest value of the class */
    } classes[GLINT_EFFECT_CLASSES]; /* name: NULL behind the last */
    const char *term;                /* how the composed picture changes by it */
    bool of_all;                     /* the passes of all effects count as its own */
};
/* All effects, by the place that each declares, behind the others those without a truth, and last those made of all. */
const struct glint_effect *glint_effects(size_t *count);
/* Of these the first, which are judged where none is asked for by name: all that have a truth and are not made of all. */
const struct glint_effect *glint_effects_by_default(size_t *count);
/* Whether passes of the pass's effect count as the effect's own. */
static inline bool glint_effect_has(const struct glint_effect *effect, const struct glint_pass *pass) {
    return effect->of_all || strcmp(pass->effect, effect->name) == 0;
}
/* NULL if there is none of that name: passes/prepare, which effects share, is no effect. */
const struct glint_effect *glint_effect_find(const char *name);
/* Labels of pixels. Arrays of GLINT_CLASS_COUNT figures hold that of all pixels in element 0, and those of the classes from 1 on. */
enum {
    GLINT_CLASS_NONE,  /* not judged: in no figure */
    GLINT_CLASS_FIRST, /* the first class; the others follow */
    GLINT_CLASS_COUNT = 1 + GLINT_EFFECT_CLASSES,
    GLINT_CLASS_UNKNOWN = GLINT_CLASS_COUNT /* judged, and in no class */
};
size_t glint_effect_class_count(const struct glint_effect *effect);
/* "all" for 0, else the name of a class. */
const char *glint_effect_class_name(const struct glint_effect *effect, size_t label);
/* The class of a value; NaN is in the last one. */
size_t glint_effect_class_of(const struct glint_effect *effect, double value);

/* The rows of capture images. */
const struct glint_row *glint_capture_images(size_t *count);
/* What a capture need not have, by role ("cubemap") and the beginning of its channels ("distance"; "": the part itself), and in one sentence
   what a replay loses without it. */
struct glint_absence {
    const char *role, *channels, *cost;
    const char *other; /* a role on which it depends, or NULL: */
    bool beside;       /* true: it counts only in captures with that role; false: only in others */
};
const struct glint_absence *glint_absences(size_t *count);
/* Whether an image of the capture is made of these channels. */
bool glint_absence_concerns(const struct glint_absence *absence, const struct glint_row *image);
/* The text of a file under passes/ that shaders include, for compiling a user's shader in-process. NULL for other paths. */
const char *glint_pass_text(const char *path);

/* ---- For host passes ---- */

/* A table that the host fills: components is 1 or 4, uint32_t for uint formats and float otherwise. */
struct glint_table {
    const char *name;
    uint32_t width, height, components;
    union {
        float *f;
        uint32_t *u;
    } texels;
};
struct glint_host_context {
    const struct glint_frame *frame;
    double eye[3];                        /* world position of the camera, engine units */
    const struct glint_cubemap *cubemaps; /* all cube maps of the capture, by number */
    size_t cubemap_count;
    /* The value of one of the pass's parameters. */
    double (*value)(const struct glint_host_context *context, const char *parameter);
    /* Creates the table of one of the pass's WRITE rows; NULL on failure. */
    struct glint_table *(*table)(struct glint_host_context *context, const char *image, uint32_t width, uint32_t height,
                                 struct glint_error *err);
    void *user;
};

#ifdef __cplusplus
}
#endif
#endif
