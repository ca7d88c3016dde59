/* Writes run.json, which is written last and so marks a run folder as complete. */
#ifndef GLINT_REPLAY_RUN_JSON_H
#define GLINT_REPLAY_RUN_JSON_H

#include <jansson.h>

#include "glint/common.h"

enum { RUN_JSON_BYTES = 1 << 24 }; /* more than any run has */

/* Replaces the file atomically. */
bool run_write_json(const char *folder, const json_t *root, struct glint_error *err);

/* Removes the images from the folder that the run.json `removed` lists, except those of the run.json `kept`, unless that is NULL. */
bool run_remove_images(const char *removed, const char *kept, const char *folder, struct glint_error *err);

#endif
