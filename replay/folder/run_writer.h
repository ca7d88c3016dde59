/* Run folders in which a run is being replaced. */
#ifndef GLINT_REPLAY_RUN_WRITER_H
#define GLINT_REPLAY_RUN_WRITER_H

#include "glint/replay.h"

/* The folder that the writer was opened with. */
const char *run_writer_folder(const struct glint_run_writer *writer);

/* Completes a run that a process had written whole when it ended before the run had its place. Whether the folder has a run. */
bool run_writer_recover(const char *folder);

#endif
