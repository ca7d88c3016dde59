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
    double center[3]; /* engine units */
    uint32_t size;
    bool has_distance;
    float *texels; /* R G B A distance, as stored; distance in engine units */
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
    bool inverse_camera;
    bool cube_planar; /* stored distance is along the face's axis */
    double cube_scale, center_scale;
    int face[6], turn[6]; /* which stored face a face of the format is, and how it is turned */
    enum glint_color_encoding lit, cube;
    bool lit_upside_down, lit_bgr;
};
struct lint_reading lint_declared(const struct lint_data *data);

/* ---- geometry.c: where things are, by a reading; positions in engine units ---- */

struct lint_view {
    double rotation[9], position[3]; /* world to view; the eye */
    double a, b, c, d, A, B, s;
};
struct lint_eyes {
    struct lint_view now, before;
};
struct lint_eyes lint_eyes_of(const struct lint_data *data, const struct lint_reading *reading);

/* Depth along the view axis; false for sky. */
bool lint_depth(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t x, uint32_t y, double *depth);
void lint_view_position(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        double x, double y, double depth, double out[3]);
void lint_to_world(const struct lint_view *view, const double in[3], double out[3]);
/* Pixels, y down; false behind the eye. */
bool lint_project(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                  const double world[3], double out[2]);
/* World axes, unit length; false when it has none. */
bool lint_normal(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                 size_t pixel, double out[3]);
/* In pixels, y down. */
void lint_motion(const struct lint_data *data, const struct lint_reading *reading, size_t pixel, double out[2]);
/* A place after one of eight turns: bit 0 mirrors u, bit 1 v, bit 2 exchanges them afterwards. */
void lint_turn(int turn, double *u, double *v);
/* R G B A and the distance as stored. */
const float *lint_texel(const struct lint_cube *cube, int face, double u, double v);
double lint_cube_distance(const struct lint_reading *reading, const float *texel, const double direction[3]);

/* ---- measures.c: how far independent images agree ---- */

static const double LINT_MOVES_PX = 0.25; /* less may be jitter, and tells nothing of unit and sign */
double lint_luminance(const float *rgb);

enum lint_measure { LINT_FACETS, LINT_CUBEMAPS, LINT_MOTION, LINT_COLORS, LINT_MEASURES };
extern const char *const lint_measure_names[];
struct lint_agreement {
    double share[LINT_MEASURES]; /* of what was compared */
    size_t count[LINT_MEASURES];
};
enum { LINT_ENOUGH = 200 };
/* The measures of the bits of `which` are taken, the others are as in `known`, which may be NULL: then all are taken. */
struct lint_agreement lint_agree(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *known, unsigned which);
/* Whether a texel shows what lies in a direction, as far away as that is long. 1: it does; 0: something stands before it; -1: it
   shows what lies beyond. */
int lint_shows(const struct lint_reading *reading, const struct lint_cube *cube, const float *texel,
               const double direction[3]);
/* The same of the texel in which a cube map has a place. */
int lint_sees(const struct lint_reading *reading, const struct lint_cube *cube, const double world[3],
              const float **texel);
/* The place of a sample in the world; false under sky. */
bool lint_place(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t pixel, double world[3]);
/* How far its surface moves on screen by both cameras, to where it was: pixels, y down. */
bool lint_moved(const struct lint_data *data, const struct lint_reading *reading, const struct lint_eyes *eyes,
                uint32_t pixel, double out[2]);

/* ---- findings ---- */

struct lint_finding {
    char id[48];    /* "depth.reversed" */
    char what[200]; /* "depth is stored reversed" */
    char evidence[400];
    const char *likelihood;        /* "certain", "likely", "possible" */
    char mend[240];                /* the declaration that would mend it, or what to change in the dump */
    const char *attribute, *value; /* what --fix sets on every part that declares or may declare it; NULL: nothing */
    bool has_matrix;               /* the attribute is a matrix */
    double matrix[16];
};
struct lint_findings {
    struct lint_finding items[LINT_FINDINGS];
    size_t count;
    char undecided[16][200];
    size_t undecided_count;
};
struct lint_finding *lint_add(struct lint_findings *findings, const char *id, const char *likelihood);
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
/* values.c: what values must be by themselves. */
void lint_find_values(const struct lint_data *data, const struct lint_reading *reading,
                      const struct lint_agreement *agreement, struct lint_findings *findings);

/* fix.c: a copy with the declarations of the findings; pixels keep their bits. *fixed: how many were declared. */
bool lint_fix(const char *from, const char *to, const struct lint_findings *findings, size_t *fixed,
              struct glint_error *err);

#endif
