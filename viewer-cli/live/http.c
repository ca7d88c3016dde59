/* The HTTP server of glint live over libmicrohttpd: takes requests, reads their bodies, and calls the routes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <signal.h>
#include <unistd.h>

#include "live/http_internal.h"

/* Headers have to fit into CONNECTION_BYTES. A connection without the token is closed after UNTRUSTED_S seconds without a byte, one with it
   after TRUSTED_S. Replays, drawings and colour conversions were measured to need 160 KiB of stack at most; a stack of a MiB is too small
   for a large page, of which each thread would take 2 MiB. */
enum { CONNECTION_BYTES = 16384, STACK_BYTES = 1 << 20, UNTRUSTED_S = 10, TRUSTED_S = 30 };

struct http {
    struct http_options options;
    struct http_guard guard;
    struct http_peers peers;
    struct MHD_Daemon *daemon;
    struct MHD_Response *page;
};

/* A request, from its first line until its answer is sent. */
struct request {
    struct http_peer *peer;
    bool admitted;
    char *body;
    size_t size, room;
    size_t dropped; /* bytes past the limit */
    char path[];    /* as it was sent: what is written with % is no path of this server */
};

const char *http_query(const struct http_request *request, const char *name) {
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

/* ---- Who may ask ---- */

static enum MHD_Result refuse(struct MHD_Connection *connection, const struct http_refusal *refusal) {
    struct http_answer answer = {0};
    http_refuse(&answer, refusal->status, refusal->code, refusal->message);
    return http_send(connection, &answer, refusal->name, refusal->value);
}

static bool is_page(const struct request *request) {
    return !strcmp(request->path, "/");
}

/* The route, or NULL and why; `allow` takes the methods of the path. */
static const struct http_route *find_route(const struct http *http, const struct request *request, const char *method,
                                           char *allow, size_t size, struct http_refusal *refusal) {
    size_t used = 0;
    allow[0] = 0;
    for (const struct http_route *route = http->options.routes; route->path; route++) {
        if (strcmp(route->path, request->path)) continue;
        if (!strcmp(route->method, method)) return route;
        const int more = snprintf(allow + used, size - used, "%s%s", used ? ", " : "", route->method);
        if (more > 0 && (size_t)more < size - used) used += (size_t)more;
    }
    *refusal = used ? (struct http_refusal){405, "unknown", "this path has no such method", "Allow", allow}
                    : (struct http_refusal){404, "unknown", "there is no such path", NULL, NULL};
    return NULL;
}

/* Decides by the headers alone, before any of the body is read. */
static bool admit(struct http *http, struct MHD_Connection *connection, struct request *request, const char *method,
                  char *allow, size_t size, struct http_refusal *refusal) {
    const struct http_headers headers = http_read_headers(connection);
    if (!http_own_page(&http->guard, &headers, refusal)) return false;
    if (is_page(request)) {
        if (!strcmp(method, "GET") || !strcmp(method, "HEAD")) return http_body_allowed(&headers, false, refusal);
        *refusal = (struct http_refusal){405, "unknown", "the page can be read only", "Allow", "GET, HEAD"};
        return false;
    }
    if (strncmp(request->path, "/api/", 5)) {
        *refusal = (struct http_refusal){404, "unknown", "there is no such path", NULL, NULL};
        return false;
    }
    if (!http_has_token(&http->guard, &headers, refusal)) return false;
    if (!request->peer || !http_peers_begin(&http->peers, request->peer)) {
        *refusal = (struct http_refusal){503, "busy", "too many requests at once, or the server is ending", NULL, NULL};
        return false;
    }
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, (unsigned)TRUSTED_S);
    return find_route(http, request, method, allow, size, refusal) && http_body_allowed(&headers, true, refusal) &&
           http_query_allowed(connection, refusal);
}

/* ---- Bodies ---- */

/* Keeps a part of the body. Of one that is too long as much again is read, so that its sender can see the answer; false: it does not end. */
static bool take_body(struct request *request, const char *part, size_t size) {
    if (request->dropped > 0 || size > HTTP_BODY_BYTES - request->size) {
        free(request->body);
        request->body = NULL;
        request->dropped += request->size + size;
        request->size = request->room = 0;
        return request->dropped <= 2 * (size_t)HTTP_BODY_BYTES;
    }
    if (request->size + size > request->room) {
        const size_t twice = 2 * (request->size + size), room = twice < HTTP_BODY_BYTES ? twice : HTTP_BODY_BYTES;
        char *larger = realloc(request->body, room);
        if (!larger) return false;
        request->body = larger;
        request->room = room;
    }
    memcpy(request->body + request->size, part, size);
    request->size += size;
    return true;
}

static json_t *parse(const struct request *request, struct http_answer *answer) {
    json_error_t error;
    char message[400];
    json_t *body = json_loadb(request->body, request->size, JSON_REJECT_DUPLICATES, &error);
    if (json_is_object(body)) return body;
    if (body) snprintf(message, sizeof message, "the body has to be a JSON object; found an array");
    else
        snprintf(message, sizeof message, "the body has to be a JSON object; line %d, column %d: %s", error.line,
                 error.column, error.text);
    json_decref(body);
    http_refuse(answer, 400, "format", message);
    return NULL;
}

static enum MHD_Result answer(struct http *http, struct MHD_Connection *connection, struct request *request,
                              const char *method) {
    struct http_refusal refusal;
    struct http_answer answer = {0};
    char allow[64];
    json_t *body = NULL;
    if (is_page(request)) return MHD_queue_response(connection, 200, http->page);
    const struct http_route *route = find_route(http, request, method, allow, sizeof allow, &refusal);
    if (request->dropped > 0) http_refuse(&answer, 413, "size", "the body is larger than 1 MiB");
    else if (request->size > 0) body = parse(request, &answer);
    free(request->body);
    request->body = NULL;
    if (!answer.status) {
        const struct http_request asked = {
            .method = method, .path = request->path, .body = body, .connection = connection};
        route->handler(http->options.user, &asked, &answer);
    }
    json_decref(body);
    return http_send(connection, &answer, NULL, NULL);
}

/* ---- What libmicrohttpd calls ---- */

/* The first line of a request has been read. */
static void *begin_request(void *user, const char *uri, struct MHD_Connection *connection) {
    const size_t size = strcspn(uri, "?");
    struct request *request = calloc(1, sizeof *request + size + 1);
    (void)user;
    if (!request) return NULL;
    memcpy(request->path, uri, size);
    request->peer = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT)->socket_context;
    return request;
}

static void end_request(void *user, struct MHD_Connection *connection, void **context,
                        enum MHD_RequestTerminationCode how) {
    struct http *http = user;
    struct request *request = *context;
    (void)connection, (void)how;
    if (!request) return;
    if (request->peer) http_peers_end(&http->peers, request->peer);
    free(request->body);
    free(request);
    *context = NULL;
}

static enum MHD_Result take(void *user, struct MHD_Connection *connection, const char *url, const char *method,
                            const char *version, const char *part, size_t *size, void **context) {
    struct http *http = user;
    struct request *request = *context;
    struct http_refusal refusal;
    char allow[64];
    (void)url, (void)version;
    if (!request) return MHD_NO; /* no memory: the connection is closed */
    if (!request->admitted) {
        request->admitted = admit(http, connection, request, method, allow, sizeof allow, &refusal);
        return request->admitted ? MHD_YES : refuse(connection, &refusal);
    }
    if (*size == 0) return answer(http, connection, request, method);
    const bool ok = take_body(request, part, *size);
    *size = 0;
    return ok ? MHD_YES : MHD_NO;
}

static void connection_changed(void *user, struct MHD_Connection *connection, void **context,
                               enum MHD_ConnectionNotificationCode what) {
    struct http *http = user;
    if (what == MHD_CONNECTION_NOTIFY_STARTED)
        *context = http_peers_add(&http->peers,
                                  MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd);
    else if (*context) http_peers_remove(&http->peers, *context);
}

/* ---- Start and stop ---- */

/* Its threads wait by select(), not by poll(): with poll() version 0.9.75 spins in the last second before a timeout. */
static bool start(struct http *http, int fd, struct glint_error *err) {
    sigset_t all, before;
    http->page = http_page_response(http->options.page, http->options.page_bytes);
    if (!http->page) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    sigfillset(&all); /* signals are for the program's own threads */
    pthread_sigmask(SIG_BLOCK, &all, &before);
    bool ok = http_peers_init(&http->peers, err);
    if (ok) {
        http->daemon = MHD_start_daemon(
            MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_ITC, 0, NULL, NULL, take, http,
            MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_CONNECTION_LIMIT, (unsigned)HTTP_CONNECTIONS,
            MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)UNTRUSTED_S, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
            (size_t)CONNECTION_BYTES, MHD_OPTION_THREAD_STACK_SIZE, (size_t)STACK_BYTES, MHD_OPTION_STRICT_FOR_CLIENT,
            1, MHD_OPTION_URI_LOG_CALLBACK, begin_request, http, MHD_OPTION_NOTIFY_COMPLETED, end_request, http,
            MHD_OPTION_NOTIFY_CONNECTION, connection_changed, http, MHD_OPTION_END);
        ok = http->daemon || glint_fail(err, GLINT_ERROR_IO, "cannot start the HTTP server");
        if (!ok) http_peers_finish(&http->peers);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return ok;
}

struct http *http_start(const struct http_options *options, struct glint_error *err) {
    struct http *http = calloc(1, sizeof *http);
    if (!http) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    http->options = *options;
    const int fd = http_listen(&http->guard, options, err);
    if (fd >= 0 && start(http, fd, err))
        return http; /* without success libmicrohttpd may have closed the socket, or not */
    if (http->page) MHD_destroy_response(http->page);
    free(http);
    return NULL;
}

uint16_t http_port(const struct http *http) {
    return http->guard.port;
}

void http_stop(struct http **http) {
    struct http *h = *http;
    if (!h) return;
    const int fd = MHD_quiesce_daemon(h->daemon);
    http_peers_drain(&h->peers);
    MHD_stop_daemon(h->daemon);
    http_peers_finish(&h->peers);
    close(fd);
    MHD_destroy_response(h->page);
    free(h);
    *http = NULL;
}
