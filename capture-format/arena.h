/* An arena: many small allocations that are freed together. */
#ifndef GLINT_ARENA_H
#define GLINT_ARENA_H

#include <stdbool.h>
#include <stddef.h>

struct glint_arena {
    struct glint_arena_block *last;
    size_t bytes;   /* allocated so far */
    bool exhausted; /* an allocation failed, whatever else what failed then says */
};

/* Zeroed, aligned for any type; NULL if memory is exhausted. */
void *glint_arena_take(struct glint_arena *arena, size_t bytes);
void *glint_arena_copy(struct glint_arena *arena, const void *data, size_t bytes);
char *glint_arena_string(struct glint_arena *arena, const char *string);
void glint_arena_finish(struct glint_arena *arena);

#endif
