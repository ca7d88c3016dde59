/* A room without a ceiling and a block in it, of all kinds of surfaces, with two cube maps, the sky, water and panes: for what holds
   of any scene. */
#ifndef GLINT_TESTS_PASSES_ROOM_H
#define GLINT_TESTS_PASSES_ROOM_H

#include "gpu.h"

enum { ROOM_SIZE = 96 };

/* Writes and loads it, or the same with the world's x and y exchanged. */
void room_load(struct gpu *gpu, bool swapped);
/* A fresh pipeline of plain.json whose random choices are off, changed by words: slot=variant, slot.parameter=value; NULL ends
   them. Every pass runs, in floats. */
void room_arrange(struct gpu *gpu, const char *const *words);

#endif
