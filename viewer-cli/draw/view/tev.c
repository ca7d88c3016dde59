/* Sends images to a running tev. A message is its length in bytes, its type and its fields, all little-endian. */
#include "draw/view/tev.h"

#include <errno.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { CREATE_IMAGE = 4, UPDATE_IMAGE = 6 /* with offsets and strides of channels */ };
enum { SLICE_BYTES = 16 << 20 };

struct message {
    uint8_t *bytes;
    size_t length, room;
    bool failed;
};

static void put_bytes(struct message *m, const void *bytes, size_t length) {
    if (m->failed) return;
    if (m->length + length > m->room) {
        const size_t room = 2 * (m->length + length);
        uint8_t *larger = realloc(m->bytes, room);
        m->failed = larger == NULL;
        if (m->failed) return;
        m->bytes = larger;
        m->room = room;
    }
    memcpy(m->bytes + m->length, bytes, length);
    m->length += length;
}
static void put_number(struct message *m, uint64_t value, int bytes) {
    uint8_t b[8];
    for (int i = 0; i < 8; i++) b[i] = (uint8_t)(value >> (8 * i));
    put_bytes(m, b, (size_t)bytes);
}
static void put_text(struct message *m, const char *text) {
    put_bytes(m, text, strlen(text) + 1);
}

static void begin_message(struct message *m, int kind, const char *name) {
    m->length = 0;
    put_number(m, 0, 4); /* placeholder for the length */
    put_number(m, (uint64_t)kind, 1);
    put_number(m, 1, 1); /* selects the image */
    put_text(m, name);
}

static void put_channels(struct message *m, const struct source *s) {
    put_number(m, s->components, 4);
    for (uint32_t k = 0; k < s->components; k++) put_text(m, s->channels[k]);
}

static void create(struct message *m, const char *name, const struct source *s) {
    begin_message(m, CREATE_IMAGE, name);
    put_number(m, s->width, 4);
    put_number(m, s->height, 4);
    put_channels(m, s);
}

static void update(struct message *m, const char *name, const struct source *s, uint32_t y, uint32_t rows) {
    begin_message(m, UPDATE_IMAGE, name);
    put_channels(m, s);
    const uint32_t area[4] = {0, y, s->width, rows};
    for (int i = 0; i < 4; i++) put_number(m, area[i], 4);
    for (uint32_t k = 0; k < s->components; k++) put_number(m, k, 8);
    for (uint32_t k = 0; k < s->components; k++) put_number(m, s->components, 8);
    const size_t row = (size_t)s->width * s->components;
    for (size_t i = 0; i < row * rows; i++) {
        uint32_t bits;
        memcpy(&bits, &s->texels[row * y + i], 4);
        put_number(m, bits, 4);
    }
}

static bool send_message(int socket, struct message *m, const char *host, struct glint_error *err) {
    if (m->failed) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (int i = 0; i < 4; i++) m->bytes[i] = (uint8_t)(m->length >> (8 * i));
    for (size_t sent = 0; sent < m->length;) {
        const ssize_t n = send(socket, m->bytes + sent, m->length - sent, MSG_NOSIGNAL);
        if (n < 0 && errno != EINTR)
            return glint_fail(err, GLINT_ERROR_IO, "%s: tev stopped listening: %s", host, strerror(errno));
        sent += n > 0 ? (size_t)n : 0;
    }
    return true;
}

/* Splits "HOST:PORT" and "[HOST]:PORT". */
static void split_host(char *host, const char **name, const char **port) {
    char *colon = strrchr(host, ':'), *bracket = strrchr(host, ']');
    *port = "14158";
    *name = *host == '[' ? host + 1 : host;
    if (colon && (bracket ? colon == bracket + 1 : strchr(host, ':') == colon)) {
        *colon = '\0';
        *port = colon + 1;
    }
    if (bracket) *bracket = '\0';
}

static int connect_to(const char *host, struct glint_error *err) {
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM};
    char text[NI_MAXHOST];
    const char *name, *port;
    struct addrinfo *list = NULL;
    int found = -1;
    snprintf(text, sizeof text, "%s", host);
    split_host(text, &name, &port);
    const int code = getaddrinfo(name, port, &hints, &list);
    for (const struct addrinfo *a = list; a && found < 0; a = a->ai_next) {
        found = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
        if (found >= 0 && connect(found, a->ai_addr, a->ai_addrlen) != 0) {
            const int reason = errno;
            close(found);
            errno = reason;
            found = -1;
        }
    }
    if (found < 0)
        glint_fail(err, GLINT_ERROR_IO, "%s: cannot reach tev: %s; it must be running there, at port %s", host,
                   code ? gai_strerror(code) : strerror(errno), port);
    if (list) freeaddrinfo(list);
    return found;
}

bool tev_send(const char *host, const char *name, const struct source *source, struct glint_error *err) {
    const size_t row_bytes = (size_t)source->width * source->components * 4;
    const uint32_t rows = row_bytes < SLICE_BYTES ? (uint32_t)(SLICE_BYTES / row_bytes) : 1;
    struct message message = {0};
    const int socket = connect_to(host, err);
    if (socket < 0) return false;
    create(&message, name, source);
    bool ok = send_message(socket, &message, host, err);
    for (uint32_t y = 0; ok && y < source->height; y += rows) {
        update(&message, name, source, y, source->height - y < rows ? source->height - y : rows);
        ok = send_message(socket, &message, host, err);
    }
    close(socket);
    free(message.bytes);
    return ok;
}
