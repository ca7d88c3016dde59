/* glint lint: interprets a capture under other conventions than it declares. Independent images of the same surfaces (depth and
   normals, depth and cube maps, depth and motion, colours on screen and in cube maps) are compared as declared and under every other
   convention; where another one matches and the declared one does not, the declaration or the dump is likely wrong. */
#ifndef GLINT_VIEWER_LINT_H
#define GLINT_VIEWER_LINT_H

#include <math.h>
#include <stddef.h>

#include "glint/capture.h"

enum { LINT_CUBES = 12, LINT_SAMPLES = 4096, LINT_FINDINGS = 32, LINT_MATERIAL = 6 /* channels */ };

struct lint_cube {
    char name[64];
    struct glint_cubemap map; /* centre and inner volume in engine units */
    uint32_t size;
    bool has_distance;
    bool elsewhere; /* its pixels are in a sibling file */
    float *texels;  /* R G B A distance, as stored; distance in engine units */
};

/* The quantization of depth that was found in the data, where it is coarser than the declared storage. */
struct lint_rounding {
    char format[48]; /* "16-bit fixed point"; "" when none is found */
    bool of_device;  /* device depth was quantized, although the file contains distances */
    enum glint_clip_z clip_z;
    bool fixed;
    int bits; /* of a fixed point number, or of the fraction of a float */
};

/* The images that are compared, as stored. */
struct lint_data {
    struct glint_frame frame;
    struct glint_encodings encodings; /* of the G-buffer */
    enum glint_color_encoding lit_encoding, cube_encoding, sky_encoding, scene_encoding;
    bool two_channels; /* normals have no Z */
    bool has_motion, has_specular;
    uint32_t width, height;
    float *depth, *normal /* X Y Z */, *motion /* X Y */, *lit /* R G B */,
        *material /* roughness metalness specular albedo.R G B */, *scene /* R G B; NULL where the capture has none */;
    /* The previous frame; NULL where the capture does not contain it. */
    float *before_depth, *before_lit;
    enum glint_depth_encoding before_encoding;
    struct lint_rounding rounding;
    float *depth_half_step; /* half the rounding step of stored depth, at the samples and their four neighbours */
    double normal_half_step;
    const struct glint_capture *capture;
    struct lint_cube cubes[LINT_CUBES];
    size_t cube_count;
    struct lint_cube sky; /* without texels where the capture has none */
    uint32_t *samples;    /* pixels, away from the borders */
    size_t sample_count;
};
/* The i-th point of a lattice that does not align with patterns of rows and columns, away from the borders. */
uint32_t lint_lattice(const struct lint_data *data, uint32_t i);
bool lint_data_read(struct lint_data *data, struct glint_capture *capture, struct glint_error *err);
void lint_data_finish(struct lint_data *data);

/* A set of conventions under which the stored values are decoded. */
struct lint_reading {
    enum glint_depth_encoding depth;
    bool radial; /* stored depth is the distance from the eye */
    double depth_scale;
    enum glint_normal_encoding normal;
    enum glint_normal_space space;
    double normal_sign[3];
    int normal_axis[3]; /* which stored channel is X, Y, Z */
    bool normal_upside_down;
    enum glint_motion_encoding motion;
    double motion_sign[2];
    bool motion_unjittered; /* motion without the change of jitter */
    enum glint_clip_y clip_y;
    enum glint_clip_z clip_z;
    double view_sign[3]; /* -1: this axis of view space is negated */
    bool inverse_camera, inverse_current /* of the current frame only */, swapped_cameras;
    bool swapped_depth /* depth of gbuffer and previous.gbuffer */, swapped_lit /* lit and previous.lit */;
    bool cube_planar; /* stored distance is along the face's axis */
    double cube_scale, center_scale;
    double center_offset[LINT_CUBES][3]; /* engine units */
    int face[6], turn[6];                /* for each face of the format: the stored face, and its orientation */
    enum glint_color_encoding lit, cube, sky;
    double sky_scale; /* the sky in lit is this many times as bright as the sky cube map */
    int sky_face[6], sky_turn[6];
    bool lit_upside_down, lit_bgr;
};
struct lint_reading lint_declared(const struct lint_data *data);

/* ---- geometry.c: decoded positions and directions; positions in engine units ---- */

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
bool lint_is_sky(const struct lint_data *data, const struct lint_reading *reading, uint32_t x, uint32_t y);
/* The same for the previous frame; view must be that of the previous frame. */
bool lint_depth_before(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                       uint32_t x, uint32_t y, double *depth);
/* The largest error of a pixel's depth due to its storage format. Known for samples and their neighbours only. */
double lint_depth_error(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        uint32_t x, uint32_t y, double depth);
void lint_view_position(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                        double x, double y, double depth, double out[3]);
void lint_to_world(const struct lint_view *view, const double in[3], double out[3]);
/* Pixels, y down; false behind the eye. */
bool lint_project(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                  const double world[3], double out[2], double *depth);
/* In world space, unit length; false when the pixel has no valid normal. */
bool lint_normal(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                 size_t pixel, double out[3]);
/* The cosine of the largest error of a normal due to its storage format. */
double lint_normal_rounding(const struct lint_data *data, const struct lint_reading *reading,
                            const struct lint_view *view, size_t pixel, const double normal[3]);
/* The vector from a cube map's centre to a world position. */
void lint_from_center(const struct lint_data *data, const struct lint_reading *reading, size_t cube,
                      const double world[3], double out[3]);
/* In pixels, y down. */
void lint_motion(const struct lint_data *data, const struct lint_reading *reading, size_t pixel, double out[2]);

/* ---- Cube maps. In the innermost loops, and so inline. ---- */

/* fmax and fmin, which compilers call rather than inline. */
static inline double lint_larger(double a, double b) {
    return a > b || isnan(b) ? a : b;
}
static inline double lint_smaller(double a, double b) {
    return a < b || isnan(b) ? a : b;
}

/* Applies one of eight orientations to a texture coordinate: bit 0 mirrors u, bit 1 mirrors v, bit 2 swaps them afterwards. */
static inline void lint_turn(int turn, double *u, double *v) {
    if (turn & 1) *u = 1 - *u;
    if (turn & 2) *v = 1 - *v;
    if (turn & 4) {
        const double t = *u;
        *u = *v;
        *v = t;
    }
}

static inline uint32_t lint_texel_along(double u, uint32_t size) {
    const double at = u * size, last = size - 1;
    return !(u > 0) ? 0 : at < last ? (uint32_t)at : size - 1;
}

/* R G B A and the distance as stored. */
static inline const float *lint_texel(const struct lint_cube *cube, int face, double u, double v) {
    const size_t row = (size_t)face * cube->size + lint_texel_along(v, cube->size);
    return cube->texels + 5 * (row * cube->size + lint_texel_along(u, cube->size));
}

/* `away`: the length of the direction. */
static inline double lint_cube_distance(const struct lint_reading *reading, const float *texel, const double d[3],
                                        double away) {
    const double distance = (double)texel[4] * reading->cube_scale;
    return reading->cube_planar ? distance * (away / lint_larger(fabs(d[0]), lint_larger(fabs(d[1]), fabs(d[2]))))
                                : distance;
}

/* How far from a surface, in parts of its distance, a texel's may be that shows it; from 1 on everything nearer would match. */
static inline double lint_tolerance(const struct lint_cube *cube) {
    return 0.02 + 3.0 / cube->size;
}

/* Whether a texel shows the surface at the end of a vector from the centre, of length `away`. 1: it does; 0: the texel's surface is nearer; -1:
   it is farther away. */
static inline int lint_shows(const struct lint_reading *reading, const struct lint_cube *cube, const float *texel,
                             const double direction[3], double away) {
    const double slack = away * lint_tolerance(cube);
    if (slack >= away) return 0;
    const double distance = lint_cube_distance(reading, texel, direction, away);
    if (fabs(distance - away) <= slack) return 1;
    return distance > away + 3 * slack ? -1 : 0;
}

/* ---- measures.c: how well independent images match ---- */

static const double LINT_MOVES_PX = 0.25; /* smaller motion may be jitter and does not show unit and sign */
/* Below this share of matches no cause is reported: so few samples match by chance, or where both readings decode the same value. */
static const double LINT_MIN_SHARE = 0.2;
double lint_luminance(const float *rgb);
double lint_linear(const struct lint_data *data, enum glint_color_encoding encoding, float value);
/* The stored colour of lit that a reading takes for this pixel. */
const float *lint_lit(const struct lint_data *data, const struct lint_reading *reading, uint32_t pixel);

enum lint_measure {
    LINT_FACETS,
    LINT_CUBEMAPS,
    LINT_MOTION,
    LINT_COLORS,
    LINT_BEFORE,
    LINT_LIGHT,
    LINT_SKY,
    LINT_MEASURES
};
struct lint_tally {
    size_t agree, count;
};
void lint_count(struct lint_tally *tally, bool agrees);
extern const char *const lint_measure_names[];
/* Directions that a surface may face, 22° wide. */
enum { LINT_DIRECTIONS = 6 * 4 * 4 };
struct lint_facing {
    unsigned char direction; /* of the facet */
    signed char agrees;      /* 1: yes, -1: no, 0: not compared */
};
struct lint_agreement {
    double share[LINT_MEASURES]; /* of the compared samples */
    size_t count[LINT_MEASURES];
    struct lint_facing facing[LINT_SAMPLES]; /* LINT_FACETS, sample by sample */
};
enum { LINT_ENOUGH = 200 };
void lint_measure(const struct lint_data *data, const struct lint_reading *reading, enum lint_measure m,
                  struct lint_agreement *a);
/* Takes the measures whose bits are set in `which`, and copies the others from `known`. NULL for `known` takes all. */
struct lint_agreement lint_agree(const struct lint_data *data, const struct lint_reading *reading,
                                 const struct lint_agreement *known, unsigned which);
/* The share of matches, reduced where far fewer samples were compared than under the other reading. */
double lint_worth(const struct lint_agreement *a, const struct lint_agreement *other, int m);
/* lint_shows() for the texel of a cube map that sees a world position. */
int lint_sees(const struct lint_data *data, const struct lint_reading *reading, size_t cube, const double world[3],
              const float **texel);
/* The normal, in world space and towards the eye, of the surface through a pixel and its four neighbours in the depth buffer. */
enum lint_facet { LINT_NO_FACET, LINT_UNSURE_FACET /* rounding of depth may have rotated it */, LINT_FACET };
enum lint_facet lint_facet_of(const struct lint_data *data, const struct lint_reading *reading,
                              const struct lint_view *view, uint32_t pixel, double out[3]);
bool lint_same_direction(const double a[3], const double b[3]);
/* before.c: depth at the reprojected position in the previous frame, or colour where that frame has no depth. */
struct lint_tally lint_before(const struct lint_data *data, const struct lint_reading *reading);
/* before.c: colour at the reprojected position in the previous frame, where lint_before compares depth. */
struct lint_tally lint_light(const struct lint_data *data, const struct lint_reading *reading);
/* before.c: samples that move and would show it; those whose colours in lit and previous.lit are equal to the bit. */
struct lint_tally lint_same_light(const struct lint_data *data, const struct lint_reading *reading);
/* sky.c: sky pixels of lit and the sky cube map in their directions. */
struct lint_tally lint_sky(const struct lint_data *data, const struct lint_reading *reading);
/* sky.c: sky pixels whose direction is not black in the sky cube map; those that are 0 in lit. */
struct lint_tally lint_black_sky(const struct lint_data *data, const struct lint_reading *reading);
/* sky.c: the factor of brightness between the two; 1 where there is no sky. */
double lint_sky_scale(const struct lint_data *data, const struct lint_reading *reading);
/* The world position of a sample; false for sky. */
bool lint_place(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                uint32_t pixel, double world[3]);
/* The motion of a static surface by both cameras: previous minus current position in pixels, y down. */
bool lint_moved(const struct lint_data *data, const struct lint_reading *reading, const struct lint_eyes *eyes,
                uint32_t pixel, double out[2]);

/* For each face of the format: how many samples agree with each stored face in each orientation, and how many do not. */
enum { LINT_TURNS = 8 };
struct lint_votes {
    size_t agree[6][6][LINT_TURNS], beyond[6][6][LINT_TURNS];
};
void lint_sky_votes(const struct lint_data *data, const struct lint_reading *reading, struct lint_votes *votes);

/* ---- findings ---- */

enum lint_pixels {
    LINT_NO_PIXELS,
    LINT_BLACK_SKY,      /* 0 into R G B where A is 0 */
    LINT_CLEAR_INFINITE, /* 0 into A and R G B where the distance is infinite */
    LINT_FAR_SKY         /* +inf into the distance where A is 0 */
};

struct lint_finding {
    char id[48];    /* "depth.reversed" */
    char what[200]; /* "depth is reversed device depth" */
    char evidence[400];
    const char *likelihood;        /* "certain", "likely", "possible" */
    char remedy[240];              /* the declaration that would fix it, or what to change in the dump */
    char either[240];              /* another cause that explains the data equally well; "" for none */
    const char *attribute, *value; /* what --fix sets on every part that may declare it; NULL: nothing */
    bool has_matrix, has_previous; /* the attribute is a matrix; so is glint.previousWorldToView */
    double matrix[16], previous[16];
    enum lint_pixels pixels; /* what --fix writes into cube maps */
    bool left_out;           /* --fix left it out, because something else would match less */
};
struct lint_findings {
    struct lint_finding items[LINT_FINDINGS];
    size_t count;
    char undecided[16][200];
    size_t undecided_count;
};
/* Adds a finding with the text, remedy, attribute and pixels that its id has in the tables. */
struct lint_finding *lint_add(struct lint_findings *findings, const char *id, const char *likelihood);
/* A finding that is possible. --fix can correct it if it has an attribute or pixels. */
struct lint_known {
    const char *id, *what, *attribute; /* attribute: "" for none */
    enum lint_pixels pixels;
    char measured[240], remedy[240];
};
/* The i-th one; false past the last. */
bool lint_known(size_t i, struct lint_known *known);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void lint_undecided(struct lint_findings *findings, const char *format, ...);

/* readings.c: tries other conventions, one after the other as long as the match improves. */
void lint_find_readings(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                        struct lint_findings *findings);
/* faces.c: swapped, mirrored and rotated faces of cube maps and of the sky. */
void lint_find_faces(const struct lint_data *data, struct lint_reading *reading, struct lint_agreement *agreement,
                     struct lint_findings *findings);
/* center.c: searches cube-map centres for which distances match depth; false when none is better than the declared ones. */
bool lint_search_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_reading *other);
void lint_describe_centers(const struct lint_data *data, const struct lint_reading *reading, struct lint_finding *f);
/* rounding.c */
void lint_find_rounding(struct lint_data *data);
/* The step of the quantization that was found, at a stored value; 0 when none was found. */
double lint_rounding_step(const struct lint_data *data, double stored);
void lint_find_coarse_depth(const struct lint_data *data, const struct lint_reading *reading, const char *depth_text,
                            struct lint_findings *findings);
/* cubes.c: sky texels and inner volumes of cube maps. */
void lint_find_cubes(const struct lint_data *data, struct lint_findings *findings);
/* light.c: what lit holds besides diffuse light of this frame. */
void lint_find_light(const struct lint_data *data, const struct lint_reading *reading, struct lint_findings *findings);
/* values.c: checks of single images, motion and the previous camera. */
void lint_find_values(const struct lint_data *data, const struct lint_reading *reading,
                      const struct lint_agreement *agreement, struct lint_findings *findings);

/* fix.c: writes a copy with corrected declarations and sky texels; all other pixels keep their bits. *fixed: the number of findings
   that the copy fixes: those that are certain and whose fix makes no measure worse. */
bool lint_is_fixable(const struct lint_finding *finding);
bool lint_fix(const char *from, const char *to, struct lint_findings *findings, size_t *fixed, struct glint_error *err);

#endif
