/* A small synthetic capture for the tests of the format, with the channels of every role and values from closed forms. */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "glint/capture.h"

enum { FIX_W = 40, FIX_H = 24, FIX_CUBE = 8, FIX_SHADOW = 16, FIX_CELLS_X = 3, FIX_CELLS_Y = 2, FIX_CELLS_Z = 4 };

/* A right-handed camera at `eye` that looks along its own -z, with near and far planes in units. */
struct glint_camera fixture_camera(const double eye[3], double near, double far);
struct glint_frame fixture_frame(void);

/* A pseudo-random number in [0, 1) from two indices. */
double fixture_noise(uint32_t a, uint32_t b);

/* A unit normal for pixel i. */
void fixture_normal(uint32_t i, double n[3]);

struct fixture {
    float gbuffer[FIX_W * FIX_H * 17];
    uint32_t stencil[FIX_W * FIX_H];
    float color[FIX_W * FIX_H * 4];
    float visible[FIX_W * FIX_H];
    float cube[FIX_CUBE * FIX_CUBE * 6 * 5];
    struct glint_cubemap cubemap;
    struct glint_planar planar;
    struct glint_sky sky;
    struct glint_probe probe[2]; /* by level */
    struct glint_indirect indirect;
    struct glint_shadow shadow[2]; /* of the sun, and of light 1 */
    struct glint_light_volume volume;
    struct glint_froxels froxels;
    struct glint_truth truth;
};
void fixture_init(struct fixture *f);
/* The one of a test program. Its setup, with cmocka's signature, initialises it. */
extern struct fixture fixture;
int fixture_setup(void **state);

enum fixture_part {
    FIXTURE_GBUFFER,
    FIXTURE_LIT,
    FIXTURE_SCENE,
    FIXTURE_PREVIOUS_GBUFFER,
    FIXTURE_PREVIOUS_LIT,
    FIXTURE_CUBEMAP_0,
    FIXTURE_CUBEMAP_1,
    FIXTURE_SKY,
    FIXTURE_PROBE,
    FIXTURE_PROBE_1,
    FIXTURE_PLANAR,
    FIXTURE_TRANSPARENT,
    FIXTURE_WATER,
    FIXTURE_TRUTH,
    FIXTURE_MIRROR,
    FIXTURE_ENGINE,
    FIXTURE_INDIRECT,
    FIXTURE_EMISSIVE,
    FIXTURE_AO,
    FIXTURE_SUN,
    FIXTURE_SHADOW_0,
    FIXTURE_SHADOW_1,
    FIXTURE_VOLUME,
    FIXTURE_FROXELS,
    FIXTURE_CURVATURE,
    FIXTURE_STARS,
    FIXTURE_CLOUD_DENSITY,
    FIXTURE_CLOUD_HEIGHT,
    FIXTURE_CLOUD_NOISE,
    FIXTURE_TRUTH_OCCLUSION,
    FIXTURE_TRUTH_SUN,
    FIXTURE_TRUTH_INDIRECT,
    FIXTURE_TRUTH_ANTIALIASED,
    FIXTURE_TRUTH_PICTURE,
    FIXTURE_LAMPS,
    FIXTURE_TRUTH_LAMPS,
    FIXTURE_PARTS
};
struct fixture_channels {
    struct glint_channel all[20];
};
/* Describes a part with pixels from `f`; `channels` holds its list of channels. */
struct glint_part fixture_part(const struct fixture *f, enum fixture_part which, struct fixture_channels *channels);
/* Writes the parts [0, count) and the frame. The smallest valid count is FIXTURE_LIT + 1. */
bool fixture_write(const struct fixture *f, const char *path, int count, const struct glint_writer_options *options,
                   struct glint_error *err);
/* A path in the temporary folder of the test ($TMPDIR or /tmp; TEMP of Windows), in the caller's buffer. */
const char *fixture_path(char buffer[512], const char *name);

#endif
