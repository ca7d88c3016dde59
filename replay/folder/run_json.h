/* run.json, which comes last and so says that a run folder is complete. */
#ifndef GLINT_REPLAY_RUN_JSON_H
#define GLINT_REPLAY_RUN_JSON_H

#include <jansson.h>

#include "glint/common.h"

/* The file, complete or as it was before. */
bool run_write_json(const char *folder, const json_t *root, struct glint_error *err);

#endif
