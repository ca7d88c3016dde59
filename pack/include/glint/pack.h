/* Captures from loose textures and a manifest (docs/pack.md), and back. Both calls may be made by several threads at once for
   different outputs. */
#ifndef GLINT_PACK_H
#define GLINT_PACK_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_pack_note {
    GLINT_PACK_DEFAULT, /* nothing was said, and this holds */
    GLINT_PACK_FOUND,   /* derived from what was said: a projection's planes, the handedness of the world */
    GLINT_PACK_SAID     /* what the manifest says, as it was understood */
};

/* Zero-initialise. */
struct glint_pack_options {
    uint32_t threads; /* 0: one for each core */
    /* Called with what was understood, in the order in which it was; `key` is the way to it ("frame.clip_y"). May be NULL. */
    void (*note)(void *user, enum glint_pack_note kind, const char *key, const char *text);
    void *note_user;
    /* Called with errors of the manifest beyond the first, which glint_pack returns: "FILE:LINE: KEY: what is wrong". May be NULL. */
    void (*fault)(void *user, const char *text);
    void *fault_user;
    bool outside;            /* the manifest may name files outside its folder; otherwise that is an error */
    glint_progress progress; /* may be NULL */
    void *progress_user;
};

/* Writes the capture that the manifest describes; the file appears under its name only when it is complete. `out` NULL: everything is
   read and checked, and nothing is written. Errors name the manifest's line and key; up to twenty of one manifest are told together. */
bool glint_pack(const char *manifest, const char *out, const struct glint_pack_options *options,
                struct glint_error *err);

/* The same of a multilayer EXR file that Blender wrote. The manifest holds what is not in it: the camera in `frame`, and parts and channels of
   your own, which come before those of the file. */
bool glint_pack_blender(const char *blender, const char *manifest, const char *out,
                        const struct glint_pack_options *options, struct glint_error *err);

/* Writes FOLDER/manifest.json and textures that glint_pack makes the same capture of, and copies sibling files. The manifest is written
   last. Files that are there already are overwritten, but never the capture itself. */
bool glint_extract(const char *capture, const char *folder, const struct glint_pack_options *options,
                   struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
