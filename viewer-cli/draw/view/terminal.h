/* Draws pictures in the terminal with chafa. */
#ifndef GLINT_VIEWER_VIEW_TERMINAL_H
#define GLINT_VIEWER_VIEW_TERMINAL_H

#include "draw/view/picture.h"

/* auto: what the terminal reports to support; the others regardless of it. */
enum terminal_mode { TERMINAL_AUTO, TERMINAL_KITTY, TERMINAL_SIXEL, TERMINAL_ITERM2, TERMINAL_BLOCKS };
extern const char *const terminal_mode_names[]; /* "auto", "kitty", …, NULL */

/* Draws to stdout, as wide as the terminal but not higher; 80 columns if stdout is not a terminal. */
bool terminal_draw(const struct picture *picture, enum terminal_mode mode, struct glint_error *err);

#endif
