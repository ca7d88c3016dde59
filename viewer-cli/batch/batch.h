/* A command that is cut into shards, as jobs of Slurm: job scripts, what was submitted, how far the shards are. Queueing, placing, retries and limits are Slurm's;
   the shards of a folder that something else runs are read just as well. */
#ifndef GLINT_VIEWER_BATCH_H
#define GLINT_VIEWER_BATCH_H

#include <jansson.h>

#include "glint/common.h"
#include "options/args.h"

/* Numbers of jobs, and states and reasons in Slurm's words. */
enum { BATCH_WORD = 64, BATCH_MOST_SHARDS = 10000 };
struct batch_job {
    char job[BATCH_WORD];    /* "": never submitted */
    char state[BATCH_WORD];  /* "RUNNING"; "": not known to Slurm, or no longer */
    char reason[BATCH_WORD]; /* why it waits, or "" */
};
struct batch_shard {
    struct batch_job job;  /* the array that has it last */
    bool begun, done;      /* whether it was ever started, and whether all its results are there */
    size_t results, total; /* whole lines of its journal, and how many there will be, fewer where points fail */
    double per_second;     /* since it was started last; NAN: not known, or done */
};
struct batch {
    const char *folder;
    char command[BATCH_WORD]; /* "sweep" */
    char result[BATCH_WORD];  /* the file that the command writes last; "": not known */
    json_t *record;           /* batch.json; NULL: something else than glint batch started the shards */
    struct batch_shard *shards;
    size_t count;
    double changed;         /* when a shard was started or done last */
    struct batch_job merge; /* the last one */
    bool asked;             /* Slurm has been, and answered */
    struct glint_folder_lock *lock;
};

/* ---- record.c ---- */

/* A new one: makes the folder and keeps others from submitting. A folder from which a batch was submitted is an error. */
bool batch_create(struct batch *batch, const char *folder, const char *command, size_t shards, struct glint_error *err);
/* The one in the folder, or only its shards. `lock` keeps others from submitting. */
bool batch_open(struct batch *batch, const char *folder, bool lock, struct glint_error *err);
void batch_finish(struct batch *batch);
/* Note that the chosen shards were submitted as an array, or that the merge was, and write batch.json. */
bool batch_note_array(struct batch *batch, const char *job, const bool *chosen, struct glint_error *err);
bool batch_note_merge(struct batch *batch, const char *job, struct glint_error *err);
bool batch_write(const struct batch *batch, struct glint_error *err);
/* "FOLDER/name" in at most 4096 bytes. */
bool batch_path(const struct batch *batch, const char *name, char path[4096], struct glint_error *err);

/* ---- script.c ---- */

#define BATCH_SHARD_SCRIPT "shard.sbatch"
#define BATCH_MERGE_SCRIPT "merge.sbatch"
#define BATCH_LOGS "logs"
struct batch_script {
    const char *output;          /* the folder, as the command names it */
    const char *option;          /* of the command that takes it: "output" */
    const char *const *options;  /* of the command */
    const char *const *operands; /* captures */
    const char *partition;       /* NULL: Slurm's default */
    uint32_t gpus;               /* a task; 0: Slurm's default */
    const char *const *sbatch;   /* further options, such as "--time=1:00:00" */
};
/* Writes both job scripts. They go into the folder in which glint was called, and call the same executable file. */
bool batch_write_scripts(const struct batch *batch, const struct batch_script *script, struct glint_error *err);

/* ---- shards.c ---- */

/* Reads how far each shard is. */
bool batch_read_shards(struct batch *batch, struct glint_error *err);
/* Whether the merged results of these shards are there. */
bool batch_is_merged(const struct batch *batch);
/* "1-3,7" of the shards that are chosen, malloc'd. */
char *batch_list(const bool *chosen, size_t count);

/* ---- slurm.c ---- */

/* Asks Slurm for the states of all jobs, if there are any. False with an error if it does not answer. */
bool batch_ask(struct batch *batch, struct glint_error *err);
/* Whether a job waits or runs. */
bool batch_job_active(const struct batch_job *job);
/* Submits these shards, if any, and a merge job that waits for them and for shards that are waiting or running already. */
bool batch_submit(struct batch *batch, const bool *chosen, struct glint_error *err);
/* Takes these jobs out of the queue. */
bool batch_cancel(const struct batch *batch, const char *const *jobs, struct glint_error *err);

/* ---- status.c ---- */

/* Chooses the shards that are neither done, nor waiting or running; how many. */
size_t batch_choose(const struct batch *batch, bool *chosen);
json_t *batch_json(const struct batch *batch);
void batch_print(const struct batch *batch);

#endif
