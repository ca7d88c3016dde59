/* A server of a few routes for live_server.py: http_host [ADDRESS [PORT]]. Prints its port and token as JSON, and ends when its input does. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "live/http.h"

struct host {
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    bool ending;
    unsigned calls, streams; /* handlers called so far, streams that are open */
};
struct ticks {
    struct host *host;
    unsigned next;
};

static const char *text_of(const struct http_request *request, const char *name) {
    const char *value = http_query(request, name);
    return value ? value : "";
}

/* Waits, but not past the end; whether the end has come. */
static bool wait_ms(struct host *host, long ms) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += (until.tv_nsec / 1000000 + ms) / 1000;
    until.tv_nsec = (until.tv_nsec / 1000000 + ms) % 1000 * 1000000;
    pthread_mutex_lock(&host->mutex);
    while (!host->ending && pthread_cond_timedwait(&host->ended, &host->mutex, &until) == 0) continue;
    const bool ending = host->ending;
    pthread_mutex_unlock(&host->mutex);
    return ending;
}

static void count(struct host *host, unsigned calls, int streams) {
    pthread_mutex_lock(&host->mutex);
    host->calls += calls;
    host->streams += (unsigned)streams;
    pthread_mutex_unlock(&host->mutex);
}

static void echo(void *user, const struct http_request *request, struct http_answer *answer) {
    count(user, 1, 0);
    answer->json = json_pack("{ss, ss, ss, sO?}", "method", request->method, "path", request->path, "text",
                             text_of(request, "text"), "body", request->body);
}

static void counts(void *user, const struct http_request *request, struct http_answer *answer) {
    struct host *host = user;
    (void)request;
    pthread_mutex_lock(&host->mutex);
    answer->json = json_pack("{si, si}", "calls", (int)host->calls, "streams", (int)host->streams);
    pthread_mutex_unlock(&host->mutex);
}

static void block(void *user, const struct http_request *request, struct http_answer *answer) {
    count(user, 1, 0);
    const bool ending = wait_ms(user, atol(text_of(request, "ms")));
    answer->json = json_pack("{sb}", "ended", ending);
}

static void large(void *user, const struct http_request *request, struct http_answer *answer) {
    count(user, 1, 0);
    answer->size = (size_t)atol(text_of(request, "bytes"));
    answer->data = malloc(answer->size);
    if (answer->data) memset(answer->data, 'x', answer->size);
    answer->type = "application/octet-stream";
    answer->download = http_query(request, "name");
}

static void fail(void *user, const struct http_request *request, struct http_answer *answer) {
    struct glint_error err;
    count(user, 1, 0);
    glint_fail(&err, (enum glint_code)atol(text_of(request, "code")), "message \xff of \"%s\"",
               text_of(request, "text"));
    http_error(answer, &err);
}

static size_t tick(void *user, char *out, size_t size) {
    struct ticks *ticks = user;
    if (ticks->next > 0 && wait_ms(ticks->host, 20)) return 0;
    return (size_t)snprintf(out, size, "{\"tick\": %u}\n", ticks->next++);
}

static void end_ticks(void *user) {
    struct ticks *ticks = user;
    count(ticks->host, 0, -1);
    free(ticks);
}

static void events(void *user, const struct http_request *request, struct http_answer *answer) {
    struct ticks *ticks = calloc(1, sizeof *ticks);
    (void)request;
    if (!ticks) return;
    count(user, 1, 1);
    ticks->host = user;
    *answer = (struct http_answer){.type = "application/x-ndjson", .next = tick, .stream = ticks, .close = end_ticks};
}

int main(int argc, char **argv) {
    static const struct http_route routes[] = {{"GET", "/api/v1/echo", echo},     {"POST", "/api/v1/echo", echo},
                                               {"GET", "/api/v1/counts", counts}, {"GET", "/api/v1/block", block},
                                               {"GET", "/api/v1/large", large},   {"GET", "/api/v1/fail", fail},
                                               {"GET", "/api/v1/events", events}, {NULL, NULL, NULL}};
    static const char page[] = "<!doctype html><title>host</title>";
    struct host host = {.mutex = PTHREAD_MUTEX_INITIALIZER, .ended = PTHREAD_COND_INITIALIZER};
    char token[2 * HTTP_TOKEN_BYTES + 1];
    struct glint_error err;
    if (!http_new_token(token, &err)) return fprintf(stderr, "%s\n", err.message), 2;
    struct http *http = http_start(&(struct http_options){.address = argc > 1 ? argv[1] : NULL,
                                                          .port = (uint16_t)(argc > 2 ? atol(argv[2]) : 0),
                                                          .token = token,
                                                          .routes = routes,
                                                          .user = &host,
                                                          .page = page,
                                                          .page_bytes = sizeof page - 1},
                                   &err);
    if (!http) return fprintf(stderr, "%s\n", err.message), 1;
    printf("{\"port\": %u, \"token\": \"%s\"}\n", (unsigned)http_port(http), token);
    fflush(stdout);
    while (getchar() != EOF) continue;
    pthread_mutex_lock(&host.mutex);
    host.ending = true;
    pthread_cond_broadcast(&host.ended);
    pthread_mutex_unlock(&host.mutex);
    http_stop(&http);
    if (host.streams) return fprintf(stderr, "%u streams were not closed\n", host.streams), 3;
    return http ? 3 : 0;
}
