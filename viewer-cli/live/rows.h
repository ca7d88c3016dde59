/* Work on the rows of a picture, by several threads beside each other. */
#ifndef GLINT_VIEWER_LIVE_ROWS_H
#define GLINT_VIEWER_LIVE_ROWS_H

#include <stdint.h>

/* Calls `work` for parts of the rows 0 … rows - 1 that together are all of them, on as many threads as there are processors, at most 16. */
void rows_share(uint32_t rows, void (*work)(void *user, uint32_t first, uint32_t end), void *user);

#endif
