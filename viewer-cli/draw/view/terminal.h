/* Pictures in the terminal, by chafa. */
#ifndef GLINT_VIEWER_VIEW_TERMINAL_H
#define GLINT_VIEWER_VIEW_TERMINAL_H

#include "draw/view/picture.h"

/* How: what the terminal says that it can, or one of these whatever it says. */
enum terminal_mode { TERMINAL_AUTO, TERMINAL_KITTY, TERMINAL_SIXEL, TERMINAL_ITERM2, TERMINAL_BLOCKS };
extern const char *const terminal_mode_names[]; /* "auto", "kitty", …, NULL */

/* To stdout, as wide as the terminal and no higher; 80 columns where there is none. */
bool terminal_draw(const struct picture *picture, enum terminal_mode mode, struct glint_error *err);

#endif
