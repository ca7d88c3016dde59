/* Memory of scripts: Duktape 2.7 crashes in places where it gets none, so it never sees that there is none. */
#ifndef GLINT_VIEWER_SCRIPT_HEAP_H
#define GLINT_VIEWER_SCRIPT_HEAP_H

#include <setjmp.h>
#include <stddef.h>

struct script_block;
/* All blocks of a heap of Duktape. Where one cannot be allocated, the functions jump to `out`, which the caller sets before each call of Duktape; the
   heap is then in no state to be used, and script_heap_free frees what it has. */
struct script_heap {
    struct script_block *first;
    jmp_buf out;
};
/* Duktape's allocation functions; `heap` is a struct script_heap. */
void *script_alloc(void *heap, size_t size);
void *script_realloc(void *heap, void *pointer, size_t size);
void script_free(void *heap, void *pointer);
void script_heap_free(struct script_heap *heap);

#endif
