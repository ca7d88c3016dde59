/* How much the program has on the heap, counted by standing in for malloc. Under AddressSanitizer, which does that
   itself, by its hooks. */
#ifndef HEAP_H
#define HEAP_H

#include <stddef.h>

/* Begins a new peak and returns what is taken now. */
size_t heap_peak_reset(void);
/* The most that was taken since. */
size_t heap_peak(void);

#endif
