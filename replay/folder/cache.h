/* A folder of files that later processes find again by key: KEY-HASH.exr, where HASH is that of the file's bytes. Whatever
   goes wrong in it is a file that is not there. */
#ifndef GLINT_REPLAY_CACHE_H
#define GLINT_REPLAY_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CACHE_KEY_SIZE = 33 }; /* 32 hexadecimal digits */
#define CACHE_BYTES_MAX (UINT64_C(4) << 30)

/* The path of an entry whose bytes are those that were stored; it becomes the one used last. A damaged one is removed. */
bool cache_find(const char *folder, const char *key, char *path, size_t size);
/* Copies the entry: whole or not at all. */
bool cache_give(const char *folder, const char *key, const char *to);
/* Keeps a copy of the file, and makes the folder if need be. Then what was not used for longest goes until `most` bytes
   are left. */
void cache_store(const char *folder, const char *key, const char *file, uint64_t most);

#endif
