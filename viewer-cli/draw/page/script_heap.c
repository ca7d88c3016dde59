/* Memory of scripts, as a list of blocks. */
#include "draw/page/script_heap.h"

#include <stdalign.h>
#include <stdlib.h>

/* In front of what Duktape gets. */
struct script_block {
    alignas(max_align_t) struct script_block *previous;
    struct script_block *next;
};

static void add(struct script_heap *heap, struct script_block *block) {
    *block = (struct script_block){NULL, heap->first};
    if (heap->first) heap->first->previous = block;
    heap->first = block;
}

static void take_out(struct script_heap *heap, const struct script_block *block) {
    if (block->previous) block->previous->next = block->next;
    else heap->first = block->next;
    if (block->next) block->next->previous = block->previous;
}

void *script_alloc(void *user, size_t size) {
    struct script_heap *heap = user;
    if (!size) return NULL;
    struct script_block *block = malloc(sizeof *block + size);
    if (!block) longjmp(heap->out, 1);
    add(heap, block);
    return block + 1;
}

void script_free(void *user, void *pointer) {
    if (!pointer) return;
    struct script_block *block = (struct script_block *)pointer - 1;
    take_out(user, block);
    free(block);
}

void *script_realloc(void *user, void *pointer, size_t size) {
    struct script_heap *heap = user;
    if (!pointer) return script_alloc(user, size);
    if (!size) return script_free(user, pointer), NULL;
    struct script_block *block = (struct script_block *)pointer - 1;
    take_out(heap, block);
    struct script_block *larger = realloc(block, sizeof *block + size);
    add(heap, larger ? larger : block);
    if (!larger) longjmp(heap->out, 1);
    return larger + 1;
}

void script_heap_free(struct script_heap *heap) {
    for (struct script_block *block = heap->first, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    heap->first = NULL;
}
