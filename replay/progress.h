/* How far a call is, told to whoever follows it, who may stop it. */
#ifndef GLINT_REPLAY_PROGRESS_H
#define GLINT_REPLAY_PROGRESS_H

#include "glint/replay.h"

bool report_progress(glint_progress progress, void *user, const char *what, double done, struct glint_error *err);

#endif
