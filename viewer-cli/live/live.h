/* glint live: one replay that several pages and scripts share, what they ask of it, and what it keeps for them.

   Requests come on threads of the server. What needs the device is a job, which the one worker thread runs; everything else
   (checking states, drawing pictures from texels that are in memory) runs where it is asked for. */
#ifndef GLINT_VIEWER_LIVE_H
#define GLINT_VIEWER_LIVE_H

#include <pthread.h>

#include "draw/view/ocio.h"
#include "draw/view/source.h"
#include "glint/judge.h"
#include "io/temporary.h"
#include "live/http.h"
#include "options/pipeline_args.h"
#include "watch/watch.h"

/* ---- The captures of the command line, which does not change ---- */

struct live_frame {
    const char *path;
    uint32_t number, width, height;
    bool cut;
    bool has_draft; /* its draft is made */
};

/* ---- Events: lines of JSON that every listener gets ---- */

enum { EVENTS_KEPT = 256, EVENT_BYTES = 512 };
struct events {
    char lines[EVENTS_KEPT][EVENT_BYTES];
    uint64_t count; /* number of all events so far; the newest are kept */
};

/* ---- Images of runs in memory ---- */

enum { RUNS_KEPT = 256, ANSWERS_KEPT = 8, WATCHED = 4, RUN_ID = 17 };
/* Texels of an image. Counted: whoever draws it holds it while others come and go. */
struct held {
    struct held *next;
    char run[RUN_ID], image[128];
    struct source source;
    size_t bytes, users;
    uint64_t used_at;
    bool answer; /* of a reference or a truth, which no replay of a state makes again */
};
/* What an id stands for. */
struct run_entry {
    char id[RUN_ID];
    json_t *state; /* NULL: its images are answers */
    bool draft, quick;
    uint64_t used_at;
};
struct runs {
    struct held *held;
    struct run_entry entries[RUNS_KEPT];
    uint64_t clock;
    size_t bytes;
    char watched[WATCHED][128]; /* images that were asked for last: each run reads them back at once */
};

/* ---- Conversions to displays, each prepared once ---- */

enum { CONVERSIONS = 32 };
struct conversion {
    char display[128], view[128]; /* "": the default */
    struct ocio_conversion *ready;
};

/* ---- Everything ---- */

struct job;
struct live {
    const struct command *command;
    struct pipeline_args *args;
    const struct list *captures;
    const char *reference, *out; /* folders, or NULL */
    char *cache;                 /* a folder, or NULL */
    struct temporary temporary;  /* for drafts and pages */
    struct live_frame *frames;
    size_t count;         /* of frames */
    const char **presets; /* names that states may have, NULL-terminated */
    json_t *registry;

    pthread_mutex_t lock; /* of all that follows up to the conversions */
    pthread_cond_t wake, changed;
    struct job *jobs, *running;
    bool stopping, idle;
    uint64_t generation; /* of the files of shaders and presets */
    struct events events;
    struct runs runs;

    pthread_mutex_t converting; /* of the conversions */
    struct conversion conversions[CONVERSIONS];

    /* The worker's own. */
    struct glint_device *device;
    struct glint_replay *replay;
    struct glint_capture *capture; /* that is loaded, or NULL */
    size_t loaded;
    bool loaded_draft;
    uint64_t ran,
        before; /* keys of the states whose run of the loaded frame came last, and with which the frames before it ran; 0: none */
    json_t *times; /* ns of passes by their keys */
    struct glint_judge *judge;
    struct judged {
        const struct glint_effect *effect;
        uint32_t metrics;
        bool reference, truth;
        struct glint_capture *capture; /* that the judge has loaded, or NULL */
        size_t frame;
        uint64_t before; /* the key of the state with which the frames before it ran; 0: none */
        char *folder;    /* of references that are traced */
    } judged;
    pthread_t worker, watcher;
    bool working, watching; /* the threads run */
    struct watch_files files;
};

/* live.c. `live` has its command, args, captures and folders set; end it even after a failure. */
bool live_begin(struct live *live, struct glint_error *err);
/* Ends jobs and streams, before the server is stopped. */
void live_stop(struct live *live);
void live_end(struct live *live);
/* The conversion of colours for a display and view, which stays until the end. NULL on failure. */
const struct ocio_conversion *live_conversion(struct live *live, const struct ocio_options *options,
                                              struct glint_error *err);
/* answers.c */
extern const struct http_route live_routes[];

/* ---- States (state.c) ---- */

struct state {
    json_t *json; /* canonical */
    size_t capture;
    struct glint_pipeline *pipeline, *base; /* base: before `set` */
    const char **skip, **force;             /* NULL-terminated; texts of `json` */
    uint64_t key;                           /* hash of everything but the capture */
};
/* `json` may be NULL for the defaults. Names and values are checked; an error says what was expected. Finish it even after a failure. */
bool state_read(struct state *state, struct live *live, const json_t *json, struct glint_error *err);
void state_finish(struct state *state);
/* The slots in order of execution with their parameters, as docs/live.md has them. */
json_t *state_slots(const struct state *state, struct glint_error *err);
/* A command line that gives the same run, malloc'd. `folder`: where it writes. */
char *state_command(const struct live *live, const struct state *state, const char *folder);
/* Whether a pass of the pipeline reads images of the frame before. */
bool state_needs_history(const struct state *state);
/* The first frame that has to be replayed before the state's own: that of the last camera cut, or the own one. */
size_t state_first_frame(const struct live *live, const struct state *state);
/* The state that the command line describes. */
json_t *state_of_arguments(const struct pipeline_args *args, struct glint_error *err);

/* ---- Jobs (jobs.c) ---- */

enum {
    JOB_URGENT = 1, /* gives up those that wait or run, unless they are short */
    JOB_SHORT = 2   /* goes first, and is not given up */
};
/* On the worker thread. */
typedef bool (*job_work)(struct live *live, void *data, struct glint_error *err);
/* Has the worker do it and waits. Fails with GLINT_ERROR_INTERRUPTED if a later request gave it up. `client` names who asked in
   events; NULL: nobody. */
bool live_do(struct live *live, unsigned flags, const char *client, job_work work, void *data, struct glint_error *err);
/* A glint_progress for work on the worker thread; `user` is the struct live. */
bool live_progress(void *user, const char *what, double done);
void *live_worker(void *live); /* the thread's function */
/* Takes over the event. */
void live_say(struct live *live, json_t *event);
/* Answers /api/v1/events. */
void live_listen(void *live, const struct http_request *request, struct http_answer *answer);

/* ---- Replaying, on the worker thread (replaying.c) ---- */

bool live_open_device(struct live *live, struct glint_error *err);
/* Releases everything on the device, and the device; it is opened again when it is needed. */
void live_close(struct live *live);
/* The options for a state's replay. */
struct glint_replay_options live_options(const struct live *live, const struct state *state);
/* Opens the device if it is not, and replays the frames that the state needs up to and with its own. `quick`: the own one without compiling
   programs for new values. */
bool live_replay(struct live *live, const struct state *state, bool draft, bool quick, struct glint_error *err);
/* The same up to the frame itself, which is loaded and not run. */
bool live_load(struct live *live, const struct state *state, bool draft, struct glint_error *err);
/* Notes how the run of the loaded frame ended. After a fault of the device everything on it is released. */
bool live_ran(struct live *live, const struct state *state, bool ok, struct glint_error *err);
/* The path of a frame's capture at half the width and height, which is made when it is first asked for (draft.c). */
bool live_draft(struct live *live, size_t frame, char *path, size_t size, struct glint_error *err);
bool draft_path(const struct live *live, size_t frame, char *path, size_t size); /* false if there is no room for it */

/* ---- Runs and their images (runs.c) ---- */

/* Notes a run of the state; its id follows from what it depends on. `quick`: some of its images come from generic programs. */
void runs_note(struct live *live, const struct state *state, bool draft, bool quick, char id[RUN_ID]);
/* Keeps the images of the last replay that pages look at. On the worker thread. */
bool runs_keep_watched(struct live *live, const struct state *state, const char *id, struct glint_error *err);
/* The image of a run, replayed again if it is not in memory. Release it with runs_release. NULL on failure. */
struct held *runs_take(struct live *live, const char *id, const char *image, struct glint_error *err);
void runs_release(struct live *live, struct held *held);
/* Takes over the source as the only image of a run. */
void runs_keep_answer(struct live *live, struct source *source, char id[RUN_ID]);
void runs_finish(struct runs *runs);

/* ---- Figures, on the worker thread (figures.c) ---- */

void live_close_judge(struct live *live);

/* ---- Answers, by path; `live` is a struct live ---- */

json_t *live_registry(const struct live *live, struct glint_error *err);
void live_answer_registry(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_pipeline(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_run(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_picture(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_difference(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_values(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_answer(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_figures(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_probe(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_preset(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_report(void *live, const struct http_request *request, struct http_answer *answer);
void live_answer_write(void *live, const struct http_request *request, struct http_answer *answer);

#endif
