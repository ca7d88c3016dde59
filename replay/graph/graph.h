/* The graph of a pipeline: which passes run and why, in order, and where each image comes from. Host only: it is told what
   the frame shows, and reads no pixel. */
#ifndef GLINT_REPLAY_GRAPH_H
#define GLINT_REPLAY_GRAPH_H

#include "faults.h"
#include "pipeline.h"
#include "row.h"

enum source {
    SOURCE_MADE,    /* a pass of this run writes it */
    SOURCE_CAPTURE, /* decoded from the capture */
    SOURCE_RUN,     /* read from a run folder */
    SOURCE_HISTORY, /* what the device still holds of the frame before */
    SOURCE_ENGINE,  /* the engine's own, a part engine.SLOT.IMAGE of the capture */
    SOURCE_NOTHING  /* the row's "nothing" value */
};

struct graph_image {
    const char *name;              /* of history: "history." and the image's */
    const struct glint_row *row;   /* the WRITE, DIAGNOSTIC or CAPTURE row that defines it */
    const struct glint_pass *pass; /* whose row it is; NULL for a capture image */
    enum source source;
    bool wanted;                     /* written out, where there is `instead` as that: its memory is its own */
    bool history;                    /* of the frame before */
    bool blank;                      /* NOTHING, in all of its size */
    bool kept;                       /* the next frame's history: its memory is its own */
    const struct glint_row *instead; /* what it is besides, a dropped pass's image, and whose; or NULL */
    const struct glint_pass *instead_of;
    const char *kept_as; /* what it stands for there, when the pass that would have passed it on was dropped; or NULL */
    size_t maker;        /* MADE: place of the pass in the graph */
    size_t first_use, last_use; /* places of the passes that touch it */
    char history_name[80];
};

/* Passes that run for each ray of a frame stand together, after those that they need and before those that need them. */
enum rank { RANK_BEFORE, RANK_RAY, RANK_AFTER };

struct graph_pass {
    const struct pipeline_pass *entry;
    const struct glint_pass *pass;
    enum rank rank;
    bool runs;
    const struct glint_row *instead; /* ALIAS, where its image is the one of the capture; or NULL */
    uint32_t lacks;                  /* a bit for each FACT row, in order: the fact does not hold */
    bool cached_work;                /* it reads cube maps and nothing that changes with every frame */
    char reason[192];
};

struct graph {
    const struct glint_pipeline *pipeline;
    struct graph_pass *passes; /* in order of execution, also those that do not run */
    size_t pass_count;
    size_t loop_first, loop_end; /* passes that run for each ray; none when there is one ray */
    struct graph_image *images;  /* all that passes which run read or write */
    size_t image_count;
    struct faults declared, faults; /* of the declarations alone; with those of the last decision and of links */
};

/* What the frame shows, for NEEDS and FACT rows. */
enum fact_about {
    FACT_UNKNOWN,
    FACT_PARTS,    /* what parts the capture has tells it */
    FACT_CUBEMAPS, /* the same, of a pass that works on cube maps */
    FACT_PIXELS,
    FACT_FACES, /* what the faces of the active cube maps show; conservative until that is known */
    FACT_FACES_AND_PIXELS,
    FACT_CONES /* pixels; readers of coarser levels may need the pass although it does not hold */
};
struct facts {
    bool (*holds)(void *user, const char *fact, char *reason, size_t size, struct glint_error *err);
    enum fact_about (*about)(const char *fact);
    void *user;
};

struct graph_inputs {
    const struct glint_replay_options *options;
    struct glint_capture *capture;
    const struct glint_run *run; /* or NULL */
    struct facts facts;
};

/* An empty graph with room for the pipeline's. */
bool graph_allocate(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err);
/* Builds the graph of a pipeline: checks the declarations and sorts the passes. Faults are kept for graph_link, so that all are
   reported together; false only without memory. */
bool graph_init(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err);
/* Decides which passes run, and why the others do not; again when more is known. False only when facts cannot be had. */
bool graph_decide(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err);
/* Finds the images that the passes which run read and write. Once for a graph; reports all faults together. */
bool graph_link(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err);
/* The same graph before any decision. */
bool graph_copy(struct graph *copy, const struct graph *graph, struct glint_error *err);
void graph_finish(struct graph *graph);

struct graph_image *graph_find(const struct graph *graph, const char *name);
/* The graph's image that a binding shows. */
struct graph_image *graph_bound(const struct graph *graph, const struct glint_row *binding);
/* The row that defines an image, of the pipeline's passes, of the capture, or of any pass there is; NULL: of none. *pass: its own,
   NULL where that is the capture. */
const struct glint_row *graph_row(const struct graph *graph, const char *name, const struct glint_pass **pass);
/* The pass that writes the image; pass_count when none does. */
size_t graph_maker(const struct graph *graph, const char *image);
/* True when pass `later` reads what pass `earlier` made in the frame before. */
bool pass_remembers(const struct glint_pass *later, const struct glint_pass *earlier);
/* How often a pass runs in a frame. */
uint64_t pass_rays(const struct graph *graph, const struct graph_pass *pass);

/* order.c */
void graph_sort(struct graph *graph);
void graph_find_loop(struct graph *graph, uint32_t rays);
void graph_find_cached_work(struct graph *graph);

/* check.c: declarations that contradict themselves or one another. */
void graph_check(const struct graph *graph, struct faults *faults);
void graph_check_kind(const struct glint_pass *pass, const struct glint_row *binding, const struct glint_row *image,
                      struct faults *faults);

#endif
