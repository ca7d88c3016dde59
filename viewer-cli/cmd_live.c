/* glint live: a page in a browser with everything that can be changed, over a replay. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "io/console.h"
#include "draw/page/page.h"
#include "live/live.h"

struct arguments {
    struct pipeline_args pipeline;
    struct list captures;
    const char *out, *reference, *listen, *token_file, *cache;
    uint32_t port;
};

enum { KEY_PORT = 256, KEY_REFERENCE, KEY_LISTEN, KEY_TOKEN_FILE };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",     'o',            "DIR",  0, "Let the page write run folders below DIR. Without -o nothing is written", 0},
    WHOLE_PIPELINE_OPTIONS("The pipeline that the page begins with"),
    SKIP_OPTION,
    {"force",      KEY_FORCE,      "SLOT,...", 0, "Run these passes even if the plan finds that they are not needed", 0},
    {"reference",  KEY_REFERENCE,  "RUN",  0, "Run of glint reference that errors are measured against (default: a reference is traced when the page asks for it)", 0},
    {"port",       KEY_PORT,       "N",    0, "Port of the server (default: a free one)", 0},
    {"listen",     KEY_LISTEN,     "ADDRESS", 0, "Address to listen at instead of 127.0.0.1, for browsers on other machines. Needs --token-file; nothing is encrypted", 0},
    {"token-file", KEY_TOKEN_FILE, "FILE", 0, "File with the token that requests have to show, of 16 characters or more, which only you may read (default: a new token each time)", 0},
    CACHE_OPTION("results for cube maps", ""),
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint live street.exr", "prints the address of a page for the capture: open it in a browser"},
    {"glint live shot/*.exr --preset mafia_de_display", "plays a shot"},
    {"glint live street.exr --reference ref -o runs", "measures against a reference, and may write runs/NAME"},
    {"glint live street.exr --shader resolve=my.comp", "replays again when the shader changes"},
    {"glint live street.exr --port 8000",
     "on a machine that ssh -L 8000:127.0.0.1:8000 MACHINE reaches: open the printed address here"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED('p', struct arguments, pipeline.preset),
    STORED('d', struct arguments, pipeline.device),
    STORED(KEY_USE, struct arguments, pipeline.use),
    STORED(KEY_SET, struct arguments, pipeline.set),
    STORED(KEY_SHADER, struct arguments, pipeline.shader),
    STORED_NAMES(KEY_SKIP, struct arguments, pipeline.skip),
    STORED_NAMES(KEY_FORCE, struct arguments, pipeline.force),
    STORED(KEY_ALL, struct arguments, pipeline.replay.all),
    STORED(KEY_REFERENCE, struct arguments, reference),
    STORED(KEY_LISTEN, struct arguments, listen),
    STORED(KEY_TOKEN_FILE, struct arguments, token_file),
    STORED(KEY_CACHE, struct arguments, cache),
    STORED_NUMBER(KEY_PORT, struct arguments, port, 1, 65535),
    STORED(ARGP_KEY_ARG, struct arguments, captures),
    {0},
};

static error_t cmd_live_parse(int key, char *arg, struct argp_state *state) {
    const struct arguments *a = state->input;
    (void)arg;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (a->listen && !a->token_file) argp_error(state, "--listen needs --token-file: others can reach that address");
    for (size_t i = 0; i < a->captures.count; i++)
        if (!strcmp(a->captures.items[i], "-")) argp_error(state, "captures are read again and again: name files");
    return 0;
}

/* More than a token may have, so that a longer one is refused and not cut. */
enum { TOKEN_BYTES = 512 };

/* Reads the first line of a file that only its owner may read. */
static bool read_token(const char *path, char token[TOKEN_BYTES], struct glint_error *err) {
    struct stat info;
    FILE *file = fopen(path, "r");
    if (!file || fstat(fileno(file), &info) != 0) {
        glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
        if (file) fclose(file);
        return false;
    }
    const bool read = fgets(token, TOKEN_BYTES, file) != NULL;
    fclose(file);
    if (info.st_mode & 077)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: others may read it; chmod 600 %s", path, path);
    token[read ? strcspn(token, "\r\n") : 0] = '\0';
    return strlen(token) >= 16 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a token of 16 characters or more", path);
}

static bool take_token(const struct arguments *a, char token[TOKEN_BYTES], struct glint_error *err) {
    return a->token_file ? read_token(a->token_file, token, err) : http_new_token(token, err);
}

static void print_address(const struct arguments *a, const struct http *http, const char *token) {
    const char *host = a->listen ? a->listen : "127.0.0.1";
    const bool brackets = strchr(host, ':') != NULL;
    printf("http://%s%s%s:%u/%s%s\n", brackets ? "[" : "", name_text(host), brackets ? "]" : "", http_port(http),
           a->token_file ? "" : "#", a->token_file ? "" : token);
    if (a->token_file) printf("the token is the first line of %s\n", name_text(a->token_file));
    puts("open this address in a browser; stop with Ctrl-C");
    fflush(stdout);
}

/* Serves until a signal asks to stop. */
static bool serve(const struct arguments *a, struct live *live, const sigset_t *signals, struct glint_error *err) {
    char token[TOKEN_BYTES], *page = page_live(err);
    int number;
    const struct http_options http_options = {.address = a->listen,
                                              .port = (uint16_t)a->port,
                                              .token = token,
                                              .routes = live_routes,
                                              .user = live,
                                              .page = page,
                                              .page_bytes = page ? strlen(page) : 0};
    struct http *http = page && take_token(a, token, err) ? http_start(&http_options, err) : NULL;
    const bool started = http != NULL;
    if (started) {
        print_address(a, http, token);
        sigwait(signals, &number);
        /* A second Ctrl-C ends what does not want to end. */
        sigset_t interrupt;
        sigemptyset(&interrupt);
        sigaddset(&interrupt, SIGINT);
        pthread_sigmask(SIG_UNBLOCK, &interrupt, NULL);
        live_stop(live);
        http_stop(&http);
    }
    free(page);
    return started;
}

static enum status cmd_live_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    sigset_t signals;
    command_parse(&cmd_live, argc, argv, &a);
    /* Of all threads that begin from here on, so that the one below gets them. */
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &signals, NULL);
    signal(SIGPIPE, SIG_IGN);
    struct live *live = calloc(1, sizeof *live);
    bool ok = live || fail_memory(&err);
    if (ok) {
        live->command = &cmd_live;
        live->args = &a.pipeline;
        live->captures = &a.captures;
        live->out = a.out;
        live->reference = a.reference;
        live->cache = pipeline_args_cache(a.cache);
        ok = live_begin(live, &err) && serve(&a, live, &signals, &err);
        live_end(live);
        free(live->cache);
    }
    free(live);
    pipeline_args_finish(&a.pipeline);
    list_free(&a.captures);
    return ok ? STATUS_DONE : command_fail(&cmd_live, &err);
}

const struct command cmd_live = {
    .name = "live",
    .arguments = "F...",
    .summary = "change a pipeline in a browser while the frame replays",
    .description =
        "Serves a page in which every variant and every parameter can be changed while the frame replays: pictures of "
        "all images, the drawing of a pixel, errors, times and fetches, side by side with another state. Everything "
        "has "
        "keys, which the page lists when ? is pressed; Ctrl-C here ends the server. The page is "
        "served to this machine alone, and only to those who have the token in the printed address. Passes that a "
        "change does not reach are not run again; on slow devices a draft of half the width and height comes first. "
        "Several captures are a shot, whose frames carry their history as glint replay does. Scripts can do what the "
        "page does: docs/live.md describes its interface.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_live_parse,
    .examples = examples,
    .run = cmd_live_run,
};
