/* Tables that host passes fill from the capture's attributes, before anything is uploaded. */
#ifndef GLINT_REPLAY_TABLES_H
#define GLINT_REPLAY_TABLES_H

#include "graph.h"

enum { TABLES_MAX = 16 };
struct tables {
    struct glint_table tables[TABLES_MAX];
    const struct glint_pass *makers[TABLES_MAX];
    double seconds[TABLES_MAX]; /* that the maker took for all of its tables */
    size_t count;
};
/* Runs every host pass of the graph that runs and has not run yet. */
struct frame_source;
bool tables_fill(struct tables *tables, const struct graph *graph, const struct frame_source *source,
                 struct glint_error *err);
void tables_finish(struct tables *tables);
const struct glint_table *tables_find(const struct tables *tables, const char *image);
/* What the pass took; 0 when it did not run. */
double tables_seconds(const struct tables *tables, const struct glint_pass *pass);

#endif
