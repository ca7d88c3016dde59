/* An arena: many small allocations that are freed together. */
#include "arena.h"

#include <stdlib.h>
#include <string.h>

struct glint_arena_block {
    struct glint_arena_block *previous;
    _Alignas(max_align_t) char data[];
};

void *glint_arena_take(struct glint_arena *arena, size_t bytes) {
    const bool fits = bytes <= (size_t)-1 - sizeof(struct glint_arena_block);
    struct glint_arena_block *block = fits ? calloc(1, sizeof *block + (bytes ? bytes : 1)) : NULL;
    if (!block) {
        arena->exhausted = true;
        return NULL;
    }
    block->previous = arena->last;
    arena->last = block;
    arena->bytes += bytes;
    return block->data;
}

void *glint_arena_copy(struct glint_arena *arena, const void *data, size_t bytes) {
    void *copy = glint_arena_take(arena, bytes);
    if (copy && bytes) memcpy(copy, data, bytes);
    return copy;
}

char *glint_arena_string(struct glint_arena *arena, const char *string) {
    return glint_arena_copy(arena, string, strlen(string) + 1);
}

void glint_arena_finish(struct glint_arena *arena) {
    while (arena->last) {
        struct glint_arena_block *block = arena->last;
        arena->last = block->previous;
        free(block);
    }
    arena->bytes = 0;
    arena->exhausted = false;
}
