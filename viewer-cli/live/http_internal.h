/* What the files of the server share: who may ask, the connections, and how an answer is sent. */
#ifndef GLINT_VIEWER_LIVE_HTTP_INTERNAL_H
#define GLINT_VIEWER_LIVE_HTTP_INTERNAL_H

#include <microhttpd.h>
#include <pthread.h>

#include "live/http.h"

/* ---- Who may ask ---- */

enum { HTTP_TOKEN_LEAST = 16, HTTP_TOKEN_MOST = 256 };
struct http_guard {
    char host[64];      /* the address that the server listens at, as a Host has it: "127.0.0.1", "[::1]" */
    bool loopback, any; /* `any`: 0.0.0.0 or :: */
    uint16_t port;
    char token[HTTP_TOKEN_MOST + 1];
};
/* What a request's headers say; NULL: nothing. */
struct http_headers {
    const char *host, *origin, *site, *authorization, *length, *encoding;
    bool twice; /* one of them stands there twice */
};
struct http_refusal {
    int status;
    const char *code, *message;
    const char *name, *value; /* a header of the answer, or NULL */
};
/* Listens; returns the socket, or -1. Fills all of `guard`. */
int http_listen(struct http_guard *guard, const struct http_options *options, struct glint_error *err);
struct http_headers http_read_headers(struct MHD_Connection *connection);
/* Whether the request comes from the server's own page, or from no page. */
bool http_own_page(const struct http_guard *guard, const struct http_headers *headers, struct http_refusal *refusal);
bool http_has_token(const struct http_guard *guard, const struct http_headers *headers, struct http_refusal *refusal);
/* Whether the body that the headers announce is one to read; without `may_have_one` none is. */
bool http_body_allowed(const struct http_headers *headers, bool may_have_one, struct http_refusal *refusal);
/* Whether the query is UTF-8 without NULs. */
bool http_query_allowed(struct MHD_Connection *connection, struct http_refusal *refusal);

/* ---- Connections ---- */

/* Connections that only those can have that have shown no token: requests past HTTP_CONNECTIONS - HTTP_SPARE are refused. */
enum { HTTP_SPARE = 16 };
struct http_peer {
    int fd;       /* -1: the place is free */
    bool trusted; /* has shown the token */
    bool cut, working;
    int64_t since_ms;
};
struct http_peers {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    pthread_t sweeper;
    bool ending;
    unsigned working; /* requests of trusted connections that are being answered */
    struct http_peer list[HTTP_CONNECTIONS];
};
bool http_peers_init(struct http_peers *peers, struct glint_error *err);
/* Takes no more requests, and waits two seconds at most until the answers under way are sent. */
void http_peers_drain(struct http_peers *peers);
void http_peers_finish(struct http_peers *peers);
/* NULL: there is no place. */
struct http_peer *http_peers_add(struct http_peers *peers, int fd);
void http_peers_remove(struct http_peers *peers, struct http_peer *peer);
/* A request with the token begins. False: too many are under way, or the server ends. */
bool http_peers_begin(struct http_peers *peers, struct http_peer *peer);
void http_peers_end(struct http_peers *peers, struct http_peer *peer);

/* ---- Answers ---- */

/* Sends the answer, and releases what it holds. `name`: a further header, or NULL. */
enum MHD_Result http_send(struct MHD_Connection *connection, struct http_answer *answer, const char *name,
                          const char *value);
/* The page's response, to be sent any number of times; NULL without memory. */
struct MHD_Response *http_page_response(const char *page, size_t size);

#endif
