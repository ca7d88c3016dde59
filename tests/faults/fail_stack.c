/* Who calls, with GLINT_FAIL_EXCEPT (the beginning of functions' names) passed over whatever these call. From a call up the stack, objects that
   work for whoever calls them (libc, libstdc++, Jansson, OpenEXRCore, libpng, …) are passed over, and the first other one decides. It has to be
   the program itself or a library libglint-…. The objects are those of dl_iterate_phdr, and the stack is that of the unwinder. */
#include "fail.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unwind.h>

enum { OBJECTS = 256, FRAMES = 48 };
enum owner { OWNER_OTHER, OWNER_GLINT, OWNER_CALLER, OWNER_SELF };

/* Work for whoever calls them. */
static const char *const of_callers[] = {"libc.so",    "libm.so",    "libstdc++.so", "libgcc_s.so", "libOpenEXRCore",
                                         "libImath",   "libjansson", "libpng",       "libz.so",     "libzstd",
                                         "libdeflate", "libjpeg",    "libfreetype",  "libduktape",  "libxxhash",
                                         "libnlopt",   "libexpat",   "libminizip",   "libbrotli",   NULL};

struct object {
    uintptr_t begin, end, base;
    enum owner owner;
    const char *name;
};
static struct object objects[OBJECTS];
static int object_count;
static atomic_flag objects_lock = ATOMIC_FLAG_INIT;

static enum owner owner_of(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (!*path || strstr(name, "libglint-")) return OWNER_GLINT;
    if (strstr(name, "glint_fail")) return OWNER_SELF;
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
        int at = object_count++;
        for (; at > 0 && objects[at - 1].begin > begin; at--) objects[at] = objects[at - 1];
        objects[at] =
            (struct object){begin, begin + part->p_memsz, info->dlpi_addr, owner_of(info->dlpi_name), info->dlpi_name};
    }
    return 0;
}

static const struct object *find_object(uintptr_t at) {
    int low = 0, high = object_count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (at < objects[middle].begin) high = middle;
        else if (at >= objects[middle].end) low = middle + 1;
        else return &objects[middle];
    }
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

/* Whether this is a function that is not to fail. */
static bool excepted(const void *code) {
    const char *start = getenv("GLINT_FAIL_EXCEPT");
    Dl_info info;
    return start && dladdr(code, &info) && info.dli_sname && !strncmp(info.dli_sname, start, strlen(start));
}

struct search {
    const void *site;
    int frames;
};

/* Ends where it is known who decides: most allocations are LLVM's, whose stacks are deep. */
static _Unwind_Reason_Code search_frame(struct _Unwind_Context *context, void *user) {
    struct search *search = user;
    const void *code = (const void *)_Unwind_GetIP(context);
    const enum owner owner = object_at(code).owner;
    if (owner == OWNER_GLINT) search->site = code;
    const bool ends = owner == OWNER_GLINT || owner == OWNER_OTHER || excepted(code) || ++search->frames == FRAMES;
    return ends ? _URC_END_OF_STACK : _URC_NO_REASON;
}

const void *fail_stack_site(const void *caller) {
    const enum owner direct = caller ? object_at(caller).owner : OWNER_CALLER;
    if (direct != OWNER_CALLER) return direct == OWNER_GLINT ? caller : NULL;
    struct search search = {0};
    _Unwind_Backtrace(search_frame, &search);
    return search.site;
}

uint64_t fail_stack_hash(void) {
    void *frames[FRAMES];
    const int count = backtrace(frames, FRAMES);
    uint64_t hash = 14695981039346656037u;
    for (int i = 1; i < count; i++) {
        const struct object object = object_at(frames[i]);
        if (object.owner == OWNER_SELF) continue;
        hash = (hash ^ ((uintptr_t)frames[i] - object.base)) * 1099511628211u;
        hash ^= hash >> 29;
    }
    return hash;
}

size_t fail_stack_name(const void *code, char *text, size_t room) {
    const struct object object = object_at(code);
    const int length = snprintf(text, room, "%s %#lx\n", *object.name ? object.name : "-",
                                (unsigned long)((uintptr_t)code - object.base - 1));
    return (size_t)length < room ? (size_t)length : 0;
}

size_t fail_stack_names(char *text, size_t room) {
    void *frames[FRAMES];
    const int count = backtrace(frames, FRAMES);
    size_t at = 0;
    for (int i = 1; i < count; i++)
        if (object_at(frames[i]).owner != OWNER_SELF) at += fail_stack_name(frames[i], text + at, room - at);
    return at;
}
