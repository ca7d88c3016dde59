/* The values of end reasons, as the diagnostics hold them. */
#ifndef GLINT_VIEWER_ENDS_H
#define GLINT_VIEWER_ENDS_H

enum {
#define REASON(name, ...) END_##name,
#include "../../passes/shared/end_reasons.h"
#undef REASON
};

#endif
