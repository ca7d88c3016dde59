/* What the court's own files share. */
#ifndef GLINT_VIEWER_SELFTEST_COURT_PARTS_H
#define GLINT_VIEWER_SELFTEST_COURT_PARTS_H

#include "court.h"

/* NDC, y up, = view.xy / depth * scale + shift, view x to the right, y up */
struct court_projection {
    double scale[2], shift[2];
};
struct court_projection court_project(const struct court *c);
void court_eye(const struct court *court, bool previous, double out[3]);
void court_camera_axes(const struct court *c, double right[3], double up[3], double ahead[3]);
/* Where a point (w: 1) or direction (w: 0) is seen; false behind the camera. */
bool court_place(const struct court *c, bool previous, const double point[3], double w, double place_px[2],
                 double *depth);
/* From within the box to its inside; faces +x -x +y -y +z -z. */
double court_leave(const double from[3], const double direction[3], int *face);
enum court_surface court_surface_of(int face);
/* point: where the surface is seen, the direction of the sky. */
enum court_surface court_look(const struct court *c, const double place_px[2], double *depth, double point[3],
                              int *face);

/* Of the cube map that a part's name says. */
void court_center(const struct court *c, const char *part, double center[3]);

/* clip z = a * depth + b, clip w = depth */
void court_clip_depth(const struct court *c, double *a, double *b);
/* Encoded as declared; `normal` in the court's axes. */
void court_encode_normal(const struct court *c, const double normal[3], double out[3]);
double court_encode_roughness(const struct court *c, double roughness);
void court_encode_color(const struct court *c, double rgb[3]);
void court_encode_motion(const struct court *c, const double uv[2], double depth_m, double out[3]);
/* From the court's axes to the engine's, and on to view axes. */
void court_to_engine(const struct court *c, const double v[3], double out[3]);
void court_view_rows(const struct court *c, double rows[3][3]);

#endif
