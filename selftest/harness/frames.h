/* Runs frames of a tiny image through the passes that use history. */
#ifndef GLINT_SELFTEST_FRAMES_H
#define GLINT_SELFTEST_FRAMES_H

#include "harness/case.h"

enum { FRAME_WIDTH = 64, FRAME_HEIGHT = 32, FRAME_PIXELS = FRAME_WIDTH * FRAME_HEIGHT };

/* A part of the capture: planes of width x height values. */
struct planes {
    const char *name;
    uint32_t width, height;
    const char *channels[12];
    const void *data[12];
    enum glint_type type;
    const struct glint_cubemap *cubemap; /* of a cubemap.NNN, else NULL */
};

/* A frame; the pipeline runs at full resolution, so that pixels and texels are the same. */
struct frame {
    struct glint_frame info;
    float depth[FRAME_PIXELS], normal[3][FRAME_PIXELS], roughness[FRAME_PIXELS], motion[2][FRAME_PIXELS];
    float color[4][FRAME_PIXELS];  /* contents of reflection_half and of reflection */
    float travelled[FRAME_PIXELS]; /* hit distances of the rays */
    const struct planes *more;     /* additional parts */
    size_t more_count;
    bool bare; /* without images of passes, which are among `more` */
};

/* The depth of the wall in frame_ordinary(), and the width of pixels there: powers of two, so that a shift by a pixel is exact. */
static const double frame_wall_m = 4, frame_pixel_m = 0.125;

/* A static camera at the origin looks along -z at a wall with a field of view of 90 degrees. The wall is rough, and its colours are
   noise, uniform in [0, 2) and independent for each pixel, channel and frame. */
void frame_ordinary(struct frame *frame, uint32_t number);
/* Sets cameras that look along -z from a position, rotated to the left by an angle. */
void frame_cameras(struct frame *frame, const double now[3], const double before[3], double turn, double turn_before);
/* Transforms to view space: x right, y up, z backwards. world: relative to the origin. */
void frame_to_view(const struct glint_camera *camera, const double world[3], double view[3]);
/* The position of a pixel's centre, shifted by pixels, at a depth. */
void frame_position(const struct frame *frame, double x, double y, double depth_m, double world[3]);

struct frames {
    const struct case_context *context;
    struct glint_replay *replay; /* shared by all pipelines, so that common programs are compiled once */
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    const char *const *passes; /* slots, NULL-terminated */
    bool half;                 /* images in their declared formats, not floats */
    bool planned;              /* passes without work are dropped */
};

bool frames_begin(struct frames *frames, const struct case_context *context, struct glint_error *err);
void frames_end(struct frames *frames);
/* Creates another pipeline. settings: "slot=variant" or "slot.parameter=value", NULL-terminated. */
bool frames_pipeline(struct frames *frames, const char *const *passes, const char *const *settings,
                     struct glint_error *err);
/* Replaces the pass of a slot by this shader. */
bool frames_shader(struct frames *frames, const char *slot, const char *text, struct glint_error *err);
bool frames_run(struct frames *frames, const struct frame *frame, struct glint_error *err);
/* The same for an existing capture. */
bool frames_run_capture(struct frames *frames, const char *path, struct glint_error *err);
/* Reads FRAME_PIXELS times the image's components; the image must have the size of a frame. */
bool frames_read(struct frames *frames, const char *image, float *out, struct glint_error *err);

#endif
