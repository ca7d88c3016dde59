/* Allocations and threads that fail. What libc makes inside (strdup, asprintf, open_memstream, fopen) comes here as well, as it calls
   malloc by its public name. */
#include "fail.h"

#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>

/* glibc's own names of what is replaced here: dlsym allocates, too. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static bool refused(const void *caller) {
    const int before = errno;
    const bool fails = fail_watches(FAIL_ALLOC) && fail_now(FAIL_ALLOC, caller);
    errno = fails ? ENOMEM : before;
    return fails;
}

#define REFUSED refused(__builtin_return_address(0))

void *malloc(size_t size) {
    return REFUSED ? NULL : __libc_malloc(size);
}
void *calloc(size_t count, size_t size) {
    return REFUSED ? NULL : __libc_calloc(count, size);
}
void *realloc(void *memory, size_t size) {
    return REFUSED ? NULL : __libc_realloc(memory, size);
}
void *reallocarray(void *memory, size_t count, size_t size) {
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) {
        errno = ENOMEM;
        return NULL;
    }
    return REFUSED ? NULL : __libc_realloc(memory, bytes);
}
void *memalign(size_t alignment, size_t size) {
    return REFUSED ? NULL : __libc_memalign(alignment, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
    return REFUSED ? NULL : __libc_memalign(alignment, size);
}
int posix_memalign(void **memory, size_t alignment, size_t size) {
    if (REFUSED) return ENOMEM;
    *memory = __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *user) {
    static int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (fail_now(FAIL_THREAD, __builtin_return_address(0))) return fail_error(EAGAIN);
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    return next(thread, attributes, run, user);
}
