/* Allocations, which note that one failed. */
#include "io/memory.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "status.h"

static atomic_bool ran_out;

bool memory_ran_out(void) {
    return atomic_load(&ran_out);
}

void memory_note(void) {
    atomic_store(&ran_out, true);
}

void memory_forget(void) {
    atomic_store(&ran_out, false);
}

static void *noted(void *memory) {
    if (!memory) atomic_store(&ran_out, true);
    return memory;
}

/* ---- Jansson: 2.14 writes past the end of a string that it reads when its buffer cannot grow, and passes over what it cannot store. It
   has to get its memory: without any from a reserve, whose parts stay taken, and then the command fails at its end. ---- */

enum { RESERVE_BYTES = 16 << 20 }; /* the registry of glint live takes some; what is not taken costs no memory */
static char *reserve;
static atomic_size_t reserve_taken;

static void *take_for_json(size_t bytes) {
    void *memory = malloc(bytes);
    if (memory) return memory;
    const size_t align = _Alignof(max_align_t);
    if (reserve && bytes < RESERVE_BYTES) {
        const size_t needed = (bytes + align) / align * align, at = atomic_fetch_add(&reserve_taken, needed);
        if (at <= RESERVE_BYTES - needed) return reserve + at;
    }
    static const char text[] = "glint: out of memory\n";
    const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
    _exit(written < 0 ? STATUS_USAGE : STATUS_CHECK); /* rather than wrong texts, or worse */
}

/* Texts of JSON come from record_text, so that what is freed elsewhere is never Jansson's. */
static void give_back(void *memory) {
    const char *at = memory;
    if (!reserve || at < reserve || at >= reserve + RESERVE_BYTES) free(memory);
}

void memory_begin(void) {
    reserve = malloc(RESERVE_BYTES);
    json_set_alloc_funcs(take_for_json, give_back);
}

void memory_end(void) {
    char *memory = reserve;
    reserve = NULL;
    free(memory);
}

/* ---- What the linker has the program call in place of the C library's functions (__wrap_), and these themselves (__real_) ---- */

void *__real_malloc(size_t bytes);
void *__real_calloc(size_t count, size_t bytes);
void *__real_realloc(void *memory, size_t bytes);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t length);
int __real_vasprintf(char **text, const char *format, va_list args);

void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
void *__wrap_realloc(void *memory, size_t bytes);
char *__wrap_strdup(const char *text);
char *__wrap_strndup(const char *text, size_t length);
int __wrap_vasprintf(char **text, const char *format, va_list args);
int __wrap_asprintf(char **text, const char *format, ...);
FILE *__wrap_open_memstream(char **text, size_t *length);
/* What FORTIFY makes of the two. */
int __real___vasprintf_chk(char **text, int flag, const char *format, va_list args);
int __wrap___vasprintf_chk(char **text, int flag, const char *format, va_list args);
int __wrap___asprintf_chk(char **text, int flag, const char *format, ...);

void *__wrap_malloc(size_t bytes) {
    return noted(__real_malloc(bytes ? bytes : 1));
}

void *__wrap_calloc(size_t count, size_t bytes) {
    return noted(__real_calloc(count ? count : 1, bytes ? bytes : 1));
}

void *__wrap_realloc(void *memory, size_t bytes) {
    return noted(__real_realloc(memory, bytes ? bytes : 1));
}

char *__wrap_strdup(const char *text) {
    return noted(__real_strdup(text));
}

char *__wrap_strndup(const char *text, size_t length) {
    return noted(__real_strndup(text, length));
}

/* A negative length is that of a text that is too long or no text at all, too, which is none of what these formats make. */
int __wrap_vasprintf(char **text, const char *format, va_list args) {
    const int length = __real_vasprintf(text, format, args);
    if (length < 0) noted(*text = NULL);
    return length;
}

int __wrap_asprintf(char **text, const char *format, ...) {
    va_list args;
    va_start(args, format);
    const int length = __wrap_vasprintf(text, format, args);
    va_end(args);
    return length;
}

int __wrap___vasprintf_chk(char **text, int flag, const char *format, va_list args) {
    const int length = __real___vasprintf_chk(text, flag, format, args);
    if (length < 0) noted(*text = NULL);
    return length;
}

int __wrap___asprintf_chk(char **text, int flag, const char *format, ...) {
    va_list args;
    va_start(args, format);
    const int length = __wrap___vasprintf_chk(text, flag, format, args);
    va_end(args);
    return length;
}

/* ---- A stream into memory: glibc's loses what does not fit, and only the function that wrote it knows ---- */

struct stream {
    char **text;
    size_t *length, capacity;
};

static ssize_t stream_write(void *cookie, const char *from, size_t bytes) {
    struct stream *stream = cookie;
    const size_t needed = *stream->length + bytes + 1;
    if (needed > stream->capacity) {
        const size_t capacity = needed > 2 * stream->capacity ? needed : 2 * stream->capacity;
        char *text = realloc(*stream->text, capacity);
        if (!text) return 0;
        *stream->text = text;
        stream->capacity = capacity;
    }
    memcpy(*stream->text + *stream->length, from, bytes);
    *stream->length += bytes;
    (*stream->text)[*stream->length] = '\0';
    return (ssize_t)bytes;
}

/* Tells the position, which ftell asks for; there is no going back. */
static int stream_seek(void *cookie, off64_t *offset, int from) {
    const struct stream *stream = cookie;
    if (*offset != 0 || from == SEEK_SET) return -1;
    *offset = (off64_t)*stream->length;
    return 0;
}

static int stream_close(void *cookie) {
    free(cookie);
    return 0;
}

FILE *__wrap_open_memstream(char **text, size_t *length) {
    struct stream *stream = malloc(sizeof *stream);
    char *begin = calloc(1, 1);
    FILE *file =
        stream && begin
            ? fopencookie(stream, "w",
                          (cookie_io_functions_t){.write = stream_write, .seek = stream_seek, .close = stream_close})
            : NULL;
    if (!noted(file)) {
        free(stream);
        free(begin);
        return NULL;
    }
    *stream = (struct stream){text, length, 1};
    *text = begin;
    *length = 0;
    return file;
}
