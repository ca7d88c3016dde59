/* Allocations and threads that fail, and which allocations are glint's. What libc makes inside (strdup, asprintf, open_memstream, fopen) comes
   here as well, as it calls malloc by its public name. */
#include "fail.h"

#include <dlfcn.h>
#include <errno.h>
#include <locale.h>
#include <pthread.h>
#include <stdlib.h>

/* glibc's own names of what is replaced here: dlsym allocates, too. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

static bool refused(const void *site) {
    const int before = errno;
    const bool fails = fail_watches(FAIL_ALLOC) && fail_now(FAIL_ALLOC, site);
    errno = fails ? ENOMEM : before;
    return fails;
}

/* What setlocale allocates is glibc's, until the process ends. */
static _Thread_local bool of_locale __attribute__((tls_model("initial-exec")));

/* The block, which is noted if it is glint's. */
static void *kept(void *block, const void *site) {
    if (block && site && !of_locale) fail_left_add(block, site);
    return block;
}

/* The block that is put in the other's place, which stays if there is none. */
static void *resized(void *block, size_t bytes, const void *site) {
    const void *before = fail_left_remove(block);
    void *now = __libc_realloc(block, bytes);
    if (!now && bytes) kept(block, before);
    return kept(now, site);
}

#define SITE fail_site(__builtin_return_address(0))

void *malloc(size_t size) {
    const void *site = SITE;
    return refused(site) ? NULL : kept(__libc_malloc(size), site);
}
void *calloc(size_t count, size_t size) {
    const void *site = SITE;
    return refused(site) ? NULL : kept(__libc_calloc(count, size), site);
}
void *realloc(void *memory, size_t size) {
    const void *site = SITE;
    return refused(site) ? NULL : resized(memory, size, site);
}
void *reallocarray(void *memory, size_t count, size_t size) {
    const void *site = SITE;
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) {
        errno = ENOMEM;
        return NULL;
    }
    return refused(site) ? NULL : resized(memory, bytes, site);
}
void *memalign(size_t alignment, size_t size) {
    const void *site = SITE;
    return refused(site) ? NULL : kept(__libc_memalign(alignment, size), site);
}
void *aligned_alloc(size_t alignment, size_t size) {
    const void *site = SITE;
    return refused(site) ? NULL : kept(__libc_memalign(alignment, size), site);
}
int posix_memalign(void **memory, size_t alignment, size_t size) {
    const void *site = SITE;
    if (refused(site)) return ENOMEM;
    *memory = kept(__libc_memalign(alignment, size), site);
    return *memory ? 0 : ENOMEM;
}
void free(void *memory) {
    fail_left_remove(memory);
    __libc_free(memory);
}

char *setlocale(int category, const char *locale) {
    static char *(*next)(int, const char *);
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, "setlocale");
    of_locale = true;
    char *before = next(category, locale);
    of_locale = false;
    return before;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *user) {
    static int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (fail_watches(FAIL_THREAD) && fail_now(FAIL_THREAD, SITE)) return fail_error(EAGAIN);
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    return next(thread, attributes, run, user);
}
