/* An open box by closed form, written as a capture under any convention: the box 0 <= x <= 8, 0 <= y <= 4, 0 <= z <= 6 m without
   its lid, whose floor mirrors and whose walls shine. Everything is computed in double and rounded once, when it is stored. */
#ifndef GLINT_SELFTEST_OPEN_BOX_H
#define GLINT_SELFTEST_OPEN_BOX_H

#include "glint/capture.h"

enum { OPEN_BOX_CUBES = 4 };

/* What is 0 is as usual. Lengths are the box's own metres unless `scale` makes them longer. */
struct open_box {
    uint32_t width, height, cube_size; /* 0: 96 x 64, 32 */
    double fov_y_rad;                  /* 0: 1.05 */
    double target[3];                  /* what the camera looks at; 0: a place over the floor */
    double shift[2];                   /* of the picture's middle, in its halves: an off-centre projection */
    double jitter_px[2];               /* +x right, +y down */
    double near_m, far_m;              /* 0: 0.1, 1000; far may be infinite */
    bool depth_grows, x_left, y_down;  /* view space: z away from the viewer; x, y negated */
    enum glint_clip_y clip_y;
    enum glint_clip_z clip_z;
    struct glint_encodings encodings;
    uint32_t depth_bits;    /* of a stored depth that is an integer; 0: a float */
    double metres_per_unit; /* 0: 1 */
    double scale;           /* of the whole world; 0: 1 */
    double offset_m[3];     /* of the world's origin, in the engine's axes */
    int axes[3]; /* which of the engine's axes 1 to 3 the box's x, y, z are, negative: against it; 0: the same */
    double pre_exposure; /* 0: 1 */
    double light;        /* factor on all light; 0: 1 */
    float roughness;     /* of the floor */
    bool cubes_reversed; /* cube maps in the opposite order */
    bool still;          /* without motion vectors */
    double travel_m[3];  /* of the camera, a frame */
    uint32_t frame;      /* number; 0: 1 */
    bool cut;            /* the frame follows no other */
    /* Changes values as they are stored; NULL: not. */
    void (*change)(void *user, const char *part, const char *channel, float *plane, uint32_t width, uint32_t height);
    void *user;
    /* Filled in, of the target and field of view that `of` holds: the camera's axes, half the height at depth 1. */
    struct open_box_view {
        double of[4], right[3], up[3], ahead[3], half_height;
    } view;
};

/* Fills in what is 0, and the view. */
struct open_box open_box_filled(const struct open_box *box);
bool open_box_write(const struct open_box *box, const char *path, struct glint_error *err);

/* The mirror ray of a pixel, or of any place in the picture, in the box's own metres and axes. */
struct open_box_ray {
    double start[3], direction[3];
    double distance; /* to the wall it meets; infinite: it leaves through the top */
    double end[3];   /* where it leaves the box; the walls' planes are met in over */
    double over[3];
    double end_px[2]; /* where the end is seen, or the vanishing point of one that leaves */
    bool in_front;    /* of the camera */
    int face;         /* as of open_box_seen */
};
enum open_box_surface { OPEN_BOX_SKY, OPEN_BOX_WALL, OPEN_BOX_FLOOR };
/* From the eye through a place in the picture, as long as to reach depth 1. */
void open_box_view_ray(const struct open_box *box, const double place_px[2], double ray[3]);
/* What is seen there, its depth and which side of the box it is: +x -x +y -y +z -z. */
enum open_box_surface open_box_seen(const struct open_box *box, const double place_px[2], double *depth, int *face);
/* From the floor at this depth, which need not be the true one. */
struct open_box_ray open_box_mirror(const struct open_box *box, const double place_px[2], double depth);
/* Where a point is seen; false behind the camera. */
bool open_box_seen_at(const struct open_box *box, const double point[3], double place_px[2]);
/* From whatever is seen there; false: the sky. */
bool open_box_reflect(const struct open_box *box, const double place_px[2], struct open_box_ray *ray);
/* Depth that a stored value means, and the value that is stored. */
double open_box_decode_depth(const struct open_box *box, double stored);
float open_box_encode_depth(const struct open_box *box, double depth);
/* How far depth in front of a pixel changes by half a step of what is stored, a float's last bit or an integer's. */
double open_box_depth_step(const struct open_box *box, double depth);
void open_box_light(const struct open_box *box, const double place[3], double rgb[3]);
void open_box_sky(const struct open_box *box, const double direction[3], double rgb[3]);

#endif
