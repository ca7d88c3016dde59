/* Counts the heap memory of the program. */
#define _GNU_SOURCE
#include "heap.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static atomic_size_t taken, peak;

static void count_heap(size_t bytes) {
    const size_t now = atomic_fetch_add(&taken, bytes) + bytes;
    size_t seen = atomic_load(&peak);
    while (now > seen && !atomic_compare_exchange_weak(&peak, &seen, now)) {
    }
}

size_t heap_peak_reset(void) {
    const size_t now = atomic_load(&taken);
    atomic_store(&peak, now);
    return now;
}

size_t heap_peak(void) {
    return atomic_load(&peak);
}

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

#ifdef SANITIZED

size_t __sanitizer_get_allocated_size(const volatile void *p);
int __sanitizer_install_malloc_and_free_hooks(void (*taken)(const volatile void *, size_t),
                                              void (*given)(const volatile void *));

static void on_malloc(const volatile void *p, size_t bytes) {
    (void)p;
    count_heap(bytes);
}

static void on_free(const volatile void *p) {
    if (p) atomic_fetch_sub(&taken, __sanitizer_get_allocated_size(p));
}

__attribute__((constructor)) static void install(void) {
    __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
}

#elif defined(_WIN32)

/* The linker renames the calls of this program and of libraries that it contains (meson.build); those of DLLs are not seen. */
void *__real_malloc(size_t bytes);
void *__real_calloc(size_t n, size_t bytes);
void *__real_realloc(void *p, size_t bytes);
void __real_free(void *p);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t n, size_t bytes);
void *__wrap_realloc(void *p, size_t bytes);
void __wrap_free(void *p);
char *__wrap_strdup(const char *text);

static void *counted(void *p) {
    if (p) count_heap(_msize(p));
    return p;
}

void *__wrap_malloc(size_t bytes) {
    return counted(__real_malloc(bytes));
}

void *__wrap_calloc(size_t n, size_t bytes) {
    return counted(__real_calloc(n, bytes));
}

void *__wrap_realloc(void *old, size_t bytes) {
    const size_t before = old ? _msize(old) : 0;
    void *p = __real_realloc(old, bytes);
    if (p || !bytes) atomic_fetch_sub(&taken, before);
    return counted(p);
}

void __wrap_free(void *p) {
    if (p) atomic_fetch_sub(&taken, _msize(p));
    __real_free(p);
}

char *__wrap_strdup(const char *text) {
    const size_t bytes = strlen(text) + 1;
    char *copy = __wrap_malloc(bytes);
    return copy ? memcpy(copy, text, bytes) : NULL;
}

#else

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count_heap, size_t bytes);
void *__libc_realloc(void *p, size_t bytes);
void __libc_free(void *p);

void *malloc(size_t bytes) {
    void *p = __libc_malloc(bytes);
    if (p) count_heap(malloc_usable_size(p));
    return p;
}

void *calloc(size_t n, size_t bytes) {
    void *p = __libc_calloc(n, bytes);
    if (p) count_heap(malloc_usable_size(p));
    return p;
}

void *realloc(void *old, size_t bytes) {
    const size_t before = old ? malloc_usable_size(old) : 0;
    void *p = __libc_realloc(old, bytes);
    if (p || !bytes) atomic_fetch_sub(&taken, before);
    if (p) count_heap(malloc_usable_size(p));
    return p;
}

void free(void *p) {
    if (p) atomic_fetch_sub(&taken, malloc_usable_size(p));
    __libc_free(p);
}

#endif
