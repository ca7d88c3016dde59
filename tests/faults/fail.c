/* A library to preload (LD_PRELOAD) that lets the n-th allocation, or the n-th system call of a kind, fail in a program of glint. Environment variables say which:

   GLINT_FAIL_KIND    alloc, thread, read, write, open, rename, sync, mmap, make (folders) or remove; without it nothing fails
   GLINT_FAIL_NUMBER  the number of the call that fails, from 1; without it calls are only counted
   GLINT_FAIL_ALL     set: all from that number on fail
   GLINT_FAIL_ERROR   the error's number (errno), or "short": the call works with half of the bytes; "kill": the process ends by SIGKILL instead of making
                      the call; "tear": it ends when the call has worked with half of the bytes; without it what is usual for the kind
   GLINT_FAIL_LOG     a file to which system calls are written that rename or sync, one a line: "rename FROM TO" ("over": TO was a file), "sync FILE"
   GLINT_FAIL_REPORT  a file to which the number of calls is written when main returns, and the call stack of the first call that fails, one "object offset" a line

   Calls are counted from the beginning of main to its end, in all threads. Only those that are made on behalf of glint count, as what the
   Vulkan loader, the driver, LLVM and GLib and OpenColorIO do without memory is not glint's to mend (they end the process): from the call
   up the stack, objects that work for whoever calls them (libc, libstdc++, Jansson, OpenEXRCore, libpng, …) are passed over, and the first
   other one decides. It has to be the program itself or a library libglint-…. The objects are those of dl_iterate_phdr, and the stack is
   that of the unwinder. */
#include "fail.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OBJECTS = 256, FRAMES = 48 };
enum owner { OWNER_OTHER, OWNER_GLINT, OWNER_CALLER };

/* Work for whoever calls them. */
static const char *const of_callers[] = {
    "libc.so",   "libm.so",  "libstdc++.so", "libgcc_s.so", "libOpenEXRCore", "libImath",    "libjansson",
    "libpng",    "libz.so",  "libzstd",      "libdeflate",  "libjpeg",        "libfreetype", "libduktape",
    "libxxhash", "libnlopt", "libexpat",     "libminizip",  "libbrotli",      "glint_fail",  NULL};

struct object {
    uintptr_t begin, end, base;
    enum owner owner;
    const char *name;
};
static struct object objects[OBJECTS];
static int object_count;
static atomic_flag objects_lock = ATOMIC_FLAG_INIT;

static const char *const kind_names[FAIL_KINDS] = {"alloc",  "thread", "read", "write", "open",
                                                   "rename", "sync",   "mmap", "make",  "remove"};
static int kind = -1;
static long number;
static bool all;
static const char *error_text, *report_path, *log_path;
static atomic_long calls;
static atomic_bool running, told;
static _Thread_local bool inside __attribute__((tls_model("initial-exec")));
static char stack_text[FRAMES * 300];

static enum owner owner_of(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (!*path || strstr(name, "libglint-")) return OWNER_GLINT;
    for (const char *const *of = of_callers; *of; of++)
        if (strstr(name, *of)) return OWNER_CALLER;
    return OWNER_OTHER;
}

static int add_object(struct dl_phdr_info *info, size_t size, void *user) {
    (void)size, (void)user;
    for (int i = 0; i < info->dlpi_phnum && object_count < OBJECTS; i++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
        const uintptr_t begin = info->dlpi_addr + part->p_vaddr;
        objects[object_count++] =
            (struct object){begin, begin + part->p_memsz, info->dlpi_addr, owner_of(info->dlpi_name), info->dlpi_name};
    }
    return 0;
}

static const struct object *find_object(uintptr_t at) {
    for (int i = 0; i < object_count; i++)
        if (at >= objects[i].begin && at < objects[i].end) return &objects[i];
    return NULL;
}

/* The object that has this code; libraries that were loaded since are looked up again. */
static struct object object_at(const void *code) {
    const uintptr_t at = (uintptr_t)code;
    while (atomic_flag_test_and_set(&objects_lock)) continue;
    const struct object *found = find_object(at);
    if (!found) {
        object_count = 0;
        dl_iterate_phdr(add_object, NULL);
        found = find_object(at);
    }
    const struct object object = found ? *found : (struct object){.owner = OWNER_CALLER, .name = "?"};
    atomic_flag_clear(&objects_lock);
    return object;
}

static bool of_glint(const void *caller) {
    const enum owner direct = caller ? object_at(caller).owner : OWNER_CALLER;
    if (direct != OWNER_CALLER) return direct == OWNER_GLINT;
    void *frames[FRAMES];
    const int count = backtrace(frames, FRAMES);
    for (int i = 1; i < count; i++) {
        const enum owner owner = object_at(frames[i]).owner;
        if (owner != OWNER_CALLER) return owner == OWNER_GLINT;
    }
    return false;
}

static void note_stack(void) {
    if (atomic_exchange(&told, true) || !report_path) return;
    void *frames[FRAMES];
    const int count = backtrace(frames, FRAMES);
    size_t at = 0;
    for (int i = 1; i < count; i++) {
        const struct object object = object_at(frames[i]);
        if (strstr(object.name, "glint_fail")) continue;
        at += (size_t)snprintf(stack_text + at, sizeof stack_text - at, "%s %#lx\n", *object.name ? object.name : "-",
                               (unsigned long)((uintptr_t)frames[i] - object.base - 1));
        if (at > sizeof stack_text - 300) break;
    }
    /* At once, as the process may not live to the end of main. */
    const int file = open(report_path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file >= 0 && write(file, stack_text, at)) close(file);
}

bool fail_watches(enum fail_kind which) {
    return (int)which == kind || (log_path && (which == FAIL_RENAME || which == FAIL_SYNC));
}

bool fail_now(enum fail_kind which, const void *caller) {
    if ((int)which != kind || inside || !running) return false;
    inside = true;
    bool fails = false;
    if (of_glint(caller)) {
        const long n = atomic_fetch_add(&calls, 1) + 1;
        fails = number > 0 && (all ? n >= number : n == number);
        if (fails) note_stack();
    }
    inside = false;
    return fails;
}

int fail_error(int otherwise) {
    const int asked = error_text ? atoi(error_text) : 0;
    return asked ? asked : otherwise;
}

static bool asked_for(const char *error) {
    return error_text && !strcmp(error_text, error);
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

static void begin(void) {
    const char *text = getenv("GLINT_FAIL_KIND");
    for (int i = 0; text && i < FAIL_KINDS; i++)
        if (!strcmp(text, kind_names[i])) kind = i;
    number = (text = getenv("GLINT_FAIL_NUMBER")) ? atol(text) : 0;
    all = getenv("GLINT_FAIL_ALL") != NULL;
    error_text = getenv("GLINT_FAIL_ERROR");
    report_path = getenv("GLINT_FAIL_REPORT");
    log_path = getenv("GLINT_FAIL_LOG");
    void *frames[2];
    backtrace(frames, 2); /* the first call loads the unwinder */
    object_at((const void *)(uintptr_t)begin);
    fail_catch_calls();
    running = true;
}

static void end(void) {
    running = false;
    if (!report_path || number > 0) return;
    FILE *file = fopen(report_path, "w");
    if (!file) return;
    fprintf(file, "%ld\n", (long)calls);
    fclose(file);
}

static int (*program_main)(int, char **, char **);

static int counted_main(int argc, char **argv, char **variables) {
    begin();
    const int status = program_main(argc, argv, variables);
    end();
    return status;
}

typedef int start_function(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void),
                           void *);

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld)(void), void *stack);
int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld)(void), void *stack) {
    program_main = main;
    start_function *start;
    *(void **)&start = dlsym(RTLD_NEXT, "__libc_start_main");
    return start(counted_main, argc, argv, init, fini, rtld, stack);
}
