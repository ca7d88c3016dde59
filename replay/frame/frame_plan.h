/* The loaded frame, and the plan of how it will be computed. */
#ifndef GLINT_REPLAY_FRAME_PLAN_H
#define GLINT_REPLAY_FRAME_PLAN_H

#include "channels.h"
#include "format.h"
#include "frame_block.h"
#include "tables.h"
#include "timing.h"

enum {
    LIST_WIDTH = 256,
    SMALL_FACE = 32 /* of GLINT_SIZE_COCOON (shared/cocoon.glsl) */,
    FIGURES = 512 /* survey/gbuffer.comp */
};

/* The loaded frame, and what has been read of it so far. */
struct frame_source {
    struct glint_capture *capture;
    const struct glint_part_info **cubemaps; /* its cube maps by number */
    size_t cubemap_count;
    uint64_t serial;         /* number of the load, which distinguishes the images of different captures */
    char hash[33];           /* of the capture; "": not computed yet */
    struct channels gbuffer; /* read for the survey and kept for the upload after it */
    struct channels sky;     /* read for its hash and kept for the upload after it */
    uint64_t sky_hash;       /* of the sky's pixels; 0: not computed yet */
    double seconds[PHASES];  /* time spent since the load */
};
/* The capture's hash, computed once. */
bool frame_source_hash(struct frame_source *source, char hash[33], struct glint_error *err);
bool frame_source_load(struct frame_source *source, struct glint_capture *capture, struct glint_error *err);
void frame_source_finish(struct frame_source *source);
/* Frees pixels that were kept. */
void frame_source_release(struct frame_source *source);

/* Faces of the active cube maps that rays reach, as masks with +X in the lowest bit. */
struct reach {
    bool known; /* false: rays may reach every face */
    uint8_t crossed[GLINT_SURVEY_CUBEMAPS], nearby[GLINT_SURVEY_CUBEMAPS];
    bool *captured; /* for each of graph.images: an image of the capture of which only reached faces are uploaded */
    bool *limited;  /* for each of graph.passes: dispatches with a row RAY_MARGIN are limited to reached faces */
};

/* The work of a pass when nothing is culled. */
struct whole_work {
    uint64_t texels; /* over all rays; 0 if unknown */
    bool cached_work;
};

/* How a frame will be computed. The planner (plan/) fills it in; for all others it is const. */
struct frame_plan {
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
    struct frame_source *source;
    struct glint_run *inputs, *history; /* or NULL */
    struct graph graph;
    struct tables own_tables;
    struct tables *tables; /* own_tables, or for a survey those of the plan that needs it */
    struct frame_sizes sizes;
    struct frame_block block;
    uint32_t *active; /* indices of the active cube maps in the capture, sizes.active of them */
    struct reach reach;
    struct whole_work *whole; /* for each of graph.passes, or NULL */
    struct glint_cube_faces faces;
    char content[33]; /* hash of the capture for the cache of files; "": the cache is not used */
    bool is_cpu;      /* that of struct glint_device_info */
    bool interim;     /* a run of the survey: another run of the frame follows, for which images and pixels are kept */
};
void frame_plan_finish(struct frame_plan *plan);

/* stored.c: the run folder that an image of the graph is read from, and the stored image of that name (of the image or of one of its MIP
   levels), or NULL. */
struct glint_run *plan_stored_run(const struct frame_plan *plan, const struct graph_image *image);
const struct glint_run_image *plan_stored_image(const struct frame_plan *plan, const struct graph_image *image,
                                                const char *name);

/* sizes.c: sets sizes and active from the graph and the tables. */
bool plan_find_sizes(struct frame_plan *plan, struct glint_error *err);
bool plan_describe(const struct frame_plan *plan, const struct graph_image *image, struct image_desc *desc,
                   struct glint_error *err);
/* The number of tiles of a list (passes/shared/work_list.h). */
uint32_t tile_count(const struct frame_sizes *sizes);

/* levels.c: the finest and coarsest MIP level of a row DISPATCH_LEVELS, among those that the image has; false if there is none. */
bool dispatch_levels(const struct frame_sizes *sizes, const struct graph_pass *pass, const struct glint_row *row,
                     const struct image_desc *desc, uint32_t *first, uint32_t *last);
/* The number of texels of a dispatch over a MIP level of an image. */
uint64_t dispatch_texels(const struct frame_sizes *sizes, const struct image_desc *desc, uint32_t level);

/* faces.c: the faces that rays reach or pass within a margin, in texels of a MIP level; false if the survey does not cover that margin. */
bool plan_faces(const struct frame_plan *plan, uint32_t level, int texels, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* The faces of image i of the graph that are uploaded from the capture; false: all. */
bool plan_captured_faces(const struct frame_plan *plan, size_t i, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* The faces of a MIP level that a row DISPATCH runs over, by the row RAY_MARGIN that follows it; false: all. */
bool plan_dispatched_faces(const struct frame_plan *plan, const struct graph_pass *pass, const struct glint_row *row,
                           uint32_t level, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* Whether dispatches of the pass are limited to reached faces. */
bool plan_limits(const struct frame_plan *plan, const struct graph_pass *pass);
uint32_t count_faces(const uint8_t *faces, uint32_t active);
/* The layers of faces as runs of successive layers. */
struct face_run {
    uint32_t first, count;
};
enum { FACE_RUNS_MAX = 3 * GLINT_SURVEY_CUBEMAPS };
uint32_t face_runs(const uint8_t *faces, uint32_t active, struct face_run *runs);

#endif
