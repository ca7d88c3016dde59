/* Tables, which host passes fill from the capture's attributes before anything is uploaded. */
#ifndef GLINT_REPLAY_TABLES_H
#define GLINT_REPLAY_TABLES_H

#include "graph.h"

enum { TABLES_MAX = 16 };
struct tables {
    struct glint_table tables[TABLES_MAX];
    const struct glint_pass *makers[TABLES_MAX];
    double seconds[TABLES_MAX]; /* run time of the maker, for all of its tables */
    size_t count;
};
struct frame_source;
/* Runs each host pass of the graph that the plan keeps and that has not run yet. */
bool tables_fill(struct tables *tables, const struct graph *graph, const struct frame_source *source,
                 struct glint_error *err);
void tables_finish(struct tables *tables);
const struct glint_table *tables_find(const struct tables *tables, const char *image);
/* The run time of a host pass; 0 if it did not run. */
double tables_seconds(const struct tables *tables, const struct glint_pass *pass);

#endif
