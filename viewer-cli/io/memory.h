/* Memory that the program asked for and did not get. Hundreds of places make a text, a cell of a table or a value of JSON, and go on
   without it. What comes of that is not printed as if it were whole: no file gets its name (output.h), and main ends the command with
   "out of memory".

   The linker hands the allocations of the program's own code to memory.c (--wrap in meson.build), and Jansson's come from there in the
   whole process. Libraries of glint report what they lack as an error. */
#ifndef GLINT_VIEWER_MEMORY_H
#define GLINT_VIEWER_MEMORY_H

#include <stdbool.h>

/* From here on Jansson's allocations are noted, too, and a reserve is held for them. Called once, by main. */
void memory_begin(void);
void memory_end(void);
/* Whether an allocation failed, in any thread, since the beginning or memory_forget. */
bool memory_ran_out(void);
/* Notes a failure that only a library saw. */
void memory_note(void);
/* For what goes on after a part of its work failed: a server after a request. */
void memory_forget(void);

#endif
