/* The shards of a search. Each shard runs the same search, which asks for the same points in the same order whichever shard evaluates them, and they share out each batch of
   evaluations. A shard locks a point on a capture while it evaluates it, and appends the figures to its own journal before it unlocks it; the lock also ends with the process. Each shard
   reads the journals of all. It begins with its own share of a batch, cut by cost, and then helps the others, so that a batch ends whether all shards run or only one. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

#include "inside.h"
#include "tune/tune.h"

/* The journal of another shard, and how far it is read. */
struct peer {
    struct shard shard;
    off_t at;
    bool checked; /* its search is this one */
};
struct tune_shards {
    struct peer *peers;
    size_t count;
    struct shard_cost *costs; /* of each capture */
    int claims;               /* the file CLAIMS in the folder of shards, whose bytes are locked */
    double waited;            /* seconds for which no other shard appended anything while this one had nothing to do */
};
static const char CLAIMS[] = "claims";

/* ---- The journals of the others ---- */

static bool peer_path(const struct tune *tune, const struct peer *peer, const char *name, char path[4096],
                      struct glint_error *err) {
    char folder[4096];
    return shard_folder(&peer->shard, tune->common, folder, err) && journal_path(folder, name, path, err);
}

static bool check_peer(const struct tune *tune, struct peer *peer, struct glint_error *err) {
    char path[4096];
    if (peer->checked) return true;
    if (!peer_path(tune, peer, "tune.json", path, err)) return false;
    json_t *theirs = json_inside(path, err);
    if (theirs && !json_equal(theirs, tune->definition))
        glint_fail(err, GLINT_ERROR_USAGE,
                   "%s: this shard's search has other arguments or captures, runs on another device, or is of another "
                   "version of glint",
                   path);
    else peer->checked = theirs != NULL;
    json_decref(theirs);
    return peer->checked;
}

static bool read_lines(struct tune *tune, struct peer *peer, FILE *log, const char *path, bool *some,
                       struct glint_error *err) {
    struct journal_line line = {0};
    enum journal_next next = JOURNAL_FAILED;
    bool ok = fseeko(log, peer->at, SEEK_SET) == 0 || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    while (ok && (next = journal_next_line(log, path, &line, err)) == JOURNAL_LINE) {
        json_t *json = journal_parse(&line);
        ok = (json && tune_keep_line(tune, json)) ||
             glint_fail(err, GLINT_ERROR_FORMAT, "%s: byte %lld: expected a line of a tune, found '%.80s'", path,
                        (long long)peer->at, line.text);
        peer->at += (off_t)line.length;
        *some = true;
        json_decref(json);
    }
    free(line.text);
    return ok && next != JOURNAL_FAILED;
}

/* Reads what the shard has appended since. A part of a line, which a kill leaves, is not read. */
static bool read_peer(struct tune *tune, struct peer *peer, bool *some, struct glint_error *err) {
    char path[4096];
    struct stat info;
    glint_file file;
    uint64_t bytes;
    if (!peer_path(tune, peer, "log.jsonl", path, err)) return false;
    if (lstat(path, &info) != 0 && errno == ENOENT) return true; /* not started */
    if (!check_peer(tune, peer, err) || !inside_open(&file, path, UINT64_MAX, &bytes, err)) return false;
    FILE *log = bytes > (uint64_t)peer->at ? fdopen((int)file, "rb") : NULL;
    if (!log) {
        glint_file_close(file);
        return bytes <= (uint64_t)peer->at || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    }
    const bool ok = read_lines(tune, peer, log, path, some, err);
    fclose(log);
    return ok;
}

static bool read_peers(struct tune *tune, bool *some, struct glint_error *err) {
    for (size_t i = 0; i < tune->shards->count; i++)
        if (!read_peer(tune, &tune->shards->peers[i], some, err)) return false;
    return true;
}

static bool add_peer(struct tune_shards *shards, struct shard shard, struct glint_error *err) {
    struct peer *larger = realloc(shards->peers, (shards->count + 1) * sizeof *larger);
    if (!larger) return fail_memory(err);
    shards->peers = larger;
    shards->peers[shards->count++] = (struct peer){.shard = shard};
    return true;
}

/* For the process that makes the result of all shards: those that the folder has. */
static bool find_peers(struct tune *tune, const char *folder, struct glint_error *err) {
    DIR *entries = opendir(folder);
    bool ok = true;
    for (const struct dirent *entry; ok && entries && (entry = readdir(entries));) {
        struct shard shard;
        if (shard_of_name(entry->d_name, &shard)) ok = add_peer(tune->shards, shard, err);
    }
    if (entries) closedir(entries);
    return ok;
}

/* ---- Shares ---- */

static bool weigh_captures(struct tune *tune, struct glint_error *err) {
    struct shard_cost *costs = tune->shards->costs = calloc(tune->captures.count + 1, sizeof *costs);
    bool ok = costs || fail_memory(err);
    for (size_t s = 0; ok && s < tune->captures.count; s++)
        ok = shard_pixels(tune->captures.items[s], &costs[s].each, err);
    return ok;
}

bool tune_shards_open(struct tune *tune, struct glint_error *err) {
    char folder[4096], path[4096];
    bool some;
    struct tune_shards *shards = tune->shards = calloc(1, sizeof *shards);
    if (!shards) return fail_memory(err);
    shards->claims = -1;
    if (!journal_path(tune->common, "shards", folder, err)) return false;
    if (!tune->shard.count) return find_peers(tune, folder, err) && read_peers(tune, &some, err);
    for (uint32_t k = 1; k <= tune->shard.count; k++)
        if (k != tune->shard.number && !add_peer(shards, (struct shard){k, tune->shard.count}, err)) return false;
    if (!journal_path(folder, CLAIMS, path, err)) return false;
    shards->claims = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (shards->claims < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    return weigh_captures(tune, err) && read_peers(tune, &some, err);
}

void tune_shards_close(struct tune *tune) {
    struct tune_shards *shards = tune->shards;
    if (!shards) return;
    if (shards->claims >= 0) close(shards->claims);
    free(shards->costs);
    free(shards->peers);
    free(shards);
    tune->shards = NULL;
}

enum claim { CLAIM_FAILED, CLAIM_HELD, CLAIM_MINE };

/* Locks or unlocks the byte that stands for this work. Two pieces of work that share a byte by chance are only done one after the other. */
static enum claim claim(const struct tune *tune, size_t capture, const json_t *values, bool take,
                        struct glint_error *err) {
    char *key = tune_point_key(capture, values);
    if (!key) return fail_memory(err), CLAIM_FAILED;
    struct flock lock = {.l_type = take ? F_WRLCK : F_UNLCK,
                         .l_whence = SEEK_SET,
                         .l_start = (off_t)(XXH3_64bits(key, strlen(key)) >> 2),
                         .l_len = 1};
    free(key);
    if (fcntl(tune->shards->claims, F_SETLK, &lock) == 0) return CLAIM_MINE;
    if (errno == EAGAIN || errno == EACCES) return CLAIM_HELD;
    glint_fail(err, GLINT_ERROR_IO, "%s/shards/%s: %s; shards of glint tune need a file system with locks",
               tune->common, CLAIMS, strerror(errno));
    return CLAIM_FAILED;
}

/* Does the work, unless another shard is doing it (*held) or has just finished it, which its journal tells. */
static bool try_work(struct tune *tune, size_t capture, const json_t *values, bool *held, struct glint_error *err) {
    bool some = false;
    const enum claim mine = claim(tune, capture, values, true, err);
    *held = mine == CLAIM_HELD;
    if (mine != CLAIM_MINE) return mine != CLAIM_FAILED;
    bool ok = read_peers(tune, &some, err);
    if (ok && !tune_is_known(tune, capture, values)) {
        ok = tune_do(tune, capture, values, err) && tune_report(tune, NULL, 0);
        if (ok && fdatasync(tune->journal.log) != 0)
            ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", tune->folder, strerror(errno));
        if (!ok && !err->code) glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
    }
    if (some) tune->shards->waited = 0;
    struct glint_error unlocked = {0};
    claim(tune, capture, values, false, &unlocked);
    return ok;
}

/* Work on all captures, in the order capture · points + point. */
struct batch {
    const json_t *points; /* NULL: the start */
    size_t each, count;   /* points, at least 1; all work */
    size_t begin, end;    /* this shard's share */
};

/* The i-th piece of work that this shard looks at: its own share in order, then the others' shares backwards, since their owners begin at the front. */
static size_t work_at(const struct batch *batch, size_t i) {
    const size_t own = batch->end - batch->begin;
    return i < own ? batch->begin + i : (batch->begin + batch->count - 1 - (i - own)) % batch->count;
}

/* Loading a capture takes time. Therefore this shard helps others with captures that it has loaded, and with others only when no shard has appended anything for a while. */
static bool may_work(const struct tune *tune, const struct batch *batch, size_t i, size_t capture) {
    enum { PATIENCE_SECONDS = 3 };
    return i < batch->end - batch->begin || tune->subjects[capture].judge || tune->shards->waited >= PATIENCE_SECONDS;
}

/* Goes over all work once. *left: pieces that are still missing; *worked: whether some was done. */
static bool work_through(struct tune *tune, const struct batch *batch, size_t *left, bool *worked,
                         struct glint_error *err) {
    for (size_t i = 0; i < batch->count; i++) {
        const size_t at = work_at(batch, i), capture = at / batch->each;
        const json_t *values = json_array_get(batch->points, at % batch->each);
        bool held = true;
        if (tune_is_known(tune, capture, values)) continue;
        if (may_work(tune, batch, i, capture) && !try_work(tune, capture, values, &held, err)) return false;
        *left += held;
        *worked |= !held;
    }
    return true;
}

static bool wait_for_others(struct tune *tune, double seconds, size_t left, struct glint_error *err) {
    const struct timespec pause = {(time_t)seconds, (long)(fmod(seconds, 1) * 1e9)};
    bool some = false;
    snprintf(tune->label, sizeof tune->label, "waiting for %zu evaluations of others", left);
    if (!tune_report(tune, NULL, 0)) return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
    nanosleep(&pause, NULL);
    if (!read_peers(tune, &some, err)) return false;
    tune->shards->waited = some ? 0 : tune->shards->waited + seconds;
    return true;
}

static bool share_batch(struct tune *tune, const struct batch *batch, struct glint_error *err) {
    static const double shortest = 0.005, longest = 0.5; /* seconds between two looks at the journals */
    size_t left = 1;
    for (double pause = shortest; left;) {
        bool worked = false;
        left = 0;
        if (!work_through(tune, batch, &left, &worked, err)) return false;
        pause = worked || tune->shards->waited == 0 ? shortest : fmin(2 * pause, longest);
        if (left && !wait_for_others(tune, pause, left, err)) return false;
    }
    return true;
}

bool tune_share(struct tune *tune, const json_t *points, struct glint_error *err) {
    struct batch batch = {.points = points, .each = points ? json_array_size(points) : 1};
    batch.count = batch.each * tune->captures.count;
    if (tune->shard.count) {
        shard_cut(&tune->shard, tune->shards->costs, tune->captures.count, batch.each, &batch.begin, &batch.end);
        return share_batch(tune, &batch, err);
    }
    for (size_t i = 0; i < batch.count; i++) {
        const size_t capture = i / batch.each;
        const json_t *values = json_array_get(points, i % batch.each);
        if (!tune_is_known(tune, capture, values) && !tune_do(tune, capture, values, err)) return false;
    }
    return true;
}
