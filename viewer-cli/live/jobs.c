/* Work for the device: a queue, the one thread that works it off, and events about it. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "io/memory.h"
#include "live/live.h"
#include "options/args.h"

struct job {
    struct job *next;
    unsigned flags;
    const char *client;
    job_work work;
    void *data;
    struct glint_error err;
    bool ok, done, given_up;
    double told; /* when its progress was last an event */
};

/* ---- Events ---- */

static void say_locked(struct live *live, json_t *event) {
    char text[EVENT_BYTES]; /* the oldest line is left as it is if this one is too long */
    const size_t length = event ? json_dumpb(event, text, EVENT_BYTES - 2, JSON_COMPACT | JSON_ENSURE_ASCII) : 0;
    json_decref(event);
    if (!length || length > EVENT_BYTES - 2) return;
    memcpy(text + length, "\n", 2);
    memcpy(live->events.lines[live->events.count % EVENTS_KEPT], text, length + 2);
    live->events.count++;
    pthread_cond_broadcast(&live->changed);
}

void live_say(struct live *live, json_t *event) {
    pthread_mutex_lock(&live->lock);
    say_locked(live, event);
    pthread_mutex_unlock(&live->lock);
}

struct listener {
    struct live *live;
    uint64_t next;
};

/* The next event, or a sign of life after ten seconds without one. */
static size_t next_line(void *user, char *out, size_t size) {
    enum { ALIVE_SECONDS = 10 };
    struct listener *listener = user;
    struct live *live = listener->live;
    const char *line = "{\"event\":\"alive\"}\n";
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += ALIVE_SECONDS;
    pthread_mutex_lock(&live->lock);
    int waited = 0;
    while (!live->stopping && listener->next == live->events.count && waited == 0)
        waited = pthread_cond_timedwait(&live->changed, &live->lock, &until);
    if (live->events.count - listener->next > EVENTS_KEPT) listener->next = live->events.count - EVENTS_KEPT;
    if (listener->next < live->events.count) line = live->events.lines[listener->next++ % EVENTS_KEPT];
    const size_t length = live->stopping ? 0 : strlen(line);
    if (length && length <= size) memcpy(out, line, length);
    pthread_mutex_unlock(&live->lock);
    return length <= size ? length : 0;
}

void live_listen(void *user, const struct http_request *request, struct http_answer *answer) {
    (void)request;
    struct live *live = user;
    struct listener *listener = malloc(sizeof *listener);
    if (!listener) {
        http_refuse(answer, 500, "memory", "out of memory");
        return;
    }
    pthread_mutex_lock(&live->lock);
    *listener = (struct listener){live, live->events.count};
    pthread_mutex_unlock(&live->lock);
    *answer =
        (struct http_answer){.type = "application/x-ndjson", .next = next_line, .stream = listener, .close = free};
}

/* ---- The queue ---- */

static bool fail_interrupted(const struct live *live, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_INTERRUPTED,
                      live->stopping ? "the server is ending" : "a later request gave this one up");
}

/* Ends a job that has not begun. */
static void end_job(const struct live *live, struct job **at) {
    struct job *job = *at;
    *at = job->next;
    fail_interrupted(live, &job->err);
    job->done = true;
}

static void give_up_others(struct live *live) {
    if (live->running && !(live->running->flags & JOB_SHORT)) live->running->given_up = true;
    for (struct job **at = &live->jobs; *at;)
        if ((*at)->flags & JOB_SHORT) at = &(*at)->next;
        else end_job(live, at);
    pthread_cond_broadcast(&live->changed);
}

static void append_job(struct live *live, struct job *job) {
    struct job **at = &live->jobs;
    while (*at && (!(job->flags & JOB_SHORT) || (*at)->flags & JOB_SHORT)) at = &(*at)->next;
    job->next = *at;
    *at = job;
    pthread_cond_signal(&live->wake);
}

bool live_do(struct live *live, unsigned flags, const char *client, job_work work, void *data,
             struct glint_error *err) {
    struct job job = {.flags = flags, .client = client, .work = work, .data = data};
    pthread_mutex_lock(&live->lock);
    if (flags & JOB_URGENT) give_up_others(live);
    if (live->stopping) job.done = !fail_interrupted(live, &job.err);
    else append_job(live, &job);
    while (!job.done) pthread_cond_wait(&live->changed, &live->lock);
    pthread_mutex_unlock(&live->lock);
    if (!job.ok && err) *err = job.err;
    return job.ok;
}

bool live_progress(void *user, const char *what, double done) {
    enum { EVENTS_A_SECOND = 25 };
    struct live *live = user;
    const double now = glint_now_seconds();
    pthread_mutex_lock(&live->lock);
    struct job *job = live->running;
    const bool go_on = !live->stopping && job && !job->given_up;
    if (go_on && now - job->told > 1.0 / EVENTS_A_SECOND) {
        job->told = now;
        say_locked(live, json_pack("{s:s, s:s?, s:s, s:f}", "event", "progress", "client", job->client, "what", what,
                                   "done", done));
    }
    pthread_mutex_unlock(&live->lock);
    return go_on;
}

static void run_job(struct live *live, struct job *job) {
    live->running = job;
    live->idle = false;
    pthread_mutex_unlock(&live->lock);
    struct glint_error err = {0};
    memory_forget(); /* what an earlier job lacked */
    const bool ok = job->work(live, job->data, &err);
    if (live->device && glint_device_lost(live->device)) live_close(live); /* wherever the job found that */
    pthread_mutex_lock(&live->lock);
    live->running = NULL;
    job->ok = ok;
    job->err = err;
    if (!ok && err.code == GLINT_ERROR_INTERRUPTED) fail_interrupted(live, &job->err);
    job->done = true;
    pthread_cond_broadcast(&live->changed);
}

void *live_worker(void *user) {
    struct live *live = user;
    pthread_mutex_lock(&live->lock);
    while (!live->stopping) {
        struct job *job = live->jobs;
        if (job) {
            live->jobs = job->next;
            run_job(live, job);
        } else {
            if (!live->idle) say_locked(live, json_pack("{s:s}", "event", "idle"));
            live->idle = true;
            pthread_cond_wait(&live->wake, &live->lock);
        }
    }
    while (live->jobs) end_job(live, &live->jobs);
    pthread_cond_broadcast(&live->changed);
    pthread_mutex_unlock(&live->lock);
    live_close(live);
    return NULL;
}
