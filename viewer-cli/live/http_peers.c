/* The connections of the server. Those that have not shown the token are closed before they can keep others out: after half a minute, and
   after a second when places are few. */
#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

#include "live/http_internal.h"

enum { UNTRUSTED_MS = 30000, CROWDED_MS = 1000, SWEEP_MS = 250, DRAIN_MS = 2000 };

static int64_t now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Waits for a change, until `until_ms` at most. */
static void wait_until(struct http_peers *peers, int64_t until_ms) {
    const struct timespec until = {.tv_sec = until_ms / 1000, .tv_nsec = until_ms % 1000 * 1000000};
    pthread_cond_timedwait(&peers->changed, &peers->mutex, &until);
}

/* ---- Closing what stays too long ---- */

/* Closes what has stayed too long; returns how many connections there are that have not shown the token. */
static unsigned sweep(struct http_peers *peers) {
    const int64_t now = now_ms();
    unsigned count = 0, untrusted = 0;
    for (size_t i = 0; i < HTTP_CONNECTIONS; i++) {
        count += peers->list[i].fd >= 0;
        untrusted += peers->list[i].fd >= 0 && !peers->list[i].trusted;
    }
    const int64_t longest = count > HTTP_CONNECTIONS - HTTP_SPARE ? CROWDED_MS : UNTRUSTED_MS;
    for (size_t i = 0; i < HTTP_CONNECTIONS; i++) {
        struct http_peer *peer = &peers->list[i];
        if (peer->fd < 0 || peer->trusted || peer->cut || now - peer->since_ms < longest) continue;
        shutdown(peer->fd, SHUT_RDWR); /* its thread sees an end, and leaves */
        peer->cut = true;
    }
    return untrusted;
}

static void *sweep_on(void *user) {
    struct http_peers *peers = user;
    pthread_mutex_lock(&peers->mutex);
    while (!peers->ending) {
        if (sweep(peers)) {
            const int64_t next = now_ms() + SWEEP_MS;
            while (!peers->ending && now_ms() < next) wait_until(peers, next);
        } else pthread_cond_wait(&peers->changed, &peers->mutex);
    }
    pthread_mutex_unlock(&peers->mutex);
    return NULL;
}

bool http_peers_init(struct http_peers *peers, struct glint_error *err) {
    pthread_condattr_t attributes;
    for (size_t i = 0; i < HTTP_CONNECTIONS; i++) peers->list[i].fd = -1;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&peers->mutex, NULL);
    pthread_cond_init(&peers->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    const int failed = pthread_create(&peers->sweeper, NULL, sweep_on, peers);
    if (!failed) return true;
    pthread_cond_destroy(&peers->changed);
    pthread_mutex_destroy(&peers->mutex);
    return glint_fail(err, GLINT_ERROR_MEMORY, "cannot start a thread: %s", strerror(failed));
}

void http_peers_drain(struct http_peers *peers) {
    pthread_mutex_lock(&peers->mutex);
    peers->ending = true;
    pthread_cond_broadcast(&peers->changed);
    const int64_t until = now_ms() + DRAIN_MS;
    while (peers->working > 0 && now_ms() < until) wait_until(peers, until);
    pthread_mutex_unlock(&peers->mutex);
}

void http_peers_finish(struct http_peers *peers) {
    pthread_mutex_lock(&peers->mutex);
    peers->ending = true;
    pthread_cond_broadcast(&peers->changed);
    pthread_mutex_unlock(&peers->mutex);
    pthread_join(peers->sweeper, NULL);
    pthread_cond_destroy(&peers->changed);
    pthread_mutex_destroy(&peers->mutex);
}

/* ---- What the server tells ---- */

struct http_peer *http_peers_add(struct http_peers *peers, int fd) {
    struct http_peer *peer = NULL;
    pthread_mutex_lock(&peers->mutex);
    for (size_t i = 0; i < HTTP_CONNECTIONS && !peer; i++)
        if (peers->list[i].fd < 0) peer = &peers->list[i];
    if (peer) *peer = (struct http_peer){.fd = fd, .since_ms = now_ms()};
    pthread_cond_broadcast(&peers->changed);
    pthread_mutex_unlock(&peers->mutex);
    return peer;
}

void http_peers_remove(struct http_peers *peers, struct http_peer *peer) {
    pthread_mutex_lock(&peers->mutex);
    peer->fd = -1;
    pthread_mutex_unlock(&peers->mutex);
}

bool http_peers_begin(struct http_peers *peers, struct http_peer *peer) {
    pthread_mutex_lock(&peers->mutex);
    const bool ok = !peers->ending && peers->working < HTTP_CONNECTIONS - HTTP_SPARE;
    peer->trusted = true;
    peer->working = ok;
    peers->working += ok;
    pthread_mutex_unlock(&peers->mutex);
    return ok;
}

void http_peers_end(struct http_peers *peers, struct http_peer *peer) {
    pthread_mutex_lock(&peers->mutex);
    peers->working -= peer->working;
    peer->working = false;
    pthread_cond_broadcast(&peers->changed);
    pthread_mutex_unlock(&peers->mutex);
}
