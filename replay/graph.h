/* The graph of a run: which passes run and why, in order, and where each image comes from. */
#ifndef GLINT_REPLAY_GRAPH_H
#define GLINT_REPLAY_GRAPH_H

#include "faults.h"
#include "pipeline.h"

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
    struct graph_pass *passes; /* in order of execution, also those that do not run */
    size_t pass_count;
    size_t loop_first, loop_end; /* passes that run for each ray; none when there is one ray */
    struct graph_image *images;  /* all that passes which run read or write */
    size_t image_count;
};

/* What the frame shows, for NEEDS rows. */
struct facts {
    bool (*holds)(void *user, const char *fact, char *reason, size_t size, bool *known, struct glint_error *err);
    void *user;
};

struct graph_inputs {
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
    struct glint_capture *capture;
    const struct glint_run *run; /* or NULL */
    struct facts facts;
};

/* Reports all faults together. */
bool graph_init(struct graph *graph, const struct graph_inputs *inputs, struct glint_error *err);
void graph_finish(struct graph *graph);
struct graph_image *graph_find(const struct graph *graph, const char *name);

/* Sets `runs` and `reason` of passes that are in order already. False only when the facts cannot be had. */
bool graph_decide(struct graph *graph, const struct graph_inputs *inputs, struct faults *faults,
                  struct glint_error *err);
/* The row that defines an image, of the pipeline's passes, of the capture, or of any pass there is; NULL: of none. *pass: its own,
   NULL where that is the capture. */
const struct glint_row *graph_row(const struct graph *graph, const char *name, const struct glint_pass **pass);
/* The pass that writes the image; pass_count when none does. */
size_t graph_maker(const struct graph *graph, const char *image);
/* The row with which a pass writes the image, or NULL. */
const struct glint_row *pass_output(const struct glint_pass *pass, const char *image);
/* True when pass `later` reads something that pass `earlier` writes. */
bool pass_depends(const struct glint_pass *later, const struct glint_pass *earlier);
/* `list` is NULL-terminated, or NULL. */
bool list_has(const char *const *list, const char *name);

bool row_is_output(const struct glint_row *row);
bool row_is_sampled(const struct glint_row *row);
bool row_is_image(const struct glint_row *row); /* it is a binding: one of the above */
const char *row_image(const struct glint_row *row);
#define HISTORY_PREFIX "history."
/* The graph's image that a binding shows. */
struct graph_image *graph_bound(const struct graph *graph, const struct glint_row *binding);
/* True when pass `later` reads what pass `earlier` made in the frame before. */
bool pass_remembers(const struct glint_pass *later, const struct glint_pass *earlier);

bool size_is_cube(enum glint_size_class size);  /* one cube map or an array of them */
bool size_is_array(enum glint_size_class size); /* with layers for each active cube map */
bool size_has_levels(enum glint_size_class size);
bool size_is_buffer(enum glint_size_class size); /* a list */

/* order.c */
/* The images a row reads: its own, and what that implies. */
size_t reads_of(const struct glint_row *row, const char *names[2]);
void graph_sort(struct graph *graph, struct faults *faults);
void graph_find_loop(struct graph *graph, uint32_t rays);
void graph_find_cached_work(struct graph *graph);

/* check.c: declarations that contradict themselves or one another. */
void graph_check(const struct graph *graph, struct faults *faults);
void graph_check_kind(const struct glint_pass *pass, const struct glint_row *binding, const struct glint_row *image,
                      struct faults *faults);
/* The row of this kind about the image (NULL: any), or NULL. */
const struct glint_row *pass_row(const struct glint_pass *pass, enum glint_row_kind kind, const char *image);
const struct glint_row *capture_row(const char *image);

#endif
