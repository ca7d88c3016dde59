/* What the box's own files share. */
#ifndef GLINT_SELFTEST_OPEN_BOX_INTERNAL_H
#define GLINT_SELFTEST_OPEN_BOX_INTERNAL_H

#include "oracles/open_box.h"

/* NDC, y up, = view.xy / depth * scale + shift, view x to the right, y up */
struct open_box_projection {
    double scale[2], shift[2];
};
struct open_box_projection open_box_project(const struct open_box *c);
void open_box_eye(const struct open_box *box, bool previous, double out[3]);
void open_box_camera_axes(const struct open_box *c, double right[3], double up[3], double ahead[3]);
/* Where a point (w: 1) or direction (w: 0) is seen; false behind the camera. */
bool open_box_project_point(const struct open_box *c, bool previous, const double point[3], double w,
                            double place_px[2], double *depth);
/* From within the box to its inside; faces +x -x +y -y +z -z. */
double open_box_exit(const double from[3], const double direction[3], int *face);
enum open_box_surface open_box_surface_of(int face);
/* point: where the surface is seen, the direction of the sky. */
enum open_box_surface open_box_view_hit(const struct open_box *c, const double place_px[2], double *depth,
                                        double point[3], int *face);

/* Of the cube map that a part's name says. */
void open_box_center(const struct open_box *c, const char *part, double center[3]);

/* clip z = a * depth + b, clip w = depth */
void open_box_clip_depth(const struct open_box *c, double *a, double *b);
/* Encoded as declared; `normal` in the box's axes. */
void open_box_encode_normal(const struct open_box *c, const double normal[3], double out[3]);
double open_box_encode_roughness(const struct open_box *c, double roughness);
void open_box_encode_color(const struct open_box *c, double rgb[3]);
void open_box_encode_motion(const struct open_box *c, const double uv[2], double depth_m, double out[3]);
/* From the box's axes to the engine's, and on to view space. */
void open_box_to_engine(const struct open_box *c, const double v[3], double out[3]);
void open_box_view_rows(const struct open_box *c, double rows[3][3]);

#endif
