/* Error values and progress reports shared by every glint library. */
#ifndef GLINT_COMMON_H
#define GLINT_COMMON_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Lets compilers check arguments against a format of C11's printf. */
#if defined(__MINGW32__) && !defined(__clang__)
#define GLINT_PRINTF(format_index, first) __attribute__((format(gnu_printf, format_index, first)))
#elif defined(__GNUC__)
#define GLINT_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define GLINT_PRINTF(format_index, first)
#endif

enum glint_code {
    GLINT_OK = 0,
    GLINT_ERROR_USAGE,       /* the caller requested something that does not exist or is out of range */
    GLINT_ERROR_IO,          /* the operating system refused: missing file, full disk */
    GLINT_ERROR_FORMAT,      /* the file breaks a rule of FORMAT.md */
    GLINT_ERROR_LIMIT,       /* within the format, but past a limit of this reader */
    GLINT_ERROR_UNSUPPORTED, /* valid, but this build or device cannot do it */
    GLINT_ERROR_MEMORY,
    GLINT_ERROR_DEVICE,     /* a Vulkan call failed */
    GLINT_ERROR_INTERRUPTED /* a progress callback asked to stop */
};

/* Zero-initialise. The message is one line without a newline, UTF-8, and names what was expected and found. */
struct glint_error {
    enum glint_code code;
    char message[1024];
};

/* Sets *err unless err is NULL; always returns false, so that `return glint_fail(…)` reads well. */
GLINT_PRINTF(3, 4)
bool glint_fail(struct glint_error *err, enum glint_code code, const char *format, ...);

/* Creates a folder and its missing parents. It is no error if the folder exists. */
bool glint_make_folder(const char *folder, struct glint_error *err);

/* The declarations of libglint-capture's public headers, with which this library was compiled, as C without comments and macros. A binding
   that takes the layout of structs and the parameters of functions from here fits every version of the library. */
const char *glint_declarations(void);

/* Called repeatedly during long work, on the thread that called glint. `done` is in [0, 1]; `what` is valid during the call only.
   Return false to stop the work, which then fails with GLINT_ERROR_INTERRUPTED and leaves only complete files behind. */
typedef bool (*glint_progress)(void *user, const char *what, double done);

#ifdef __cplusplus
}
#endif
#endif
