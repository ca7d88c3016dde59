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
    COCOON_SIZE = 32 /* shared/cocoon.glsl */,
    FIGURES = 512 /* survey/gbuffer.comp */
};

/* The frame that is loaded, and what was read of it so far. */
struct frame_source {
    struct glint_capture *capture;
    const struct glint_part_info **cubemaps; /* its cube maps, in order of their numbers */
    size_t cubemap_count;
    uint64_t serial;         /* of the load: contents of another capture never pass for this one's */
    char hash[33];           /* of the capture; "": not known yet */
    struct channels gbuffer; /* read for the survey, kept for the upload that follows it */
    struct channels sky;     /* read for its key, likewise */
    uint64_t sky_hash;       /* of its pixels; 0: not known yet */
    double seconds[PHASES];  /* since the load */
};
/* The capture's hash, found once. */
bool frame_source_hash(struct frame_source *source, char hash[33], struct glint_error *err);
bool frame_source_load(struct frame_source *source, struct glint_capture *capture, struct glint_error *err);
void frame_source_finish(struct frame_source *source);
/* Forgets pixels that were kept. */
void frame_source_release(struct frame_source *source);

/* Faces of the active cube maps that rays come to: bits of faces, +X the lowest. */
struct reach {
    bool known; /* else any may be */
    uint8_t crossed[GLINT_SURVEY_CUBEMAPS], nearby[GLINT_SURVEY_CUBEMAPS];
    bool *captured; /* beside graph.images: of the capture's, the other faces are left out */
    bool *limited;  /* beside graph.passes: the pass leaves the other faces out where rows RAY_MARGIN let it */
};

/* What each pass works on when nothing is left out. */
struct whole_work {
    uint64_t texels; /* rays included; 0 where it is not known */
    bool cached_work;
};

/* How a frame will be computed. The room plan/ fills it in; to everybody else it is const. */
struct frame_plan {
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
    struct frame_source *source;
    struct glint_run *inputs, *history; /* or NULL */
    struct graph graph;
    struct tables own_tables;
    struct tables *tables; /* own_tables, or those of the plan that this one serves */
    struct frame_sizes sizes;
    struct frame_block block;
    uint32_t *active; /* the capture's cube maps that take part, sizes.active of them */
    struct reach reach;
    struct whole_work *whole; /* beside graph.passes; NULL: not asked for */
    struct glint_cube_faces faces;
    char content[33]; /* hash of the capture; "": nothing of it is found again by other processes */
    bool is_cpu;      /* the device */
    bool interim;     /* another run of the same frame follows: what is on the device and was read stays */
};
void frame_plan_finish(struct frame_plan *plan);

/* given.c. The image of a run folder that one of the graph, or its level of that name, is read from; NULL: none. */
struct glint_run *plan_folder(const struct frame_plan *plan, const struct graph_image *image);
const struct glint_run_image *plan_given(const struct frame_plan *plan, const struct graph_image *image,
                                         const char *name);

/* sizes.c. Needs graph and tables; finds sizes and active. */
bool plan_find_sizes(struct frame_plan *plan, struct glint_error *err);
bool plan_describe(const struct frame_plan *plan, const struct graph_image *image, struct image_desc *desc,
                   struct glint_error *err);
uint32_t block_width(const struct frame_sizes *sizes, const struct glint_pass *pass); /* texels of an invocation */
uint32_t tile_count(const struct frame_sizes *sizes); /* of a list: passes/shared/work_list.h */

/* levels.c. The levels that a row DISPATCH_LEVELS names, from the finer to the coarser, of those that there are; false: none. */
bool dispatch_levels(const struct graph_pass *pass, const struct glint_row *row, const struct image_desc *desc,
                     uint32_t *first, uint32_t *last);
/* Texels that a dispatch over an image's level goes over. */
uint64_t dispatch_texels(const struct frame_sizes *sizes, const struct image_desc *desc, uint32_t level);

/* faces.c. The faces that lie within so many texels of a level of the rays; false: it is not known of that many. */
bool plan_faces(const struct frame_plan *plan, uint32_t level, int texels, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* Which faces of the graph's image number i are taken from the capture; false: all. */
bool plan_captured_faces(const struct frame_plan *plan, size_t i, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* The faces of a level that a row DISPATCH works on, by the row RAY_MARGIN behind it; false: all. */
bool plan_dispatched_faces(const struct frame_plan *plan, const struct graph_pass *pass, const struct glint_row *row,
                           uint32_t level, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
bool plan_limits(const struct frame_plan *plan, const struct graph_pass *pass);
uint32_t count_faces(const uint8_t *faces, uint32_t active);
/* Faces as runs of layers. */
struct face_run {
    uint32_t first, count;
};
enum { FACE_RUNS_MAX = 3 * GLINT_SURVEY_CUBEMAPS };
uint32_t face_runs(const uint8_t *faces, uint32_t active, struct face_run *runs);

#endif
