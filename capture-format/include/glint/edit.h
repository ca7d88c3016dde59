/* Copies of a capture with changes: attributes set or removed, parts and channels left out, the frame cropped, pixels changed. What is
   not changed keeps every bit, including parts and attributes that this version does not know; the copy is compressed with ZIP, and parts that are already, and of which no pixel changes, are
   copied without being decompressed: pixels that are damaged there stay so. An edit
   holds the changes, and the file is never written to: glint_edit_write makes a new one. Objects may be used by one thread at a time. */
#ifndef GLINT_EDIT_H
#define GLINT_EDIT_H

#include "glint/exr.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_edit;

/* Receives one sentence about each change that is made, and about what a change cannot do. */
typedef void (*glint_edit_note)(void *user, const char *text);

/* Reads the headers. The file may break rules of FORMAT.md, which the changes are then to repair. NULL on failure. `note` may be NULL. */
struct glint_edit *glint_edit_open(const char *path, const struct glint_limits *limits, glint_edit_note note,
                                   void *user, struct glint_error *err);
void glint_edit_close(struct glint_edit **edit);

/* A part as it will be written; NULL past the last. The pointers in it are valid until the next change. A cube map that names a sibling is
   listed with its placeholder. */
const struct glint_exr_part_info *glint_edit_part(const struct glint_edit *edit, size_t part);
/* Its index, or the number of parts. */
size_t glint_edit_find(const struct glint_edit *edit, const char *name);

/* Adds an attribute or replaces the one of its name. */
bool glint_edit_set(struct glint_edit *edit, size_t part, const struct glint_exr_attribute *attribute,
                    struct glint_error *err);
/* False if there was none. */
bool glint_edit_unset(struct glint_edit *edit, size_t part, const char *attribute);
/* Later parts move forward by one. */
void glint_edit_drop_part(struct glint_edit *edit, size_t part);
/* The functions on channels and pixels take those of a sibling into the copy. */
bool glint_edit_drop_channel(struct glint_edit *edit, size_t part, const char *channel, struct glint_error *err);

/* Adds a part of float channels, behind the others; values: those of a pixel beside each other, copied. A part of this name is an error. */
bool glint_edit_add_part(struct glint_edit *edit, const char *name, uint32_t width, uint32_t height,
                         const char *const *channels, size_t count, const float *values, struct glint_error *err);

/* Pixels of one channel, which may be changed until the edit is closed. */
struct glint_edit_pixels {
    uint8_t *data;
    size_t x_stride_bytes, y_stride_bytes;
    enum glint_stored stored;
    uint32_t width, height;
};
bool glint_edit_pixels(struct glint_edit *edit, size_t part, const char *channel, struct glint_edit_pixels *pixels,
                       struct glint_error *err);
/* Replaces a channel by floats, which are copied; width · height of the part. */
bool glint_edit_replace(struct glint_edit *edit, size_t part, const char *channel, const float *values,
                        struct glint_error *err);

struct glint_edit_rectangle {
    uint32_t x, y, width, height; /* pixels of the G-buffer, y down */
};
/* Reduces one part to a rectangle of its own pixels. */
bool glint_edit_crop_part(struct glint_edit *edit, size_t part, const struct glint_edit_rectangle *rectangle,
                          struct glint_error *err);
/* Crops the frame: all parts of the G-buffer's size, and engine and unknown parts that are a whole number of times smaller. Projections of
   this and the previous frame and motion are corrected, so that every pixel keeps its ray, its jitter and its motion; `visible` of truth.mirror
   becomes 0 where the hit is outside the rectangle, and `froxels` are left out. The file must be a valid capture. An image whose texels cover pixels inside and outside is an
   error that names a rectangle for which there is none. */
bool glint_edit_crop(struct glint_edit *edit, const struct glint_edit_rectangle *rectangle, struct glint_error *err);

/* Keeps every factor-th pixel of the frame in both directions, the one nearest to the middle of its block, or up and left of the middle. No pixels are mixed: depth,
   normals and stencil values stay those of surfaces. The size is rounded so that no kept pixel is missing. All parts of the G-buffer's size are reduced, and so are engine and
   unknown parts that are a whole number of times smaller, if the new frame still has room for their texels; else they are left out. Projections of this and the previous frame, jitter and motion are corrected, so that every pixel
   keeps its ray. A `stipple` is left out by an even factor, and `froxels` where their cells no longer fit. The file must be a valid capture; factor: from 1, which changes nothing, to the frame's
   smaller side. */
bool glint_edit_reduce(struct glint_edit *edit, uint32_t factor, struct glint_error *err);

/* Where a key of glint_edit_assign applies. */
enum glint_edit_scope {
    GLINT_EDIT_FRAME,    /* on gbuffer, for the whole frame */
    GLINT_EDIT_CUBEMAP,  /* on each cubemap.NNN */
    GLINT_EDIT_SKY,      /* on sky */
    GLINT_EDIT_PROBE,    /* on each probe.NNN and its levels */
    GLINT_EDIT_PLANAR,   /* on each planar.NNN */
    GLINT_EDIT_INDIRECT, /* on indirect */
    GLINT_EDIT_SHADOW,   /* on each shadow.NNN */
    GLINT_EDIT_VOLUME,   /* on each volume.NNN */
    GLINT_EDIT_FROXELS,  /* on froxels */
    GLINT_EDIT_TRUTH,    /* on truth.occlusion or truth.sun */
    GLINT_EDIT_ENCODING, /* on each part that has channels of the encoding */
    GLINT_EDIT_STORAGE   /* on each part that has the channel */
};
struct glint_edit_key {
    const char *name; /* "metresPerUnit", the attribute without "glint."; NNN in it stands for the number of a light */
    enum glint_edit_scope scope;
    const char *form; /* "number", "3 numbers", "a name", … */
    bool required;
    const char *unit, *meaning;
};
/* The i-th key; false past the last. */
bool glint_edit_key(size_t i, struct glint_edit_key *key);
/* The k-th name that may be the value of the i-th key; NULL past the last, or if the key takes no names. */
const char *glint_edit_value_name(size_t i, size_t k);
/* Sets a key, or any other attribute of simple type that a part has, from text: numbers and names are separated by commas, and an empty value
   removes the attribute. `part` restricts it to the part of this name, or else to those that begin with it and a dot ("cubemap", "previous"); NULL: all. */
bool glint_edit_assign(struct glint_edit *edit, const char *part, const char *key, const char *value,
                       struct glint_error *err);

/* Checks all rules of FORMAT.md but those about pixels on what will be written, and writes it: under the final name only when it is
   complete. A file that is the input or one of its siblings, by whatever name, is refused. Cube maps of siblings stay there if the copy is in the
   same folder, and are otherwise taken into the copy. */
bool glint_edit_write(struct glint_edit *edit, const char *path, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
