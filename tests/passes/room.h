/* A room without a ceiling and a block in it, with all kinds of surfaces, two cube maps, the sky, water and panes: for properties that
   hold for any scene. */
#ifndef GLINT_TESTS_PASSES_ROOM_H
#define GLINT_TESTS_PASSES_ROOM_H

#include "gpu.h"

enum { ROOM_SIZE = 96 };

/* Writes and loads it, optionally with the world's x and y exchanged. */
void room_load(struct gpu *gpu, bool swapped);
/* Creates the pipeline of plain.json without random choices and applies words: slot=variant, slot.parameter=value, terminated by NULL.
   Every pass runs, with float images. */
void room_arrange(struct gpu *gpu, const char *const *words);

#endif
