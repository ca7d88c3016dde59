/* A library to preload (LD_PRELOAD) that lets the n-th allocation, or the n-th system call of a kind, fail in a program of glint. What is
   asked for is a text of four words, "KIND NUMBER ERROR HOW":

   KIND    alloc, thread, read, write, open, rename, sync, mmap, make (folders) or remove; or any, with 0: calls of each kind are counted
   NUMBER  the number of the call that fails, from 1; with 0 calls are only counted
   ERROR   the error's number (errno), 0 for what is usual for the kind, or "short": the call works with half of the bytes;
           "kill": the process ends by SIGKILL instead of making the call; "tear": it ends when the call has worked with half of the bytes
   HOW     once, all (all from that number on fail) or stacks (with 0: the stack of each call is told as well)

   It comes from the environment variable GLINT_FAIL, or a program serves many of them (fail_serve.c). GLINT_FAIL_REPORT names a file to
   which is written, a line each: "stack", and "OBJECT OFFSET" for each call of the stack of the first call that fails; when main returns
   "calls KIND N", "left OBJECT OFFSET" for each block that glint allocated and nobody freed, and "open N", the number of open files. The
   numbers of stacks go, as 64 bits each, to a file of that name with .KIND for each kind. GLINT_FAIL_LOG names a file to which is written what
   is renamed and synced, a line each: "rename FROM TO" ("over": TO was a file), "sync FILE".

   Calls are counted from the beginning of main to its end, in all threads. Only those that are made on behalf of glint count, as what the
   Vulkan loader, the driver, LLVM and GLib and OpenColorIO do without memory is not glint's to mend (they end the process): fail_stack.c. */
#include "fail.h"

#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { STACKS = 1 << 20, TEXT_BYTES = 16384 };

static const char *const kind_names[FAIL_KINDS] = {"alloc",  "thread", "read", "write", "open",
                                                   "rename", "sync",   "mmap", "make",  "remove"};
enum { ANY = FAIL_KINDS };
static int kind = -1;
static long number;
static bool all, stacks;
static char error_text[16];
static const char *report_path, *log_path;
static atomic_long calls[FAIL_KINDS];
static atomic_bool running, told;
static _Thread_local bool inside __attribute__((tls_model("initial-exec")));
static uint64_t hashes[FAIL_KINDS][STACKS];
static char text[TEXT_BYTES];

/* Appends to the report at once, as the process may not live to the end of main. */
static int open_report(const char *suffix, int flags) {
    char path[4096];
    if (!report_path || snprintf(path, sizeof path, "%s%s", report_path, suffix) >= (int)sizeof path) return -1;
    return open(path, O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0600);
}

static void write_all(int file, const void *from, size_t bytes) {
    if (write(file, from, bytes) != (ssize_t)bytes) _exit(99);
}

static void tell_stack(void) {
    if (atomic_exchange(&told, true)) return;
    const int file = open_report("", O_APPEND);
    if (file < 0) return;
    size_t length = (size_t)snprintf(text, sizeof text, "stack\n");
    length += fail_stack_names(text + length, sizeof text - length);
    write_all(file, text, length);
    close(file);
}

const void *fail_site(const void *caller) {
    if (inside || !running) return NULL;
    inside = true;
    const void *site = fail_stack_site(caller);
    inside = false;
    return site;
}

bool fail_watches(enum fail_kind which) {
    return (int)which == kind || kind == ANY || (log_path && (which == FAIL_RENAME || which == FAIL_SYNC));
}

bool fail_all(void) {
    return all;
}

bool fail_now(enum fail_kind which, const void *site) {
    if (((int)which != kind && kind != ANY) || !site || inside || !running) return false;
    inside = true;
    const long n = atomic_fetch_add(&calls[which], 1) + 1;
    const bool fails = number > 0 && (all ? n >= number : n == number);
    if (fails) tell_stack();
    if (stacks && n <= STACKS) hashes[which][n - 1] = fail_stack_hash();
    inside = false;
    return fails;
}

int fail_error(int otherwise) {
    const int asked = atoi(error_text);
    return asked ? asked : otherwise;
}

static bool asked_for(const char *error) {
    return !strcmp(error_text, error);
}
bool fail_short(void) {
    return asked_for("short") || asked_for("tear");
}
bool fail_tears(void) {
    return asked_for("tear");
}
bool fail_kills(void) {
    return asked_for("kill");
}
const char *fail_log(void) {
    return log_path;
}

static void begin(const char *asked) {
    char name[16], how[16];
    if (sscanf(asked, "%15s %ld %15s %15s", name, &number, error_text, how) != 4) return;
    for (int i = 0; i < FAIL_KINDS; i++)
        if (!strcmp(name, kind_names[i])) kind = i;
    if (!strcmp(name, "any")) kind = ANY;
    all = !strcmp(how, "all");
    stacks = !strcmp(how, "stacks");
    const int file = open_report("", O_TRUNC);
    if (file >= 0) close(file);
}

void fail_begin(const char *asked, const char *path) {
    report_path = path;
    log_path = getenv("GLINT_FAIL_LOG");
    if (!asked && !log_path) return;
    if (asked) begin(asked);
    fail_stack_hash(); /* the first call loads the unwinder */
    fail_catch_calls();
    running = true;
}

static void write_stacks(enum fail_kind of) {
    char suffix[16];
    snprintf(suffix, sizeof suffix, ".%s", kind_names[of]);
    const int file = open_report(suffix, O_TRUNC);
    if (file < 0) return;
    write_all(file, hashes[of], sizeof **hashes * (size_t)(calls[of] < STACKS ? calls[of] : STACKS));
    close(file);
}

void fail_end(void) {
    if (!atomic_exchange(&running, false)) return;
    const int counted = kind;
    kind = -1; /* what is written here is not counted */
    const int file = open_report("", O_APPEND);
    if (file < 0) return;
    for (int i = 0; i < FAIL_KINDS; i++)
        if (counted == i || counted == ANY) dprintf(file, "calls %s %ld\n", kind_names[i], (long)calls[i]);
    fail_left_write(file);
    close(file);
    for (int i = 0; i < FAIL_KINDS && stacks; i++)
        if (counted == i || counted == ANY) write_stacks((enum fail_kind)i);
}
