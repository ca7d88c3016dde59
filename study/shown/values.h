/* Reads images of runs and channels of captures into memory. */
#ifndef GLINT_STUDY_VALUES_H
#define GLINT_STUDY_VALUES_H

#include "glint/replay.h"

/* The image of the last run that has a role; if several passes have it, that of the last one. NULL if there is none. */
const struct glint_image *study_image(const struct glint_replay *replay, enum glint_pass_role role);
/* What tables call the tracer whose image of end reasons has this role. */
const char *study_tracer_label(enum glint_pass_role end);
/* The values of an image as GLINT_F32 or GLINT_U32, and channels of a part as interleaved floats. The caller frees them; NULL on failure. */
void *study_values(struct glint_replay *replay, const struct glint_image *image, enum glint_type type,
                   struct glint_error *err);
float *study_channels(struct glint_capture *capture, const char *part, const char *const *channels, size_t count,
                      struct glint_error *err);

/* The same of an image of a run folder, as GLINT_F32. */
float *study_run_values(struct glint_run *run, const struct glint_run_image *image, struct glint_error *err);
/* Names such as "R G B", one by one. */
struct study_channel_list {
    char text[64];
    const char *names[4];
    uint32_t count;
};
void study_split_channels(const char *channels, struct study_channel_list *list);
/* The last of a pass's images of the last run that holds radiance at full resolution. */
const struct glint_image *study_radiance(struct glint_replay *replay, const struct glint_pass *pass);

#endif
