/* Writes run.json, which is written last and so marks a run folder as complete. */
#ifndef GLINT_REPLAY_RUN_JSON_H
#define GLINT_REPLAY_RUN_JSON_H

#include <jansson.h>

#include "glint/common.h"

/* Replaces the file atomically. */
bool run_write_json(const char *folder, const json_t *root, struct glint_error *err);

/* Removes the images of STAGING/old.json from the folder, except those that STAGING/run.json lists as well. */
bool run_remove_others(const char *folder, const char *staging, struct glint_error *err);

#endif
