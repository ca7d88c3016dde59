/* Counts the heap memory of the program by replacing malloc, or through the hooks of AddressSanitizer, which replaces malloc itself. */
#ifndef HEAP_H
#define HEAP_H

#include <stddef.h>

/* Begins a new peak and returns the current size. */
size_t heap_peak_reset(void);
/* The peak since then. */
size_t heap_peak(void);

#endif
