/* A folder of files that later processes find by key, also those of other machines when it lies on a shared file system: docs/cache.md. Names are
   KEY-HASH and the extension that the file had, where HASH is that of KEY and of the file's contents: so a file with other contents, or those of
   another key, is noticed, and made anew. Any failure counts as a cache miss. */
#ifndef GLINT_CACHE_H
#define GLINT_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_CACHE_KEY_SIZE = 33
}; /* 32 hexadecimal digits and a NUL: a hash of everything that the contents depend on */

/* Why a folder is not used as a cache, or NULL: a folder that is there has to belong to the user, nobody else may write to it, and
   $GLINT_CACHE_GIB has to be a size. */
const char *glint_cache_refusal(const char *folder);
/* Belongs into the key of what a CPU device computed: a hash of the processor's model and instructions, for which its driver compiles. */
uint64_t glint_cache_processor(void);
/* The path of an intact entry of the key, which is also marked as recently used. Damaged ones are removed. Another process may remove the entry at
   any time: that its path cannot be opened or read afterwards is a miss, too. */
bool glint_cache_find(const char *folder, const char *key, char *path, size_t size);
/* Copies the entry to the file `to`, which appears complete or not at all. */
bool glint_cache_copy(const char *folder, const char *key, const char *to);
/* Stores a copy of the file unless the key has an intact entry, and creates the folder if necessary. Then removes the least recently used entries
   until the folder holds at most `max_bytes`; 0: $GLINT_CACHE_GIB, else 4 GiB. Larger files are not stored. */
void glint_cache_store(const char *folder, const char *key, const char *file, uint64_t max_bytes);

#ifdef __cplusplus
}
#endif
#endif
