/* What the passes declare, as the host sees it. Built from passes/EFFECT/SLOT/VARIANT.pass.h; nothing is written here twice. */
#ifndef GLINT_PASSES_H
#define GLINT_PASSES_H

#include <stdint.h>

#include "glint/capture.h"
#include "glint/row_kinds.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What replay and study look for in declarations, since they know no slot and no image by name. */
enum glint_pass_role {
    GLINT_ROLE_CUBEMAP_ORDER,     /* the table that says which of the capture's cube maps take part, in which order */
    GLINT_ROLE_SURVEY_FIGURES,    /* what a frame holds: passes/survey/figures.h */
    GLINT_ROLE_SURVEY_OPEN_FACES, /* where active cube maps have texels without distance */
    GLINT_ROLE_SURVEY_SKY_FACES,  /* where they let the sky through */
    GLINT_ROLE_SURVEY_REACHED_FACES, /* the faces that mirror rays come to */
    GLINT_ROLE_COMPOSED,             /* the reflection that the slot lays over the picture */
    GLINT_ROLE_LOBE,                 /* the parameter that names the lobe rays are drawn from: truth.reflection.LOBE */
    GLINT_ROLE_QUESTION,             /* a parameter that is part of what is asked, and not of how well it is answered */
    GLINT_ROLE_RAY_NORMAL,           /* of rays, one a texel: the surface's normal and roughness, */
    GLINT_ROLE_RAY_PICK,             /* which pixel they start from, */
    GLINT_ROLE_RAY_DISTANCE,         /* how far they got, by the last tracer that is there, */
    GLINT_ROLE_RAY_RADIANCE,         /* what arrives along them; */
    GLINT_ROLE_CONTRIBUTION,         /* how much of the reflection is the run's own, beside its alpha; */
    GLINT_ROLE_SCREEN_FINISHED,      /* whether they ended on screen, why, and what it cost; */
    GLINT_ROLE_SCREEN_END,
    GLINT_ROLE_SCREEN_FETCHES,
    GLINT_ROLE_CUBEMAP_END, /* the same in cube maps */
    GLINT_ROLE_CUBEMAP_FETCHES
};

enum glint_value_type { GLINT_VALUE_INT, GLINT_VALUE_FLOAT, GLINT_VALUE_BOOL, GLINT_VALUE_UINT };

/* Relative to the pipeline's resolution, to the cube maps, or a table that a host pass fills. */
enum glint_size_class {
    GLINT_SIZE_FULL,     /* the capture's resolution */
    GLINT_SIZE_HALF,     /* half of it, rounded up; full under downsample/none */
    GLINT_SIZE_CUBEMAPS, /* cube-map array: one cube of the capture's face size for each active cube map */
    GLINT_SIZE_COCOON,   /* the same with faces of 32 × 32 */
    GLINT_SIZE_SKY,      /* the sky's cube map */
    GLINT_SIZE_ACTIVE,   /* 2D, active cube maps × 1 */
    GLINT_SIZE_CHAIN,    /* 2D, chain length × active cube maps */
    GLINT_SIZE_EIGHTH,   /* the coarsest level of HALF_MIPS3, alone */
    GLINT_SIZE_VOLUME,   /* 2D, what the longest description of an inner volume takes × active cube maps */
    GLINT_SIZE_FIGURES,  /* 2D, 512 × 1 */
    GLINT_SIZE_PLANAR,   /* 2D, as large as the capture's planar reflection map */
    /* the class of that name with all levels down to 1 × 1 */
    GLINT_SIZE_FULL_MIPS,
    GLINT_SIZE_HALF_MIPS,
    GLINT_SIZE_HALF_MIPS3, /* its three finest levels alone */
    GLINT_SIZE_CUBEMAPS_MIPS,
    GLINT_SIZE_SKY_MIPS,
    GLINT_SIZE_PARABOLOIDS_MIPS, /* 2D array of two hemispheres for each active cube map, as wide as its faces, with levels */
    GLINT_SIZE_LIST /* a buffer of uints, shown as an image 256 wide: tiles of the picture (passes/shared/work_list.h). DISPATCH over
                       it: a workgroup for each 64 × 64 pixels of the picture. It is never read from a run, and no pass has to
                       make it: readers then run over whole images */
};

/* In which order the levels of DISPATCH_LEVELS run. */
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
    uint32_t id; /* binding or constant id: the row's line number */
    const char *name;
    /* images */
    const char *glsl; /* texture2D, image2D, … */
    enum glint_format format;
    enum glint_size_class size;
    const char *unit;     /* images and parameters */
    const char *channels; /* "R G B A", "Z", "X Y Z roughness" */
    double nothing;       /* what a reader gets when the pass that makes it has nothing to do */
    const char *role;     /* CAPTURE: the role, and in `source` its channels; "-" for a component left 0 */
    bool required;        /* CAPTURE: false: `nothing` when absent */
    bool optional;        /* READ: format, size and nothing are given here, for when no pass makes the image */
    const char *image;    /* READ_OWN, HISTORY: the image; NULL: `name` */
    const char *assigned; /* REFERENCE_SET: as glint_pipeline_set takes it. DISPATCH_LEVELS: a parameter, or NULL */
    /* DISPATCH_LEVELS: the levels from one to the other, both included; negative: from the coarsest, which is -1.
       With a parameter: of the levels that there are, counted from the finest one that is no wider than that */
    int first, last;
    enum glint_level_order order;
    /* parameters */
    enum glint_value_type type;
    double initial, lowest, highest;
    const char *const *choices; /* CHOICE: names of 0, 1, …, NULL at the end */
    /* all */
    const char *source; /* which source document and section it comes from */
    const char *help;   /* meaning or help */
};

struct glint_host_context;
/* A pass that runs on the host: fills its small images (tables) from the capture's attributes. */
typedef bool (*glint_host_pass)(struct glint_host_context *context, struct glint_error *err);

struct glint_pass {
    const char *effect; /* the family of slots that it belongs to, "reflection": the first folder of its path */
    const char *folder; /* where its files lie under passes/, "reflection/blur" */
    const char *slot, *variant;
    const char *title, *source;
    const struct glint_row *rows; /* slot.h's rows first or wherever it includes them */
    size_t row_count;
    const uint32_t *spirv; /* NULL for a host pass */
    size_t spirv_bytes;
    glint_host_pass host; /* NULL for a shader */
};

/* All passes, ordered by slot and variant name. */
const struct glint_pass *glint_passes(size_t *count);
const struct glint_pass *glint_pass_find(const char *slot, const char *variant);
/* Whether a parameter of the pass stands for what the capture's data do not say. */
bool glint_pass_assumes(const struct glint_pass *pass, const struct glint_row *parameter);
/* The rows of capture images. */
const struct glint_row *glint_capture_images(size_t *count);
/* The text of every file under passes/ that shaders include, for compiling a user's shader in-process. NULL: unknown. */
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
    const struct glint_cubemap *cubemaps; /* the capture's, in order of their numbers */
    size_t cubemap_count;
    double (*value)(const struct glint_host_context *context, const char *parameter);
    /* Makes the table of a WRITE row with the given size; NULL on failure. */
    struct glint_table *(*table)(struct glint_host_context *context, const char *image, uint32_t width, uint32_t height,
                                 struct glint_error *err);
    void *user;
};

#ifdef __cplusplus
}
#endif
#endif
