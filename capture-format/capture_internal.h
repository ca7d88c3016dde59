/* An open capture. */
#ifndef GLINT_CAPTURE_INTERNAL_H
#define GLINT_CAPTURE_INTERNAL_H

#include "exr_internal.h"
#include "part.h"
#include "perturb.h"

/* Another file in the capture's folder that holds pixels of its cube maps. */
struct glint_sibling {
    char *name;
    char hex[33];
    struct glint_exr *exr;
};

/* Where a part's pixels are. */
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

/* The reader's open, and validate's: the check decides whether a broken rule ends it. */
struct glint_capture *glint_capture_open_checked(const char *path, const struct glint_limits *limits,
                                                 struct glint_check *check);

/* Reports the pixel rules that the part breaks. False: it cannot be read. */
bool glint_validate_pixels(struct glint_check *check, struct glint_capture *capture, size_t part,
                           struct glint_error *err);

/* What decoding needs to know about the frame that a part belongs to. */
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
/* In place, `count` <= GLINT_BLOCK values as stored (widened to float) to canonical ones. */
void glint_decode_depth(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_roughness(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_motion(const struct glint_decoder *d, int axis, float *v, size_t count);
/* From uint channels. */
void glint_decode_motion_packed(const struct glint_decoder *d, int axis, const uint32_t *in, float *v, size_t count);
void glint_decode_color(const struct glint_decoder *d, float *v, size_t count);
void glint_decode_length(const struct glint_decoder *d, float *v, size_t count);
/* n[0], n[1], n[2] to unit world normals; n[2] is not read when Z is not stored. `lengths` receives their
   lengths before they were made unit, or NULL. */
void glint_decode_normal(const struct glint_decoder *d, enum glint_normal_encoding encoding, float *const n[3],
                         float *lengths, size_t count);

#endif
