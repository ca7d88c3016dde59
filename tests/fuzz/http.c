/* Fuzzes who may ask glint live: the input's lines are a request's headers. Nothing but the token, and no other page, is let in. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "fuzz.h"
#include "live/http_internal.h"

static const char token[] = "0123456789abcdef";

static void read_line(struct http_headers *headers, const char *line) {
    const struct {
        const char *name, **value;
    } known[] = {{"Host: ", &headers->host},     {"Origin: ", &headers->origin},
                 {"Site: ", &headers->site},     {"Authorization: ", &headers->authorization},
                 {"Length: ", &headers->length}, {"Encoding: ", &headers->encoding}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strncmp(line, known[i].name, strlen(known[i].name))) *known[i].value = line + strlen(known[i].name);
}

/* Whether a host may be that of the server, by the address before the port. */
static bool is_address(const char *host) {
    return !host[strspn(host, "0123456789abcdefABCDEF.:[]")] || !strncmp(host, "localhost", 9);
}

static void check(const struct http_guard *guard, const struct http_headers *headers) {
    struct http_refusal refusal = {0};
    if (http_has_token(guard, headers, &refusal))
        fuzz_must(headers->authorization && !strncasecmp(headers->authorization, "Bearer ", 7) &&
                      !strcmp(headers->authorization + 7, token),
                  "the token is the whole token");
    else fuzz_must(refusal.status == 401 && refusal.message, "a refusal has a status and a message");
    if (http_own_page(guard, headers, &refusal)) {
        fuzz_must(headers->host && is_address(headers->host), "a host is an address");
        fuzz_must(!headers->origin || (!strncmp(headers->origin, "http://", 7) && is_address(headers->origin + 7)),
                  "an origin is an address");
        fuzz_must(!headers->site || strcasecmp(headers->site, "cross-site") != 0, "another site is refused");
    }
    http_body_allowed(headers, true, &refusal);
    http_body_allowed(headers, false, &refusal);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct http_guard guards[] = {{.host = "127.0.0.1", .loopback = true, .port = 4000},
                                  {.host = "0.0.0.0", .any = true, .port = 4000},
                                  {.host = "[::1]", .loopback = true, .port = 80},
                                  {.host = "192.168.1.7", .port = 80}};
    struct http_headers headers = {0};
    char text[4096];
    snprintf(text, sizeof text, "%s", fuzz_text(data, size));
    for (char *rest = text, *line; (line = strsep(&rest, "\n")) != NULL;) read_line(&headers, line);
    for (size_t i = 0; i < sizeof guards / sizeof *guards; i++) {
        memcpy(guards[i].token, token, sizeof token);
        check(&guards[i], &headers);
    }
    return 0;
}
