/* The tables of glint info. */
#ifndef GLINT_VIEWER_INFO_TABLES_H
#define GLINT_VIEWER_INFO_TABLES_H

#include "capture/channels.h"
#include "glint/replay.h"

void info_print_camera(const struct glint_frame *frame);
/* Parts and channels whose names differ only by a number share a line. */
void info_print_parts(const struct glint_capture *capture);
void info_print_channels(const struct channel_table *all);
/* The resolution of the depth storage. */
void info_print_depth(const struct glint_capture *capture);
/* Prints nothing if the capture has no cube maps. */
void info_print_cubemaps(const struct glint_capture *capture);
/* Prints nothing if it has neither probes nor a sky with painted ground. */
void info_print_probes(const struct glint_capture *capture);
void info_print_survey(const struct glint_survey *survey);
/* Including the figures that are counted on the device. */
void info_print_whole_survey(const struct glint_survey *survey, const struct glint_time *time,
                             const struct glint_frame *frame);
void info_print_run(const struct glint_run *run);
const char *cubemap_volume_name(enum glint_volume volume);

#endif
