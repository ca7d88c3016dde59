/* Who may ask the server: the address it listens at, and what the headers of a request have to say. */
#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include "live/http_internal.h"

bool http_new_token(char token[2 * HTTP_TOKEN_BYTES + 1], struct glint_error *err) {
    unsigned char bytes[HTTP_TOKEN_BYTES];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return glint_fail(err, GLINT_ERROR_IO, "the system gives no random bytes for a token: %s", strerror(errno));
    for (size_t i = 0; i < sizeof bytes; i++) sprintf(token + 2 * i, "%02x", bytes[i]);
    return true;
}

/* ---- Listening ---- */

static bool take_token(struct http_guard *guard, const char *token, struct glint_error *err) {
    const size_t size = token ? strlen(token) : 0;
    if (size < HTTP_TOKEN_LEAST || size > HTTP_TOKEN_MOST)
        return glint_fail(err, GLINT_ERROR_USAGE, "a token has %d to %d characters; this one has %zu", HTTP_TOKEN_LEAST,
                          HTTP_TOKEN_MOST, size);
    for (size_t i = 0; i < size; i++)
        if (token[i] <= ' ' || token[i] > '~')
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "character %zu of the token is neither a letter, a digit nor a sign of ASCII", i + 1);
    memcpy(guard->token, token, size + 1);
    return true;
}

/* Fills in the address that the socket got. */
static bool take_address(struct http_guard *guard, int fd, struct glint_error *err) {
    union {
        struct sockaddr any;
        struct sockaddr_in v4;
        struct sockaddr_in6 v6;
    } at = {0};
    socklen_t size = sizeof at;
    char text[INET6_ADDRSTRLEN];
    if (getsockname(fd, &at.any, &size) != 0)
        return glint_fail(err, GLINT_ERROR_IO, "the socket has no address: %s", strerror(errno));
    const bool v6 = at.any.sa_family == AF_INET6;
    inet_ntop(at.any.sa_family, v6 ? (const void *)&at.v6.sin6_addr : (const void *)&at.v4.sin_addr, text, sizeof text);
    snprintf(guard->host, sizeof guard->host, v6 ? "[%s]" : "%s", text);
    guard->port = ntohs(v6 ? at.v6.sin6_port : at.v4.sin_port);
    guard->any = v6 ? IN6_IS_ADDR_UNSPECIFIED(&at.v6.sin6_addr) : at.v4.sin_addr.s_addr == htonl(INADDR_ANY);
    guard->loopback = v6 ? IN6_IS_ADDR_LOOPBACK(&at.v6.sin6_addr) : ntohl(at.v4.sin_addr.s_addr) >> 24 == 127;
    return true;
}

static bool cannot_listen(const char *address, uint16_t port, struct glint_error *err) {
    if (errno == EADDRINUSE)
        return glint_fail(err, GLINT_ERROR_IO,
                          "port %u of %s is in use by another program; choose another port, or 0 for any free one",
                          (unsigned)port, address);
    if (errno == EADDRNOTAVAIL) return glint_fail(err, GLINT_ERROR_USAGE, "%s is no address of this machine", address);
    return glint_fail(err, GLINT_ERROR_IO, "cannot listen at port %u of %s: %s", (unsigned)port, address,
                      strerror(errno));
}

int http_listen(struct http_guard *guard, const struct http_options *options, struct glint_error *err) {
    const char *address = options->address ? options->address : "127.0.0.1";
    const struct addrinfo hints = {.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE,
                                   .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    char port[8];
    const int yes = 1, no = 0;
    snprintf(port, sizeof port, "%u", (unsigned)options->port);
    *guard = (struct http_guard){0};
    if (!take_token(guard, options->token, err)) return -1;
    if (getaddrinfo(address, port, &hints, &found) != 0) {
        glint_fail(err, GLINT_ERROR_USAGE, "%s is no IP address, such as 127.0.0.1 or ::1", address);
        return -1;
    }
    const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    /* The port of a server that has just ended can be taken again; :: is for IPv4 too. */
    bool ok = fd >= 0 && setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
              (found->ai_family != AF_INET6 || setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no) == 0) &&
              bind(fd, found->ai_addr, found->ai_addrlen) == 0 && listen(fd, SOMAXCONN) == 0;
    if (!ok) cannot_listen(address, options->port, err);
    freeaddrinfo(found);
    ok = ok && take_address(guard, fd, err);
    if (!ok && fd >= 0) close(fd);
    return ok ? fd : -1;
}

/* ---- Headers ---- */

static enum MHD_Result read_header(void *user, enum MHD_ValueKind kind, const char *name, const char *value) {
    struct http_headers *headers = user;
    const struct {
        const char *name, **value;
    } known[] = {{"Host", &headers->host},
                 {"Origin", &headers->origin},
                 {"Sec-Fetch-Site", &headers->site},
                 {"Authorization", &headers->authorization},
                 {"Content-Length", &headers->length},
                 {"Transfer-Encoding", &headers->encoding}};
    (void)kind;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcasecmp(name, known[i].name)) {
            headers->twice |= *known[i].value != NULL;
            *known[i].value = value ? value : "";
        }
    return MHD_YES;
}

struct http_headers http_read_headers(struct MHD_Connection *connection) {
    struct http_headers headers = {0};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, read_header, &headers);
    return headers;
}

static bool refuse(struct http_refusal *refusal, int status, const char *code, const char *message) {
    *refusal = (struct http_refusal){.status = status, .code = code, .message = message};
    return false;
}

/* Whether the text is an IP address as a URL has it, and no name, which could be made to mean any address. */
static bool is_address(const char *text) {
    unsigned char address[sizeof(struct in6_addr)];
    char inner[INET6_ADDRSTRLEN];
    const size_t size = strlen(text);
    if (inet_pton(AF_INET, text, address) == 1) return true;
    if (size < 4 || size - 2 >= sizeof inner || text[0] != '[' || text[size - 1] != ']') return false;
    memcpy(inner, text + 1, size - 2);
    inner[size - 2] = 0;
    return inet_pton(AF_INET6, inner, address) == 1;
}

/* Whether HOST:PORT is the server itself. Browsers leave out port 80. */
static bool is_own_host(const struct http_guard *guard, const char *host) {
    char name[sizeof guard->host], port[8];
    const size_t port_size = (size_t)snprintf(port, sizeof port, ":%u", (unsigned)guard->port);
    size_t size = strlen(host);
    if (size > port_size && !strcmp(host + size - port_size, port)) size -= port_size;
    else if (guard->port != 80) return false;
    if (size >= sizeof name) return false;
    memcpy(name, host, size);
    name[size] = 0;
    if (guard->any && is_address(name)) return true;
    if ((guard->any || guard->loopback) &&
        (!strcmp(name, "127.0.0.1") || !strcmp(name, "localhost") || !strcmp(name, "[::1]")))
        return true;
    return !strcmp(name, guard->host);
}

bool http_own_page(const struct http_guard *guard, const struct http_headers *headers, struct http_refusal *refusal) {
    static const char scheme[] = "http://";
    const size_t size = sizeof scheme - 1;
    if (headers->twice) return refuse(refusal, 400, "format", "a header of the request stands there twice");
    if (!headers->host || !is_own_host(guard, headers->host))
        return refuse(refusal, 403, "origin", "the request's Host is not the address that the server has printed");
    if (headers->origin && (strncmp(headers->origin, scheme, size) || !is_own_host(guard, headers->origin + size)))
        return refuse(refusal, 403, "origin", "the request comes from another page");
    if (headers->site && !strcasecmp(headers->site, "cross-site"))
        return refuse(refusal, 403, "origin", "the request comes from another site");
    return true;
}

/* Takes the same time wherever the two differ. */
static bool same_token(const char *token, const char *given) {
    const size_t size = strlen(token), given_size = strlen(given);
    volatile unsigned char differ = size != given_size;
    for (size_t i = 0; i < size; i++)
        differ = (unsigned char)(differ | (token[i] ^ given[i < given_size ? i : given_size]));
    return !differ;
}

bool http_has_token(const struct http_guard *guard, const struct http_headers *headers, struct http_refusal *refusal) {
    static const char scheme[] = "Bearer ";
    const char *given = headers->authorization;
    if (given && !strncasecmp(given, scheme, sizeof scheme - 1) && same_token(guard->token, given + sizeof scheme - 1))
        return true;
    refuse(refusal, 401, "token",
           given ? "the token in the header Authorization is not that of this server"
                 : "the request has no header \"Authorization: Bearer TOKEN\"");
    refusal->name = "WWW-Authenticate";
    refusal->value = "Bearer";
    return false;
}

bool http_body_allowed(const struct http_headers *headers, bool may_have_one, struct http_refusal *refusal) {
    if (headers->encoding && (headers->length || strcasecmp(headers->encoding, "chunked")))
        return refuse(refusal, 400, "format", "a body has either a Content-Length or the Transfer-Encoding chunked");
    const unsigned long long size =
        headers->length ? strtoull(headers->length, NULL, 10) : 0; /* the library has refused what is no number */
    if (!may_have_one && (size > 0 || headers->encoding))
        return refuse(refusal, 400, "format", "this request has no body");
    if (size > HTTP_BODY_BYTES) return refuse(refusal, 413, "size", "the body is larger than 1 MiB");
    return true;
}

static enum MHD_Result check_value(void *user, enum MHD_ValueKind kind, const char *name, size_t name_size,
                                   const char *value, size_t value_size) {
    json_t *texts[] = {json_stringn(name, name_size), json_stringn(value ? value : "", value ? value_size : 0)};
    bool *ok = user;
    (void)kind;
    *ok = *ok && texts[0] && texts[1] && !memchr(name, 0, name_size) && !(value && memchr(value, 0, value_size));
    json_decref(texts[0]);
    json_decref(texts[1]);
    return *ok ? MHD_YES : MHD_NO;
}

bool http_query_allowed(struct MHD_Connection *connection, struct http_refusal *refusal) {
    bool ok = true;
    MHD_get_connection_values_n(connection, MHD_GET_ARGUMENT_KIND, check_value, &ok);
    return ok || refuse(refusal, 400, "format", "a value of the query is not UTF-8, or holds a NUL");
}
