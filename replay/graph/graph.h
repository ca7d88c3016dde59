/* The graph of a pipeline: the order of its passes, which of them run and why, and where each image comes from. It needs no device and
   reads no pixel: callers pass it the facts about the frame. */
#ifndef GLINT_REPLAY_GRAPH_H
#define GLINT_REPLAY_GRAPH_H

#include "faults.h"
#include "pipeline.h"
#include "row.h"

enum source {
    SOURCE_MADE,    /* a pass of this run writes it */
    SOURCE_CAPTURE, /* decoded from the capture */
    SOURCE_RUN,     /* read from a run folder */
    SOURCE_HISTORY, /* kept on the device since the previous frame */
    SOURCE_ENGINE,  /* a part engine.SLOT.IMAGE of the capture, dumped by the engine */
    SOURCE_FALLBACK /* not made: every texel has the row's fallback value */
};

struct graph_image {
    const char *name;              /* history: "history." and the name of the image */
    const struct glint_row *row;   /* the WRITE, DIAGNOSTIC or CAPTURE row that defines it */
    const struct glint_pass *pass; /* whose row it is; NULL for a capture image */
    enum source source;
    bool requested; /* the caller may read it, under the name of `alias` if there is one; memory is not shared */
    bool history;   /* contents of the previous frame */
    bool blank;     /* FALLBACK that is allocated in full size */
    bool kept;      /* becomes history of the next frame; memory is not shared */
    const struct glint_row *alias; /* the image of a dropped pass that this image also replaces, or NULL */
    const struct glint_pass *alias_pass;
    const char *kept_as;        /* the image of a dropped pass as whose history it is kept (row BYPASS), or NULL */
    size_t maker;               /* MADE: index of the pass in the graph */
    size_t first_use, last_use; /* indices of the first and last pass that access it */
    char history_name[80];
};

/* Passes that run for each ray are grouped together, after the passes that they depend on and before those that depend on them. */
enum rank { RANK_BEFORE, RANK_RAY, RANK_AFTER };

struct graph_pass {
    const struct pipeline_pass *entry;
    const struct glint_pass *pass;
    enum rank rank;
    bool runs;
    const char *unused;   /* why no pass uses its images, or NULL */
    bool aliased;         /* it was dropped, and images of the capture stand for those of its rows ALIAS */
    uint32_t false_facts; /* a bit for each row FACT in order, set if the fact does not hold */
    bool cached_work;     /* depends on cube maps and on nothing that changes with every frame */
    char reason[400];
};

struct graph {
    const struct glint_pipeline *pipeline;
    struct graph_pass *passes; /* in order of execution, also those that do not run */
    size_t pass_count;
    size_t loop_first, loop_end; /* the passes that run for each ray; empty if there is one ray */
    struct graph_image *images;  /* all images that running passes read or write */
    size_t image_count;
    struct faults declared,
        faults; /* those of the declarations; those and the ones of the last decision and of linking */
};

/* What a fact of rows NEEDS and FACT depends on, which is how much of the survey is needed to evaluate it. */
enum fact_about {
    FACT_UNKNOWN,
    FACT_PARTS,    /* which parts the capture has */
    FACT_CUBEMAPS, /* whether it has cube maps; only passes that work on cube maps need this */
    FACT_PIXELS,
    FACT_FACES, /* contents of the faces of the active cube maps; conservative as long as these are unknown */
    FACT_FACES_AND_PIXELS,
    FACT_CONES /* pixels; a pass may be needed although the fact is false, if another one reads its MIP levels */
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

/* An empty graph with memory for the pipeline's passes and images. */
bool graph_allocate(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err);
/* Builds the graph of a pipeline: checks the declarations and sorts the passes. graph_link reports the faults, together with its own.
   False only if memory is exhausted. */
bool graph_init(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err);
/* Decides which passes run. It may be called again when more facts are known. False only if a fact cannot be evaluated. */
bool graph_decide(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err);
/* Finds the images that running passes read and write, and the source of each. Call it once; it reports all faults together. */
bool graph_link(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err);
/* Copies the graph as it was before any decision. */
bool graph_copy(struct graph *copy, const struct graph *graph, struct glint_error *err);
void graph_finish(struct graph *graph);

/* Whether the capture has an image: its parts, with a channel that can be read. All cube maps must have it. */
bool graph_capture_has(const struct glint_capture *capture, const struct glint_row *image);
struct graph_image *graph_find(const struct graph *graph, const char *name);
/* The image that is bound for a row. */
struct graph_image *graph_bound(const struct graph *graph, const struct glint_row *binding);
/* The row that defines an image: of the pipeline's passes, else of the capture, else of any pass; NULL if there is none. *pass receives
   its pass, NULL for the capture. */
const struct glint_row *graph_row(const struct graph *graph, const char *name, const struct glint_pass **pass);
/* The index of the pass that writes the image, or pass_count. */
size_t graph_maker(const struct graph *graph, const char *image);
/* Whether the pass has a row CALLED_BY of the image that counts in this pipeline. */
bool graph_calls(const struct graph *graph, const struct glint_pass *pass, const char *image);
/* The row IN_PLACE_OF by which the pass does without an image that it reads in this pipeline, or NULL. A user's shader may use it. */
const struct glint_row *graph_replaced(const struct graph *graph, const struct graph_pass *pass, const char *image);
/* Whether pass `later` reads as history an image that pass `earlier` writes. */
bool pass_reads_history(const struct glint_pass *later, const struct glint_pass *earlier);
/* The number of rays that a pass runs for in each frame. */
uint64_t pass_rays(const struct graph *graph, const struct graph_pass *pass);

/* order.c */
void graph_sort(struct graph *graph);
void graph_find_loop(struct graph *graph, uint32_t rays);
void graph_find_cached_work(struct graph *graph);

/* check.c: finds declarations that contradict themselves or one another. */
void graph_check(const struct graph *graph, struct faults *faults);
void graph_check_kind(const struct glint_pass *pass, const struct glint_row *binding, const struct glint_row *image,
                      struct faults *faults);

#endif
