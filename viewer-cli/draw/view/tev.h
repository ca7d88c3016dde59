/* Sends images to a running tev (https://github.com/Tom94/tev) through its network protocol. */
#ifndef GLINT_VIEWER_VIEW_TEV_H
#define GLINT_VIEWER_VIEW_TEV_H

#include "draw/view/source.h"

/* `host` is HOST, HOST:PORT or [IPv6]:PORT; the default port is 14158. An image of the same name is replaced. */
bool tev_send(const char *host, const char *name, const struct source *source, struct glint_error *err);

#endif
