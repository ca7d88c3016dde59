/* How a command can end. */
#ifndef GLINT_VIEWER_STATUS_H
#define GLINT_VIEWER_STATUS_H

enum status { STATUS_DONE = 0, STATUS_CHECK = 1, STATUS_USAGE = 2, STATUS_NOT_RUN = 2, STATUS_INTERRUPTED = 130 };

#endif
