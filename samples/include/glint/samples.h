/* The stand-in engine: sample scenes made by code, rendered with Embree and dumped through the public writer alone. */
#ifndef GLINT_SAMPLES_H
#define GLINT_SAMPLES_H

#include "glint/capture.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_probes {
    GLINT_PROBES_IMPERFECT, /* as games have them: static objects only, simplified meshes, metals as diffuse */
    GLINT_PROBES_PERFECT,   /* the very scene; for tests that need closed forms */
    GLINT_PROBES_AUTO       /* placed by the sampler (glTF files) */
};

/* Truths that are traced. */
enum glint_truths {
    GLINT_TRUTH_REFLECTION = 1,
    GLINT_TRUTH_OCCLUSION = 2,
    GLINT_TRUTH_SUN = 4, /* in scenes with a sun */
    GLINT_TRUTH_INDIRECT = 8,
    GLINT_TRUTH_ANTIALIASED = 16, /* of the finished picture with finished_samples, else of lit */
    GLINT_TRUTH_PICTURE = 32,     /* lit, with traced in place of baked indirect light, and what surfaces reflect */
    GLINT_TRUTH_LAMPS = 64        /* in scenes with lamps */
};

/* What the engine writes only when asked. */
enum glint_also {
    GLINT_ALSO_AO = 1 << 0,         /* its own, coarse ambient occlusion, over half the radius of the truth */
    GLINT_ALSO_SUN = 1 << 1,        /* its shadow mask, in scenes with a sun */
    GLINT_ALSO_SHADOW = 1 << 2,     /* shadow maps, in scenes with a sun */
    GLINT_ALSO_VOLUME = 1 << 3,     /* a volume of light */
    GLINT_ALSO_LUT = 1 << 4,        /* the table of colours that it grades with */
    GLINT_ALSO_DIRT = 1 << 5,       /* the dirt on its lens */
    GLINT_ALSO_STIPPLE = 1 << 6,    /* where stippled surfaces were drawn */
    GLINT_ALSO_DECALS = 1 << 7,     /* decals on the ground, in buffers of their own */
    GLINT_ALSO_LAMPS = 1 << 8,      /* the light of the lamps, and shadow maps of at most eight spot lights */
    GLINT_ALSO_CAUSTICS = 1 << 9,   /* light that water focuses on its bottom, in scenes with water and a sun */
    GLINT_ALSO_FROXELS = 1 << 10,   /* light in the air, in scenes with fog */
    GLINT_ALSO_CURVATURE = 1 << 11, /* of the surfaces */
    GLINT_ALSO_SKY = 1 << 12        /* atmosphere, clouds and stars, and the sky that they make in its picture */
};

struct glint_sample_options {
    uint32_t width, height;               /* 0: 1280 × 720 */
    uint32_t cube_size;                   /* 0: 256 */
    uint32_t planar_width, planar_height; /* of the planar reflection map of a scene with water; 0: 240 × 120 */
    uint32_t frames;                      /* 0: 1; more make a shot OUT.0001.exr … that shares its cube maps */
    uint32_t first_frame;                 /* number of the first frame */
    bool cut;                             /* the first frame follows another shot */
    bool probes_given;                    /* false: the scene's default */
    enum glint_probes probes;
    struct glint_encodings encodings;
    /* Rays a pixel for truth.*; 0: none of these parts. The parts of a lobe say it in `truthSamples`, and in
       `truthNoise` the median over the pixels of the mean's standard error, relative. */
    uint32_t truth_samples;
    uint32_t truths;         /* enum glint_truths, which of them; 0: that of reflections */
    double occlusion_radius; /* m: how far the truth of occlusion looks for occluders; 0: 1 */
    double contact_length;   /* m: how far that of contact shadows does; 0: 0.5 */
    uint32_t also;           /* enum glint_also */
    uint32_t
        cascades; /* shadow maps of GLINT_ALSO_SHADOW, each three times as wide as the one before, at most 4; 0: 1 */
    bool truth_of_pixels; /* of their whole areas, as a still camera sees them over its jitter; false: of the samples */
    uint32_t light_samples; /* rays a point for indirect light; 0: the scene's default */
    double fov_y_rad;       /* 0: the scene's */
    bool camera_given;      /* position, then a point looked at, in world units; false: the scene's */
    double eye[3], target[3];
    bool travel_given; /* metres a frame; false: as the scene's camera moves, a given one stands still */
    double travel[3];
    /* Rays a pixel of what opaque surfaces reflect in `scene`, the finished picture; 0: no such part. The truth then holds
       what reflected surfaces themselves reflect. Scenes with water or panes have their own, and refuse. */
    uint32_t finished_samples;
    bool foreground; /* a gun and hands before the camera, of the stencil class foreground, reflected by nothing */
    bool unjittered; /* rays through the centres of the pixels in every frame */
    /* The part of the picture that reflects, 0 to 1, whatever the scene's materials: in one block, or in squares of 2 x 2 pixels
       that lie scattered; half of the squares are smooth (0.05), half rough (0.4). */
    bool reflecting_given, scattered;
    double reflecting;
    double offset[3]; /* added to every position in double before it is stored (the scene is not rendered again) */
    enum glint_compression compression;
    uint32_t threads;
};

struct glint_sample {
    const char *name, *summary; /* "street", "wet road with puddles, …" */
};
/* All built-in scenes; *count receives how many. */
const struct glint_sample *glint_samples(size_t *count);

/* Renders a built-in scene or a glTF file and writes `out` (a shot: out with .NNNN before the suffix). The same options
   give the same bytes. Frames of a shot that are there already, made with the same settings, are kept. */
bool glint_sample_write(const char *scene, const char *out, const struct glint_sample_options *options,
                        glint_progress progress, void *user, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
