/* Tables that host passes fill before anything is uploaded. */
#ifndef GLINT_REPLAY_TABLES_H
#define GLINT_REPLAY_TABLES_H

#include "graph.h"

enum { TABLES_MAX = 16 };
struct tables {
    struct glint_table tables[TABLES_MAX];
    const struct glint_row *rows[TABLES_MAX];
    size_t count;
};
/* Runs every host pass of the graph. `seconds`, one for each pass of the graph, receives their times. */
bool tables_init(struct tables *tables, const struct graph *graph, struct glint_capture *capture, double *seconds,
                 struct glint_error *err);
void tables_finish(struct tables *tables);
const struct glint_table *tables_find(const struct tables *tables, const char *image);

/* The capture's cube maps in order of their numbers. The caller frees *parts. */
bool cubemap_parts(const struct glint_capture *capture, const struct glint_part_info ***parts, size_t *count,
                   struct glint_error *err);

#endif
