/* An open capture. */
#ifndef GLINT_CAPTURE_INTERNAL_H
#define GLINT_CAPTURE_INTERNAL_H

#include "exr_internal.h"
#include "part.h"
#include "perturb.h"

/* A file in the capture's folder that holds the pixels of its cube maps. */
struct glint_sibling {
    char *name;
    char hex[33];
    struct glint_exr *exr;
};

/* The location of a part's pixels. */
struct glint_source {
    struct glint_exr *exr;
    size_t part;
};

struct glint_capture {
    struct glint_exr *exr;
    struct glint_arena arena;
    struct glint_part_info *parts;
    struct glint_source *sources;
    size_t count;
    struct glint_sibling *siblings;
    size_t sibling_count;
    struct glint_frame frame;
    bool has_frame;
    struct glint_perturbation perturbation; /* of what glint_capture_read returns */
};

/* Opens a capture for the reader and for validation; `check` decides whether a violated rule is fatal. */
struct glint_capture *glint_capture_open_checked(const char *path, const struct glint_limits *limits,
                                                 struct glint_check *check);

/* Reports what is not as the format has it in a file's compression, line order and windows. */
bool glint_container_check(struct glint_check *check, const struct glint_exr *exr);

/* Reports the pixel rules that a part violates. False if it cannot be read. */
bool glint_validate_pixels(struct glint_check *check, struct glint_capture *capture, size_t part,
                           struct glint_error *err);

/* Properties of the frame that decoding needs. */
struct glint_decoder {
    const struct glint_frame *frame;
    const struct glint_camera *camera; /* the one that depth and view-space normals refer to */
    struct glint_encodings encodings;
    uint32_t width, height;
};
struct glint_decoder glint_decoder_of(const struct glint_capture *capture, const struct glint_part_info *part);
#define GLINT_BLOCK 256 /* pixels decoded at a time */

/* Half or float as stored, which need not be aligned, to float; `count` <= GLINT_BLOCK. */
void glint_decode_widen(enum glint_stored stored, const uint8_t *in, size_t count, float *out);
/* Decodes stored values, widened to float, to canonical ones in place; `count` <= GLINT_BLOCK. */
void glint_decode_depth(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_roughness(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_motion(const struct glint_decoder *d, int axis, float *v, size_t count);
/* The same from uint channels. */
void glint_decode_motion_packed(const struct glint_decoder *d, int axis, const uint32_t *in, float *v, size_t count);
void glint_decode_color(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_length(const struct glint_decoder *d, float *v, size_t count);
/* Decodes n[0], n[1], n[2] to unit world-space normals; n[2] is not read if Z is not stored. `lengths` (may be NULL) receives their
   lengths before normalisation. */
void glint_decode_normal(const struct glint_decoder *d, enum glint_normal_encoding encoding, float *const n[3],
                         float *lengths, size_t count);

#endif
