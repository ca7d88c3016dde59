/* Makes answers and sends them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/http_internal.h"
#include "record.h"

/* Sent when there is no memory for more. */
static const char no_memory[] = "{\"error\": \"out of memory\", \"code\": \"memory\"}";

enum { STREAM_BYTES = 16384 };

/* ---- Errors ---- */

json_t *http_text(const char *text) {
    json_t *made = json_string(text);
    char *plain = made ? NULL : strdup(text);
    if (!plain) return made;
    for (char *c = plain; *c; c++)
        if ((unsigned char)*c >= 0x80) *c = '?';
    made = json_string(plain);
    free(plain);
    return made;
}

void http_refuse(struct http_answer *answer, int status, const char *code, const char *message) {
    json_decref(answer->json);
    free(answer->data);
    if (answer->close) answer->close(answer->stream);
    *answer = (struct http_answer){.status = status,
                                   .json = json_pack("{so, ss}", "error", http_text(message), "code", code)};
}

void http_error(struct http_answer *answer, const struct glint_error *err) {
    static const struct {
        int status;
        const char *code;
    } of[] = {
        [GLINT_OK] = {500, "device"},
        [GLINT_ERROR_USAGE] = {400, "usage"},
        [GLINT_ERROR_IO] = {500, "io"},
        [GLINT_ERROR_FORMAT] = {500, "format"},
        [GLINT_ERROR_LIMIT] = {500, "format"},
        [GLINT_ERROR_UNSUPPORTED] = {500, "device"},
        [GLINT_ERROR_MEMORY] = {500, "memory"},
        [GLINT_ERROR_DEVICE] = {500, "device"},
        [GLINT_ERROR_INTERRUPTED] = {409, "superseded"},
    };
    const size_t code = err->code < sizeof of / sizeof *of ? err->code : GLINT_OK;
    http_refuse(answer, of[code].status, of[code].code, err->message);
}

/* ---- Headers ---- */

static void add_guards(struct MHD_Response *response) {
    static const char *const headers[][2] = {
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cache-Control", "no-store"},
        {"X-Frame-Options", "DENY"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
    };
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        MHD_add_response_header(response, headers[i][0], headers[i][1]);
}

static bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c && strchr("-._", c));
}

/* The name twice: with '_' for what is not plain, and, after RFC 8187, each of its bytes. */
static void add_download(struct MHD_Response *response, const char *name) {
    const size_t size = strlen(name);
    static const char start[] = "attachment; filename=\"", middle[] = "\"; filename*=UTF-8''";
    char *value = malloc(sizeof start + sizeof middle + 4 * size);
    if (!value) return;
    char *at = stpcpy(value, start);
    for (size_t i = 0; i < size; i++) *at++ = is_plain(name[i]) ? name[i] : '_';
    at = stpcpy(at, middle);
    for (size_t i = 0; i < size; i++)
        if (is_plain(name[i])) *at++ = name[i];
        else at += sprintf(at, "%%%02X", (unsigned)(unsigned char)name[i]);
    *at = 0;
    MHD_add_response_header(response, "Content-Disposition", value);
    free(value);
}

/* ---- Sending ---- */

struct stream {
    http_next next;
    void *user;
    void (*close)(void *user);
};

static ssize_t read_stream(void *user, uint64_t position, char *out, size_t size) {
    const struct stream *stream = user;
    const size_t written = stream->next(stream->user, out, size);
    (void)position;
    return written > 0 ? (ssize_t)written : MHD_CONTENT_READER_END_OF_STREAM;
}

static void close_stream(void *user) {
    struct stream *stream = user;
    if (stream->close) stream->close(stream->user);
    free(stream);
}

static struct MHD_Response *make_stream(struct http_answer *answer) {
    struct stream *stream = malloc(sizeof *stream);
    if (!stream) return NULL;
    *stream = (struct stream){answer->next, answer->stream, answer->close};
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, STREAM_BYTES, read_stream, stream, close_stream);
    if (response) answer->close = NULL; /* the response closes it */
    else free(stream);
    return response;
}

/* What the answer says, with its memory handed on. */
static struct MHD_Response *make(struct http_answer *answer) {
    if (answer->next) return make_stream(answer);
    if (!answer->type) {
        free(answer->data);
        answer->data = answer->json ? record_text(answer->json, JSON_COMPACT) : NULL;
        if (!answer->data) return NULL;
        answer->size = strlen(answer->data);
    }
    struct MHD_Response *response = MHD_create_response_from_buffer(answer->size, answer->data, MHD_RESPMEM_MUST_FREE);
    if (response) answer->data = NULL;
    return response;
}

enum MHD_Result http_send(struct MHD_Connection *connection, struct http_answer *answer, const char *name,
                          const char *value) {
    struct MHD_Response *response = make(answer);
    unsigned status = answer->status ? (unsigned)answer->status : 200;
    const char *type = answer->type ? answer->type : "application/json";
    if (!response) {
        response =
            MHD_create_response_from_buffer(sizeof no_memory - 1, (void *)(uintptr_t)no_memory, MHD_RESPMEM_PERSISTENT);
        status = 500;
        type = "application/json";
    }
    enum MHD_Result sent = MHD_NO;
    if (response) {
        MHD_add_response_header(response, "Content-Type", type);
        add_guards(response);
        if (answer->download && status < 300) add_download(response, answer->download);
        if (name) MHD_add_response_header(response, name, value);
        sent = MHD_queue_response(connection, status, response);
        MHD_destroy_response(response);
    }
    if (answer->close) answer->close(answer->stream);
    json_decref(answer->json);
    free(answer->data);
    *answer = (struct http_answer){0};
    return sent;
}

struct MHD_Response *http_page_response(const char *page, size_t size) {
    struct MHD_Response *response =
        MHD_create_response_from_buffer(size, (void *)(uintptr_t)page, MHD_RESPMEM_PERSISTENT);
    if (!response) return NULL;
    MHD_add_response_header(response, "Content-Type", "text/html; charset=utf-8");
    add_guards(response);
    return response;
}
