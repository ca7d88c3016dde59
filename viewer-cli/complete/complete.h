/* Completion: what may stand at the cursor of a shell. The scripts beside this file ask for it with glint --complete WORD…. */
#ifndef GLINT_VIEWER_COMPLETE_H
#define GLINT_VIEWER_COMPLETE_H

#include "command.h"

/* The word that is being completed. */
struct completion {
    const char *const *words; /* those before it, from the command on */
    size_t count;
    char before[4096]; /* its part that is finished: "--set=", "travelled," */
    const char *typed; /* and the part that a candidate begins with */
    char **offered;
    size_t offered_count;
};

/* Offers a candidate that takes the place of `typed`, with a description or NULL. Other beginnings and what was offered before are ignored.
   Ends that are no end of a word ('=', '.', ':') are left to the shell. */
void complete_offer(struct completion *c, const char *candidate, const char *about);
/* The next bytes of the word are finished, too. */
void complete_finish(struct completion *c, size_t bytes);
/* Offers what a placeholder of the help stands for: alternatives with '|' between them, each a kind ("PRESET", "SLOT.PARAM=VALUE"), words that
   stand for themselves ("half"), or something that only the user knows ("N"). An ending "..." of a list with commas continues it. */
void complete_placeholder(struct completion *c, const char *placeholder);

/* Prints the candidates for the last of these words, one a line with a tab before the description. A line ":files" or ":folders", with a tab and
   the finished part of the word, asks the shell for names of files or folders besides. */
void complete_print(int count, char *const words[]);

#endif
