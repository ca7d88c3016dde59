/* Several captures replayed into one folder: what an interrupted replay left complete is kept. */
#ifndef GLINT_VIEWER_SHOT_H
#define GLINT_VIEWER_SHOT_H

#include "options/pipeline_args.h"

/* What every frame's images follow from, as JSON: pipeline, shaders, options, tool and device. */
json_t *shot_settings(const struct glint_pipeline *pipeline, const struct pipeline_args *args, const char *device);

/* Makes `folder`, which remembers the settings in shot.json. With other settings than those it was begun with, the
   frames' run.json are removed first, so that no mixture of two settings ever looks complete. */
bool shot_begin(const char *folder, const json_t *settings, char *const *runs, size_t count, struct glint_error *err);
/* Whether a frame's run is complete and of this capture. */
bool shot_has(const char *run, const char *capture);
/* Whether the capture is the frame after the run's. */
bool shot_follows(const char *run, const char *capture);

#endif
