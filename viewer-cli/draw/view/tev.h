/* Images to a running tev (https://github.com/Tom94/tev), by its network protocol. */
#ifndef GLINT_VIEWER_VIEW_TEV_H
#define GLINT_VIEWER_VIEW_TEV_H

#include "draw/view/source.h"

/* `host` is HOST, HOST:PORT or [IPv6]:PORT; tev listens at 14158. The image is replaced when one of this name is there. */
bool tev_send(const char *host, const char *name, const struct source *source, struct glint_error *err);

#endif
