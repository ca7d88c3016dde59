/* glint lint: a capture read in other ways than it declares. What independent images say of the same surfaces (depth and normals,
   depth and cube maps, depth and motion, colours on screen and in cube maps) is compared as declared and under every other
   reading; where another one agrees and the declared one does not, the declaration or the dump is likely wrong. */
#ifndef GLINT_VIEWER_LINT_H
#define GLINT_VIEWER_LINT_H

#include <stddef.h>

#include "glint/capture.h"

enum { LINT_CUBES = 12, LINT_SAMPLES = 4096, LINT_FINDINGS = 32 };

struct lint_cube {
    char name[64];
    struct glint_cubemap map; /* centre and inner volume in engine units */
    uint32_t size;
    bool has_distance;
    bool elsewhere; /* its pixels stand in a sibling */
    float *texels;  /* R G B A distance, as stored; distance in engine units */
};

/* How coarse depth's values are found to be: all lie on the steps of a format that nothing declares. */
struct lint_rounding {
    char format[48]; /* "16 bits of fixed point"; "" when none is found */
    bool of_device;  /* the steps are of device depth, while the file holds distances */
    enum glint_clip_z clip_z;
    bool fixed;
    int bits; /* of fixed point, or of a floating point number's fraction */
};

/* What is looked at, as it is stored. */
struct lint_data {
    struct glint_frame frame;
    struct glint_encodings encodings; /* of the G-buffer */
    enum glint_color_encoding lit_encoding, cube_encoding;
    bool two_channels; /* normals have no Z */
    bool has_motion;
    uint32_t width, height;
    float *depth, *normal /* X Y Z */, *motion /* X Y */, *lit /* R G B */,
        *material /* roughness metalness specular */;
    /* The frame before, where the capture holds it; NULL where not. */
    float *before_depth, *before_lit;
    enum glint_depth_encoding before_encoding;
    struct lint_rounding rounding;
    float *depth_half_step; /* of what held depth, as stored, at the samples and their four neighbours */
    double normal_half_step;
    const struct glint_capture *capture;
    struct lint_cube cubes[LINT_CUBES];
    size_t cube_count;
    uint32_t *samples; /* pixels, away from the borders */
    size_t sample_count;
};
bool lint_data_read(struct lint_data *data, struct glint_capture *capture, struct glint_error *err);
void lint_data_finish(struct lint_data *data);

/* A way to read the values. */
struct lint_reading {
    enum glint_depth_encoding depth;
    bool radial; /* stored depth is the distance from the eye */
    double depth_scale;
    enum glint_normal_encoding normal;
    enum glint_normal_space space;
    double normal_sign[3];
    int normal_axis[3]; /* which stored channel is X, Y, Z */
    enum glint_motion_encoding motion;
    double motion_sign[2];
    bool motion_unjittered; /* as if the centres of both pictures were in one place */
    enum glint_clip_y clip_y;
    enum glint_clip_z clip_z;
    double view_sign[3]; /* axes of the view turned around */
    bool inverse_camera, inverse_current /* alone */, swapped_cameras;
    bool cube_planar; /* stored distance is along the face's axis */
    double cube_scale, center_scale;
    double center_offset[LINT_CUBES][3]; /* engine units */
    int face[6], turn[6];                /* which stored face a face of the format is, and how it is turned */
    enum glint_color_encoding lit, cube;
    bool lit_upside_down, lit_bgr;
};
struct lint_reading lint_declared(const struct lint_data *data);

/* ---- geometry.c: where things are, by a reading; positions in engine units ---- */

struct lint_view {
    double rotation[9], inverse[9], position[3]; /* world to view, and back; the eye */
    double a, b, c, d, A, B, s;
};
struct lint_eyes {
    struct lint_view now, before;
};
struct lint_eyes lint_eyes_of(const struct lint_data *data, const struct lint_reading *reading);

/* Depth along the view axis; false for sky. */
bool lint_depth(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t x, uint32_t y, double *depth);
/* The same of the frame before, which the view is that of. */
bool lint_depth_before(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                       uint32_t x, uint32_t y, double *depth);
/* By how much rounding to what held a pixel's depth may have moved it: of samples and their neighbours. */
double lint_depth_error(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        uint32_t x, uint32_t y, double depth);
void lint_view_position(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        double x, double y, double depth, double out[3]);
void lint_to_world(const struct lint_view *view, const double in[3], double out[3]);
/* Pixels, y down; false behind the eye. */
bool lint_project(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                  const double world[3], double out[2], double *depth);
/* World axes, unit length; false when it has none. */
bool lint_normal(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                 size_t pixel, double out[3]);
/* The cosine of how far rounding to what held a normal may have turned it. */
double lint_normal_rounding(const struct lint_data *data, const struct lint_reading *reading,
                            const struct lint_view *view, size_t pixel, const double normal[3]);
/* From a cube map's centre to a place. */
void lint_from_center(const struct lint_data *data, const struct lint_reading *reading, size_t cube,
                      const double world[3], double out[3]);
/* In pixels, y down. */
void lint_motion(const struct lint_data *data, const struct lint_reading *reading, size_t pixel, double out[2]);
/* A place after one of eight turns: bit 0 mirrors u, bit 1 v, bit 2 exchanges them afterwards. */
void lint_turn(int turn, double *u, double *v);
/* R G B A and the distance as stored. */
const float *lint_texel(const struct lint_cube *cube, int face, double u, double v);
double lint_cube_distance(const struct lint_reading *reading, const float *texel, const double direction[3]);

/* ---- measures.c: how far independent images agree ---- */

static const double LINT_MOVES_PX = 0.25; /* less may be jitter, and tells nothing of unit and sign */
/* Below this share no cause is named: so few places agree by chance, or where both readings say the same. */
static const double LINT_TELLS = 0.2;
double lint_luminance(const float *rgb);

enum lint_measure { LINT_FACETS, LINT_CUBEMAPS, LINT_MOTION, LINT_COLORS, LINT_BEFORE, LINT_MEASURES };
struct lint_tally {
    size_t agree, count;
};
void lint_count(struct lint_tally *tally, bool agrees);
extern const char *const lint_measure_names[];
struct lint_agreement {
    double share[LINT_MEASURES]; /* of what was compared */
    size_t count[LINT_MEASURES];
};
enum { LINT_ENOUGH = 200 };
/* The measures of the bits of `which` are taken, the others are as in `known`, which may be NULL: then all are taken. */
struct lint_agreement lint_agree(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *known, unsigned which);
/* What a reading's share of a measure is worth beside that of another one: nothing that was reached by comparing less. */
double lint_worth(const struct lint_agreement *a, const struct lint_agreement *other, int m);
/* Whether a texel shows what lies in a direction, as far away as that is long. 1: it does; 0: something stands before it; -1: it
   shows what lies beyond. */
int lint_shows(const struct lint_reading *reading, const struct lint_cube *cube, const float *texel,
               const double direction[3]);
/* The same of the texel in which a cube map has a place. */
int lint_sees(const struct lint_data *data, const struct lint_reading *reading, size_t cube, const double world[3],
              const float **texel);
/* The surface through a pixel and its four neighbours, as its depths have it: the normal towards the eye, in world axes. */
enum lint_facet { LINT_NO_FACET, LINT_UNSURE_FACET /* rounding of depth may have turned it */, LINT_FACET };
enum lint_facet lint_facet_of(const struct lint_data *data, const struct lint_reading *reading,
                              const struct lint_view *view, uint32_t pixel, double out[3]);
bool lint_same_direction(const double a[3], const double b[3]);
/* before.c: depth where both cameras put it in the frame before; colour, where that has no depth. */
struct lint_tally lint_before(const struct lint_data *data, const struct lint_reading *reading);
/* The place of a sample in the world; false under sky. */
bool lint_place(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t pixel, double world[3]);
/* How far its surface moves on screen by both cameras, to where it was: pixels, y down. */
bool lint_moved(const struct lint_data *data, const struct lint_reading *reading, const struct lint_eyes *eyes,
                uint32_t pixel, double out[2]);

/* ---- findings ---- */

enum lint_pixels {
    LINT_NO_PIXELS,
    LINT_BLACK_SKY,      /* 0 into R G B where A is 0 */
    LINT_CLEAR_INFINITE, /* 0 into A and R G B where the distance is infinite */
    LINT_FAR_SKY         /* +inf into the distance where A is 0 */
};

struct lint_finding {
    char id[48];    /* "depth.reversed" */
    char what[200]; /* "depth is stored reversed" */
    char evidence[400];
    const char *likelihood;        /* "certain", "likely", "possible" */
    char mend[240];                /* the declaration that would mend it, or what to change in the dump */
    char either[240];              /* another cause that explains the data as well; "" for none */
    const char *attribute, *value; /* what --fix sets on every part that declares or may declare it; NULL: nothing */
    bool has_matrix, has_previous; /* the attribute is a matrix; so is glint.previousWorldToView */
    double matrix[16], previous[16];
    enum lint_pixels pixels; /* what --fix writes into cube maps */
    bool left_out;           /* by --fix, after which something would agree less */
};
struct lint_findings {
    struct lint_finding items[LINT_FINDINGS];
    size_t count;
    char undecided[16][200];
    size_t undecided_count;
};
/* What the id means is looked up among all ids. */
struct lint_finding *lint_add(struct lint_findings *findings, const char *id, const char *likelihood);
/* Every id that there is and what it means; NULL past the last. */
const char *lint_id(size_t i, const char **what);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void lint_undecided(struct lint_findings *findings, const char *format, ...);

/* readings.c: other readings, one after the other while they agree better. */
void lint_find_readings(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                        struct lint_findings *findings);
/* faces.c: which stored face is which. */
void lint_find_faces(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                     struct lint_findings *findings);
/* center.c: centres of cube maps under which their distances agree with depth; false when others are no better. */
bool lint_search_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_reading *other);
void lint_tell_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_finding *f);
/* rounding.c */
void lint_find_rounding(struct lint_data *data);
/* A step of what is found, at a stored value; 0 when nothing is. */
double lint_rounding_step(const struct lint_data *data, double stored);
void lint_find_coarse_depth(const struct lint_data *data, const struct lint_reading *reading, const char *depth_text,
                            struct lint_findings *findings);
/* cubes.c: what cube maps must hold by themselves: sky, and nothing in their inner volumes. */
void lint_find_cubes(const struct lint_data *data, struct lint_findings *findings);
/* values.c: what values must be by themselves. */
void lint_find_values(const struct lint_data *data, const struct lint_reading *reading,
                      const struct lint_agreement *agreement, struct lint_findings *findings);

/* fix.c: a copy with the declarations of the findings, and with their pixels; all others keep their bits. *fixed: how many
   findings are mended in it: those that are certain and after which every measure of the copy is as good as before or better. */
bool lint_may_mend(const struct lint_finding *finding);
bool lint_fix(const char *from, const char *to, struct lint_findings *findings, size_t *fixed, struct glint_error *err);

#endif
