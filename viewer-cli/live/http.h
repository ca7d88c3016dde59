/* The HTTP server of glint live: connections, who may ask, bodies and answers. It knows nothing of replays. */
#ifndef GLINT_VIEWER_LIVE_HTTP_H
#define GLINT_VIEWER_LIVE_HTTP_H

#include <jansson.h>
#include <stdint.h>

#include "glint/common.h"

enum { HTTP_BODY_BYTES = 1 << 20, HTTP_CONNECTIONS = 128, HTTP_TOKEN_BYTES = 32 };

struct http_request {
    const char *method, *path; /* the path without its query: "/api/v1/run" */
    const json_t *body;        /* an object; NULL without a body */
    void *connection;
};
/* The decoded value of `name` in the query, or NULL; valid during the request. */
const char *http_query(const struct http_request *request, const char *name);

/* The next part of an answer that is made while it is sent: writes at most `size` bytes to `out` and returns how many, waiting until
   there are some; 0 ends the answer. */
typedef size_t (*http_next)(void *stream, char *out, size_t size);
struct http_answer {
    int status;       /* 200 if it is left 0 */
    const char *type; /* of what `data` holds, such as "text/html"; NULL: JSON, which is taken from `json` */
    json_t *json;     /* taken over; an error is made by http_error */
    void *data;       /* malloc'd, taken over */
    size_t size;
    const char *download; /* a file name that a browser stores it under, or NULL */
    http_next next;       /* a stream instead of data */
    void *stream;
    void (*close)(void *stream);
};
/* The text as JSON: messages about files and requests need not be UTF-8. NULL: out of memory. */
json_t *http_text(const char *text);
/* {"error", "code"}; the status follows from the error's code. */
void http_error(struct http_answer *answer, const struct glint_error *err);
/* The same with a status and a code of its own. */
void http_refuse(struct http_answer *answer, int status, const char *code, const char *message);

/* Answers a request. Each connection has a thread of its own, in which this may wait. */
typedef void (*http_handler)(void *user, const struct http_request *request, struct http_answer *answer);
struct http_route {
    const char *method, *path;
    http_handler handler;
};
/* All pointers but `address` and `token` are to be valid until http_stop. */
struct http_options {
    const char *address;             /* to listen at, an IP address, also 0.0.0.0 or ::; NULL: 127.0.0.1 */
    uint16_t port;                   /* 0: any free one */
    const char *token;               /* 16 to 256 letters, digits and signs of ASCII */
    const struct http_route *routes; /* below /api/; the last has no path */
    void *user;
    const char *page; /* what "/" is, and with it the only thing that needs no token */
    size_t page_bytes;
};
struct http;
struct http *http_start(const struct http_options *options, struct glint_error *err);
uint16_t http_port(const struct http *http);
/* Takes no more requests and waits for the threads of those under way: streams and waiting handlers have to end first. Answers that are made
   are still sent, to clients that take them within two seconds. */
void http_stop(struct http **http);
/* Fills `token` with new random hexadecimal digits. */
bool http_new_token(char token[2 * HTTP_TOKEN_BYTES + 1], struct glint_error *err);

#endif
