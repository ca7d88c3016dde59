/* Replays several captures into one folder and keeps frames that an interrupted replay completed. */
#ifndef GLINT_VIEWER_SHOT_H
#define GLINT_VIEWER_SHOT_H

#include "options/pipeline_args.h"

/* Everything that the images of all frames depend on, as JSON: pipeline, shaders, options, tool and device. */
json_t *shot_settings(const struct glint_pipeline *pipeline, const struct pipeline_args *args, const char *device,
                      struct glint_error *err);

/* Adds to the images that are written (none: all are) those that the next frame reads as its history. Without them in the run folder, a shot that
   was interrupted could not go on where it ended. */
void shot_keep_history(struct list *outputs, const struct glint_pipeline *pipeline);

/* Makes `folder`, which remembers the settings in shot.json. With other settings than those it was begun with, the
   frames' run.json are removed first, so that no mixture of two settings ever looks complete. */
bool shot_begin(const char *folder, const json_t *settings, char *const *runs, size_t count, struct glint_error *err);
/* Whether a run is complete and was made from this capture. Fails if memory or the system refuses to tell. */
bool shot_has(const char *run, const char *capture, bool *has, struct glint_error *err);
/* Whether the capture is the next frame after that of the run. Fails likewise. */
bool shot_follows(const char *run, const char *capture, bool *follows, struct glint_error *err);

#endif
