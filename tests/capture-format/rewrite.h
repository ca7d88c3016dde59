/* Loads an EXR file into memory to change and rewrite it, so that tests can break rules that the writer enforces. */
#ifndef REWRITE_H
#define REWRITE_H

#include "glint/exr.h"

enum { REWRITE_PARTS = 40, REWRITE_ATTRIBUTES = 512, REWRITE_CHANNELS = 24 };

struct rewrite_part {
    struct glint_exr_part part;
    char name[256];
    struct glint_exr_attribute attributes[REWRITE_ATTRIBUTES];
    struct glint_exr_channel channels[REWRITE_CHANNELS];
    void *data[REWRITE_CHANNELS];
};

struct rewrite {
    struct glint_exr *exr;
    struct rewrite_part parts[REWRITE_PARTS];
    size_t count;
};

/* Fails the test on any error. */
void rewrite_load(struct rewrite *r, const char *path);
void rewrite_save(const struct rewrite *r, const char *path);
void rewrite_finish(struct rewrite *r);

struct rewrite_part *rewrite_find(struct rewrite *r, const char *part);
struct glint_exr_attribute *rewrite_attribute(struct rewrite *r, const char *part, const char *name);
void rewrite_remove_attribute(struct rewrite *r, const char *part, const char *name);
void rewrite_remove_channel(struct rewrite *r, const char *part, const char *name);
void rewrite_remove_part(struct rewrite *r, const char *part);
/* The channel's pixels, of its stored type. */
void *rewrite_pixels(struct rewrite *r, const char *part, const char *channel);

#endif
