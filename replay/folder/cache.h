/* A folder of files that later processes find by key. Names are KEY-HASH.exr, where HASH is that of KEY and of the file's contents: so a
   file with other contents, or those of another key, is noticed, and made anew. Any failure counts as a cache miss. */
#ifndef GLINT_REPLAY_CACHE_H
#define GLINT_REPLAY_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CACHE_KEY_SIZE = 33 }; /* 32 hexadecimal digits */
#define CACHE_BYTES_MAX (UINT64_C(4) << 30)

/* The path of the entry if it is intact, which also marks it as recently used. A damaged entry is removed. */
bool cache_find(const char *folder, const char *key, char *path, size_t size);
/* Copies the entry to the file `to`, which appears complete or not at all. */
bool cache_copy(const char *folder, const char *key, const char *to);
/* Stores a copy of the file and creates the folder if necessary. Then removes the least recently used entries until the folder holds at
   most `max_bytes`. */
void cache_store(const char *folder, const char *key, const char *file, uint64_t max_bytes);

#endif
