/* The channels of a capture or of any EXR file, and what values they hold. Read part by part, so that memory stays at one part's size. */
#ifndef GLINT_VIEWER_CHANNELS_H
#define GLINT_VIEWER_CHANNELS_H

#include "glint/capture.h"
#include "glint/exr.h"

struct channel_stats {
    uint64_t count, nan, inf; /* min, max and sum are over the finite values */
    double min, max, sum;
};

struct channel_row {
    char part[256], channel[256];
    const char *stored;          /* half, float, uint */
    char storage[64];            /* the engine's own format */
    const char *encoding;        /* "" where none applies */
    const char *unit;            /* after decoding; "" unknown */
    bool has_stats, of_surfaces; /* of_surfaces: stats leave out pixels whose depth says that there is none */
    struct channel_stats stats;
};

struct channel_table {
    struct channel_row *rows;
    size_t count;
};

/* Length of a channel's layer: 8 for "material.roughness", 0 for "R". */
size_t channel_layer_length(const char *channel);
/* R G B A and X Y Z come in that order, everything else after them. */
int channel_rank(const char *channel);

/* With `pixels` off no pixel is read and has_stats is false. Values are decoded as the format says. */
bool channels_of_capture(struct channel_table *table, struct glint_capture *capture, bool pixels,
                         glint_progress progress, void *user, struct glint_error *err);
/* Values as stored; tiled and deep parts are listed without statistics. */
bool channels_of_exr(struct channel_table *table, struct glint_exr *exr, bool pixels, glint_progress progress,
                     void *user, struct glint_error *err);
void channel_table_finish(struct channel_table *table);

void stats_merge(struct channel_stats *into, const struct channel_stats *from);
double stats_mean(const struct channel_stats *stats);

#endif
