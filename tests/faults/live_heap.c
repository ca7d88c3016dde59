/* A library to preload (LD_PRELOAD) that counts the memory which threads of glint hold: the bytes that they allocated and nobody has freed. Threads that the Vulkan driver
   started are left out, as what they hold changes from moment to moment. The layer of fault_layer.c asks for the sum. */
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* glibc's own names of what is replaced here: dlsym allocates, too. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

size_t live_heap_bytes(void);

/* A hash table of addresses. A place that was freed stays taken, so that searches go on behind it, until another address gets it. */
enum { PLACES = 1 << 20 };
static struct place {
    uintptr_t address; /* 0: never used, 1: freed */
    size_t bytes;
} * places;
static size_t total;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static _Thread_local bool of_driver __attribute__((tls_model("initial-exec")));

static size_t first_place(uintptr_t address) {
    return (address >> 4) * UINT64_C(11400714819323198485) >> 44;
}

static void *note(void *memory, size_t bytes) {
    if (!memory || of_driver) return memory;
    pthread_mutex_lock(&lock);
    if (!places)
        places = mmap(NULL, PLACES * sizeof *places, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    size_t i = first_place((uintptr_t)memory);
    while (places[i].address > 1) i = (i + 1) % PLACES;
    places[i] = (struct place){(uintptr_t)memory, bytes};
    total += bytes;
    pthread_mutex_unlock(&lock);
    return memory;
}

static void forget(void *memory) {
    if (!memory || !places) return;
    pthread_mutex_lock(&lock);
    size_t i = first_place((uintptr_t)memory);
    while (places[i].address && places[i].address != (uintptr_t)memory) i = (i + 1) % PLACES;
    if (places[i].address) {
        total -= places[i].bytes;
        places[i] = (struct place){1, 0};
    }
    pthread_mutex_unlock(&lock);
}

size_t live_heap_bytes(void) {
    return total;
}

void *malloc(size_t bytes) {
    return note(__libc_malloc(bytes), bytes);
}
void *calloc(size_t count, size_t bytes) {
    return note(__libc_calloc(count, bytes), count * bytes);
}
void *realloc(void *memory, size_t bytes) {
    forget(memory);
    return note(__libc_realloc(memory, bytes), bytes);
}
void *memalign(size_t alignment, size_t bytes) {
    return note(__libc_memalign(alignment, bytes), bytes);
}
void *aligned_alloc(size_t alignment, size_t bytes) {
    return memalign(alignment, bytes);
}
int posix_memalign(void **memory, size_t alignment, size_t bytes) {
    *memory = memalign(alignment, bytes);
    return *memory ? 0 : 12; /* ENOMEM */
}
void free(void *memory) {
    forget(memory);
    __libc_free(memory);
}

struct start {
    void *(*run)(void *);
    void *user;
    bool of_driver;
};

static void *run_thread(void *user) {
    const struct start start = *(struct start *)user;
    free(user);
    of_driver = start.of_driver;
    return start.run(start.user);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *user) {
    static int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    Dl_info object = {0};
    struct start *start = malloc(sizeof *start);
    *start = (struct start){run, user, dladdr(*(void **)&run, &object) && !strstr(object.dli_fname, "glint")};
    return next(thread, attributes, run_thread, start);
}
